//! A water tank thrown sideways at 30 g, after Vesenjak & Ren (2007): pressures, forces, the surface.
//! `cargo validate sloshing_tank -- --help` lists the options.

mod air;
mod bars;
#[path = "../common/mod.rs"]
mod common;
mod elastic;
mod forms;
mod heights;
mod pulse;
mod report;
mod run;
mod surface;
mod tank;
#[cfg(test)]
mod tests;

use common::{Example, Failure, Options, Own};
use meshfree::material::SoundSpeed;
use meshfree::scalar::Real;
use pulse::Pulse;
use run::Record;
use std::process::ExitCode;
use tank::Case;

const EXAMPLE: Example = Example {
    name: "sloshing_tank",
    about: "A closed tank, 60 % full of water, accelerated at about 30 g for 80 ms (Vesenjak & Ren 2007).\n\
            Coordinates are the tank's: origin at the inner corner, z up, x towards the wall that the\n\
            water is thrown at.",
    schemes: &tank::SCHEMES,
    own: &[
        own("--peak-g", "G", "peak of the pulse; 30"),
        own(
            "--pulse",
            "NAME",
            "half-sine, trapezoid, constant, or a CSV file with time_s, acceleration",
        ),
        own(
            "--fill",
            "SHARE",
            "share of the tank that is full, as 0.6 or 60%; 0.6",
        ),
        own("--length", "M", "inner size along x; 0.5"),
        own("--width", "M", "inner size along y; 0.3"),
        own("--height", "M", "inner size along z; 0.3"),
        own(
            "--cut-off-pa",
            "PA",
            "lowest pressure, 0 or negative (air: 0; vacuum: -101325); 0",
        ),
        own(
            "--sound-speed",
            "NAME",
            "artificial (Mach 0.1), physical (1480 m/s), or a number in m/s; artificial, with elastic walls physical",
        ),
        own(
            "--probe",
            "X,Y,Z",
            "a sensor on a wall, may be given several times; six heights at x = L",
        ),
        own(
            "--in-frame",
            "",
            "the tank rests and its frame is accelerated",
        ),
        own("--walls", "NAME", "rigid, elastic (PMMA of 30 mm); rigid"),
        own("--youngs-modulus", "PA", "of elastic walls; 3e9"),
        own(
            "--air",
            "NAME",
            "a slice of the tank in 2D with air above the water: on, off, both",
        ),
        own(
            "--compare",
            "",
            "SPH, ALE, Eulerian and Lagrangian water side by side, on a slice",
        ),
        own("--in-space", "", "with --compare: in 3D, at 15 mm"),
        own("--compare-schemes", "", "all schemes side by side"),
        own("--bars", "", "measures what must hold"),
    ],
};

const fn own(name: &'static str, value: &'static str, help: &'static str) -> Own {
    Own { name, value, help }
}

/// Heights \[m\] of the sensors on the struck wall, Point 1 first.
const HEIGHTS: [f64; 6] = [0.05, 0.01, 0.10, 0.15, 0.20, 0.25];

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, Some(perform::<f32>))
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let case = case(options)?;
    println!("{}", case.choices());
    if let Some(youngs) = case.youngs {
        println!("{}", elastic::choices(&case, youngs));
        let of_rigid = ["--bars", "--compare", "--compare-schemes"];
        if let Some(option) = of_rigid.into_iter().find(|own| options.has(own)) {
            return Err(format!("{option} is of rigid walls; leave out --walls elastic").into());
        }
    }
    if let Some(which) = options.text("--air") {
        return air::compare::<T>(&case, which, options);
    }
    if options.has("--compare") {
        let in_space = options.has("--in-space");
        let spacing = if in_space {
            options.spacing_or(0.015, 0.03)
        } else {
            options.spacing_or(0.01, 0.015)
        };
        return forms::compare(&Case { spacing, ..case }, in_space, options);
    }
    if options.has("--bars") {
        return bars::measure::<T>(&case, options);
    }
    let mut runs: Vec<(String, Record)> = Vec::new();
    let schemes = if options.has("--compare-schemes") {
        EXAMPLE.schemes.to_vec()
    } else {
        vec![case.scheme.as_str()]
    };
    for scheme in schemes {
        let folder = if options.has("--compare-schemes") {
            options.folder().join(scheme)
        } else {
            options.folder().to_path_buf()
        };
        let case = Case {
            scheme: scheme.into(),
            ..case.clone()
        };
        // Sensors all over the ends take time, which schemes are compared by.
        let ends = !options.has("--compare-schemes") && case.peak() > 0.0;
        runs.push((scheme.into(), run::run::<T>(&case, Some(&folder), ends)?));
    }
    let runs: Vec<_> = runs
        .iter()
        .map(|(name, record)| (name.clone(), record))
        .collect();
    report::figure(&case, &runs)?.save(options.file("probes.svg"))?;
    let table = report::table(&case, &runs);
    println!("{table}");
    std::fs::write(
        options.file("report.md"),
        format!("{}\n{}", case.choices(), table.markdown()),
    )?;
    for (name, record) in &runs {
        let far = record.far_wall;
        let balance = match case.youngs {
            Some(_) => "water and walls against loads and clamps",
            None => "the water against pair reactions",
        };
        println!(
            "{name}: {} particles, leaked {}, momentum of {balance} {:.1e}, far wall at \
             38 ms: lowest pressure {:.0} Pa, cut {} times",
            record.particles, record.leaked, record.imbalance, far.lowest, far.cuts
        );
        if !record.ends.is_empty() {
            println!(
                "{name}: the impulse that sensors all over the ends read is {:+.2} % off that on the ends, \
                 {:+.2} % off that on the tank",
                1e2 * record.sensed_over(case.until, |ends| ends.felt),
                1e2 * record.sensed_over(case.until, |ends| ends.tank),
            );
        }
    }
    if let (Some(youngs), Some((_, record))) = (case.youngs, runs.first()) {
        let walls = elastic::report(&case, youngs, record, options.folder())?;
        println!("{walls}");
        let path = options.file("report.md");
        let text = std::fs::read_to_string(&path)?;
        let choices = elastic::choices(&case, youngs);
        std::fs::write(path, format!("{text}\n{choices}\n{walls}\n"))?;
    }
    println!("written to {}", options.folder().display());
    Ok(())
}

/// The case of the command line.
fn case(options: &Options) -> Result<Case, Failure> {
    let size = [
        options.number("--length", 0.5)?,
        options.number("--width", 0.3)?,
        options.number("--height", 0.3)?,
    ];
    let peak_g = options.number("--peak-g", 30.0)?;
    let probes = match options.text("--probe") {
        Some(text) => text
            .split_whitespace()
            .map(place)
            .collect::<Result<_, _>>()?,
        None => HEIGHTS
            .into_iter()
            .filter(|&z| z < size[2])
            .map(|z| [size[0], 0.5 * size[1], z])
            .collect(),
    };
    let speed = (2.0 * peak_g * pulse::STANDARD_GRAVITY * size[0])
        .sqrt()
        .max(2.0);
    let youngs = match options.text("--walls") {
        None | Some("rigid") => None,
        Some("elastic") => Some(options.number("--youngs-modulus", elastic::YOUNGS)?),
        Some(other) => {
            return Err(
                format!("--walls: `{other}` is not accepted; it takes rigid or elastic").into(),
            );
        }
    };
    let sound_speed = match options.text("--sound-speed") {
        // Walls that deform feel how stiff the water is.
        None if youngs.is_some() && !options.quick => SoundSpeed::Physical,
        None | Some("artificial") => SoundSpeed::artificial(speed),
        Some("physical") => SoundSpeed::Physical,
        Some(text) => SoundSpeed::Artificial {
            mach: speed / number("--sound-speed", text)?,
            speed,
        },
    };
    // Elastic walls want three layers in 30 mm, and are slow: within 20 ms the water has run up the struck wall.
    let (spacings, quick_end) = match youngs {
        None => ([0.01, 0.03], 0.08),
        Some(_) => ([0.01, 0.015], 0.02),
    };
    Ok(Case {
        size,
        fill: match options.text("--fill") {
            None => 0.6,
            Some(text) => match text.strip_suffix('%') {
                Some(percent) => 0.01 * number("--fill", percent)?,
                None => number("--fill", text)?,
            },
        },
        spacing: options.spacing_or(spacings[0], spacings[1]),
        pulse: Pulse::named(options.text("--pulse").unwrap_or("half-sine")),
        peak_g,
        cut_off: options
            .text("--cut-off-pa")
            .map_or(Ok(0.0), |text| number("--cut-off-pa", text))?,
        sound_speed,
        scheme: options.scheme.clone(),
        probes,
        youngs,
        in_frame: options.has("--in-frame"),
        until: options.until_or(0.08, quick_end),
        step: None,
    })
}

/// `X,Y,Z` in metres.
fn place(text: &str) -> Result<[f64; 3], Failure> {
    let coordinates: Vec<f64> = text
        .split(',')
        .map(|part| number("--probe", part))
        .collect::<Result<_, _>>()?;
    coordinates
        .try_into()
        .map_err(|_| format!("--probe: `{text}` is not accepted; it takes X,Y,Z in metres").into())
}

fn number(option: &str, text: &str) -> Result<f64, Failure> {
    text.trim()
        .parse()
        .map_err(|_| format!("{option}: `{text}` is not accepted; it takes a number").into())
}
