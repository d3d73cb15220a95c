//! Tests of the command line: every bad option has a message that helps.
//! Figures are drawn unless an option says something of the case.

use super::choices::{SchemeChoice, StrengthChoice};
use super::options::{Options, Task, parse};

fn parse_line(line: &str) -> Result<Options, String> {
    let line = ["rod_impact"].into_iter().chain(line.split_whitespace());
    parse(line.map(Into::into)).map_err(|bad| bad.to_string())
}

#[test]
fn bad_options_name_themselves_and_what_they_take() {
    let lines = [
        ("--speed fast", "--speed", "'fast'", "above 0"),
        ("--speed -3", "--speed", "'-3'", "above 0"),
        ("--spacing nan", "--spacing", "'nan'", "MM"),
        ("--spacing 9", "--spacing", "`9`", "at most 2 mm"),
        ("--spacing 1e-9", "--spacing", "at least", "particles"),
        ("--target cheese", "--target", "'cheese'", "wall, or one of"),
        ("--striker air", "--striker", "'air'", "copper"),
        ("--pad pmma", "--pad", "'pmma'", "MATERIAL:MM"),
        ("--pad pmma:0", "--pad", "'pmma:0'", "above 0"),
        (
            "--scheme best",
            "--scheme",
            "'best'",
            "impact, continuity, lam2002",
        ),
        ("--kernel flat", "--kernel", "'flat'", "quintic"),
        ("--h-over-dx 5", "--h-over-dx", "`5`", "1 to 2"),
        ("--integrator euler", "--integrator", "'euler'", "lam-fresh"),
        ("--viscosity mg:-1", "--viscosity", "'mg:-1'", "limited"),
        ("--contact glue", "--contact", "'glue'", "bonded"),
        ("--threads 0", "--threads", "'0'", "1..=1024"),
        ("--probe 51", "--probe", "`51`", "0 to 50 mm"),
        ("--until 5 --snapshot 6", "--snapshot", "`6`", "5 µs"),
        (
            "--scheme continuity --integrator lam-fresh",
            "--integrator",
            "`lam-fresh`",
            "density",
        ),
        ("--state gas", "--state", "'gas'", "uniaxial-stress"),
        ("--strength on", "--strength", "`on`", "uniaxial-strain"),
        (
            "--state uniaxial-stress --scheme impact",
            "--scheme",
            "`impact`",
            "continuity",
        ),
        (
            "--state uniaxial-strain --integrator rk4",
            "--integrator",
            "`rk4`",
            "kicks",
        ),
        ("--speed", "--speed", "a value is required", ""),
        ("--quick=yes", "--quick", "'yes'", "unexpected value"),
        ("--sped 3", "'--sped'", "unexpected argument", "--speed"),
    ];
    for (line, option, value, accepted) in lines {
        let message = parse_line(line).map(|_| ()).expect_err(line);
        let complete = [option, value, accepted]
            .iter()
            .all(|part| message.contains(part));
        assert!(complete, "{line}: {message}");
    }
}

#[test]
fn options_that_say_nothing_of_the_case_leave_the_figures() {
    assert_eq!(parse_line("").map(|o| o.task), Ok(Task::Figures));
    let quick = parse_line("--quick --threads 2 --out x").map(|o| (o.task, o.case.spacing));
    assert_eq!(quick, Ok((Task::Figures, 2e-4)));
    let case = parse_line("--target=wall --pad pmma:7.5 --quick --spacing 0.1");
    let case = case.map(|o| (o.task, o.case.length(), o.case.spacing, o.case.probes.len()));
    assert_eq!(case, Ok((Task::Case, 0.0175, 1e-4, 2)));
    let solid = parse_line("--state uniaxial-strain").map(|o| (o.case.scheme, o.case.strength()));
    assert_eq!(solid, Ok((SchemeChoice::Continuity, StrengthChoice::On)));
}
