//! A rod that is saved half-way, and goes on as the run that was not stopped, from *Restart* and *Loads*.

use meshfree::prelude::*;

fn scene() -> Scene<f64, 1> {
    let rod = Body::block("rod", catalogue::aluminium(), [0.0], [0.02], 2e-4);
    Scene::<f64, 1>::new(schemes::impact())
        .body(rod.velocity([10.0]))
        .boundary(MirrorPlane::wall([0.02], [1.0]))
        .load(Load::heating(|at| if at.position[0] < 2e-3 { 1e6 } else { 0.0 }).on("rod"))
}

fn main() -> Result<(), Error> {
    let mut whole = scene().build()?;
    whole.run_until(4e-6)?;

    let file = std::env::temp_dir().join("meshfree-use-restart.safetensors");
    let mut first = scene().build()?;
    first.run_until(2e-6)?;
    // This run ends a step at 2 µs, and the other one does not.
    first.save(&file)?;
    let mut resumed = scene().resume(&file)?;
    resumed.run_until(4e-6)?;
    std::fs::remove_file(&file).ok();

    let pressure =
        |run: &Simulation<f64, 1>| run.all().map(|own| own.pressure()).fold(0.0, f64::max);
    let (once, twice) = (pressure(&whole), pressure(&resumed));
    println!(
        "{:.1} MPa at once, {:.1} MPa by way of a file",
        1e-6 * once,
        1e-6 * twice
    );
    assert!((once / twice - 1.0).abs() < 1e-3);
    assert_eq!(first.particles(), resumed.particles());
    Ok(())
}
