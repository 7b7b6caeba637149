//! The book in `doc/` against the tree: links, paths, files, keys, commands and scenes that it names are there;
//! its figures are those of the budgets.

mod commands;
mod dependencies;
mod figures;
mod files;
mod links;
mod listings;
mod pages;
mod scenes;
