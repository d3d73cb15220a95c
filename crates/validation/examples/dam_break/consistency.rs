//! SPHERIC 2 over quarter seconds, beside its record: pressures on the face of the box, and the water that gauges see.
//! The record is compared with itself, too: what its gauges add up to, and what weighs between its sensors.

use super::common::Failure;
use super::flat::GRAVITY;
use super::obstacle::{BOX, COLUMN, DENSITY, GAUGES, SENSORS, TANK};
use super::violent::{Choices, History};
use meshfree::output::table::{Table, significant};
use meshfree::study::records::Record;

/// The record's columns at the gauges along the tank: it has the first and the third exchanged.
const MEASURED: [&str; 4] = ["H3", "H2", "H1", "H4"];

/// A record as a history.
fn history_of(record: &Record, columns: &[&str]) -> Result<History, Failure> {
    let read = columns.iter().map(|name| record.column(name));
    Ok(History {
        time: record.column("time_s")?,
        names: columns.iter().map(ToString::to_string).collect(),
        columns: read.collect::<Result<_, _>>()?,
        ..History::default()
    })
}

/// The share of the water that levels at the gauges add up to, with straight lines between them, level to the ends
/// of the tank, and the box under water.
fn accounted_for(levels: [f64; 4]) -> f64 {
    let [length, width, _] = TANK;
    let mut area = levels[0] * GAUGES[0] + levels[3] * (length - GAUGES[3]);
    for k in 1..4 {
        area += 0.5 * (levels[k - 1] + levels[k]) * (GAUGES[k] - GAUGES[k - 1]);
    }
    let hidden: f64 = (0..3).map(|d| BOX[1][d] - BOX[0][d]).product();
    let [start, height] = COLUMN;
    (area * width - hidden) / ((length - start) * width * height)
}

/// Prints means over quarter seconds from 0.5 s on, computed and measured.
pub fn print(history: &History, choices: &Choices) -> Result<(), Failure> {
    let [Some(heights), Some(pressures)] = ["water_heights", "pressures"].map(|name| {
        choices
            .records
            .read(&format!("spheric02_dambreak3d/{name}.csv"))
    }) else {
        return Ok(());
    };
    let heights = history_of(&heights, &MEASURED)?;
    let pressures = history_of(&pressures, &["P1", "P2", "P3", "P4"])?;
    let weight = DENSITY * GRAVITY * (SENSORS[3] - SENSORS[0]);
    let head = [
        "from [s]",
        "P1 to P4, computed [Pa]",
        "measured [Pa]",
        "P1 - P4 over the weight between, computed",
        "measured",
        "water that the gauges account for, computed",
        "measured",
    ];
    let mut table = Table::new(head).title("SPHERIC 2, means over quarter seconds");
    let until = history.time.last().copied().unwrap_or(0.0);
    for from in (2..24).map(|k| 0.25 * f64::from(k)) {
        let to = from + 0.25;
        if to > until + 0.01 {
            break;
        }
        let computed = [1, 2, 3, 4].map(|k| history.mean(&format!("p{k}_pa"), from, to));
        let measured = [1, 2, 3, 4].map(|k| pressures.mean(&format!("P{k}"), from, to));
        let list = |p: [f64; 4]| p.map(|p| format!("{p:.0}")).join(", ");
        let levels = [1, 2, 3, 4].map(|k| history.mean(&format!("h{k}_m"), from, to));
        let seen = MEASURED.map(|name| heights.mean(name, from, to));
        table.row([
            significant(from, 3),
            list(computed),
            list(measured),
            significant((computed[0] - computed[3]) / weight, 3),
            significant((measured[0] - measured[3]) / weight, 3),
            significant(accounted_for(levels), 3),
            significant(accounted_for(seen), 3),
        ]);
    }
    println!("{}", table.markdown());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauges_account_for_all_water_of_a_level_tank() {
        // 1.228 × 1 × 0.55 m³ of water, and 0.161 × 0.403 × 0.161 m³ of box, on 3.22 × 1 m² of bed.
        let level = (0.6754 + 0.010_446) / 3.22;
        assert!((accounted_for([level; 4]) - 1.0).abs() < 1e-4);
        // A triangle of 0.1 m between the gauges at 0.496 and 1.488 m, a twentieth of a metre high in the mean.
        let more = accounted_for([level, level + 0.1, level, level]) - accounted_for([level; 4]);
        assert!((more - 0.05 * 0.992 / 0.6754).abs() < 1e-6);
    }

    #[test]
    fn a_record_is_read_by_the_names_of_its_columns() {
        let record = Record::parse("time_s,H1,H2,H3,H4\n0,1,2,3,4\n1,3,2,5,4\n").unwrap();
        let history = history_of(&record, &MEASURED).unwrap();
        // Along the tank: behind the box, before it, at the gate and in the column.
        let means = MEASURED.map(|name| history.mean(name, 0.0, 1.0));
        assert_eq!(means, [4.0, 2.0, 2.0, 4.0]);
        assert!(history_of(&record, &["H5"]).is_err());
    }
}
