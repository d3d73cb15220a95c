//! Pages: every link of README and docs leads to a file and a heading that are there, the book has every page, and words to
//! avoid are in none. Reads files alone, so it costs nothing.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The pages, README first.
fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).expect("the folder docs");
    let docs = docs.filter_map(|entry| Some(entry.ok()?.path()));
    let pages = docs.filter(|path| path.extension().is_some_and(|end| end == "md"));
    [root.join("README.md")].into_iter().chain(pages).collect()
}

/// Targets of `](…)` and of `[…]: …` outside of blocks of code.
fn links(text: &str) -> Vec<String> {
    let mut code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        code ^= line.trim_start().starts_with("```");
        if code {
            continue;
        }
        let inline = line.split("](").skip(1);
        found.extend(inline.filter_map(|rest| Some(rest.split_once(')')?.0.to_string())));
        if let Some((name, target)) = line.split_once("]: ")
            && name.starts_with('[')
        {
            found.push(target.trim().to_string());
        }
    }
    found
}

/// Anchors of a page: its headings in lower case, with hyphens for spaces and without other signs, as GitHub and mdBook
/// make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut code = false;
    let mut found = BTreeSet::new();
    for line in text.lines() {
        code ^= line.trim_start().starts_with("```");
        if code || !line.starts_with('#') {
            continue;
        }
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let title = title.replace(' ', "-");
        found.insert(title.replace(|c: char| !(c.is_alphanumeric() || "-_".contains(c)), ""));
    }
    found
}

#[test]
fn links_lead_to_what_is_there() {
    // The package has none of the gallery's pictures but that of README, since they are a third of its size.
    let packed = !Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("docs/gallery/build.py")
        .exists();
    let (mut broken, mut skipped) = (Vec::new(), 0);
    let mut checked = 0;
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let folder = page.parent().expect("a folder");
        for link in links(&text) {
            if link.contains("://") {
                continue;
            }
            if packed && link.starts_with("gallery/") {
                skipped += 1;
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let path = if path.is_empty() {
                page.clone()
            } else {
                folder.join(path)
            };
            checked += 1;
            let there = path.exists()
                && (anchor.is_empty()
                    || anchors(&fs::read_to_string(path).expect("a page")).contains(anchor));
            if !there {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    if packed {
        println!("skipped: {skipped} pictures of the gallery, which the repository has");
    }
    assert!(checked > 40, "only {checked} links were found");
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// The crate's source files and their texts.
fn sources() -> Vec<(PathBuf, String)> {
    sources_in("src")
}

/// Source files in a folder of the repository. The package has not all of them.
fn sources_in(folder: &str) -> Vec<(PathBuf, String)> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    folders.retain(|folder| folder.exists());
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text = fs::read_to_string(&path).expect("a file");
                found.push((path, text));
            }
        }
    }
    found
}

/// Rustdoc shows the first paragraph of an item in the index of its module.
#[test]
fn index_lines_are_whole_sentences() {
    let mut broken = Vec::new();
    let mut checked = 0;
    for (path, text) in sources() {
        let lines: Vec<_> = text.lines().map(str::trim).collect();
        let mut begin = 0;
        while begin < lines.len() {
            if !lines[begin].starts_with("///") {
                begin += 1;
                continue;
            }
            let about = |line: &&&str| line.starts_with("///") || line.starts_with('#');
            let end = begin + lines[begin..].iter().take_while(about).count();
            let first = lines[begin..end].iter();
            let first = first.take_while(|line| line.starts_with("/// "));
            let last = first.last().copied().unwrap_or_default();
            if lines.get(end).is_some_and(|item| item.starts_with("pub ")) && !last.is_empty() {
                checked += 1;
                let closing = last.trim_end_matches(['"', '\'', ')', '`', ']']);
                if !closing.ends_with(['.', '?', '!']) {
                    broken.push(format!("{}:{}: {last}", path.display(), begin + 1));
                }
            }
            begin = end;
        }
    }
    assert!(checked > 1000, "only {checked} items were found");
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

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
    let mut found = Vec::new();
    for (avoid, instead) in AVOID {
        let parts: Vec<_> = avoid.split(' ').collect();
        for own in words.windows(parts.len()) {
            if own.iter().zip(&parts).all(|((_, word), part)| word == part) {
                found.push(format!("line {}: \"{avoid}\": write {instead}", own[0].0));
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
    let folders = ["src", "examples", "crates/validation"];
    for (path, text) in folders.into_iter().flat_map(sources_in) {
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
    let sources = sources().into_iter();
    let texts = texts.chain(sources.map(|(path, text)| (path, documentation(&text))));
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

#[test]
fn rustdoc_links_every_page_and_names_no_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("src/lib.rs")).expect("the crate's page");
    let missing: Vec<_> = pages()
        .into_iter()
        .skip(1)
        .filter_map(|page| Some(page.file_name()?.to_str()?.to_owned()))
        .filter(|name| name != "SUMMARY.md" && !text.contains(&format!("/docs/{name}) |")))
        .collect();
    assert!(missing.is_empty(), "the table of pages lacks {missing:?}");
    let mut named = Vec::new();
    for (path, text) in sources() {
        let docs = text
            .lines()
            .filter(|line| line.trim_start().starts_with("//"));
        let files = docs.filter(|line| line.contains("`docs/") && line.contains(".md`"));
        named.extend(files.map(|line| format!("{}: {line}", path.display())));
    }
    assert!(
        named.is_empty(),
        "a reader of docs.rs has no such file:\n{}",
        named.join("\n")
    );
}

/// Effects that have no equation: the absence of walls, and a window of time around another effect.
const WITHOUT_EQUATION: [&str; 2] = ["NoWalls", "During"];

#[test]
fn every_effect_has_its_equation() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/effect");
    let files = fs::read_dir(folder).expect("the folder of effects");
    let (mut with, mut without) = (0, Vec::new());
    let paths = files.map(|file| file.expect("an entry").path());
    for path in paths.filter(|path| path.is_file()) {
        let text = fs::read_to_string(path).expect("a file");
        let effects = text.lines().filter(|line| line.starts_with("impl"));
        let effects = effects.filter_map(|line| Some(line.split_once("Effect<D> for ")?.1));
        for effect in effects {
            let name: String = effect.chars().take_while(|c| c.is_alphanumeric()).collect();
            // What describes a public type stands right above it.
            let types = ["struct", "enum"].map(|kind| format!("\npub {kind} {name}"));
            let place = types.iter().find_map(|own| text.find(own));
            let Some(place) = place.filter(|_| !WITHOUT_EQUATION.contains(&name.as_str())) else {
                continue;
            };
            // Variants of an enum have theirs.
            let above = text[..place].rfind("\n\n").unwrap_or(0);
            let end = text[place..]
                .find("\n}")
                .map_or(text.len(), |end| place + end);
            if text[above..end].contains("docs/equations/") {
                with += 1;
            } else {
                without.push(name);
            }
        }
    }
    assert!(
        with > 25 && without.is_empty(),
        "{with} with an equation, not {without:?}"
    );
}

#[test]
fn the_book_has_every_page() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).expect("the summary");
    let listed: BTreeSet<PathBuf> = links(&summary).iter().map(|link| docs.join(link)).collect();
    let written = pages().into_iter().skip(1);
    let written: BTreeSet<PathBuf> = written
        .filter(|page| !page.ends_with("SUMMARY.md"))
        .collect();
    assert_eq!(listed, written);
}

/// What a browser makes of the page of costs at an address, and what its console says. `None` without a browser.
fn in_a_browser(page: &Path, fragment: &str) -> Option<(String, String)> {
    let profile = std::env::temp_dir().join(format!("meshfree-browser-{}", std::process::id()));
    let done = std::process::Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .args(["--enable-logging=stderr", "--v=0", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}#{fragment}", page.display()))
        .output()
        .ok()?;
    drop(fs::remove_dir_all(profile));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some((text(&done.stdout), text(&done.stderr)))
}

/// Points that are drawn and runs that are listed.
fn drawn(dom: &str) -> [usize; 2] {
    ["data-points=\"", "data-rows=\""].map(|name| {
        let rest = dom.split_once(name).map_or("", |(_, rest)| rest);
        rest.split('"')
            .next()
            .and_then(|n| n.parse().ok())
            .unwrap_or(0)
    })
}

#[test]
fn the_page_of_costs_draws_and_filters_in_a_browser() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy.html");
    let Some((dom, console)) = in_a_browser(&page, "") else {
        println!("skipped: there is no chromium");
        return;
    };
    let [points, rows] = drawn(&dom);
    assert!(
        points > 20 && rows >= points,
        "{points} points of {rows} rows"
    );
    // The script in the page has the text of a mark, too.
    let marks = dom.matches("data-row=\"").count() - dom.matches("data-row=\"${").count();
    assert!((points..=rows).contains(&marks), "{marks} marks");
    let (less, also) =
        in_a_browser(&page, "filter=default&x=pairs&most=0.05").expect("it was there");
    let [fewer, listed] = drawn(&less);
    assert!(
        fewer > 0 && fewer < points && listed < rows,
        "{fewer} of {points}"
    );
    // The cheapest run of these is told, with the command that repeats it.
    let told = less.split_once("id=\"point\"").map_or("", |(_, rest)| rest);
    let told = told.split("</p>").next().unwrap_or_default();
    assert!(
        told.contains("--spacing ") && told.contains("default"),
        "{told}"
    );
    for said in [console, also] {
        assert!(!said.contains("CONSOLE"), "{said}");
    }
    assert!(!dom.contains("data-error") && !less.contains("data-error"));
}
