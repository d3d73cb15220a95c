//! Checks of the Godunov method: order, balance, impedance matching, the acoustic limit, contacts.
//! The law of the rods is the cubic Mie–Grüneisen form of Lam, Shen and Gong (2001), Eqs 4–6.

use super::*;
use crate::material::eos::{EosState, Guards};
use crate::scalar::Lane;
use crate::study::Joint;
use crate::study::acoustic_rods::{self, AcousticRods};
use crate::study::norms::{Norms, arrival, observed_order, overshoot, plateau_mean, rise_10_90};
use crate::study::sod::Sod;

#[derive(Clone, Copy, Debug)]
struct Cubic {
    density: f64,
    sound_speed: f64,
    slope: f64,
    gruneisen: f64,
}

impl EquationOfState for Cubic {
    fn name(&self) -> &'static str {
        "cubic"
    }
    fn reference_density(&self) -> f64 {
        self.density
    }
    fn uses_energy(&self) -> bool {
        true
    }
    fn state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let a = self.density * self.sound_speed * self.sound_speed;
        let s = self.slope - 1.0;
        let (b, c) = (a * (1.0 + 2.0 * s), a * (2.0 * s + 3.0 * s * s));
        let g = self.gruneisen;
        let eta = density / L::of(self.density) - L::one();
        let hugoniot = eta * (L::of(a) + eta * (L::of(b) + eta * L::of(c)));
        let slope = L::of(a) + eta * (L::of(2.0 * b) + eta * L::of(3.0 * c));
        let share = L::one() - L::of(0.5 * g) * eta;
        let thermal = L::of(g * self.density) * energy;
        let pressure = share * hugoniot + (L::one() + eta) * thermal;
        let by_eta = share * slope - L::of(0.5 * g) * hugoniot + thermal;
        let squared = by_eta / L::of(self.density) + pressure / density * L::of(g);
        EosState {
            pressure,
            sound_speed: squared.sqrt(),
            guards: Guards::none(),
        }
    }
}

const fn cubic(density: f64, sound_speed: f64, slope: f64, gruneisen: f64) -> Cubic {
    Cubic {
        density,
        sound_speed,
        slope,
        gruneisen,
    }
}
const COPPER: Cubic = cubic(8930.0, 3940.0, 1.49, 2.02);
const STEEL: Cubic = cubic(7850.0, 3570.0, 1.92, 1.8);
const ALUMINIUM: Cubic = cubic(2700.0, 5350.0, 1.34, 2.0);
const PMMA: Cubic = cubic(1190.0, 2600.0, 1.52, 1.0);

fn rod(law: Cubic, length: f64, velocity: f64) -> RodSegment {
    RodSegment::at_rest(Arc::new(law), length, law.density).moving(velocity)
}

fn onto(target: Cubic, speed: f64, cells: usize) -> GodunovRods {
    GodunovRods::new(cells)
        .segment(rod(COPPER, 0.010, speed))
        .contact(Contact::Unilateral)
        .segment(rod(target, 0.040, 0.0))
        .gauge(0.005)
        .gauge(0.015)
}

fn onto_wall(cells: usize) -> GodunovRods {
    GodunovRods::new(cells)
        .segment(rod(COPPER, 0.010, 20.0))
        .right_end(End::Wall)
        .gauge(0.005)
}

fn padded(pad: f64, cells: usize) -> GodunovRods {
    GodunovRods::new(cells)
        .segment(rod(COPPER, 0.010, 20.0))
        .segment(rod(PMMA, pad, 20.0))
        .contact(Contact::Unilateral)
        .segment(rod(COPPER, 0.040, 0.0))
        .gauge(0.005)
}

fn mean(gauge: &GaugeRecord, from: f64, to: f64) -> f64 {
    plateau_mean(&gauge.time, &gauge.stress, from * 1e-6, to * 1e-6).unwrap()
}

fn balanced(run: &GodunovSolution) {
    let ledger = run.ledger();
    assert!(ledger.momentum_defect().abs() < 1e-11, "{ledger:?}");
    assert!(ledger.energy_defect().abs() < 1e-11, "{ledger:?}");
}

#[test]
fn smooth_acoustic_waves_converge_with_second_order() {
    let (amplitude, c) = (1e-4, 3940.0);
    let pulse = move |x: f64| amplitude * (-((x - 0.02) / 0.003).powi(2)).exp();
    let (mut spacings, mut errors) = (Vec::new(), Vec::new());
    for cells in [200, 400, 800, 1600] {
        let initially = move |x: f64| InitialState {
            density: 8930.0,
            energy: 0.0,
            velocity: pulse(x),
        };
        // Half the pulse meets the free end, half the clamped one: v returns even, and odd.
        let run = GodunovRods::new(cells)
            .segment(RodSegment::at_rest(Arc::new(COPPER), 0.05, 8930.0).initially(initially))
            .right_end(End::Bonded)
            .courant(0.6)
            .snapshot(0.045 / c)
            .solve(0.045 / c)
            .unwrap();
        let row = &run.snapshots()[0].cells;
        let exact = |x: f64| {
            let shift = 0.045;
            let image = |y: f64| pulse(y) + pulse(-y) - pulse(0.1 - y) - pulse(0.1 + y);
            0.5 * (image(x - shift) + image(x + shift))
        };
        let velocity: Vec<f64> = row.iter().map(|cell| cell.velocity).collect();
        let expected: Vec<f64> = row.iter().map(|cell| exact(cell.x0)).collect();
        let norms = Norms::of_difference(&velocity, &expected).unwrap();
        spacings.push(0.05 / cells as f64);
        errors.push(1e3 * norms.l1 / amplitude);
        balanced(&run);
    }
    let order = observed_order(&spacings, &errors).unwrap();
    println!(
        "smooth wave: 1000 L1 {errors:.3?} order {:.3} ± {:.3}",
        order.order, order.half_width
    );
    assert!((order.order - 2.0).abs() < 0.2, "{order:?} {errors:?}");
}

#[test]
fn shock_tube_converges_with_first_order() {
    let air = |density: f64, energy: f64| {
        let p = 0.4 * density * energy;
        (p, (1.4 * p / density).sqrt())
    };
    let tube = Sod::new().unwrap();
    let (mut spacings, mut errors) = (Vec::new(), Vec::new());
    for cells in [100, 200, 400, 800] {
        let law = Arc::new(PressureFn(air));
        let run = GodunovRods::new(cells)
            .starting_at(-0.5)
            .segment(RodSegment::at_rest(law.clone(), 0.5, 1.0).with_energy(2.5))
            .segment(RodSegment::at_rest(law, 0.5, 0.125).with_energy(2.0))
            .left_end(End::Bonded)
            .right_end(End::Bonded)
            .snapshot(0.2)
            .solve(0.2)
            .unwrap();
        let row = &run.snapshots()[0].cells;
        let x: Vec<f64> = row.iter().map(|cell| cell.x).collect();
        let exact: Vec<f64> = tube
            .profile(&x, 0.2)
            .unwrap()
            .iter()
            .map(|state| state.density)
            .collect();
        let density: Vec<f64> = row.iter().map(|cell| cell.density).collect();
        let lengths: Vec<f64> = row.iter().map(|cell| cell.length).collect();
        errors.push(Norms::weighted(&density, &exact, &lengths).unwrap().l1);
        spacings.push(1.0 / cells as f64);
        balanced(&run);
    }
    let order = observed_order(&spacings, &errors).unwrap();
    println!(
        "Sod: L1(ρ) {errors:.5?} order {:.3} ± {:.3}",
        order.order, order.half_width
    );
    assert!(order.order > 0.75 && errors[2] < 2.5e-3, "{errors:?}");
}

#[test]
fn plateaus_match_the_shock_impedances() {
    let cases = [
        ("copper", onto(COPPER, 20.0, 2000), 353.17),
        ("steel", onto(STEEL, 20.0, 2000), 313.49),
        ("aluminium", onto(ALUMINIUM, 20.0, 2000), 205.46),
        ("PMMA", onto(PMMA, 20.0, 2000), 57.44),
        ("wall", onto_wall(2000), 709.01),
    ];
    for (name, rods, expected) in cases {
        let run = rods.solve(5e-6).unwrap();
        let gauge = &run.gauges()[0];
        let plateau = -mean(gauge, 1.6, 3.4) / 1e6;
        let front = arrival(&gauge.time, &gauge.stress, 0.0, -expected * 1e6).unwrap();
        let rise = rise_10_90(&gauge.time, &gauge.stress, 0.0, -expected * 1e6).unwrap();
        let over = overshoot(&gauge.stress, 0.0, -expected * 1e6).unwrap();
        println!(
            "{name}: plateau {plateau:.4} MPa, arrival {:.5} µs, rise {:.5} µs, overshoot {:.2} %",
            front * 1e6,
            rise * 1e6,
            over * 100.0
        );
        assert!((plateau / expected - 1.0).abs() < 1e-4, "{name} {plateau}");
        balanced(&run);
    }
}

#[test]
fn small_velocities_give_the_acoustic_solution() {
    for (target, until) in [(COPPER, 12e-6), (ALUMINIUM, 14e-6), (PMMA, 25e-6)] {
        let mut errors = Vec::new();
        let elastic = |law: Cubic, length: f64, velocity: f64| acoustic_rods::RodSegment {
            length,
            density: law.density,
            sound_speed: law.sound_speed,
            velocity,
        };
        let waves = AcousticRods::new()
            .segment(elastic(COPPER, 0.010, 0.02))
            .contact(Contact::Unilateral)
            .segment(elastic(target, 0.040, 0.0))
            .solve(until)
            .unwrap();
        let plateau = waves.stress(0.005, 2.5e-6).unwrap();
        for cells in [250, 500, 1000, 2000] {
            let run = onto(target, 0.02, cells).solve(until).unwrap();
            let gauge = &run.gauges()[1];
            let exact: Vec<f64> = gauge
                .time
                .iter()
                .map(|&t| waves.stress(0.015, t).unwrap())
                .collect();
            errors.push(Norms::of_difference(&gauge.stress, &exact).unwrap().l1 / -plateau);
        }
        let spacings = [8.0, 4.0, 2.0, 1.0];
        let order = observed_order(&spacings, &errors).unwrap();
        println!("acoustic limit: L1 {errors:.5?} order {:.3}", order.order);
        assert!(order.order > 0.6 && errors[3] < 0.01, "{errors:?}");
    }
}

#[test]
fn contacts_open_and_the_wall_turns_the_striker_round() {
    let cases = [
        ("copper", onto(COPPER, 20.0, 1000), Joint::Between(0)),
        ("steel", onto(STEEL, 20.0, 1000), Joint::Between(0)),
        ("aluminium", onto(ALUMINIUM, 20.0, 1000), Joint::Between(0)),
        ("PMMA", onto(PMMA, 20.0, 1000), Joint::Between(0)),
        ("wall", onto_wall(1000), Joint::Right),
        ("pad 5 mm", padded(0.005, 1000), Joint::Between(1)),
        ("pad 7.5 mm", padded(0.0075, 1000), Joint::Between(1)),
        ("pad 10 mm", padded(0.010, 1000), Joint::Between(1)),
        ("pad 20 mm", padded(0.020, 1000), Joint::Between(1)),
    ];
    let expected = [20.2, 22.2, 14.9, 30.4, 5.07];
    for (k, (name, rods, joint)) in cases.into_iter().enumerate() {
        let run = rods.solve(60e-6).unwrap();
        balanced(&run);
        let times =
            |i: &crate::study::ContactInterval| (i.from * 1e6, i.until.unwrap_or(f64::NAN) * 1e6);
        let closed: Vec<_> = run
            .joint(joint)
            .unwrap()
            .intervals
            .iter()
            .map(times)
            .collect();
        println!(
            "{name}: closed {closed:.3?} µs, {} steps",
            run.ledger().steps
        );
        if let Some(expected) = expected.get(k) {
            let until = closed[0].1;
            assert!((until - expected).abs() < 0.2, "{name} {closed:?}");
        }
    }
    // p(U) acts from 0 to 5.019 µs, then falls linearly with the fan until 5.038 µs: 0.9962.
    for (cells, tolerance) in [(500, 3e-3), (1000, 1.5e-3), (2000, 1e-3)] {
        let run = onto_wall(cells).solve(7e-6).unwrap();
        let turned = run.ledger().final_momentum / run.ledger().initial_momentum;
        println!("wall, {cells} cells: momentum returned {turned:.6}");
        assert!((turned + 0.9962).abs() < tolerance, "{turned}");
    }
}

#[test]
fn later_plateaus_of_the_pad() {
    // Acoustic values 104.56, 0, 161.15 MPa; the nonlinear ones at 4000 cells.
    let run = padded(0.005, 1500).solve(9.5e-6).unwrap();
    let spans = [(3.5, 5.4, -106.378), (6.1, 6.7, 0.0), (8.6, 9.2, -164.481)];
    for (from, to, expected) in spans {
        let level = mean(&run.gauges()[0], from, to) / 1e6;
        assert!((level - expected).abs() < 0.01, "{from} {level}");
    }
}

#[test]
fn a_gap_closes_again_without_loss() {
    let run = GodunovRods::new(400)
        .segment(rod(PMMA, 0.010, 0.0))
        .contact(Contact::Unilateral)
        .segment(rod(COPPER, 0.013, -5.0))
        .left_end(End::Wall)
        .snapshot(200e-6)
        .solve(200e-6)
        .unwrap();
    let wall = run.joint(Joint::Left).unwrap();
    let joint = run.joint(Joint::Between(0)).unwrap();
    assert!(wall.intervals.len() + joint.intervals.len() > 2);
    balanced(&run);
    let cells = &run.snapshots()[0].cells;
    let k = cells.iter().position(|cell| cell.segment == 1).unwrap();
    let right_of = cells[k - 1].x + 0.5 * cells[k - 1].length;
    let gap = cells[k].x - 0.5 * cells[k].length - right_of;
    assert!((gap - joint.gap[joint.gap.len() - 1]).abs() < 1e-15);
    assert!(joint.gap.iter().all(|&gap| gap >= 0.0));
}

#[test]
fn wrong_input_is_refused() {
    assert!(GodunovRods::new(10).solve(1.0).is_err());
    assert!(onto(COPPER, 20.0, 100).gauge(0.06).solve(1e-6).is_err());
    assert!(onto(COPPER, 20.0, 100).snapshot(2e-6).solve(1e-6).is_err());
    assert!(onto(COPPER, 20.0, 100).courant(1.1).solve(1e-6).is_err());
    let hollow = RodSegment::at_rest(Arc::new(COPPER), 0.01, -1.0);
    assert!(GodunovRods::new(10).segment(hollow).solve(1e-6).is_err());
    let absurd = GodunovRods::new(100)
        .segment(rod(COPPER, 0.01, -30000.0))
        .segment(rod(COPPER, 0.01, 30000.0))
        .solve(1e-6);
    assert!(matches!(absurd, Err(StudyError::State { .. })));
}
