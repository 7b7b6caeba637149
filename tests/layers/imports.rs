//! Which file imports which: paths resolved through `use` lines and re-exports to the files where the items stand.

use std::collections::{BTreeMap, BTreeSet};

use super::tree::{Names, Tree};

/// By importing and imported file: the names.
pub type Imports = BTreeMap<(String, String), BTreeSet<String>>;

/// All imports between the files of a crate.
pub fn imports(tree: &Tree) -> Imports {
    let mut imports = Imports::new();
    let mut import = |from: usize, to: Option<Found>, name: &str| {
        let Some(Found { file, .. }) = to else { return };
        if file != from {
            let label = |file: usize| label(tree, file);
            imports.entry((label(from), label(file))).or_default().insert(name.to_owned());
        }
    };
    for (module, here) in &tree.modules {
        for (name, line) in &here.uses {
            let found = resolve(tree, module, &line.path, 0);
            // A module's name alone imports nothing: what is taken from it is a path.
            let item = found.filter(|found| !found.is_module && (!line.public || here.names.contains(name)));
            import(here.file, item, name);
        }
        for line in &here.globs {
            import(here.file, resolve(tree, module, &line.path, 0).filter(|_| !line.public), "*");
        }
        for path in &here.paths {
            let found = resolve(tree, module, path, 0).filter(|found| !found.is_module);
            import(here.file, found, path.last().unwrap());
        }
    }
    imports
}

/// A file as people know it: its module's path.
pub fn label(tree: &Tree, file: usize) -> String {
    let module = &tree.files()[file].0;
    if module.is_empty() { "crate".to_owned() } else { module.join("::") }
}

/// Where a path leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Found {
    file: usize,
    is_module: bool,
}

/// Where a path leads that stands in `module`; nothing where it leads out of the crate.
fn resolve(tree: &Tree, module: &Names, path: &[String], depth: usize) -> Option<Found> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        // A `use` that names itself, as `use foreign::foreign;`, leads out of the crate.
        _ if depth > 16 => None,
        "crate" => within(tree, Names::new(), rest, depth),
        "self" => within(tree, module.clone(), rest, depth),
        "super" => {
            let mut module = module.clone();
            module.pop()?;
            let mut rest = rest;
            while let Some(("super", further)) = rest.split_first().map(|(name, further)| (name.as_str(), further)) {
                module.pop()?;
                rest = further;
            }
            within(tree, module, rest, depth)
        }
        name => {
            let here = &tree.modules[module];
            let known = here.uses.contains_key(name) || tree.modules.contains_key(&child(module, name));
            let through_glob = || {
                let lines = here.globs.iter();
                lines
                    .flat_map(|line| module_of(tree, module, &line.path, depth))
                    .any(|target| owns(tree, &target, name))
            };
            if known || through_glob() { within(tree, module.clone(), path, depth) } else { None }
        }
    }
}

/// Where the rest of a path leads from a module.
fn within(tree: &Tree, module: Names, path: &[String], depth: usize) -> Option<Found> {
    let here = tree.modules.get(&module)?;
    let Some((name, rest)) = path.split_first() else { return Some(Found { file: here.file, is_module: true }) };
    let inner = child(&module, name);
    if tree.modules.contains_key(&inner) {
        return within(tree, inner, rest, depth);
    }
    if let Some(line) = here.uses.get(name) {
        let whole: Names = line.path.iter().chain(rest).cloned().collect();
        // A name that is imported under its own first name leads out of the crate.
        return if line.path.first() == Some(name) { None } else { resolve(tree, &module, &whole, depth + 1) };
    }
    if !here.defined.contains(name) {
        for line in &here.globs {
            if let Some(target) = module_of(tree, &module, &line.path, depth).filter(|target| owns(tree, target, name))
            {
                return within(tree, target, path, depth + 1);
            }
        }
    }
    Some(Found { file: here.file, is_module: false })
}

/// The module that a glob's path leads to.
fn module_of(tree: &Tree, module: &Names, path: &[String], depth: usize) -> Option<Names> {
    let found = resolve(tree, module, path, depth + 1).filter(|found| found.is_module)?;
    Some(tree.files()[found.file].0.clone())
}

/// Whether a module has an item or a child of this name.
fn owns(tree: &Tree, module: &Names, name: &str) -> bool {
    let here = &tree.modules[module];
    here.defined.contains(name) || here.uses.contains_key(name) || tree.modules.contains_key(&child(module, name))
}

fn child(module: &Names, name: &str) -> Names {
    module.iter().cloned().chain([name.to_owned()]).collect()
}
