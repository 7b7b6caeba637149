//! The modules of a crate and what each of them names: children, `use` lines, definitions, paths.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A path of names: of a module from its crate, or of an item as it is written.
pub type Names = Vec<String>;

/// A `use` of one name.
#[derive(Clone, Debug)]
pub struct Use {
    /// The path as it is written, without `*`.
    pub path: Names,
    /// It is re-exported.
    pub public: bool,
}

/// A module: a file's, or one with braces in a file.
#[derive(Debug, Default)]
pub struct Module {
    /// The file it stands in.
    pub file: usize,
    /// Names that it imports.
    pub uses: BTreeMap<String, Use>,
    /// Modules that it imports all names of.
    pub globs: Vec<Use>,
    /// What is defined in it.
    pub defined: BTreeSet<String>,
    /// Paths of two names and more.
    pub paths: BTreeSet<Names>,
    /// Every name that stands outside its `use` lines.
    pub names: BTreeSet<String>,
}

/// A crate.
#[derive(Debug, Default)]
pub struct Tree {
    /// Modules by their paths from the crate.
    pub modules: BTreeMap<Names, Module>,
    /// Each file's module, and its name for people.
    files: Vec<(Names, PathBuf)>,
}

/// A file's text by the module's path, with its place.
type Find<'a> = &'a dyn Fn(&[String]) -> Option<(PathBuf, String)>;

impl Tree {
    /// The crate that begins with this file.
    pub fn on_disk(first: &Path) -> Self {
        let folder = first.parent().unwrap();
        let find = |module: &[String]| {
            let base = module.iter().fold(folder.to_owned(), |path, name| path.join(name));
            let candidates = match module {
                [] => [first.to_owned(), first.to_owned()],
                _ => [base.with_extension("rs"), base.join("mod.rs")],
            };
            candidates.into_iter().find_map(|path| Some((path.clone(), fs::read_to_string(path).ok()?)))
        };
        let mut tree = Self::read(&find);
        // A macro may write the `mod` line of a file in its module's folder.
        let mut at = 0;
        while let Some((module, _)) = tree.files.get(at).cloned() {
            at += 1;
            let folder = module.iter().fold(folder.to_owned(), |path, name| path.join(name));
            for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let is_source = path.extension().is_some_and(|kind| kind == "rs");
                let child: Names = module.iter().cloned().chain([name.clone()]).collect();
                let apart = ["main", "lib", "mod"].contains(&name.as_str());
                if is_source && !apart && !tree.modules.contains_key(&child) {
                    tree.file(&find, child);
                }
            }
        }
        tree
    }

    /// A crate of planted sources, by the paths of their modules: `a::b`, the crate's own is empty.
    pub fn planted(sources: &[(&str, &str)]) -> Self {
        Self::read(&|module| {
            let name = module.join("::");
            let (_, text) = sources.iter().find(|(path, _)| *path == name)?;
            Some((PathBuf::from(name), (*text).to_owned()))
        })
    }

    fn read(find: Find) -> Self {
        let mut tree = Self::default();
        tree.file(find, Names::new());
        tree
    }

    /// The files, by the module of each.
    pub fn files(&self) -> &[(Names, PathBuf)] {
        &self.files
    }

    /// Whether this file is one of them.
    pub fn reads(&self, path: &Path) -> bool {
        self.files.iter().any(|(_, file)| file == path)
    }

    fn file(&mut self, find: Find, module: Names) {
        let (path, text) = find(&module).unwrap_or_else(|| panic!("module {} has no file", module.join("::")));
        let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let file = self.files.len();
        self.files.push((module.clone(), path));
        self.module(find, file, module, tokens);
    }

    fn module(&mut self, find: Find, file: usize, module: Names, tokens: TokenStream) {
        self.modules.insert(module.clone(), Module { file, ..Module::default() });
        self.walk(find, file, &module, tokens, true);
    }

    /// A file that an item only for unit tests names: known, and without content.
    fn file_of_tests(&mut self, find: Find, module: &Names, item: &[TokenTree]) {
        let [.., word, TokenTree::Ident(name), end] = item else { return };
        if word.to_string() == "mod" && end.to_string() == ";" {
            let child: Names = module.iter().cloned().chain([name.to_string()]).collect();
            let (path, _) = find(&child).unwrap_or_else(|| panic!("module {} has no file", child.join("::")));
            self.modules.insert(child.clone(), Module { file: self.files.len(), ..Module::default() });
            self.files.push((child, path));
        }
    }

    /// Reads tokens of a module; `outside` of bodies it finds definitions.
    fn walk(&mut self, find: Find, file: usize, module: &Names, tokens: TokenStream, outside: bool) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        let mut public = false;
        while let Some(token) = tokens.get(at) {
            let word = token.to_string();
            match token {
                TokenTree::Punct(_) if word == "#" && is_for_tests(tokens.get(at + 1)) => {
                    let end = after_item(&tokens, at + 2);
                    self.file_of_tests(find, module, &tokens[at + 2..end]);
                    at = end;
                    continue;
                }
                TokenTree::Group(group) => self.walk(find, file, module, group.stream(), false),
                // A path in an attribute: `with = "super::module"`.
                TokenTree::Literal(_) if word.contains("::") => {
                    let path: Names = word.trim_matches('"').split("::").map(str::to_owned).collect();
                    if path.iter().all(|name| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_'))
                    {
                        self.modules.get_mut(module).unwrap().paths.insert([path, vec!["*".to_owned()]].concat());
                    }
                }
                TokenTree::Ident(_) if word == "pub" => {
                    public = true;
                    // `pub(crate)`
                    let parenthesis = Delimiter::Parenthesis;
                    let within =
                        |token: &TokenTree| matches!(token, TokenTree::Group(g) if g.delimiter() == parenthesis);
                    at += if tokens.get(at + 1).is_some_and(within) { 2 } else { 1 };
                    continue;
                }
                TokenTree::Ident(_) if word == "use" => {
                    let end = (at..tokens.len()).find(|&at| tokens[at].to_string() == ";").unwrap_or(tokens.len());
                    self.uses(module, &Names::new(), &tokens[at + 1..end], public);
                    at = end;
                }
                TokenTree::Ident(_) if word == "mod" && matches!(tokens.get(at + 1), Some(TokenTree::Ident(_))) => {
                    let mut child = module.clone();
                    child.push(tokens[at + 1].to_string());
                    match tokens.get(at + 2) {
                        Some(TokenTree::Group(group)) => self.module(find, file, child, group.stream()),
                        _ => self.file(find, child),
                    }
                    at += 2;
                }
                TokenTree::Ident(_) => {
                    let path = path_at(&tokens, at);
                    at += 3 * (path.len() - 1);
                    let here = self.modules.get_mut(module).unwrap();
                    here.names.insert(path[0].clone());
                    if DEFINES.contains(&word.as_str()) && matches!(tokens.get(at + 1), Some(TokenTree::Ident(_))) {
                        at += 1;
                        if outside {
                            here.defined.insert(tokens[at].to_string());
                        }
                    }
                    if path.len() > 1 {
                        here.paths.insert(path);
                    }
                }
                _ => {}
            }
            public = false;
            at += 1;
        }
    }

    /// Reads a `use` tree.
    fn uses(&mut self, module: &Names, before: &Names, tokens: &[TokenTree], public: bool) {
        let here = self.modules.get_mut(module).unwrap();
        let mut path = before.clone();
        let mut alias = None;
        let mut tokens = tokens.iter();
        while let Some(token) = tokens.next() {
            match token {
                TokenTree::Ident(word) if word == "as" => alias = tokens.next().map(ToString::to_string),
                TokenTree::Ident(word) => path.push(word.to_string()),
                TokenTree::Punct(mark) if mark.as_char() == '*' => {
                    here.globs.push(Use { path, public });
                    return;
                }
                TokenTree::Group(group) => {
                    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                    for part in inner.split(|token| token.to_string() == ",").filter(|part| !part.is_empty()) {
                        self.uses(module, &path, part, public);
                    }
                    return;
                }
                _ => {}
            }
        }
        if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
            path.pop();
        }
        if let Some(name) = alias.or_else(|| path.last().cloned()) {
            here.uses.insert(name, Use { path, public });
        }
    }
}

/// Words that a definition's name stands behind.
const DEFINES: [&str; 9] = ["struct", "enum", "union", "trait", "type", "fn", "const", "static", "macro_rules"];

fn is_for_tests(attribute: Option<&TokenTree>) -> bool {
    matches!(attribute, Some(TokenTree::Group(group)) if group.stream().to_string().replace(' ', "") == "cfg(test)")
}

/// The place behind the item that begins here.
fn after_item(tokens: &[TokenTree], from: usize) -> usize {
    let ends = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        _ => token.to_string() == ";",
    };
    tokens.iter().skip(from).position(ends).map_or(tokens.len(), |items| from + items + 1)
}

/// The path that begins here: names with `::` between them.
fn path_at(tokens: &[TokenTree], at: usize) -> Names {
    let mut path = vec![tokens[at].to_string()];
    let mut at = at;
    let colon = |at: usize| matches!(tokens.get(at), Some(TokenTree::Punct(mark)) if mark.as_char() == ':');
    while colon(at + 1) && colon(at + 2) {
        let Some(TokenTree::Ident(name)) = tokens.get(at + 3) else { break };
        path.push(name.to_string());
        at += 3;
    }
    path
}
