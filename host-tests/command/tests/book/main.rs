//! The book in `doc/` against the tree: links, paths, files, keys, commands and scenes that it names are there.

mod commands;
mod dependencies;
mod files;
mod links;
mod pages;
mod scenes;
