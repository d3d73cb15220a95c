//! What pads must meet: the steps that the reference holds, quiet before the wave, joints free of stress.
//! One of the pads is no multiple of the striker.

use super::Failure;
use super::bars::{Measured, Row, means, window};
use super::paper::pad_label;
use super::theory::Theory;

/// Steps that the reference holds at probe `p` for half a microsecond, within 0.5 % of the largest
/// stress, as (from, until, stress).
fn held(theory: &Theory, p: usize) -> Vec<(f64, f64, f64)> {
    let gauge = &theory.reference.gauges()[p];
    let (time, stress) = (&gauge.time, &gauge.stress);
    let largest = stress.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
    let mut steps = Vec::new();
    let mut start = 0;
    while start < time.len() {
        let (mut low, mut high, mut end) = (stress[start], stress[start], start);
        for (k, &s) in stress.iter().enumerate().skip(start + 1) {
            (low, high) = (low.min(s), high.max(s));
            if high - low > 0.005 * largest {
                break;
            }
            end = k;
        }
        if time[end] - time[start] >= 0.5e-6 {
            steps.push((time[start], time[end], stress[usize::midpoint(start, end)]));
            start = end;
        }
        start += 1;
    }
    steps
}

/// Measures case 3 with pads of 5, 7.5, 10 and 20 mm.
pub fn rows(measured: &Measured, rows: &mut Vec<Row>) -> Result<(), Failure> {
    for mm in [5.0, 10.0, 20.0, 7.5] {
        let label = pad_label(mm);
        let steps = held(measured.theory(&label)?, 0);
        let loaded = steps
            .iter()
            .enumerate()
            .skip(1)
            .filter(|(_, step)| step.2.abs() > 1e6);
        for (count, (_, &(from, until, stress))) in loaded.enumerate() {
            let bar = if count == 0 { 1.5 } else { 3.0 };
            let margin = 0.15 * (until - from);
            let name = format!(
                "{label}: {:.2} to {:.2} µs, {:.1} MPa [% of the first]",
                1e6 * from,
                1e6 * until,
                1e-6 * stress
            );
            rows.push(measured.row(name, bar, &label, |r, t| {
                let (first, _) = means(r, t, 0, window(t, 5e-3, 1)?)?;
                let (reference, run) = means(r, t, 0, (from + margin, until - margin))?;
                Ok(100.0 * (run - reference) / first)
            })?);
        }
        rows.push(measured.row(
            format!("{label}: stress until 0.25 µs before arrival [%]"),
            0.5,
            &label,
            |r, t| {
                let steps = held(t, 0);
                let &(arrival, _, first) = steps.get(1).ok_or("no wave arrives")?;
                let end = r.time.partition_point(|&time| time < arrival - 0.25e-6);
                let most = r.probes[0].stress[..end]
                    .iter()
                    .fold(0.0, |most: f64, s| most.max(s.abs()));
                Ok(100.0 * most / first.abs())
            },
        )?);
        rows.push(measured.row(
            format!("{label}: largest pressure at t = 0 [Pa]"),
            0.0,
            &label,
            |r, _| Ok(r.at_rest),
        )?);
    }
    let label = pad_label(7.5);
    rows.push(measured.row(
        format!("{label}: joint at 1.5 µs, before the wave [of the plateau]"),
        1e-9,
        &label,
        |r, _| {
            let shot = r.snapshot(1.5e-6).ok_or("no snapshot")?;
            let joint = shot
                .points
                .iter()
                .filter(|p| (p.reference - 10e-3).abs() < 1e-3);
            Ok(joint.fold(0.0, |most: f64, p| most.max(p.stress.abs())) / 104.56e6)
        },
    )?);
    Ok(())
}
