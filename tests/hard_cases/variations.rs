//! All cases with halved steps, doubled durations, and from another perturbed start, and on one and two threads to the same bits.
//! The program runs itself with what `harness.rs` reads from the environment, and prints the rows side by side.

use std::collections::BTreeMap;
use std::process::Command;

/// The rows of a run of all quick cases, by case and criterion, and the cases that failed.
fn rows(set: &[(&str, &str)]) -> (BTreeMap<String, String>, Vec<String>) {
    let own = std::env::current_exe().expect("a program");
    let mut run = Command::new(own);
    run.args(["hard_cases::", "--nocapture", "--test-threads", "1"]);
    let done = run.envs(set.iter().copied()).output().expect("a run");
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let mut rows = BTreeMap::new();
    for line in text
        .lines()
        .filter_map(|line| line.find("| ").map(|at| &line[at..]))
    {
        let cells: Vec<_> = line.split('|').map(str::trim).collect();
        if let [_, case, criterion, _, value, _, _] = cells[..] {
            rows.insert(format!("{case} | {criterion}"), value.into());
        }
    }
    let failed = text
        .lines()
        .filter(|line| line.starts_with("    ") && line.contains("::"));
    let mut failed: Vec<String> = failed.map(|line| line.trim().into()).collect();
    failed.dedup();
    println!("{set:?}: {} rows, failed {failed:?}", rows.len());
    (rows, failed)
}

#[test]
#[ignore = "fifteen minutes: all cases five times"]
fn cases_hold_when_they_are_varied() {
    let two = ("RAYON_NUM_THREADS", "2");
    let runs = [
        rows(&[two]),
        rows(&[two, ("MESHFREE_STEP", "0.5")]),
        rows(&[two, ("MESHFREE_DURATION", "2")]),
        rows(&[two, ("MESHFREE_SEED", "100")]),
    ];
    let round = |value: Option<&String>, first: Option<&String>| match value {
        Some(value) if Some(value) != first => match value.parse::<f64>() {
            Ok(number) => format!("{number:.2e}"),
            Err(_) => value.clone(),
        },
        Some(_) => "–".into(),
        None => "fails".into(),
    };
    for (name, value) in &runs[0].0 {
        let others = [1, 2, 3].map(|k| round(runs[k].0.get(name), Some(value)));
        println!(
            "| {name} | {} | {} |",
            round(Some(value), None),
            others.join(" | ")
        );
    }
    assert!(
        rows(&[("RAYON_NUM_THREADS", "1")]).0 == runs[0].0,
        "one and two threads differ"
    );
    assert!(runs[0].1.is_empty(), "{:?}", runs[0].1);
}
