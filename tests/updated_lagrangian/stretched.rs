//! A lattice with some disorder under uniform tension: it clumps without a cure, and stays with one.
//! Tension is 5 % of the bulk modulus in a periodic square, so no edge and no wave takes part.

use super::{Cure, RHO, elastic, plane};
use meshfree::prelude::*;

const COUNT: usize = 20;
const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;

/// The least distance of neighbours after 200 times that a wave crosses a spacing, in spacings.
fn least_distance(cure: Cure, tension: f64) -> f64 {
    let body = Body::block(
        "square",
        elastic(YOUNG, POISSON),
        [0.0; 2],
        [1.0; 2],
        1.0 / COUNT as f64,
    )
    .jitter(0.02, 1)
    .density(RHO * (1.0 - tension));
    let mut square = Scene::new(plane(cure))
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()
        .unwrap();
    let sound = (YOUNG / (3.0 * (1.0 - 2.0 * POISSON)) / RHO).sqrt();
    square.run_until(200.0 / COUNT as f64 / sound).unwrap();
    let places: Vec<_> = square.all().map(|p| p.position()).collect();
    let mut least = f64::INFINITY;
    for (k, a) in places.iter().enumerate() {
        for b in &places[..k] {
            let [x, y] = [0, 1].map(|d| {
                let gap = (a[d] - b[d]).abs();
                gap.min(1.0 - gap)
            });
            least = least.min(x.hypot(y));
        }
    }
    least * COUNT as f64
}

#[test]
fn a_stretched_lattice_stays_with_a_cure_alone() {
    let all = [Cure::None, Cure::ArtificialStress, Cure::HourglassFree];
    let stretched = all.map(|cure| least_distance(cure, 0.05));
    let rest = all.map(|cure| least_distance(cure, 0.0));
    println!("least distance stretched {stretched:?}, at rest {rest:?}");
    // Measured 0.564, 0.979 and 0.960; at rest, which is 0.961 at the start, 0.961 in all.
    assert!(stretched[0] < 0.7, "{stretched:?}");
    assert!(
        stretched[1..].iter().all(|least| *least > 0.94),
        "{stretched:?}"
    );
    assert!(rest.iter().all(|least| *least > 0.94), "{rest:?}");
}
