#![no_std]
//! Scenes and boards.
