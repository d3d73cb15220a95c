//! A thin sheet of rubber between two levels of water, two and three particles thick: thinner than the kernel of the water.
//! Others let water see, push and leak through it. Here a train of impulses from the water shakes it, until it leaks: the
//! remedy is eight steps in one of the water's, and a viscosity of its own.

use super::harness::{Cures, Row, Varied, largest_share, lasting};
use super::stretch_and_twist::rubber;
use meshfree::effect::{HourglassControl, NeoHookean};
use meshfree::material::SoundSpeed;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::simulation::ParticleView;
use meshfree::term::viscosity::MonaghanGingold;

const GRAVITY: f64 = 9.81;
const DX: f64 = 0.005;
/// Widths of the basins and depths of the water in them \[m\].
const WIDTH: f64 = 0.1;
const DEPTHS: [f64; 2] = [0.1, 0.05];

/// What a sheet did; the lean of its tip is printed.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// Error of the mean force on it, weighted by sin² over the last three quarters as it swings, over the mean of ρ g (h₁² − h₂²)/2, with the levels that the sheet
    /// leaves to the water as it leans.
    force: f64,
    /// Share of the water that is on the other side.
    leaked: f64,
    /// Share of its largest piece.
    whole: f64,
}

/// The levels \[m\] that the waters have beside a sheet: what it has moved aside in each layer is space that they gain or lose.
fn levels(now: &Simulation<f64, 2>) -> [f64; 2] {
    let mut layers = vec![(0.0, 0.0); (0.2 / DX) as usize];
    for p in now.body("sheet").expect("a sheet") {
        let first = p.vector(Field::REFERENCE_POSITION).unwrap_or([0.0; 2]);
        let layer = &mut layers[(first[1] / DX) as usize];
        *layer = (layer.0 + p.position()[0] - first[0], layer.1 + 1.0);
    }
    let filled = |depth: f64, side: f64| {
        let (mut left, mut level) = (depth * WIDTH, 0.0);
        for (sum, count) in layers.iter().filter(|layer| layer.1 > 0.0) {
            let width = WIDTH + side * sum / count;
            let part = (left / (width * DX)).min(1.0);
            left -= part * width * DX;
            level += part * DX;
        }
        level
    };
    [filled(DEPTHS[0], 1.0), filled(DEPTHS[1], -1.0)]
}

/// A sheet of so many particles, held at its foot, that takes so many steps in one of the water's, with a viscosity.
fn sheet(thick: usize, young: f64, count: u32, alpha: f64) -> Found {
    let cells = |length: f64| (length / DX).round() as usize;
    let thickness = thick as f64 * DX;
    let sound = 10.0 * (GRAVITY * DEPTHS[0]).sqrt();
    let water = || catalogue::water_at(SoundSpeed::Chosen(sound)).with_pressure_cut_off(0.0);
    let down = [0.0, -GRAVITY];
    let far = 2.0 * WIDTH + thickness;
    let left = Body::block("left", water(), [0.0; 2], [WIDTH, DEPTHS[0]], DX);
    let right = [[WIDTH + thickness, 0.0], [far, DEPTHS[1]]];
    let right = Body::block("right", water(), right[0], right[1], DX);
    let top = 0.13;
    let rubber = rubber(1100.0, young, 0.3);
    let rubber = Body::block("sheet", rubber, [WIDTH, 0.0], [WIDTH + thickness, top], DX);
    // A wall below and beside, of which the sheet stands on the floor.
    let tank = Wall::around(
        "tank",
        [0.0; 2],
        [far, 0.2],
        DX,
        3,
        [[true; 2], [true, false]],
    );
    let viscosity = MonaghanGingold { alpha, beta: 0.0 };
    let scheme = SchemeBuilder::total_lagrangian(WendlandC2, viscosity)
        .h_over_dx(0.8)
        .with(HourglassControl::default())
        .with(NeoHookean);
    let scene = Scene::new(Cures::NONE.liquid())
        .body(left.hydrostatic(down, [0.0, DEPTHS[0]]))
        .body(right.hydrostatic(down, [0.0, DEPTHS[1]]))
        .group(scheme, [rubber])
        .wall(tank)
        .fix("sheet", |[_, y]| *y < 2.0 * DX)
        .sub_cycle("sheet", count)
        .between("left", "right", Interaction::None)
        .between("sheet", "tank", Interaction::None)
        .acceleration(move |_| down);
    let mut own = scene.varied().build().expect("a scene");
    let end = lasting(0.4);
    let (mut sum, mut exact) = (0.0, 0.0);
    let ended = own.run_with(end, |now| {
        let part = (now.time() / end - 0.25) / 0.75;
        if part > 0.0 {
            let weight = (std::f64::consts::PI * part).sin().powi(2);
            let of = |name| now.force_between("sheet", name).map_or(f64::NAN, |f| f[0]);
            sum += weight * (of("left") + of("right"));
            let [high, low] = levels(now);
            exact += weight * 500.0 * GRAVITY * (high * high - low * low);
        }
    });
    if let Err(error) = ended {
        println!("{error}");
        return Found {
            force: f64::INFINITY,
            leaked: 1.0,
            whole: 0.0,
        };
    }
    let sheet = || own.body("sheet").expect("a sheet");
    let rubber: Vec<_> = sheet().map(|p| p.position()).collect();
    let high = |p: &ParticleView<'_, f64, 2>| {
        let first = p.vector(Field::REFERENCE_POSITION);
        first.is_some_and(|x| x[1] > top - DX)
    };
    let tips: Vec<_> = sheet()
        .enumerate()
        .filter(|(_, p)| high(p))
        .map(|(k, _)| k)
        .collect();
    // The sheet at the height of a particle.
    let middle = |y: f64| {
        let near = rubber.iter().filter(|x| (x[1] - y).abs() < DX);
        let (sum, count) = near.fold((0.0, 0.0), |(s, n), x| (s + x[0], n + 1.0));
        if count > 0.0 { sum / count } else { f64::NAN }
    };
    let beyond = |name: &str, side: f64| {
        let all = own.body(name).expect("water").map(|p| p.position());
        all.filter(|x| side * (x[0] - middle(x[1])) > 0.0).count()
    };
    let leaked = beyond("left", 1.0) + beyond("right", -1.0);
    let tip = tips.iter().map(|k| rubber[*k][0]).sum::<f64>() / thick as f64;
    let water = (cells(DEPTHS[0]) + cells(DEPTHS[1])) * cells(WIDTH);
    let found = Found {
        force: (sum / exact - 1.0).abs(),
        leaked: leaked as f64 / water as f64,
        whole: largest_share(&rubber, 1.6 * DX),
    };
    println!(
        "{thick} thick, {young:e} Pa, {count} steps, α {alpha}: force {}, leans {} m, {found:?}",
        sum / exact,
        tip - WIDTH - 0.5 * thickness
    );
    found
}

#[test]
fn a_thin_sheet_parts_two_levels_of_water() {
    let row = |case, criterion, own: Found, control: Found| {
        assert!(own.whole == 1.0 && own.leaked == 0.0, "{own:?}");
        Row {
            case,
            criterion,
            value: own.force,
            control: control.force,
        }
        .at_most(0.02);
    };
    row(
        "sheet of 2 particles in water",
        "error of the force of the water; 8 steps in one of the water's, control: 64",
        sheet(2, 2e7, 8, 0.2),
        sheet(2, 2e7, 64, 0.2),
    );
    row(
        "sheet of 3 particles in water",
        "the same; and α = 0.2 in the sheet, control: neither",
        sheet(3, 6e6, 8, 0.2),
        sheet(3, 6e6, 64, 0.0),
    );
}
