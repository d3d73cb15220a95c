//! Slow flow through the cell that does not move, by the scheme of the filler and by finite differences.
//! The counterpart of the paper's check of the outflow against a finite-volume code.

use super::common::{Failure, Options};
use super::filler::{HOLE, water_scheme};
use super::finite_differences::Grid;
use meshfree::geometry::{OpenCell, fill};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::output::progress::Progress;
use meshfree::output::table::{Table, significant};
use meshfree::prelude::*;

/// Kinematic viscosity \[m²/s\] of the liquid; it cancels.
const VISCOSITY: f64 = 1e-4;
/// Reynolds numbers by the diameter of the holes and the mean velocity over the cell that the forces are for: where the water
/// creeps, and about that of the thickest water in the crush.
const REYNOLDS: [f64; 2] = [0.1, 10.0];
/// Voxels along the cell: steps of the round holes make the flow rate waver by some per cent.
const VOXELS: [usize; 3] = [18, 27, 36];
/// Particles along the cell.
const PARTICLES: [usize; 2] = [18, 27];
/// Time L²/ν in which the flow becomes steady.
const UNTIL: f64 = 0.3;

/// What the cell leaves to the liquid, in sides of the cell.
fn is_void(wall: f64) -> impl Fn([f64; 3]) -> bool {
    let radius = 0.5 * HOLE / (HOLE + wall);
    move |x: [f64; 3]| {
        let square = x.map(|x| (x - 0.5).powi(2));
        let within = |a: usize, b: usize| square[a] + square[b] < radius * radius;
        within(0, 1) || within(1, 2) || within(0, 2)
    }
}

/// Mean velocity over the cell in ν/L under a force in ν²/L³, by particles that stick to the structure or slide along it.
fn particles(
    wall: f64,
    count: usize,
    [force, expected]: [f64; 2],
    sticks: bool,
) -> Result<f64, Failure> {
    let cell = OpenCell::new(HOLE, wall);
    let side = cell.side();
    let dx = side / count as f64;
    let unit = VISCOSITY / side;
    // Ten times the fastest, which is about four times the mean; and no slower than viscosity spreads within a spacing.
    let sound_speed = (40.0 * expected * unit).max(VISCOSITY / dx);
    let liquid = Liquid::new(1000.0, 1480.0, 1000.0 * VISCOSITY);
    let liquid = liquid.material::<f64>("liquid", SoundSpeed::Chosen(sound_speed));
    let places = fill(&cell.void(), dx, [0.0; 3])?;
    let solid = fill(&cell.solid(), dx, [0.0; 3])?;
    let structure = Wall::of("structure", solid, dx);
    let structure = if sticks {
        structure.no_slip()
    } else {
        structure
    };
    let push = force * VISCOSITY * VISCOSITY / side.powi(3);
    let mut simulation = Scene::<f64, 3>::new(water_scheme(0.0))
        .body(Body::points_of("liquid", liquid, places, dx))
        .wall(structure)
        .boundary(Periodic::along(0, 0.0, side))
        .boundary(Periodic::along(1, 0.0, side))
        .boundary(Periodic::along(2, 0.0, side))
        .acceleration(move |_| [push, 0.0, 0.0])
        .build()?;
    let end = UNTIL * side * side / VISCOSITY;
    let mut progress = Progress::new(format!("{count} particles along the cell"));
    // The mean over the last fifth.
    let (mut sum, mut samples) = (0.0, 0);
    for k in 1..=50 {
        simulation.run_until(end * f64::from(k) / 50.0)?;
        progress.update(f64::from(k) / 50.0, format_args!(""));
        if k > 40 {
            let speed: f64 = simulation.all().map(|p| p.velocity()[0]).sum();
            sum += speed * dx.powi(3) / side.powi(3);
            samples += 1;
        }
    }
    progress.finish();
    Ok(sum / f64::from(samples) / unit)
}

/// Both for a thickness between the holes \[m\], in a table.
pub fn compare(wall: f64, options: &Options) -> Result<(), Failure> {
    let side = HOLE + wall;
    let mut table = Table::new([
        "Reynolds number",
        "voxels",
        "mean velocity over f L2/nu",
        "particles along the cell",
        "mean velocity over f L2/nu",
        "off the finest voxels",
        "off as many voxels",
    ]);
    // What creeps flows by some hundredth of the force.
    let mut conductivity = 0.0067;
    let voxels = options.pick(&VOXELS[..], &VOXELS[..1]);
    for reynolds in REYNOLDS {
        let force = reynolds * side / HOLE / conductivity;
        let mut by_voxels = Vec::new();
        for &n in voxels {
            let own = Grid::new(n, is_void(wall)).flow(force) / force;
            println!("Reynolds number {reynolds}, {n} voxels: {own:.4e}");
            conductivity = own;
            by_voxels.push(own);
        }
        for count in options.pick(&PARTICLES[..], &PARTICLES[..1]) {
            let own = particles(wall, *count, [force, conductivity * force], true)? / force;
            println!("Reynolds number {reynolds}, {count} particles: {own:.4e}");
            let same = voxels.iter().position(|n| n == count);
            let off = |other: f64| format!("{:+.1} %", 1e2 * (own / other - 1.0));
            let list = |of: Vec<String>| of.join(", ");
            table.row([
                significant(conductivity * force * HOLE / side, 2),
                list(voxels.iter().map(usize::to_string).collect()),
                list(by_voxels.iter().map(|k| significant(*k, 4)).collect()),
                count.to_string(),
                significant(own, 4),
                off(conductivity),
                same.map_or(String::new(), |k| off(by_voxels[k])),
            ]);
        }
    }
    println!("{table}");
    std::fs::create_dir_all(options.folder())?;
    std::fs::write(options.file("through.md"), table.markdown())?;
    println!("written to {}", options.folder().display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creeping flow. Particles and voxels fill the same room, so the steps of the round holes are in both; what is left is the
    /// error of particles, which falls with their spacing. Control: a structure along which the liquid slides.
    #[test]
    fn particles_let_through_what_finite_differences_do() {
        let wall = 1.5e-3;
        let conductivity = 0.0067;
        let force = REYNOLDS[0] * (HOLE + wall) / HOLE / conductivity;
        let off = |count: usize, sticks: bool| {
            let voxels = Grid::new(count, is_void(wall)).flow(force);
            let own = particles(wall, count, [force, conductivity * force], sticks);
            own.expect("a flow") / voxels - 1.0
        };
        let [coarse, fine] = [12, 18].map(|count| off(count, true));
        let slides = off(12, false);
        println!(
            "off {coarse:+.3} with 12 along the cell, {fine:+.3} with 18, {slides:+.3} where it slides"
        );
        assert!(fine.abs() < 0.12 && fine.abs() < 0.6 * coarse.abs());
        assert!(slides > 1.0);
    }
}
