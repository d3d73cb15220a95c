//! A thin sheet of rubber between two levels of water, two and three particles thick: thinner than the kernel of the water.
//! Others let water see, push and leak through it; the cure is that the waters on its sides are two bodies that do not meet.

use super::harness::{Cures, Row, Varied, largest_share, lasting};
use super::stretch_and_twist::{elastic, rubber};
use meshfree::effect::NeoHookean;
use meshfree::material::SoundSpeed;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::simulation::ParticleView;

const GRAVITY: f64 = 9.81;
const DX: f64 = 0.005;
/// Widths of the basins and depths of the water in them \[m\].
const WIDTH: f64 = 0.1;
const DEPTHS: [f64; 2] = [0.1, 0.05];

/// What a sheet did; the lean of its tip is printed.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// Error of the mean force on it in the second half over ρ g (h₁² − h₂²)/2.
    force: f64,
    /// Share of the water that is on the other side.
    leaked: f64,
    /// Share of its largest piece.
    whole: f64,
}

/// A sheet of so many particles, held at its foot.
fn sheet(thick: usize, young: f64, parted: bool, hourglass: f64) -> Found {
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
    let mut scene = Scene::new(Cures::NONE.liquid())
        .body(left.hydrostatic(down, [0.0, DEPTHS[0]]))
        .body(right.hydrostatic(down, [0.0, DEPTHS[1]]))
        .group(elastic(hourglass).with(NeoHookean), [rubber])
        .wall(tank)
        .fix("sheet", |[_, y]| *y < 2.0 * DX)
        .sub_cycle("sheet", 64)
        .acceleration(move |_| down);
    let meets = if parted {
        Interaction::None
    } else {
        Interaction::Bonded
    };
    scene = scene.between("left", "right", meets);
    let mut own = scene.varied().build().expect("a scene");
    let end = lasting(0.4);
    let (mut sum, mut count) = (0.0, 0.0);
    let ended = own.run_with(end, |now| {
        if now.time() > 0.5 * end {
            let of = |name| now.force_between("sheet", name).map_or(f64::NAN, |f| f[0]);
            sum += of("left") + of("right");
            count += 1.0;
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
    let exact = 500.0 * GRAVITY * (DEPTHS[0].powi(2) - DEPTHS[1].powi(2));
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
        force: (sum / count / exact - 1.0).abs(),
        leaked: leaked as f64 / water as f64,
        whole: largest_share(&rubber, 1.6 * DX),
    };
    println!(
        "{thick} thick, {young:e} Pa, parted {parted}, hourglass {hourglass}: force {}, leans {} m, {found:?}",
        sum / count / exact,
        tip - WIDTH - 0.5 * thickness
    );
    found
}

#[test]
fn a_thin_sheet_parts_two_levels_of_water() {
    let two = sheet(2, 2e7, true, 0.1);
    let three = sheet(3, 6e6, true, 0.1);
    for own in [two, three] {
        assert!(own.whole == 1.0 && own.leaked < 0.02, "{own:?}");
    }
    let row = |case, criterion, value, control| Row {
        case,
        criterion,
        value,
        control,
    };
    row(
        "sheet of 2 particles in water",
        "error of the force of the water; waters that do not meet, control: one water",
        two.force,
        sheet(2, 2e7, false, 0.1).force,
    )
    .at_most(0.05);
    row(
        "sheet of 3 particles in water",
        "the same; hourglass control, control without",
        three.force,
        sheet(3, 6e6, true, 0.0).force,
    )
    .at_most(0.02);
}
