//! The table of what of the crate does not run on a device, made from what can be recorded.
//! It stands in the notebook's page, which this holds to it; no device is needed.

use super::laws::material;
use meshfree::coupling::{ContactDensity, Coupling, LiquidStructure, Penalty, Tied};
use meshfree::effect::DensityForm;
use meshfree::effect::parts::{PointRecord, point_records};
use meshfree::material::eos::EquationOfState;
use meshfree::particles::Fields;
use meshfree::scalar::Record;

/// A part with what of it does not run.
type Row = (String, String);

/// Its own name in an expression that makes it.
fn name(expression: &str) -> String {
    let own = expression.replace(' ', "");
    let own = own
        .replace("$crate::effect::", "")
        .replace("$crate::term::", "");
    let end = own.find(|c: char| !(c.is_alphanumeric() || c == '.' || c == '_'));
    own[..end.unwrap_or(own.len())].to_owned()
}

/// What of the laws, rates and limits of an effect does not run.
fn of_effect(expression: &str, records: &[PointRecord]) -> Option<Row> {
    let mut all: Vec<String> = Vec::new();
    for own in records {
        let what = match &own.record {
            Err(error) => error.what.into(),
            // Limits stand in f64 on the host, and are votes of a device.
            Ok(_) if own.double && own.writes != Fields::NONE => {
                "computes in f64 also for particles in f32".to_owned()
            }
            Ok(_) => continue,
        };
        let what = format!("`{}` {what}", own.name);
        if !all.contains(&what) {
            all.push(what);
        }
    }
    (!all.is_empty()).then(|| (format!("`{}`", name(expression)), all.join("; ")))
}

fn effects(rows: &mut Vec<Row>) {
    let (continuity, deformation) = (DensityForm::Continuity, DensityForm::Deformation);
    macro_rules! each {
        ($($group:ident [$($effect:expr),*])*) => { $(each!(@$group $($effect),*);)* };
        (@liquid $($effect:expr),*) => { each!(2, continuity, $($effect),*) };
        (@solid $($effect:expr),*) => { each!(3, continuity, $($effect),*) };
        (@total_lagrangian $($effect:expr),*) => { each!(3, deformation, $($effect),*) };
        (@sheet $($effect:expr),*) => { each!(2, deformation, $($effect),*) };
        (@rod $($effect:expr),*) => { each!(1, continuity, $($effect),*) };
        ($d:literal, $density:ident, $($effect:expr),*) => { $({
            let own = point_records::<f64, $d>(&$effect, $density, &material(1.0), Fields::NONE);
            rows.extend(of_effect(stringify!($effect), &own));
        })* };
    }
    meshfree::for_each_effect!(each);
}

fn others(rows: &mut Vec<Row>) {
    macro_rules! laws {
        ($($name:ident: $law:expr);*) => { $({
            let law = $law;
            let record = Record::of(2, |given| vec![law.state(given[0], given[1]).pressure]);
            rows.extend(record.err().map(|error| (format!("`{}`", law.name()), error.what.into())));
        })* };
    }
    meshfree::for_each_eos!(laws);
    let couplings: [&dyn Coupling<f64, 2>; 6] = [
        &ContactDensity::new(),
        &Penalty::new(),
        &Tied::new(),
        &ContactDensity::new().friction(0.1),
        &Penalty::new().friction(0.1),
        &LiquidStructure,
    ];
    for (n, own) in couplings.iter().enumerate() {
        let none = own.record().is_none() && own.wall_mass_record().is_none();
        let with = if n > 2 { " with friction" } else { "" };
        rows.extend(none.then(|| (format!("{}{with}", own.name()), "has no record".into())));
    }
}

#[test]
fn the_table_of_what_does_not_run_is_that_of_the_page() {
    let mut rows = Vec::new();
    effects(&mut rows);
    others(&mut rows);
    let head = "| part of the crate | what of it does not run |\n|---|---|\n";
    let lines = rows
        .iter()
        .map(|(part, what)| format!("| {part} | {what} |\n"));
    let table = lines.collect::<String>();
    println!("{head}{table}");
    let page = include_str!("../../../../docs/notebook/gpu.md");
    let (_, rest) = page.split_once(head).expect("the head of the table");
    let (found, _) = rest.split_once("\n\n").expect("an end of the table");
    assert_eq!(format!("{found}\n"), table);
}
