//! The variants: their looks, their plots, their table.

use serde::Serialize;

use crate::chart;
use crate::chart::{Cost, Quality};
use crate::format;
use crate::format::{grouped, percent};
use crate::results::Variant;

/// A colour or a marker and what it stands for.
#[derive(Serialize)]
pub struct Named {
    pub name: String,
    pub index: usize,
}

/// The different names, in the order of their first appearance.
pub fn names(all: impl Iterator<Item = String>) -> Vec<String> {
    let mut names = Vec::new();
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The place of a name among them.
pub fn index_of(names: &[String], name: &str) -> usize {
    names.iter().position(|known| known == name).unwrap_or(0)
}

/// Colour and marker of each variant, and what they stand for.
pub struct Looks {
    /// Colour and marker, for each variant.
    pub each: Vec<(usize, usize)>,
    /// Legend of the colours: number and core.
    pub series: Vec<Named>,
    /// Legend of the markers: the observer.
    pub shapes: Vec<Named>,
}

/// Colours and markers there are.
const KINDS: usize = 6;

impl Looks {
    /// Gives every variant its look.
    pub fn of(variants: &[Variant]) -> Self {
        let target = |variant: &Variant| format!("{} on {}", variant.number, variant.core);
        let series = names(variants.iter().map(target));
        let shapes = names(variants.iter().map(|variant| variant.observer.clone()));
        let look = |variant: &Variant| {
            (index_of(&series, &target(variant)) % KINDS, index_of(&shapes, &variant.observer) % KINDS)
        };
        let each = variants.iter().map(look).collect();
        let listed = |names: Vec<String>| {
            let named = |(index, name)| Named { name, index: index % KINDS };
            names.into_iter().enumerate().map(named).collect()
        };
        Self { each, series: listed(series), shapes: listed(shapes) }
    }
}

/// A plot of error against cost.
#[derive(Serialize)]
pub struct Plot {
    group: &'static str,
    title: &'static str,
    svg: String,
}

/// A row of the table.
#[derive(Serialize)]
pub struct Row {
    look: (usize, usize),
    on_front: bool,
    label: Vec<String>,
    cells: Vec<String>,
    bit_exact: bool,
}

/// Two plots for each kind of cost.
pub fn costs(variants: &[Variant], look: &[(usize, usize)]) -> Vec<Plot> {
    if variants.is_empty() {
        return Vec::new();
    }
    let plot = |cost, quality| {
        let group = if cost == Cost::Tick { "tick" } else { "second" };
        let title = if quality == Quality::ShaftTorque { "Shaft torque" } else { "Load speed" };
        Plot { group, title, svg: chart::error_against_cost(variants, look, cost, quality) }
    };
    let both = |cost| [plot(cost, Quality::ShaftTorque), plot(cost, Quality::LoadSpeed)];
    [Cost::Tick, Cost::Second].into_iter().flat_map(both).collect()
}

/// The table.
pub fn rows(variants: &[Variant], look: &[(usize, usize)]) -> Vec<Row> {
    let points: Vec<(f64, f64)> =
        variants.iter().map(|variant| (variant.instructions.median as f64, variant.shaft_torque.rms)).collect();
    let front = chart::front(&points);
    let row = |(index, v): (usize, &Variant)| Row {
        look: look[index],
        on_front: front.contains(&index),
        label: vec![v.number.clone(), v.core.clone(), v.observer.clone(), format::rate(v.rate_hz)],
        cells: vec![
            percent(v.shaft_torque.rms),
            percent(v.shaft_torque.max),
            percent(v.load_speed.rms),
            percent(v.load_speed.max),
            percent(v.load_torque.rms),
            percent(v.load_torque.max),
            grouped(v.instructions.min as i64),
            grouped(v.instructions.median as i64),
            grouped(v.instructions.max as i64),
            format::interval(v.cycles),
            grouped(v.flash_bytes as i64),
            grouped(v.ram_bytes as i64),
            grouped(v.stack_bytes as i64),
        ],
        bit_exact: v.bit_exact,
    };
    variants.iter().enumerate().map(row).collect()
}
