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
/// A link is followed. A process that is killed leaves the temporary file, whose name begins with a dot. `failed` makes the error of an error of the system.
///
/// # Errors
/// - The errors of `write`.
/// - [`io::ErrorKind::AlreadyExists`] if the file exists and `force` is false.
/// - [`io::ErrorKind::IsADirectory`] for a folder, [`io::ErrorKind::NotSeekable`] for a device or a pipe; what the system says of a folder that does not exist or cannot be
///   written, and of a full disk.
pub fn whole<E, T>(
    path: &Path,
    force: bool,
    failed: impl Fn(io::Error) -> E,
    write: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    // A link to a file that does not exist yet is relative to its own folder.
    let through = |link: PathBuf| path.parent().map_or(link.clone(), |folder| folder.join(&link));
    let target =
        fs::canonicalize(path).or_else(|_| fs::read_link(path).map(through)).unwrap_or_else(|_| path.to_owned());
    let kind = |kind: io::ErrorKind| failed(kind.into());
    if target.is_dir() {
        return Err(kind(io::ErrorKind::IsADirectory));
    }
    if target.exists() && !target.is_file() {
        return Err(kind(io::ErrorKind::NotSeekable));
    }
    if !force && target.exists() {
        return Err(kind(io::ErrorKind::AlreadyExists));
    }
    let (temporary, mut file) = created(&target).map_err(&failed)?;
    let written = write(&mut file)?;
    drop(file);
    if force {
        fs::rename(&temporary.0, &target).map_err(&failed)?;
    } else {
        named(&temporary.0, &target).map_err(&failed)?;
    }
    Ok(written)
}

/// A new file beside the target.
fn created(target: &Path) -> io::Result<(Temporary, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let stem: String = target.file_stem().unwrap_or_default().to_string_lossy().chars().take(LONGEST_STEM).collect();
    let ending = target.extension().map_or_else(String::new, |ending| format!(".{}", ending.to_string_lossy()));
    loop {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = target.with_file_name(format!(".{stem}-{}-{number}{ending}", std::process::id()));
        match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((Temporary(path), file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

/// Names a file unless the name is taken. The system refuses a link to an existing name, and does not refuse a renaming; some file systems have no links.
fn named(temporary: &Path, target: &Path) -> io::Result<()> {
    match fs::hard_link(temporary, target) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists && !target.exists() => fs::rename(temporary, target),
        result => result,
    }
}
