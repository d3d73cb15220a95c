//! A hot bar that cools by convection on all sides, from *Heat* and *Output in time*.

use meshfree::effect::{HeatConduction, SurfaceHeat};
use meshfree::prelude::*;

fn main() -> Result<(), Error> {
    let (h, ambient, hot) = (5e4, 293.0, 600.0);
    let copper = HeatConduction {
        conductivity: 400.0,
        specific_heat: 385.0,
        temperature: hot,
    };
    let material = Material::new("copper", Tait::new(8960.0, 10.0));
    let scheme = schemes::weakly_compressible()
        .with(copper)
        .with(SurfaceHeat::convection(h, ambient));
    let mut bar = Scene::<f64, 2>::new(scheme)
        .body(Body::block("bar", material, [0.0; 2], [0.02, 0.02], 0.001))
        .build()?;

    let mut table = CsvWriter::create("out/cooling.csv", &["time_s", "mean_k"])?;
    let mut last = hot;
    Run::new(&mut bar, 0.1)
        .observe(Schedule::evenly(11), |now| {
            let own = now
                .all()
                .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE));
            last = own.sum::<f64>() / now.particles() as f64;
            table.row(&[now.time(), last])?;
            Ok(())
        })
        .go()?;
    // A lump would follow dT/dt = −h A (T − T∞)/(m c): the heat that left, over all that it has.
    let heat = bar
        .ledger()
        .whole
        .total("heat through surfaces")
        .unwrap_or(0.0);
    let stored = 8960.0 * 0.02 * 0.02 * 385.0 * (last - hot);
    println!("{last:.1} K on average; {heat:.0} J/m have left");
    assert!(last < hot && (heat / stored - 1.0).abs() < 0.05);
    Ok(())
}
