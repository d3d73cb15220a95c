//! Wave gauges: what a wire reads in layers whose heights are known.
//! Films of one particle too, which fill half of no kernel.

use meshfree::observe::WaveGauge;
use meshfree::prelude::*;

#[test]
fn a_wire_reads_liquid_without_the_air_between() {
    let spacing = 0.01;
    let water = catalogue::weakly_compressible_water(2.0);
    let layer = |name: &str, from: f64, to: f64| {
        Body::block(name, water.clone(), [0.0, from], [0.4, to], spacing)
    };
    let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(layer("pool", 0.0, 0.2))
        .body(layer("crest", 0.3, 0.4))
        .build()
        .unwrap();
    let gauge = WaveGauge::upwards(&simulation, "h", [0.2, 0.0], 1).unwrap();
    assert!((gauge.height(&simulation) - 0.4).abs() < 0.1 * spacing);
    assert!((gauge.wetted_length(&simulation) - 0.3).abs() < 0.2 * spacing);
    // Nothing is above the crest, and half of it above its middle.
    let gauge = WaveGauge::upwards(&simulation, "h", [0.2, 0.35], 1).unwrap();
    assert!((gauge.wetted_length(&simulation) - 0.05).abs() < 0.1 * spacing);
    assert!((gauge.height(&simulation) - 0.05).abs() < 0.1 * spacing);
}

#[test]
fn a_layer_thinner_than_the_kernel_is_as_high_as_it_is() {
    // One particle: without the mirrored floor it is too thin to fill half of any kernel.
    let (spacing, depth) = (0.01, 0.01);
    let water = catalogue::weakly_compressible_water(2.0);
    let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("film", water, [0.0; 2], [0.4, depth], spacing))
        .build()
        .unwrap();
    let gauge = WaveGauge::upwards(&simulation, "h", [0.2, 0.0], 1).unwrap();
    for read in [gauge.height(&simulation), gauge.wetted_length(&simulation)] {
        assert!((read - depth).abs() < 0.1 * spacing, "{read}");
    }
}
