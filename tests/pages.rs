//! Pages: every link of README and docs leads to a file and a heading that are there, the book has every page, and words to
//! avoid are in none. Reads files alone, so it costs nothing.

#[path = "pages/browser.rs"]
mod browser;
#[path = "common/browser.rs"]
mod headless;
#[path = "pages/messages.rs"]
mod messages;
#[path = "pages/words.rs"]
mod words;

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

/// Source files in a folder of the crate.
fn sources_in(folder: &str) -> Vec<(PathBuf, String)> {
    files_in(folder, "rs")
}

/// Files of a kind in a folder of the crate and below, and their texts. A package has no folder `crates`.
fn files_in(folder: &str, kind: &str) -> Vec<(PathBuf, String)> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    folders.retain(|folder| folder.exists());
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == kind) {
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
    let (mut with, mut without) = (0, Vec::new());
    for (_, text) in sources_in("src/effect") {
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

/// The bytes that all pages may have together: history and measurements in full belong to `docs/notebook`.
const MOST: usize = 130_000;

#[test]
fn the_book_stays_short() {
    let pages = pages().into_iter().skip(1);
    let pages = pages.filter(|page| !page.ends_with("SUMMARY.md"));
    let sizes = pages.map(|page| fs::read(page).expect("a page").len());
    let bytes: usize = sizes.sum();
    assert!(
        bytes <= MOST,
        "{bytes} bytes in docs/*.md, and {MOST} at most"
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
