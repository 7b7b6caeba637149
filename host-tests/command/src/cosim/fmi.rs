//! The functions of FMI 2.0 and 3.0 that a co-simulation of scalars calls: all `unsafe` code of this crate.
//!
//! A shared library is trusted: its functions are taken for those of the standard (FMI 2.0.4, 4.2; FMI 3.0.2, 4.2). It
//! stays loaded until the program ends, since it may have left code to be called then.

use std::cell::Cell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::ptr::{null, null_mut};
use std::sync::{Mutex, PoisonError};

use dlopen2::raw::Library;

use super::description::{Description, Version};

type Component = *mut c_void;
type Enter = unsafe extern "C" fn(Component) -> c_int;

/// `fmi2CallbackFunctions`.
#[repr(C)]
struct Callbacks {
    /// A function of variable arguments: those that are named come first, where [`log_two`] expects them.
    logger: *const c_void,
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    step_finished: *const c_void,
    environment: *mut c_void,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

/// The last message: why a function failed.
type Log = Mutex<String>;

/// # Safety
/// The environment that a callback was registered with, and a text.
unsafe fn keep(environment: *mut c_void, message: *const c_char) {
    // SAFETY: the caller's.
    if let (Some(log), false) = (unsafe { environment.cast::<Log>().as_ref() }, message.is_null()) {
        // SAFETY: the caller's.
        let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().trim().to_owned();
        *log.lock().unwrap_or_else(PoisonError::into_inner) = message;
    }
}

/// `fmi2CallbackLogger` without the values of the message's placeholders, which the caller puts behind it.
unsafe extern "C" fn log_two(
    environment: *mut c_void,
    _name: *const c_char,
    _status: c_int,
    _category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: what the standard passes.
    unsafe { keep(environment, message) };
}

/// `fmi3LogMessageCallback`.
unsafe extern "C" fn log_three(
    environment: *mut c_void,
    _status: c_int,
    _category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: what the standard passes.
    unsafe { keep(environment, message) };
}

type InstantiateTwo = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const Callbacks,
    c_int,
    c_int,
) -> Component;
type InstantiateThree = unsafe extern "C" fn(
    *const c_char,
    *const c_char,
    *const c_char,
    bool,
    bool,
    bool,
    bool,
    *const u32,
    usize,
    *mut c_void,
    unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char),
    *const c_void,
) -> Component;

/// The functions of a version.
enum Functions {
    Two {
        set_up: unsafe extern "C" fn(Component, c_int, f64, f64, c_int, f64) -> c_int,
        get: unsafe extern "C" fn(Component, *const u32, usize, *mut f64) -> c_int,
        set: unsafe extern "C" fn(Component, *const u32, usize, *const f64) -> c_int,
        step: unsafe extern "C" fn(Component, f64, f64, c_int) -> c_int,
        enter: Enter,
    },
    Three {
        get: unsafe extern "C" fn(Component, *const u32, usize, *mut f64, usize) -> c_int,
        set: unsafe extern "C" fn(Component, *const u32, usize, *const f64, usize) -> c_int,
        get_bits: unsafe extern "C" fn(Component, *const u32, usize, *mut u32, usize) -> c_int,
        step: unsafe extern "C" fn(Component, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> c_int,
        enter: unsafe extern "C" fn(Component, bool, f64, f64, bool, f64) -> c_int,
    },
}

/// An instance for co-simulation.
pub struct Instance {
    component: Component,
    functions: Functions,
    exit: Enter,
    terminate: Enter,
    release: unsafe extern "C" fn(Component),
    model: String,
    begun: bool,
    /// The worst status so far.
    worst: Cell<c_int>,
    log: Box<Log>,
    /// The library keeps a pointer to it.
    _callbacks: Box<Callbacks>,
    _library: ManuallyDrop<Library>,
}

impl Instance {
    /// Loads a library and makes an instance; `resources` is the FMU's folder of that name.
    ///
    /// # Errors
    /// A library of another computer, a function that is missing, a token that is refused.
    pub fn new(description: &Description, library: &Path, resources: &Path) -> Result<Self, String> {
        let Description { version, model, token, .. } = description;
        let loaded = Library::open(library).map_err(|error| format!("`{model}` cannot be loaded: {error}"))?;
        let prefix = if *version == Version::Two { "fmi2" } else { "fmi3" };
        // SAFETY (of every call): the type is that of the standard for this name, a pointer to a function.
        unsafe fn symbol<T>(library: &Library, name: &str) -> Result<T, String> {
            // SAFETY: the caller's.
            unsafe { library.symbol(name) }.map_err(|error| format!("the function `{name}` is missing: {error}"))
        }
        let named = |name: &str| format!("{prefix}{name}");
        let log: Box<Log> = Box::default();
        let environment: *mut c_void = (&raw const *log).cast_mut().cast();
        let callbacks = Box::new(Callbacks {
            logger: log_two as *const c_void,
            allocate: calloc,
            free,
            step_finished: null(),
            environment,
        });
        let text = |text: &str| CString::new(text).map_err(|_| format!("`{model}`: a name has a zero in it"));
        let (name, token) = (text("driveline")?, text(token)?);
        let folder = resources.display().to_string();
        let (component, functions);
        // SAFETY: types and arguments of the standard; the texts outlive the call, callbacks and log the instance.
        unsafe {
            if *version == Version::Two {
                let instantiate: InstantiateTwo = symbol(&loaded, "fmi2Instantiate")?;
                let place = text(&format!("file://{}", folder.replace(' ', "%20")))?;
                functions = Functions::Two {
                    set_up: symbol(&loaded, "fmi2SetupExperiment")?,
                    get: symbol(&loaded, "fmi2GetReal")?,
                    set: symbol(&loaded, "fmi2SetReal")?,
                    step: symbol(&loaded, "fmi2DoStep")?,
                    enter: symbol(&loaded, "fmi2EnterInitializationMode")?,
                };
                const CO_SIMULATION: c_int = 1;
                let (name, token, place) = (name.as_ptr(), token.as_ptr(), place.as_ptr());
                component = instantiate(name, CO_SIMULATION, token, place, &raw const *callbacks, 0, 0);
            } else {
                let instantiate: InstantiateThree = symbol(&loaded, "fmi3InstantiateCoSimulation")?;
                let place = text(&format!("{folder}/"))?;
                functions = Functions::Three {
                    get: symbol(&loaded, "fmi3GetFloat64")?,
                    set: symbol(&loaded, "fmi3SetFloat64")?,
                    get_bits: symbol(&loaded, "fmi3GetUInt32")?,
                    step: symbol(&loaded, "fmi3DoStep")?,
                    enter: symbol(&loaded, "fmi3EnterInitializationMode")?,
                };
                let (name, token, place) = (name.as_ptr(), token.as_ptr(), place.as_ptr());
                component = instantiate(
                    name,
                    token,
                    place,
                    false,
                    false,
                    false,
                    false,
                    null(),
                    0,
                    environment,
                    log_three,
                    null(),
                );
            }
        }
        let instance = Self {
            component,
            functions,
            // SAFETY: as above.
            exit: unsafe { symbol(&loaded, &named("ExitInitializationMode"))? },
            // SAFETY: as above.
            terminate: unsafe { symbol(&loaded, &named("Terminate"))? },
            // SAFETY: as above.
            release: unsafe { symbol(&loaded, &named("FreeInstance"))? },
            model: model.clone(),
            begun: false,
            worst: Cell::new(0),
            log,
            _callbacks: callbacks,
            _library: ManuallyDrop::new(loaded),
        };
        if component.is_null() { Err(instance.refused("it makes no instance")) } else { Ok(instance) }
    }

    fn refused(&self, what: &str) -> String {
        let said = std::mem::take(&mut *self.log.lock().unwrap_or_else(PoisonError::into_inner));
        let colon = if said.is_empty() { "" } else { ": " };
        format!("`{}`: {what}{colon}{said}", self.model)
    }

    /// The result of a function: OK or a warning, or the reason.
    fn done(&self, status: c_int, what: impl FnOnce() -> String) -> Result<(), String> {
        self.worst.set(self.worst.get().max(status));
        if matches!(status, 0 | 1) { Ok(()) } else { Err(self.refused(&what())) }
    }

    /// Begins initialisation at the time zero.
    pub fn begin(&mut self) -> Result<(), String> {
        // SAFETY: an instance of these functions.
        let status = unsafe {
            match self.functions {
                Functions::Two { set_up, enter, .. } => match set_up(self.component, 0, 0.0, 0.0, 0, 0.0) {
                    0 | 1 => enter(self.component),
                    status => status,
                },
                Functions::Three { enter, .. } => enter(self.component, false, 0.0, 0.0, false, 0.0),
            }
        };
        self.done(status, || "the initialisation cannot begin".to_owned())
    }

    /// Ends initialisation: steps may follow.
    pub fn start(&mut self) -> Result<(), String> {
        // SAFETY: an instance of this function.
        let status = unsafe { (self.exit)(self.component) };
        self.done(status, || "the initialisation failed".to_owned())?;
        self.begun = true;
        Ok(())
    }

    /// Values of scalar numbers.
    pub fn get(&self, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        assert_eq!(references.len(), values.len());
        let (variables, count, to) = (references.as_ptr(), references.len(), values.as_mut_ptr());
        // SAFETY: an instance of these functions; as many references as values.
        let status = unsafe {
            match self.functions {
                Functions::Two { get, .. } => get(self.component, variables, count, to),
                Functions::Three { get, .. } => get(self.component, variables, count, to, count),
            }
        };
        self.done(status, || "the outputs cannot be read".to_owned())
    }

    /// Sets scalar numbers.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), String> {
        assert_eq!(references.len(), values.len());
        let (variables, count, from) = (references.as_ptr(), references.len(), values.as_ptr());
        // SAFETY: an instance of these functions; as many references as values.
        let status = unsafe {
            match self.functions {
                Functions::Two { set, .. } => set(self.component, variables, count, from),
                Functions::Three { set, .. } => set(self.component, variables, count, from, count),
            }
        };
        self.done(status, || "a value is refused".to_owned())
    }

    /// Value of a `UInt32`, which FMI 3.0 alone has.
    pub fn bits(&self, reference: u32) -> Result<u32, String> {
        let Functions::Three { get_bits, .. } = self.functions else {
            return Err(self.refused("FMI 2.0 has no type UInt32"));
        };
        let mut value = 0;
        // SAFETY: an instance of this function, one reference, one value.
        let status = unsafe { get_bits(self.component, &raw const reference, 1, &raw mut value, 1) };
        self.done(status, || "an output cannot be read".to_owned())?;
        Ok(value)
    }

    /// A step of a size (s) from a time (s).
    ///
    /// # Errors
    /// The FMU's message; an FMU that stops early or asks for the end.
    pub fn step(&mut self, time: f64, size: f64) -> Result<(), String> {
        let [mut event, mut end, mut early] = [false; 3];
        let mut reached = time + size;
        // SAFETY: an instance of these functions, variables of this call.
        let status = unsafe {
            match self.functions {
                Functions::Two { step, .. } => step(self.component, time, size, 1),
                Functions::Three { step, .. } => {
                    let (event, end, early) = (&raw mut event, &raw mut end, &raw mut early);
                    step(self.component, time, size, true, event, end, early, &raw mut reached)
                }
            }
        };
        self.done(status, || format!("the step of {size} s from {time} s failed"))?;
        if end || early {
            return Err(self.refused(&format!("it ends the simulation at {reached} s")));
        }
        Ok(())
    }
}

/// Status of both versions after which an instance may not be used.
const FATAL: c_int = 4;

impl Drop for Instance {
    fn drop(&mut self) {
        // after a fatal status no function may be called, after an error none but the release
        if self.component.is_null() || self.worst.get() >= FATAL {
            return;
        }
        // SAFETY: the instance, for the last time.
        unsafe {
            if self.begun && self.worst.get() <= 1 {
                (self.terminate)(self.component);
            }
            (self.release)(self.component);
        }
        self.component = null_mut();
    }
}
