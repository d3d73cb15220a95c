//! Altered scenes: each is refused with the field, and none panics.
//! Beside named alterations every value of two scenes is replaced by values of other kinds.

use super::{altered, perform, source, text};
use meshfree_cli::build::{scene, schemes};
use meshfree_cli::command::{Stopped, Task};
use meshfree_cli::fault::{Fault, Faults, Source};
use meshfree_cli::format::SceneFile;

fn faults(text: &str) -> Faults {
    match perform(&source(text), &Task::Check) {
        Err(Stopped::Scene(faults)) => faults,
        Err(Stopped::Run(failure)) => panic!("a check runs nothing: {failure}"),
        Ok(_) => panic!("this must not pass:\n{text}"),
    }
}

#[test]
fn altered_scenes_are_refused_at_the_field() {
    let (mut base, mut wrong, mut count) = (String::new(), Vec::new(), 0);
    for line in include_str!("faults.txt").lines() {
        if let Some(name) = line.strip_prefix("## ") {
            let coarse = ("spacing = 0.015", "spacing = 0.05");
            base = altered(&text(name), &[coarse, coarse]);
            continue;
        }
        let parts: Vec<_> = line.split(" => ").collect();
        let [from, to, field, part] = parts[..] else {
            assert!(line.is_empty() || line.starts_with('#'), "{line}");
            continue;
        };
        let faults = faults(&altered(
            &base,
            &[(&from.replace("\\n", "\n"), &to.replace("\\n", "\n"))],
        ));
        let is_told = |own: &Fault| own.field == field && own.text.contains(part);
        if !faults.list().any(is_told) {
            wrong.push(format!("{line}\n{faults}"));
        }
        count += 1;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count > 80, "{count} alterations");
}

#[test]
fn a_fault_has_its_line_and_all_faults_are_told() {
    let base = text("dam_break.toml");
    let wrong = altered(
        &base,
        &[
            ("spacing = 0.015", "spacing = -1"),
            ("until = 0.8", "until = -1"),
        ],
    );
    let message = faults(&wrong).to_string();
    let line = |part: &str| 1 + wrong.lines().position(|line| line == part).expect("a line");
    for (part, field) in [
        ("spacing = -1", "body[0].spacing"),
        ("until = -1", "run.until"),
    ] {
        let expected = format!("altered.toml:{}: {field}: is -1:", line(part));
        assert!(
            message.contains(&expected),
            "{expected} is not in\n{message}"
        );
    }
}

/// Reads and builds, without the rehearsal of a check.
fn built(source: &Source) -> Result<(), Faults> {
    let file: SceneFile = source.parse()?;
    let one = |fault| source.faults(vec![fault]);
    if file.dimension == 1 {
        let scheme = schemes::in_line(&file.scheme).map_err(one)?;
        let _ = scene(source, &file, scheme)?.build();
    } else {
        let scheme = schemes::in_plane(&file.scheme).map_err(one)?;
        let _ = scene(source, &file, scheme)?.build();
    }
    Ok(())
}

#[test]
fn no_value_of_any_kind_panics() {
    const VALUES: [&str; 14] = [
        "-1",
        "0",
        "1",
        "3",
        "1e300",
        "-1e-300",
        "nan",
        "-inf",
        "\"water\"",
        "\"\"",
        "true",
        "[]",
        "[1e300, nan]",
        "{}",
    ];
    let coarse = [
        ("spacing = 0.015", "spacing = 0.1"),
        ("spacing = 0.015", "spacing = 0.1"),
    ];
    let dam = altered(&text("dam_break.toml"), &coarse);
    let [mut refused, mut accepted] = [0, 0];
    for base in [dam, text("composite_rods.toml")] {
        // Every number and every text between brackets, signs and commas is replaced.
        let is_end = |c: char| matches!(c, ',' | ']' | '}' | '\n');
        let starts = base.match_indices([' ', '[']).filter_map(|(at, found)| {
            let rest = &base[at + found.len()..];
            let begins = rest
                .starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '"' | 't' | 'f'));
            let line = base[..at].rsplit('\n').next().unwrap_or_default();
            let is_value = !line.trim_start().starts_with('#') && line.contains('=');
            (begins && is_value).then_some(at + found.len())
        });
        for start in starts.collect::<Vec<_>>() {
            let end = start + base[start..].find(is_end).unwrap_or(0);
            for value in VALUES {
                let text = format!(
                    "{}{value}{}",
                    &base[..start],
                    base[end..].trim_start_matches(' ')
                );
                match built(&source(&text)) {
                    Ok(()) => accepted += 1,
                    Err(faults) => {
                        refused += 1;
                        assert!(faults.list().all(|own| !own.text.is_empty()), "{text}");
                    }
                }
            }
        }
    }
    println!("{refused} refused, {accepted} accepted");
    assert!(
        refused > 300 && accepted > 20,
        "{refused} refused, {accepted} accepted"
    );
}
