//! Steps of observers over stiff and extreme machines.

mod discretisation;
mod errors;
