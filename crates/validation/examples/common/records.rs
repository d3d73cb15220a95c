//! Measured records that programs compare with. They are not part of the repository, and a program runs without them.
//! A folder that is not there is named once, in one line.

use super::Failure;
use super::options::{Options, Own};
use meshfree::study::records::Record;
use std::path::{Path, PathBuf};

/// The folder of the records.
#[derive(Clone, Debug)]
pub struct Records {
    folder: Option<PathBuf>,
}

impl Records {
    /// The option that names the folder.
    pub const OPTION: Own = Own {
        name: "--reference",
        value: "DIR",
        help: "folder of measured records, which are not part of the crate (../shared/data)",
    };

    /// The folder that `--reference` names, which must be there, or the usual one, if it is there.
    pub fn of(options: &Options) -> Result<Self, Failure> {
        if let Some(text) = options.text(Self::OPTION.name) {
            let folder = PathBuf::from(text);
            if !folder.is_dir() {
                let option = Self::OPTION.name;
                let text = format!(
                    "{option}: there is no folder `{text}`; it takes the folder of the measured records"
                );
                return Err(text.into());
            }
            return Ok(Self {
                folder: Some(folder),
            });
        }
        let folder = Self::usual().filter(|folder| folder.is_dir());
        if folder.is_none() {
            println!(
                "without measured records, which are not part of the crate: {} DIR names their folder",
                Self::OPTION.name
            );
        }
        Ok(Self { folder })
    }

    /// Beside the repository.
    fn usual() -> Option<PathBuf> {
        // This package is two folders deep in the repository.
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2)?;
        Some(repository.parent()?.join("shared/data"))
    }

    /// The path of a record, where the folder is there.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(name))
    }

    /// The record of that name. One that the folder lacks, or that is no table, is named in a line.
    pub fn read(&self, name: &str) -> Option<Record> {
        match Record::read(self.path(name)?) {
            Ok(record) => Some(record),
            Err(error) => {
                println!("without the record {name}: {error}");
                None
            }
        }
    }
}
