//! What a bar is compared with: the finite-element benchmark, and measured shots of the same metal.
//! Shots come from the records beside the crate, if they are there.

use super::common::Records;
use super::{Bar, Failure};
use meshfree::output::csv::Csv;

/// Final length and radius of the foot \[m\] of the copper of Simo 1992 in later finite-element codes.
const BENCHMARK: [f64; 2] = [21.425e-3, 7.225e-3];

/// Lines that say how a bar's final length and foot diameter \[m\] compare.
pub fn compared(
    material: &str,
    bar: Bar,
    length: f64,
    foot: f64,
    records: Option<&Records>,
) -> Result<String, Failure> {
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
    let benchmark = [
        (bar.length, 32.4e-3),
        (bar.diameter, 6.4e-3),
        (bar.speed, 227.0),
    ];
    if material == "copper-j2" && benchmark.iter().all(|&(own, its)| near(own, its)) {
        let off = |own: f64, its: f64| 100.0 * (own / its - 1.0);
        return Ok(format!(
            "finite elements (21.42 to 21.43 mm, radius 7.22 to 7.23 mm): length {:+.2} %, radius {:+.2} %\n",
            off(length, BENCHMARK[0]),
            off(0.5 * foot, BENCHMARK[1]),
        ));
    }
    let metal = match material {
        "copper-jc" => "OFHC copper",
        "4340" => "4340 steel",
        "6061" => "6061-T6 aluminium",
        _ => return Ok(String::new()),
    };
    let Some(shots) = records.and_then(|own| own.path("taylor_impact/experiments.csv")) else {
        return Ok(String::new());
    };
    let table = Csv::read(shots)?;
    let text = |name: &str| table.text_column(name).ok_or(format!("no column {name}"));
    let [materials, sources] = [text("material")?, text("source")?];
    let number = |name: &str, row: usize| -> Option<f64> {
        table.text_column(name)?.get(row)?.trim().parse().ok()
    };
    let mut lines = String::new();
    for row in 0..materials.len() {
        let at = |name: &str| number(name, row);
        let same = materials[row] == metal
            && at("U_mps").is_some_and(|u| (u - bar.speed).abs() < 1.0)
            && at("L0_mm").is_some_and(|l| near(1e-3 * l, bar.length))
            && at("D0_mm").is_some_and(|d| (1e-3 * d / bar.diameter - 1.0).abs() < 0.01)
            && at("T_K").is_none_or(|t| t < 350.0);
        if !same {
            continue;
        }
        lines += &format!("measured by {}:", sources[row]);
        if let Some(measured) = at("Lf_over_L0") {
            let own = length / bar.length;
            lines += &format!(
                " length {measured:.4} of the first, here {own:.4} ({:+.2} %)",
                100.0 * (own / measured - 1.0)
            );
        }
        if let Some(measured) = at("Df_mm") {
            let own = 1e3 * foot;
            lines += &format!(
                "; foot {measured:.2} mm, here {own:.2} mm ({:+.2} %)",
                100.0 * (own / measured - 1.0)
            );
        }
        lines.push('\n');
    }
    Ok(lines)
}
