//! A file that is written whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Characters of the file's own name that the temporary name has.
const LONGEST_STEM: usize = 40;

/// Removes the temporary file, unless it was renamed.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        // It is gone after the renaming.
        let _ = fs::remove_file(&self.0);
    }
}

/// Writes a file under a temporary name in the same folder. The file gets the name `path` when `write` returns without an error; otherwise an old file stays as it is.
/// A link is followed. A process that is killed leaves the temporary file, whose name begins with a dot.
///
/// # Errors
/// - The errors of `write`.
/// - [`io::ErrorKind::AlreadyExists`] if the file exists and `force` is false.
/// - [`io::ErrorKind::IsADirectory`] for a folder; what the system says of a folder that does not exist or cannot be written, and of a full disk.
pub fn whole<E: From<io::Error>, T>(
    path: &Path,
    force: bool,
    write: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if target.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    }
    if !force && target.exists() {
        return Err(io::Error::from(io::ErrorKind::AlreadyExists).into());
    }
    let stem: String = target.file_stem().unwrap_or_default().to_string_lossy().chars().take(LONGEST_STEM).collect();
    let ending = target.extension().map_or_else(String::new, |ending| format!(".{}", ending.to_string_lossy()));
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let temporary = Temporary(target.with_file_name(format!(".{stem}-{}-{number}{ending}", std::process::id())));
    let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(true).open(&temporary.0)?;
    let written = write(&mut file)?;
    drop(file);
    if force {
        fs::rename(&temporary.0, &target)?;
    } else {
        // A link to an existing name is refused by the system, a renaming is not.
        fs::hard_link(&temporary.0, &target)?;
    }
    Ok(written)
}
