//! Words: neither pages, rustdoc, printed texts nor texts of reports have words and phrases that the crate replaced.
//! A list of them, with what to write instead.

use super::{files_in, pages, sources_in};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Words and phrases to avoid, and what to write.
const AVOID: [(&str, &str); 64] = [
    ("asleep", "at rest"),
    ("astray", "what it did"),
    ("bear", "support, carry or allow"),
    ("bears", "supports, carries or allows"),
    ("chattering", "in repeated contact"),
    ("crowding", "concentration gradient"),
    ("cure", "remedy"),
    ("cured", "remedied"),
    ("cures", "remedies"),
    ("foretell", "predict"),
    ("foretells", "predicts"),
    ("foretold", "predicted"),
    ("mend", "fix"),
    ("mended", "fixed"),
    ("mends", "fixes"),
    ("moods", "scatter of timings"),
    ("nobody", "the noun"),
    ("outlook", "forecast"),
    ("retract", "restore"),
    ("stagger", "random offset"),
    ("staggered rows", "lattice rows with random offset"),
    ("stuff", "material"),
    ("tear", "cavitate, or separate"),
    ("tearing", "cavitation"),
    ("torn", "cavitated, or separated"),
    ("touching sum", "contact sum"),
    ("unmended", "not fixed"),
    ("wear", "take"),
    ("wears", "takes"),
    ("by turns", "alternately"),
    ("distance of particles", "particle spacing"),
    ("dual criteria", "correction caching"),
    ("facing a room", "the fluid side"),
    ("how far off", "error"),
    ("lies against", "abuts"),
    ("number that is none", "NaN"),
    ("puts back", "restores"),
    ("what is off", "the noun"),
    ("one s own", "your own"),
    ("from nowhere", "that the time integration creates"),
    ("give way", "move"),
    ("gives way", "moves"),
    ("has to be said", "the scene has to say"),
    ("held against", "compared with"),
    ("how steep", "rise"),
    ("in vain", "the noun"),
    ("looks through", "reaches through"),
    ("middling", "moderate"),
    ("otherwise than", "differently from"),
    ("tells of", "reports"),
    ("that is none", "the condition"),
    ("turn round", "reverse"),
    ("turned round", "reversed"),
    ("unless told", "by default"),
    ("wants", "needs"),
    // What only the history of a page or the work on it explains.
    ("as this page had", "what holds"),
    ("as was written here", "what holds"),
    ("was asked for", "the value, or requested"),
    ("were asked for", "the bound"),
    ("asked of us", "what holds"),
    ("of the project", "what holds"),
    ("the coordinator", "nothing"),
    ("the issue", "the subject"),
    ("the owner", "nothing"),
];

/// Sources of examples, of the packages in `crates` and of the library.
fn all_sources() -> Vec<(PathBuf, String)> {
    let folders = ["src", "examples", "crates"].into_iter();
    folders.flat_map(sources_in).collect()
}

/// Words of prose in lower case, with their lines: no blocks of code, spans of code or targets of links.
fn words(text: &str) -> Vec<(usize, String)> {
    let mut code = false;
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        code ^= line.trim_start().starts_with("```");
        if code {
            continue;
        }
        let mut parts = line.split("](");
        let mut plain = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            plain.push(' ');
            plain += part.split_once(')').map_or(part, |(_, rest)| rest);
        }
        for prose in plain.split('`').step_by(2) {
            let own = prose.split(|c: char| !c.is_alphabetic());
            let own = own.filter(|word| !word.is_empty());
            found.extend(own.map(|word| (number + 1, word.to_lowercase())));
        }
    }
    found
}

/// The words to avoid in a text, with their lines.
fn to_avoid(text: &str) -> Vec<String> {
    let words = words(text);
    // By their first words, since there are a million words of documentation.
    let mut begins: BTreeMap<&str, Vec<_>> = BTreeMap::new();
    for (avoid, instead) in AVOID {
        let parts: Vec<_> = avoid.split(' ').collect();
        begins.entry(parts[0]).or_default().push((parts, instead));
    }
    let mut found = Vec::new();
    for (at, (line, word)) in words.iter().enumerate() {
        for (parts, instead) in begins.get(word.as_str()).into_iter().flatten() {
            let own = words[at..].iter().map(|(_, word)| word).take(parts.len());
            if own.eq(parts) {
                found.push(format!(
                    "line {line}: \"{}\": write {instead}",
                    parts.join(" ")
                ));
            }
        }
    }
    found
}

/// What rustdoc shows of a source, in the lines of the source.
fn documentation(source: &str) -> String {
    let lines = source.lines().map(|line| {
        let line = line.trim_start();
        let inner = || line.strip_prefix("//!");
        line.strip_prefix("///").or_else(inner).unwrap_or_default()
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// What a source may print: its texts in quotes that are longer than a word.
fn printed(source: &str) -> String {
    let code = source.lines();
    let code = code.filter(|line| !line.trim_start().starts_with("//"));
    let code = code.collect::<Vec<_>>().join("\n");
    let code = code.replace("\\\"", "").replace("'\"'", "");
    let texts = code.split('"').skip(1).step_by(2);
    let texts = texts.filter(|text| text.trim().contains(' '));
    texts.map(|text| text.replace('`', " ") + "\n").collect()
}

#[test]
fn words_that_were_replaced_are_not_printed() {
    let mut found = Vec::new();
    for (path, text) in all_sources() {
        let own = to_avoid(&printed(&text)).into_iter();
        found.extend(own.map(|said| format!("{}: {said}", path.display())));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    let source = "// \"no cure\"\nlet a = ['\"', \"cure\", \"a \\\"cure\\\" \\\n of it\"];";
    assert_eq!(to_avoid(&printed(source)).len(), 1);
}

#[test]
fn words_that_were_replaced_stay_away() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let more = ["CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root.join(name));
    let texts = pages().into_iter().chain(more).map(|path| {
        let text = fs::read_to_string(&path).expect("a page");
        (path, text)
    });
    // What examples print of themselves with `--help` is their documentation, and reports have texts in files beside them.
    let sources = all_sources().into_iter();
    let texts = texts.chain(sources.map(|(path, text)| (path, documentation(&text))));
    let texts = texts.chain(
        ["examples", "crates"]
            .into_iter()
            .flat_map(|folder| files_in(folder, "md")),
    );
    let mut found = Vec::new();
    for (path, text) in texts {
        let own = to_avoid(&text).into_iter();
        found.extend(own.map(|said| format!("{}: {said}", path.display())));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    // Over the end of a line too, and neither in code nor in what links lead to.
    assert_eq!(to_avoid("A block has no cure, as was\nasked for.").len(), 2);
    let hidden = "`cure` [a remedy](cure.md)\n```\ncure\n```\n";
    assert!(to_avoid(hidden).is_empty());
    assert!(to_avoid(&documentation("// cure\nlet cure = 1;")).is_empty());
    assert_eq!(to_avoid(&documentation("    /// Cure.")).len(), 1);
}
