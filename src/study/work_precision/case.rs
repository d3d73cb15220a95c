//! What one run of a study is asked to be: its spacing and its choices by name.
//! Choices mean nothing to the study; the function that builds the scene reads them.

use crate::error::{Error, Problem};
use core::fmt;

/// The value of a choice: a number or a text.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}
impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.into())
    }
}
impl From<String> for Value {
    fn from(value: String) -> Self {
        Self::Text(value)
    }
}
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(value) => f.write_str(value),
        }
    }
}

/// One method: choices by name, and what it is called.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Method {
    /// What tables and plots call it.
    pub name: String,
    /// Its choices.
    pub choices: Vec<(String, Value)>,
}

/// One run: a spacing and a method.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    pub(super) spacing: f64,
    pub(super) method: &'a Method,
}

impl Case<'_> {
    /// The spacing \[m\].
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The name of the method.
    #[must_use]
    pub fn method(&self) -> &str {
        &self.method.name
    }

    fn find(&self, name: &str) -> Result<&Value, Error> {
        let choices = &self.method.choices;
        let own = choices.iter().find(|(own, _)| own == name);
        let known = || {
            choices
                .iter()
                .map(|(own, _)| own.as_str())
                .collect::<Vec<_>>()
        };
        own.map(|(_, value)| value).ok_or_else(|| {
            Error::Argument(Problem::UnknownName {
                kind: "choice",
                name: name.into(),
                known: known().join(", "),
            })
        })
    }

    /// The number that a choice has.
    ///
    /// # Errors
    /// If the method has no such choice, or it is a text.
    pub fn number(&self, choice: &str) -> Result<f64, Error> {
        match self.find(choice)? {
            Value::Number(value) => Ok(*value),
            Value::Text(text) => Err(Error::Argument(Problem::Incompatible {
                what: format!("the choice `{choice}` is the text `{text}`"),
                remedy: "ask for it with `Case::text`, or give a number",
            })),
        }
    }

    /// The text that a choice has.
    ///
    /// # Errors
    /// If the method has no such choice, or it is a number.
    pub fn text(&self, choice: &str) -> Result<&str, Error> {
        match self.find(choice)? {
            Value::Text(text) => Ok(text),
            Value::Number(value) => Err(Error::Argument(Problem::Incompatible {
                what: format!("the choice `{choice}` is the number {value}"),
                remedy: "ask for it with `Case::number`, or give a text",
            })),
        }
    }
}
