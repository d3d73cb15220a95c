//! Messages: errors that the page on troubleshooting quotes are those of the library.
//! A message has `…` where it names values.

use super::sources;
use std::fs;
use std::path::Path;

/// Texts in quotes of a source, with lines joined that a `\` continues.
fn literals(source: &str) -> Vec<String> {
    let mut joined = String::new();
    let mut parts = source.split("\\\n");
    joined += parts.next().unwrap_or_default();
    for part in parts {
        joined += part.trim_start();
    }
    let joined = joined.replace("\\\"", "'").replace("'\"'", "");
    let texts = joined.split('"').skip(1).step_by(2);
    texts.map(|text| text.replace('`', "")).collect()
}

/// Whether a text has the parts of a message between its `…`, in their order.
fn says(text: &str, message: &str) -> bool {
    let mut rest = text;
    let parts = message.split('…').map(|part| part.trim_matches([' ', ',']));
    for part in parts.filter(|part| !part.is_empty()) {
        let Some(at) = rest.find(part) else {
            return false;
        };
        rest = &rest[at + part.len()..];
    }
    true
}

/// Messages that a page quotes are those that the library has.
#[test]
fn messages_of_troubleshooting_are_printed() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/how_to_troubleshoot.md");
    let text = fs::read_to_string(page).expect("the page");
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with("| message"));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    let texts: Vec<_> = sources()
        .iter()
        .flat_map(|(_, text)| literals(text))
        .collect();
    let (mut checked, mut unknown) = (0, Vec::new());
    for row in rows {
        let quoted = row.split('|').nth(1).expect("a column").trim();
        for message in quoted.split("; ") {
            checked += 1;
            if !texts.iter().any(|text| says(text, message)) {
                unknown.push(message.to_owned());
            }
        }
    }
    assert!(checked > 10, "only {checked} messages were found");
    assert!(unknown.is_empty(), "no error says {unknown:?}");
    let source = "#[error(\"body `{a}` \\\n    overlaps {b}\")]";
    assert!(says(&literals(source)[0], "body … overlaps …"));
    assert!(!says(&literals(source)[0], "overlaps … body"));
}
