//! JSON (RFC 8259) as the crate writes it: names, numbers and texts in order.
//! What is no finite number is `null`, which JSON has in its place.

use super::csv::number;

/// A number.
pub(crate) fn json_number(value: f64) -> String {
    if value.is_finite() {
        number(value)
    } else {
        "null".into()
    }
}

/// A text.
pub(crate) fn json_text(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            c if (c as u32) < 0x20 => out += &format!("\\u{:04x}", c as u32),
            c => out.push(c),
        }
    }
    out + "\""
}

/// A list of values that are JSON.
pub(crate) fn json_list(values: impl IntoIterator<Item = String>) -> String {
    let values: Vec<String> = values.into_iter().collect();
    format!("[{}]", values.join(", "))
}

/// An object: names, with values that are JSON.
pub(crate) fn json_object<N: AsRef<str>>(parts: impl IntoIterator<Item = (N, String)>) -> String {
    let parts = parts.into_iter();
    let parts = parts.map(|(name, value)| format!("{}: {value}", json_text(name.as_ref())));
    format!("{{{}}}", parts.collect::<Vec<_>>().join(", "))
}

/// The processor's name where the system tells it.
pub(crate) fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':'));
    name.map_or("unknown".into(), |(_, name)| name.trim().into())
}
