//! What a run leaves behind: tables, plots, pictures, particle files, reports and a progress line.
//! Whatever was written before a crash stays readable.

#[cfg(feature = "checkpoint")]
pub(crate) mod checkpoint;
pub mod csv;
#[cfg(feature = "pictures")]
pub mod film;
pub(crate) mod hash;
pub(crate) mod json;
pub mod picture;
#[cfg(feature = "pictures")]
pub mod png;
pub mod progress;
pub mod pvtu;
pub mod svg;
pub mod table;
#[cfg(feature = "checkpoint")]
pub(crate) mod values;
pub mod vti;
mod vtk;
pub mod vtu;

use crate::error::{Error, Result};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::Path;

/// The crate's error for `action` on the file at `path`.
fn file_error<'a>(action: &'static str, path: &'a Path) -> impl Fn(io::Error) -> Error + 'a {
    move |cause| Error::File {
        action,
        path: path.to_path_buf(),
        cause,
    }
}

/// Makes the folder of `path`, where there is none.
fn make_folder(path: &Path) -> Result<()> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => {
            fs::create_dir_all(folder).map_err(file_error("make the folder", folder))
        }
        _ => Ok(()),
    }
}

/// Writes a whole file at once: a reader sees the old one or the new one, never a part.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    make_folder(path)?;
    let mut part: OsString = path.as_os_str().to_owned();
    part.push(".part");
    let part = Path::new(&part);
    fs::write(part, bytes).map_err(file_error("write", part))?;
    fs::rename(part, path).map_err(file_error("write", path))
}

/// Text as it may stand in XML, in an element or between double quotes.
fn xml_escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            // XML 1.0 has no way to write these.
            '\0'..'\u{20}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty folder of its own for a test, removed when it goes out of scope.
    pub(super) struct Folder(pub(super) std::path::PathBuf);

    impl Folder {
        pub(super) fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("meshfree-{}-{name}", std::process::id()));
            fs::create_dir_all(&path).expect("a folder for the test");
            Self(path)
        }
        pub(super) fn file(&self, name: &str) -> std::path::PathBuf {
            self.0.join(name)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn escaped_text_has_no_markup_left() {
        assert_eq!(
            xml_escape("a<b> & \"c\"\u{1}\n"),
            "a&lt;b&gt; &amp; &quot;c&quot;\u{fffd} "
        );
    }

    #[test]
    fn whole_files_replace_and_leave_nothing_else() {
        let folder = Folder::new("whole");
        let path = folder.file("deep/er/file.txt");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn errors_name_the_file() {
        let folder = Folder::new("error");
        fs::write(folder.file("file"), b"").unwrap();
        let error = write_whole(&folder.file("file/below"), b"").unwrap_err();
        assert!(error.to_string().contains("file"), "{error}");
    }
}
