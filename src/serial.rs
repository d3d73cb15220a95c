//! How the feature `serde` writes what its derives do not: arrays of the length of a dimension, and numbers without a bound.
//! JSON has no infinity, and a setting that is infinite has to come back as it was.

use core::fmt;
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes components as a list: serde knows arrays by their length, and not by a dimension.
pub(crate) fn components<S: Serializer, const D: usize>(
    values: &[f64; D],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(values)
}

/// For settings in which infinity has a meaning. Formats for people have it as the text `inf` or `-inf`, others as a number.
/// A NaN is written as the format writes one, and no text stands for it: no setting has a use for it.
pub(crate) mod unbounded {
    use super::{Deserialize, Deserializer, Numbers, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer, N: Numbers>(
        value: &N,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.written().serialize(serializer)
    }

    pub(crate) fn deserialize<'de, R: Deserializer<'de>, N: Numbers>(
        deserializer: R,
    ) -> Result<N, R::Error> {
        N::Written::deserialize(deserializer).map(N::read)
    }
}

/// A number, or several.
pub(crate) trait Numbers {
    type Written: Serialize + for<'de> Deserialize<'de>;
    fn written(&self) -> Self::Written;
    fn read(written: Self::Written) -> Self;
}

impl Numbers for f64 {
    type Written = Unbounded;
    fn written(&self) -> Unbounded {
        Unbounded(*self)
    }
    fn read(written: Unbounded) -> Self {
        written.0
    }
}

impl Numbers for [f64; 2] {
    type Written = [Unbounded; 2];
    fn written(&self) -> [Unbounded; 2] {
        self.map(Unbounded)
    }
    fn read(written: [Unbounded; 2]) -> Self {
        written.map(|own| own.0)
    }
}

/// A number that may be infinite.
pub(crate) struct Unbounded(f64);

impl Serialize for Unbounded {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_infinite() && serializer.is_human_readable() {
            let text = if self.0 > 0.0 { "inf" } else { "-inf" };
            return serializer.serialize_str(text);
        }
        serializer.serialize_f64(self.0)
    }
}

impl<'de> Deserialize<'de> for Unbounded {
    fn deserialize<R: Deserializer<'de>>(deserializer: R) -> Result<Self, R::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(NumberOrText)
        } else {
            f64::deserialize(deserializer).map(Self)
        }
    }
}

struct NumberOrText;

impl Visitor<'_> for NumberOrText {
    type Value = Unbounded;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, `inf` or `-inf`")
    }
    fn visit_f64<E: Error>(self, value: f64) -> Result<Unbounded, E> {
        Ok(Unbounded(value))
    }
    fn visit_u64<E: Error>(self, value: u64) -> Result<Unbounded, E> {
        Ok(Unbounded(value as f64))
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<Unbounded, E> {
        Ok(Unbounded(value as f64))
    }
    fn visit_str<E: Error>(self, text: &str) -> Result<Unbounded, E> {
        match text {
            "inf" => Ok(Unbounded(f64::INFINITY)),
            "-inf" => Ok(Unbounded(f64::NEG_INFINITY)),
            _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
        }
    }
}
