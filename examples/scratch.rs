use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
fn main() {
    let dx = 5e-5;
    let chi: f64 = std::env::args()
        .nth(1)
        .map_or(1.0 / 3.0, |a| a.parse().unwrap());
    let mode = std::env::args().nth(2).unwrap_or("nd".into());
    for name in ["copper", "pmma"] {
        let t0 = std::time::Instant::now();
        let target = catalogue::by_name::<f64>(name).unwrap();
        let mut sim = Scene::<f64, 1>::new(if mode == "nd" {
            schemes::impact().pressure_curvature(chi)
        } else {
            schemes::impact_by_continuity().pressure_curvature(chi)
        })
        .between(
            "striker",
            "target",
            if std::env::args().nth(3).is_some() {
                meshfree::sweep::Interaction::Bonded
            } else {
                meshfree::sweep::Interaction::Unilateral
            },
        )
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], dx).velocity([20.0]))
        .body(Body::block("target", target, [0.01], [0.05], dx))
        .build()
        .unwrap();
        let e0 = sim.ledger().whole.total_energy();
        let p0 = sim.ledger().whole.momentum[0];
        let mut peak = 0.0f64;
        let mut h = vec![];
        let mut marks = vec![0.0; 200];
        sim.run_with(3.6e-6, |s| {
            let p = s.body(0).nth(99).unwrap().pressure() / 2.
                + s.body(0).nth(100).unwrap().pressure() / 2.;
            h.push((s.time(), p));
            for (k, q) in s.body(0).enumerate() {
                if marks[k] == 0.0
                    && q.pressure() > 0.5 * if name == "copper" { 353.1e6 } else { 57.4e6 }
                {
                    marks[k] = s.time();
                }
            }
            peak = peak.max(p);
        })
        .unwrap();
        let pl: Vec<f64> = h
            .iter()
            .filter(|x| x.0 > 2e-6 && x.0 < 3.2e-6)
            .map(|x| x.1)
            .collect();
        let mean = pl.iter().sum::<f64>() / pl.len() as f64;
        let cross = |f: f64| {
            let k = h.iter().position(|x| x.1 > f * mean).unwrap();
            h[k - 1].0 + (f * mean - h[k - 1].1) / (h[k].1 - h[k - 1].1) * (h[k].0 - h[k - 1].0)
        };
        sim.run_until(5.1e-6).unwrap();
        println!(
            "{:?}",
            [199, 198, 195, 190, 180, 160, 140, 120, 100].map(|k| (((10.0
                - (k as f64 + 0.5) * 0.05)
                / 3.94
                / (1.0 + 1.49 * if name == "copper" { 10.0 } else { 1.63 } / 3940.)
                - marks[k] * 1e6)
                * 1e4)
                .round()
                / 1e4)
        );
        let l = sim.ledger();
        let v = sim.body(0).nth(99).unwrap().velocity()[0] / 2.
            + sim.body(0).nth(100).unwrap().velocity()[0] / 2.;
        println!(
            "{name}: plateau {:.3} MPa over {:.3} % rise {:.4} us arrival {:.4} us v5 {:.4} steps {} dE {:.2e} dP {:.2e} wall {:.2}s builds {}",
            mean / 1e6,
            (peak / mean - 1.) * 100.,
            (cross(0.9) - cross(0.1)) * 1e6,
            cross(0.5) * 1e6,
            v,
            sim.steps(),
            (l.whole.total_energy() - e0) / e0,
            (l.whole.momentum[0] - p0) / p0,
            t0.elapsed().as_secs_f64(),
            sim.list_builds()
        );
    }
}
