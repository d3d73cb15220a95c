//! A strip that is drawn to three times its length, and a column that is wrung, both in total Lagrangian.
//! Others lose their neighbours and part in a stretch, or fold in zigzags that no deformation gradient sees.

use super::harness::{Row, Varied, lasting};
use super::swegle;
use meshfree::effect::{HourglassControl, NeoHookean, NoWalls, TotalLagrangian};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::term::InternalEnergy;
use meshfree::term::viscosity::Inviscid;

/// An elastic structure.
type Structure = SchemeBuilder<
    WendlandC2,
    Inviscid,
    NoWalls,
    ((((), TotalLagrangian), InternalEnergy), HourglassControl),
>;

/// The ready structure with so much hourglass control.
pub fn elastic(strength: f64) -> Structure {
    reaching(0.8, strength)
}

/// The same at another h/dx.
fn reaching(h_over_dx: f64, strength: f64) -> Structure {
    SchemeBuilder::total_lagrangian(WendlandC2, Inviscid)
        .h_over_dx(h_over_dx)
        .with(HourglassControl { strength })
}

/// A rubber of a density, Young's modulus \[Pa\] and Poisson's ratio.
pub fn rubber(density: f64, young: f64, poisson: f64) -> Material<f64> {
    let law = Linear::from_elastic_constants(density, young, poisson);
    Material::new("rubber", law).with_shear_modulus(young / (2.0 * (1.0 + poisson)))
}

/// Cells along and across the strip, each a hundredth of a metre.
const CELLS: [usize; 2] = [40, 10];
const DX: f64 = 0.01;

/// A strip that is held at one end and drawn at the other to three times its length, by 0.02 of its sound speed: the largest gap
/// along its middle row over the mean of that row.
fn drawn(scheme: impl Into<Scheme<f64, 2>>) -> f64 {
    let [length, height] = CELLS.map(|n| n as f64 * DX);
    let body = Body::block(
        "strip",
        rubber(1000.0, 1e6, 0.3),
        [0.0; 2],
        [length, height],
        DX,
    );
    let row: Vec<usize> = (0..body.points().len())
        .filter(|&k| (body.points()[k][1] - 0.5 * (height + DX)).abs() < 0.1 * DX)
        .collect();
    let speed = 0.02 * (1e6_f64 / 1000.0).sqrt();
    // Grips of three columns; the free length is what grows.
    let grip = 3.0 * DX;
    let drawing = Translation::steady([speed, 0.0]);
    let scene = Scene::new(scheme)
        .body(body.start(move |[x, _], own| meshfree::scheme::Start {
            velocity: [
                speed * ((x - grip) / (length - 2.0 * grip)).clamp(0.0, 1.0),
                0.0,
            ],
            ..own
        }))
        .fix("strip", move |[x, _]| *x < grip)
        .clamp("strip", move |[x, _]| *x > length - grip, drawing);
    let mut strip = scene.varied().build().expect("a scene");
    let ended = strip.run_until(2.0 * (length - 2.0 * grip) / speed);
    println!("{}", strip.scheme().name());
    if let Err(error) = ended {
        println!("{error}");
        return f64::INFINITY;
    }
    let mut places: Vec<_> = strip
        .all()
        .filter(|p| row.contains(&p.id()))
        .map(|p| p.position())
        .collect();
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // The middle half, where the grips are not felt.
    let middle = &places[places.len() / 4..3 * places.len() / 4];
    let gaps: Vec<f64> = middle.windows(2).map(|own| own[1][0] - own[0][0]).collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    println!("mean gap {} of the first", mean / DX);
    gaps.into_iter().fold(0.0, f64::max) / mean
}

#[test]
fn a_strip_is_drawn_to_three_times_its_length() {
    let control = drawn(swegle::solid([0.0; 2]));
    let cured = drawn(swegle::solid([0.3, 1.0]));
    println!("updated Lagrangian with both cures {cured}");
    Row {
        case: "strip drawn to three times its length",
        criterion: "largest gap along it over the mean; control: updated Lagrangian",
        value: drawn(elastic(0.1).with(NeoHookean)),
        control,
    }
    .at_most(1.1);
}

const LAYERS: usize = 6;
const HEIGHT: f64 = 6.0;
const CELL: f64 = 1.0 / LAYERS as f64;

/// RMS of the fourth differences of places along the fibres of a column, over 16 spacings.
fn zigzag(column: &Simulation<f64, 3>, first: &[[f64; 3]]) -> f64 {
    // Particles of a fibre, by height.
    let cell = |x: f64| ((x + 0.5) / CELL) as usize;
    let mut fibres = vec![Vec::new(); LAYERS * LAYERS];
    for p in column.all() {
        let [x, y, z] = first[p.id()];
        fibres[cell(x) * LAYERS + cell(y)].push((z, p.position()));
    }
    let (mut square, mut count) = (0.0, 0.0);
    for fibre in &mut fibres {
        fibre.sort_by(|a, b| a.0.total_cmp(&b.0));
        for own in fibre.windows(5) {
            for d in 0..3 {
                let at = |k: usize| own[k].1[d];
                let bend = at(0) - 4.0 * at(1) + 6.0 * at(2) - 4.0 * at(3) + at(4);
                square += (bend / (16.0 * CELL)).powi(2);
            }
            count += 1.0;
        }
    }
    (square / count).sqrt()
}

/// A column of a square metre and six metres high, held at its foot, that starts to turn about its axis by a speed \[1/s\]
/// times sin(π z/2H) (Lee, Gil & Bonet 2013): the largest zigzag that is seen, the change of
/// energy, and the share of the energy that the hourglass control has taken.
fn wrung(h_over_dx: f64, strength: f64, speed: f64) -> [f64; 3] {
    let body = Body::block(
        "column",
        rubber(1100.0, 17e6, 0.45),
        [-0.5, -0.5, 0.0],
        [0.5, 0.5, HEIGHT],
        CELL,
    );
    let turning = |[x, y, z]: [f64; 3], own: meshfree::scheme::Start<3>| {
        let rate = speed * (0.5 * std::f64::consts::PI * z / HEIGHT).sin();
        meshfree::scheme::Start {
            velocity: [-rate * y, rate * x, 0.0],
            ..own
        }
    };
    let first = body.points().to_vec();
    let scene = Scene::new(reaching(h_over_dx, strength).with(NeoHookean))
        .body(body.start(turning))
        .fix("column", move |[_, _, z]| *z < CELL);
    let mut column = scene.varied().build().expect("a scene");
    let before = column.ledger().whole.total_energy();
    let mut rough = 0.0_f64;
    // It comes and goes with the swing, so one instant says little.
    let ended = column.run_with(lasting(0.3), |now| {
        if now.steps() % 20 == 0 {
            rough = rough.max(zigzag(now, &first));
        }
    });
    if let Err(error) = ended {
        println!("{strength}: {error}");
        return [f64::INFINITY; 3];
    }
    let whole = column.ledger().whole;
    let energy = (whole.total_energy() / before - 1.0).abs();
    let hourglass = whole.total("hourglass energy").unwrap_or(0.0) / before;
    println!(
        "h/dx {h_over_dx}, {strength}, {speed}/s: t {} steps {} rough {rough}, energy {energy}, hourglass {hourglass}, beyond \
         validity {:?}",
        column.time(),
        column.steps(),
        column.limits()
    );
    [rough, energy, hourglass]
}

#[test]
fn a_column_is_wrung_without_zigzags() {
    let row = |case, criterion, [value, energy, hourglass]: [f64; 3], control: [f64; 3]| {
        assert!(
            energy < 1e-9 && hourglass.abs() < 0.05,
            "{energy} {hourglass}"
        );
        Row {
            case,
            criterion,
            value,
            control: control[0],
        }
        .at_most(0.02);
    };
    row(
        "wrung column, 6 × 6 × 36, 30/s",
        "largest RMS zigzag along fibres in spacings; h/dx 1, control: 0.8",
        wrung(1.0, 0.1, 30.0),
        wrung(0.8, 0.1, 30.0),
    );
    row(
        "wrung column, 6 × 6 × 36, 60/s",
        "the same; h/dx 1, control: without hourglass control",
        wrung(1.0, 0.1, 60.0),
        wrung(1.0, 0.0, 60.0),
    );
}
