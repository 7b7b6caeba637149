//! The order of the enable chain, and what a line that fails does to the others.

use driveline::axis::{Board, Enabling, Parts};
use driveline::fault::Faults;
use driveline_hal::{AwaitedAngle, AwaitedTorque, EnableChain, EnableLine, TripLine};
use embedded_hal::digital::{ErrorType, OutputPin};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction};
use std::cell::RefCell;
use std::rc::Rc;

use super::bus::FAILED;

type Order = Rc<RefCell<Vec<&'static str>>>;

/// A mocked pin that notes its name.
struct Noted(Pin, &'static str, Order);

impl ErrorType for Noted {
    type Error = MockError;
}

impl OutputPin for Noted {
    fn set_low(&mut self) -> Result<(), MockError> {
        self.2.borrow_mut().push(self.1);
        self.0.set_low()
    }
    fn set_high(&mut self) -> Result<(), MockError> {
        self.2.borrow_mut().push(self.1);
        self.0.set_high()
    }
}

/// Contactor (on while high), gate driver (on while low), brake (on while high).
fn chain(expected: [&[Transaction]; 3], order: &Order) -> EnableChain<Noted, 3> {
    let [contactor, gates, brake] = expected;
    let pin = |expected: &[Transaction], name| Noted(Pin::new(expected), name, order.clone());
    EnableChain::new([
        EnableLine::high(pin(contactor, "contactor")),
        EnableLine::low(pin(gates, "gates")),
        EnableLine::high(pin(brake, "brake")),
    ])
}

fn done(chain: EnableChain<Noted, 3>) {
    for line in chain.release() {
        line.release().0.done();
    }
}

const ON: State = State::High;
const OFF: State = State::Low;

fn set(state: State) -> Transaction {
    Transaction::set(state)
}

#[test]
fn lines_go_on_in_order_and_off_in_reverse() {
    let order = Order::default();
    let mut lines = chain([&[set(ON), set(OFF)], &[set(OFF), set(ON)], &[set(ON), set(OFF)]], &order);
    assert_eq!(lines.set_enabled(true), Ok(()));
    assert_eq!(lines.set_enabled(false), Ok(()));
    assert_eq!(*order.borrow(), ["contactor", "gates", "brake", "brake", "gates", "contactor"]);
    done(lines);
}

#[test]
fn a_line_that_does_not_go_on_takes_those_before_it_off_and_those_behind_it_stay_off() {
    let order = Order::default();
    let mut lines = chain([&[set(ON), set(OFF)], &[set(OFF).with_error(FAILED), set(ON)], &[set(OFF)]], &order);
    assert_eq!(lines.set_enabled(true), Err(Faults::ENABLE));
    assert_eq!(*order.borrow(), ["contactor", "gates", "brake", "gates", "contactor"]);
    done(lines);
}

#[test]
fn a_line_that_does_not_go_off_keeps_no_other_on() {
    let order = Order::default();
    let mut lines = chain([&[set(OFF)], &[set(ON).with_error(FAILED)], &[set(OFF)]], &order);
    assert_eq!(lines.set_enabled(false), Err(Faults::ENABLE));
    assert_eq!(*order.borrow(), ["brake", "gates", "contactor"]);
    done(lines);
}

#[test]
fn a_trip_output_begins_tripped_and_is_off_on_any_failure() {
    let expected = [set(OFF), set(ON).with_error(FAILED), set(OFF), set(ON), set(OFF)];
    let mut trip = TripLine::new(EnableLine::high(Pin::new(&expected))).unwrap();
    assert_eq!(trip.set_enabled(true), Err(Faults::ENABLE));
    assert_eq!(trip.set_enabled(true), Ok(()));
    assert_eq!(trip.set_enabled(false), Ok(()));
    trip.release().release().done();
    assert!(TripLine::new(EnableLine::high(Pin::new(&[set(OFF).with_error(FAILED)]))).is_err_and(|(faults, line)| {
        line.release().done();
        faults == Faults::ENABLE
    }));
}

/// Of a board made of parts, two lines: on one after the other, off in reverse, and both off where the second fails.
#[test]
fn two_lines_of_a_board_go_on_in_order_and_off_in_reverse() {
    let order = Order::default();
    let line = |expected: &[Transaction], name| {
        EnableChain::new([EnableLine::high(Noted(Pin::new(expected), name, order.clone()))])
    };
    let contactor = line(&[set(ON), set(OFF), set(ON), set(OFF)], "contactor");
    let brake = line(&[set(ON), set(OFF), set(ON).with_error(FAILED), set(OFF), set(OFF)], "brake");
    let mut board =
        Parts { angle: AwaitedAngle::new(), torque: AwaitedTorque::<f32>::new(), enable: (contactor, brake) };
    assert_eq!(board.set_enabled(true), Ok(()));
    assert_eq!(board.set_enabled(false), Ok(()));
    assert_eq!(*order.borrow(), ["contactor", "brake", "brake", "contactor"]);
    order.borrow_mut().clear();
    assert_eq!(board.set_enabled(true), Err(Faults::ENABLE));
    // the chain of the brake takes its own line off before both go off
    assert_eq!(*order.borrow(), ["contactor", "brake", "brake", "brake", "contactor"]);
    let (contactor, brake) = board.enable;
    for chain in [contactor, brake] {
        let [line] = chain.release();
        line.release().0.done();
    }
}
