//! What is kept for the user across clones: programs that a package manager does not install.

use std::env;
use std::path::PathBuf;

/// The folder of one program, `driveline/<name>` in the user's cache, else among temporary files.
pub fn folder(name: &str) -> PathBuf {
    let cache = env::var_os("XDG_CACHE_HOME").map(PathBuf::from).filter(|path| path.is_absolute());
    let home = || env::var_os("HOME").filter(|home| !home.is_empty());
    let cache = cache.or_else(|| Some(PathBuf::from(home()?).join(".cache")));
    cache.unwrap_or_else(env::temp_dir).join("driveline").join(name)
}
