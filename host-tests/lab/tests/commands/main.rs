//! The laboratory's commands and the frame of all: help, errors, JSON, results, pages.

mod browser;
mod campaign;
mod cli;
mod pages;
mod ring_down;
#[path = "../../../report/tests/report/sample.rs"]
mod sample;
mod scope;
