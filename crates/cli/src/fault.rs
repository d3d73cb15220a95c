//! What is wrong with a scene file: file, line, field, value and remedy.
//! Lines follow from fields: the text is read a second time with the places of its values.

use core::fmt;
use meshfree::error::Error;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One thing that is wrong: the field, as `body[0].spacing`, and what is wrong with its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The field, or an empty text for the file as a whole.
    pub field: String,
    /// Value and remedy.
    pub text: String,
}

impl Fault {
    /// A fault of a field.
    pub fn new(field: impl Into<String>, text: impl fmt::Display) -> Self {
        Self {
            field: field.into(),
            text: text.to_string(),
        }
    }

    /// An error of the library about what a field says.
    pub fn of(field: &str) -> impl Fn(Error) -> Self + '_ {
        move |error| Self::new(field, error)
    }

    /// What a part of the library says of itself: a quantity, its value and what it must be.
    #[must_use]
    pub fn of_part(field: &str, (what, value, must_be): (&str, f64, &str)) -> Self {
        Self::new(field, format!("{what} is {value}: {must_be}"))
    }
}

/// All that is wrong with a file, with lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Faults {
    file: PathBuf,
    list: Vec<(Option<usize>, Fault)>,
}

impl Faults {
    /// What is wrong.
    pub fn list(&self) -> impl Iterator<Item = &Fault> {
        self.list.iter().map(|(_, fault)| fault)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, (line, fault)) in self.list.iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{}:", self.file.display())?;
            if let Some(line) = line {
                write!(f, "{line}:")?;
            }
            if !fault.field.is_empty() {
                write!(f, " {}:", fault.field)?;
            }
            write!(f, " {}", fault.text)?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}

/// A scene file as text.
#[derive(Clone, Debug)]
pub struct Source {
    path: PathBuf,
    text: String,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read as text.
    pub fn read(path: &Path) -> Result<Self, Faults> {
        let text = std::fs::read_to_string(path).map_err(|cause| Faults {
            file: path.into(),
            list: vec![(None, Fault::new("", format!("cannot be read: {cause}")))],
        })?;
        Ok(Self::new(path, text))
    }

    /// A text as if it had been read from `path`, in whose folder other files are looked for.
    #[must_use]
    pub fn new(path: &Path, text: String) -> Self {
        Self {
            path: path.into(),
            text,
        }
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it says.
    ///
    /// # Errors
    /// If it is not TOML, or not of the format.
    pub fn parse<F: DeserializeOwned>(&self) -> Result<F, Faults> {
        toml::from_str(&self.text).map_err(|error| {
            let span = error.span().filter(|span| !span.is_empty());
            let field = span.as_ref().map(|span| self.field_at(span.start));
            let line = span.map(|span| self.line_at(span.start));
            let field = field.unwrap_or_default();
            let text = in_words(error.message(), &field);
            let fault = Fault::new(field, text);
            Faults {
                file: self.path.clone(),
                list: vec![(line, fault)],
            }
        })
    }

    /// Faults with their lines.
    #[must_use]
    pub fn faults(&self, list: Vec<Fault>) -> Faults {
        let root = DeTable::parse(&self.text).ok();
        let line = |field: &str| {
            let at = place(root.as_ref()?.get_ref(), field)?;
            Some(self.line_at(at))
        };
        let told = |fault: Fault| {
            let field = self.key_named(&fault.field, &fault.text);
            let field = field.unwrap_or(fault.field);
            (line(&field), Fault { field, ..fault })
        };
        Faults {
            file: self.path.clone(),
            list: list.into_iter().map(told).collect(),
        }
    }

    /// The field of the key within a field, at any depth, that a text names first before it comes to a value.
    #[must_use]
    pub fn key_named(&self, field: &str, text: &str) -> Option<String> {
        let root = DeTable::parse(&self.text).ok()?;
        let table = find(root.get_ref(), field)?.get_ref().as_table()?;
        let ends = [" is ", ": ", "; "].iter().filter_map(|end| text.find(end));
        let start = &text[..ends.min().unwrap_or(text.len())];
        // Names of bodies and walls are no keys, and coefficients have Greek letters.
        let prose: String = start.split('`').step_by(2).collect();
        let [alpha, beta, delta] = [('α', "alpha"), ('β', "beta"), ('δ', "delta")];
        let prose = [alpha, beta, delta]
            .iter()
            .fold(prose, |own, (sign, word)| own.replace(*sign, word));
        let words: Vec<_> = prose.split(|c: char| !c.is_alphanumeric()).collect();
        let mut keys = Vec::new();
        collect(table, field, &mut keys);
        let said = |key: &str| {
            let parts: Vec<_> = key.split('_').collect();
            words.windows(parts.len()).position(|own| own == parts)
        };
        let named = keys
            .into_iter()
            .filter_map(|(key, path)| Some((said(&key)?, path)));
        named.min_by_key(|own| own.0).map(|own| own.1)
    }

    /// The field of the body, wall or other entry that is called `name`.
    #[must_use]
    pub fn entry_called(&self, name: &str) -> Option<String> {
        let root = DeTable::parse(&self.text).ok()?;
        root.get_ref().iter().find_map(|(key, value)| {
            let entries = value.get_ref().as_array()?;
            let called = |entry: &Spanned<DeValue<'_>>| {
                let own = entry.get_ref().as_table()?.get("name")?;
                (own.get_ref().as_str()? == name).then_some(())
            };
            let k = entries.iter().position(|entry| called(entry).is_some())?;
            Some(format!("{}[{k}]", key.get_ref()))
        })
    }

    /// Whether the file has a field.
    #[must_use]
    pub fn has(&self, field: &str) -> bool {
        let root = DeTable::parse(&self.text).ok();
        root.is_some_and(|root| find(root.get_ref(), field).is_some())
    }

    /// The innermost field whose value is this text.
    #[must_use]
    pub fn field_of_text(&self, text: &str) -> Option<String> {
        let root = DeTable::parse(&self.text).ok()?;
        in_table(root.get_ref(), "", &|_, value| {
            value.get_ref().as_str() == Some(text)
        })
    }

    fn line_at(&self, at: usize) -> usize {
        let before = self.text.as_bytes().iter().take(at);
        1 + before.filter(|&&byte| byte == b'\n').count()
    }

    /// The innermost field around a place of the text.
    fn field_at(&self, at: usize) -> String {
        let (root, _) = DeTable::parse_recoverable(&self.text);
        let field = in_table(root.get_ref(), "", &|key, value| {
            key.is_some_and(|key| key.contains(&at)) || value.span().contains(&at)
        });
        field.unwrap_or_default()
    }
}

/// A message of the reader without names of types.
fn in_words(message: &str, field: &str) -> String {
    if message.contains("expected newtype variant") {
        return format!("is a name alone: write a table `[{field}.NAME]`, with options or without");
    }
    let types = [
        ("f64", "a number"),
        ("u8", "a whole number that is not negative"),
        ("u64", "a whole number that is not negative"),
        ("usize", "a whole number that is not negative"),
    ];
    let ending = |(of, words): &(&str, &str)| {
        let start = message.strip_suffix(of)?.strip_suffix("expected ")?;
        Some(format!("{start}expected {words}"))
    };
    types
        .iter()
        .find_map(ending)
        .unwrap_or_else(|| message.to_owned())
}

/// A key of a table, and its value.
type Looked<'a> = &'a dyn Fn(Option<core::ops::Range<usize>>, &Spanned<DeValue<'_>>) -> bool;

/// The innermost field that is looked for, children before parents.
fn in_table(table: &DeTable<'_>, path: &str, is: Looked<'_>) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let dot = if path.is_empty() { "" } else { "." };
        let own = format!("{path}{dot}{}", key.get_ref());
        in_value(value, &own, is).or_else(|| is(Some(key.span()), value).then_some(own))
    })
}

fn in_value(value: &Spanned<DeValue<'_>>, path: &str, is: Looked<'_>) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => in_table(table, path, is),
        DeValue::Array(entries) => entries.iter().enumerate().find_map(|(k, entry)| {
            let own = format!("{path}[{k}]");
            in_value(entry, &own, is).or_else(|| is(None, entry).then_some(own))
        }),
        _ => None,
    }
}

/// All keys of a table and of tables within it, with their fields.
fn collect(table: &DeTable<'_>, path: &str, keys: &mut Vec<(String, String)>) {
    for (key, value) in table {
        let own = format!("{path}.{}", key.get_ref());
        if let Some(inner) = value.get_ref().as_table() {
            collect(inner, &own, keys);
        }
        keys.push((key.get_ref().to_string(), own));
    }
}

/// The keys and numbers of a field, outermost first.
fn steps(field: &str) -> impl Iterator<Item = &str> {
    let parts = field.split(['.', '[']).filter(|part| !part.is_empty());
    parts.map(|part| part.trim_end_matches(']'))
}

/// The value of a field.
fn find<'a, 'i>(root: &'a DeTable<'i>, field: &str) -> Option<&'a Spanned<DeValue<'i>>> {
    let mut steps = steps(field);
    let mut at = root.get(steps.next()?)?;
    for step in steps {
        at = match at.get_ref() {
            DeValue::Table(table) => table.get(step)?,
            DeValue::Array(entries) => entries.get(step.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(at)
}

/// Where in the text a field is, or the innermost of those around it that the text has.
fn place(root: &DeTable<'_>, field: &str) -> Option<usize> {
    let mut found = None;
    let mut table = Some(root);
    let mut array = None;
    for step in steps(field) {
        let value = if let Some((key, value)) = table.and_then(|own| own.get_key_value(step)) {
            found = Some(key.span().start);
            value
        } else if let Some(entry) = array.and_then(|own: &toml::de::DeArray<'_>| {
            own.get(step.parse::<usize>().unwrap_or(usize::MAX))
        }) {
            found = Some(entry.span().start);
            entry
        } else {
            break;
        };
        table = value.get_ref().as_table();
        array = value.get_ref().as_array();
    }
    found
}
