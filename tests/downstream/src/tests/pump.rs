//! A pipe between a pump and a vessel, against the column of liquid that both push (Newton's second law).

use crate::pump::{Pump, Vessel};
use meshfree::boundary::{Inlet, Outlet};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::simulation::Simulation;

const SPACING: f64 = 0.01;
/// Where the buffer begins \[m\].
const END: f64 = 0.5;

fn pipe(pump: Pump, vessel: Vessel) -> Scene<f64, 1> {
    let water = Material::new("water", Linear::new(1000.0, 40.0));
    let (end, depth) = (END + 6.0 * SPACING, 6.0 * SPACING);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0], [end], SPACING).velocity([pump.speed]))
        .inlet(Inlet::through(
            "water",
            vec![[0.0]],
            [1.0],
            SPACING,
            100,
            pump,
        ))
        .outlet(Outlet::plane([end], [1.0]).buffer(depth, vessel))
}

const PUMP: Pump = Pump {
    speed: 1.0,
    acceleration: 4.0,
};
const VESSEL: Vessel = Vessel {
    pressure: 5000.0,
    rate: 1000.0,
};

/// Mean pressure \[Pa\] and velocity \[m/s\] around a place \[m\] over the last half second, which many echoes of sound fit into.
fn around(pump: Pump, places: [f64; 2]) -> ([[f64; 2]; 2], Simulation<f64, 1>) {
    let mut flow = pipe(pump, VESSEL).build().unwrap();
    let (mut sums, mut count) = ([[0.0; 2]; 2], [0.0; 2]);
    for k in 0..200 {
        flow.run_until(0.5 + 0.0025 * f64::from(k)).unwrap();
        for p in flow.all() {
            for (n, place) in places.into_iter().enumerate() {
                if (p.position()[0] - place).abs() < 0.05 {
                    sums[n][0] += p.pressure();
                    sums[n][1] += p.velocity()[0];
                    count[n] += 1.0;
                }
            }
        }
    }
    ([0, 1].map(|n| sums[n].map(|sum| sum / count[n])), flow)
}

/// Between two places 0.25 m apart water is accelerated by 4 m/s²: 1000 Pa. The vessel's mean pressure of 5750 Pa is that of the
/// end to four spacings, over which it differs by 160 Pa.
#[test]
fn a_pump_and_a_vessel_push_the_column_between_them() {
    let ([first, second], flow) = around(PUMP, [0.1, 0.35]);
    println!("{first:?} and {second:?}");
    let fall = first[0] - second[0];
    assert!((fall / 1000.0 - 1.0).abs() < 0.05, "{fall} Pa");
    let at_end = second[0] - 4000.0 * (END - 0.35);
    assert!(
        (at_end - 5750.0).abs() < 4.5 * SPACING * 4000.0,
        "{at_end} Pa"
    );
    assert!((second[1] / 4.0 - 1.0).abs() < 0.01, "{} m/s", second[1]);
    // What has entered, in spacings of 0.01 m, less than a particle aside: t + 2 t².
    let entered = flow.removed().particles as f64 + flow.particles() as f64 - 56.0;
    let way = flow.time() + 2.0 * flow.time().powi(2);
    assert!((entered * SPACING - way).abs() <= SPACING, "{entered}");

    // The control: a pump that does not speed up leaves the pressure of the vessel everywhere.
    let steady = Pump {
        acceleration: 0.0,
        ..PUMP
    };
    let ([first, second], _) = around(steady, [0.1, 0.35]);
    assert!((first[0] / 5750.0 - 1.0).abs() < 0.01, "{first:?}");
    assert!((second[0] / 5750.0 - 1.0).abs() < 0.01, "{second:?}");
}

#[test]
fn its_own_problems_are_those_of_the_scene() {
    let empty = Vessel {
        pressure: -1.0,
        rate: 0.0,
    };
    let error = pipe(PUMP, empty)
        .build()
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("pressure of the vessel of an outlet is -1"),
        "{error}"
    );
}
