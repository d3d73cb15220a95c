//! Smoothed particle hydrodynamics in one, two and three dimensions, in `f32` and `f64`.
//!
//! A body is a set of particles that carry mass and move with the material. What a field is between
//! them, and how it changes in space, follows from sums over neighbours weighted with a kernel. There
//! is no mesh, so bodies may collide, part and deform without limit. This crate computes impact of
//! solids, shocks in gases and violent liquids that way, gives exact and reference solutions to hold
//! the result against, and counts what it had to limit.
//!
//! # A first program
//!
//! A copper rod strikes another at 20 m/s; after 2 µs a wave runs through each.
//!
//! ```
//! use meshfree::prelude::*;
//!
//! fn main() -> Result<(), Error> {
//! #   std::env::set_current_dir(std::env::temp_dir()).map_err(|cause| Error::File {
//! #       action: "enter", path: std::env::temp_dir(), cause })?;
//!     let copper = catalogue::copper;
//!     let striker = Body::block("striker", copper(), [0.000], [0.010], 1e-4);
//!     let target = Body::block("target", copper(), [0.010], [0.050], 1e-4);
//!
//!     let mut simulation = Scene::<f64, 1>::new(schemes::impact())
//!         .body(striker.velocity([20.0]))
//!         .body(target)
//!         .build()?;
//!     println!("{}", simulation.scheme());
//!     simulation.run_until(2e-6)?;
//!
//!     let columns = ["x_m", "stress_pa", "velocity_m_s"];
//!     let mut profile = CsvWriter::create("profile.csv", &columns)?;
//!     for particle in simulation.all() {
//!         let ([x], [v]) = (particle.position(), particle.velocity());
//!         profile.row(&[x, -particle.pressure(), v])?;
//!     }
//!     let whole = simulation.ledger().whole;
//!     println!("{} steps, {} J/m²", simulation.steps(), whole.total_energy());
//! #   let middle = simulation.body("striker")?.nth(50).map_or(0.0, |particle| particle.pressure());
//! #   assert!((middle / 353.17e6 - 1.0).abs() < 0.01, "{middle}");
//! #   assert!((whole.total_energy() / 17_860.0 - 1.0).abs() < 1e-12);
//!     Ok(())
//! }
//! ```
//!
//! Between the waves the stress is −353.17 MPa by the exact solution, which
//! [`study::hugoniot::impact`] gives in one line. The same program in another dimension changes the
//! type parameter and the corners of the boxes, nothing else.
//!
//! # A second program
//!
//! A column of water is let go in a tank; a sensor on the far wall is read after every step, and a picture is drawn.
//!
//! ```
//! use meshfree::prelude::*;
//!
//! fn main() -> Result<(), Error> {
//! #   std::env::set_current_dir(std::env::temp_dir()).map_err(|cause| Error::File {
//! #       action: "enter", path: std::env::temp_dir(), cause })?;
//!     // Water at rest, 0.6 m long and 0.3 m high; its sound speed is ten times the speed that is expected.
//!     let (spacing, gravity) = (0.03, [0.0, -9.81]);
//!     let water = catalogue::weakly_compressible_water(3.5);
//!     let column = Body::block("water", water, [0.0; 2], [0.6, 0.3], spacing);
//!     // Walls at both ends of x and at the lower end of y, three layers of particles thick.
//!     let sides = [[true, true], [true, false]];
//!     let tank = Wall::around("tank", [0.0; 2], [1.2, 0.6], spacing, 3, sides);
//!     let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
//!         .body(column.hydrostatic(gravity, [0.0, 0.3]))
//!         .wall(tank)
//!         .acceleration(move |_| gravity)
//!         .build()?;
//!
//!     let probe = PressureProbe::disc(&simulation, "P", [1.2, 0.03], [-1.0, 0.0], 0.03)?;
//!     let mut history = Vec::new();
//!     simulation.run_with(0.4, |now| history.push([now.time(), probe.pressure(now)]))?;
//!     CsvWriter::create("pressure.csv", &["time_s", "pressure_pa"])?.rows(&history)?;
//! #   let most = history.iter().fold(0.0_f64, |most, row| most.max(row[1]));
//! #   assert!(history[0][1] == 0.0 && most > 500.0, "{most} Pa");
//!
//!     let pressure = Axis::linear("pressure", "kPa").range(0.0, 3.0);
//!     let points = simulation.all().map(|particle| {
//!         let [x, y] = particle.position();
//!         (x, y, 1e-3 * particle.pressure())
//!     });
//!     let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
//!         .cloud(Cloud::new(pressure, points).diameter(spacing))
//!         .equal_aspect();
//!     Figure::new().panel(panel).save("water.svg")
//! }
//! ```
//!
//! A spacing of 5 mm looks like water. The [tutorials](crate#pages) go on from here to solids with strength and to a liquid
//! that bends a plate.
//!
//! # Map
//!
//! In the order in which a user meets them:
//!
//! | module | what it holds |
//! |---|---|
//! | [`prelude`] | the names that most programs use |
//! | [`scene`] | bodies, boundaries and loads, checked as a whole and built into a simulation |
//! | [`geometry`] | shapes by signed distance, and the lattices that fill and surround them |
//! | [`material`] | equations of state, viscosity laws and named materials with their sources |
//! | [`schemes`] | ready schemes |
//! | [`coupling`] | how bodies of different schemes act on each other: liquid and structure, contact, ties |
//! | [`simulation`] | steps, criteria of the time step, ledgers, questions about particles |
//! | [`observe`] | pressure probes, wave gauges, flow through planes, fields at points and on grids |
//! | [`run`](mod@run) | runs with observers by schedule and criteria that end them |
//! | [`output`] | tables, plots, pictures, particle files, progress |
//! | [`study`] | exact and reference solutions, norms, orders of convergence |
//! | [`error`] | what went wrong, where, and what to try |
//! | [`boundary`] | mirror planes, periodic directions, sheared or not, a trait for others; walls, inlets and outlets of liquids, and what flows through them |
//! | [`integrator`] | leapfrogs, Runge–Kutta methods, the printed method of Lam, Shen & Gong |
//! | [`scheme`] | how a scheme is composed: density form, energy form, smoothing, effects |
//! | [`effect`] | effects: diffusion, shifting, damping, viscosities, walls, each in one file, and your own |
//! | [`kernel`] | seven smoothing kernels |
//! | [`term`] | pair terms, one effect each, and artificial [viscosities](term::viscosity) |
//! | [`sweep`] | the loop over pairs |
//! | [`neighbors`] | neighbour search, useful on its own |
//! | [`particles`], [`tensor`], [`scalar`] | columns of fields, small matrices, numbers and lanes |
//!
//! No module depends on itself through others; the page on [architecture](crate#pages) draws the
//! layers, follows the data of a step, and gives the reasons of what was decided.
//!
//! # Choosing a scheme
//!
//! | you have | take |
//! |---|---|
//! | solids that meet at weak to moderate shocks and keep their shape | [`schemes::impact`] |
//! | the same with large motion | [`schemes::impact_by_continuity`] |
//! | the same with shear and strength | [`schemes::impact_by_continuity`] with [`Hypoelastic`](effect::Hypoelastic) and [`Plasticity`](effect::Plasticity) |
//! | solids that bend, flow or turn, and meet others by a coupling | [`schemes::updated_lagrangian`] with [`Plasticity`](effect::Plasticity) and [`HourglassFree`](effect::HourglassFree) |
//! | a result of Lam, Shen & Gong (2002) to repeat | [`schemes::lam2002`] with [`LamLeapfrog`](integrator::LamLeapfrog), bodies bonded |
//! | a liquid with a free surface, still or violent | [`schemes::weakly_compressible`] |
//! | the same, violent and for long enough that particles leave their lattice unevenly | [`schemes::weakly_compressible`] with [`ExpansionMemory`](effect::ExpansionMemory) and [`Shifting::STANDARD`](effect::Shifting), in a plane [`ConsistentShifting`](effect::ConsistentShifting) |
//! | the same, with what shifting carries exchanged between particles, so that no volume is lost | [`schemes::weakly_compressible`] with [`ExpansionMemory`](effect::ExpansionMemory) and [`ArbitraryLagrangian`](effect::ArbitraryLagrangian) |
//! | the same, without a coefficient to choose | [`schemes::riemann_liquid`] |
//! | two liquids, or a liquid and a gas | [`schemes::weakly_compressible`] with [`TwoPhase`](effect::TwoPhase), bodies bonded |
//! | water and air that fill a tank, with air that is compressed; shocks from one fluid into the other | [`SchemeBuilder::five_equations`](scheme::SchemeBuilder::five_equations) |
//! | two liquids with surface tension between them | [`SchemeBuilder::liquid`](scheme::SchemeBuilder::liquid) with [`SurfaceTension`](effect::SurfaceTension) and a weak [transport velocity](scheme::Shifting::TransportVelocity), bodies bonded |
//! | a liquid that fills what encloses it | [`schemes::weakly_compressible`] with [`Shifting::CLOSED`](scheme::Shifting::CLOSED) and [walls](effect::ExtrapolatedPressure) with a floor of −∞ |
//! | the same on a lattice that stays where it is | [`schemes::weakly_compressible`] with [`Eulerian`](effect::Eulerian) |
//! | a liquid in tension, as one that spins or is drawn out | [`schemes::weakly_compressible`] with [`Shifting::STANDARD`](scheme::Shifting::STANDARD), [`ArtificialPressure`](effect::ArtificialPressure) and [`PairingControl`](effect::PairingControl) |
//! | a result of LS-DYNA to repeat | [`schemes::ls_dyna_default`], [`schemes::ls_dyna_fluid`] and their renormalised forms |
//! | a gas | [`schemes::gas`]; where unlike gases touch or shear, with [`ArtificialConduction`](effect::ArtificialConduction) |
//!
//! A scheme prints itself, with its equations, their sources and the fields that a particle carries.
//! [`KickDriftKick`](integrator::KickDriftKick) is the integrator unless another is named. It takes one
//! evaluation a step and, with [`EnergyForm::Compatible`](scheme::EnergyForm), conserves total energy
//! to rounding.
//!
//! # Units and signs
//!
//! - **Units are SI** everywhere: metres, kilograms, seconds, pascals, joules per kilogram. A mass is
//!   in kg in 3D, per metre of depth (kg/m) in 2D, and per area of the cross-section (kg/m²) in 1D;
//!   force and energy likewise.
//! - **Pressure is positive in compression.** Stress is positive in tension, so in a fluid σ = −p.
//! - **i is the particle that receives, j its neighbour.** rᵢⱼ = xᵢ − xⱼ, vᵢⱼ = vᵢ − vⱼ, and a pair
//!   that approaches has vᵢⱼ·rᵢⱼ < 0. Sums over j include i unless the summand vanishes there.
//! - **W is the kernel, F its gradient factor:** ∇ᵢWᵢⱼ = F rᵢⱼ with F ≤ 0.
#![doc = include_str!("../docs/equations/kernel.html")]
//!
//! - **D, T, h, dx:** dimension, scalar, smoothing length, spacing. V = m/ρ is a volume. B and X are
//!   the weight and the pressure coefficient of a [density form](scheme::DensityForm).
//! - **Numbers come out as `f64`** whatever the scalar of the simulation.
//!
//! # Accuracy and cost
//!
//! What an error costs is measured on seventeen problems with known answers on the page [accuracy and cost](crate#pages), for each scheme that
//! suits them, and on a problem of your own by [`study::work_precision`]. In short:
//!
//! - Errors fall with the power 0.8 to 1 of the spacing where fronts, contacts or free surfaces are, at first order in smooth flow
//!   with an artificial viscosity, and at second in total-Lagrangian bending.
//! - A step costs about 0.5 µs a particle and core in one dimension, 1 µs for a liquid and 2 to 3 µs for a solid with shocks
//!   in three (x86-64 with AVX-512; the page on [speed](crate#pages) has the machine and the command); `f32` takes about three fifths of
//!   that, in time and in memory.
//! - Halving the spacing costs 2ᴰ⁺¹ times as much.
//! - Momentum is kept to rounding by every scheme, and with
//!   [`EnergyForm::Compatible`](scheme::EnergyForm) total energy too. Results have the same bits on any number of threads.
//!
//! Neither is a promise for another problem: repeat a run at half the spacing, and take
//! [`study::norms`] to see at what order it converges. A run that is in doubt says why by
//! [`Simulation::stability`](simulation::Simulation::stability).
//!
//! # Extending
//!
//! Eight traits are meant to be implemented in a crate of your own. Each has an example that compiles; the page on [extending](crate#pages) has a
//! whole effect and a force on single particles:
//!
//! | trait | example | what it asks for |
//! |---|---|---|
//! | [`Kernel`](kernel::Kernel) | [in `kernel`](kernel#a-kernel-of-your-own) | shape, slope, normalisation |
//! | [`EquationOfState`](material::eos::EquationOfState) | [in `eos`](material::eos#a-law-of-your-own) | pressure and sound speed |
//! | [`ViscosityLaw`](material::rheology::ViscosityLaw) | [in `rheology`](material::rheology#a-law-of-your-own) | viscosity for a shear rate |
//! | [`ArtificialViscosity`](term::viscosity::ArtificialViscosity) | [in `term`](term#a-viscosity-of-your-own) | Π and the signal of a pair |
//! | [`Boundary`](boundary::Boundary) | [at the trait](boundary::Boundary) | images and their transforms |
//! | [`Shape`](geometry::Shape) | [at the trait](geometry::Shape) | signed distance and a box around it |
//! | [`Integrator`](integrator::Integrator) | [at the trait](integrator::Integrator) | one step, from a handful of operations |
//! | [`Effect`](effect::Effect) | on the page [extending](crate#pages) | pair terms by stage, fields of its own, laws, limits, ledger |
//!
//! The first four run inside the loop over pairs or over particles. Their methods are generic over a
//! [`Lane`](scalar::Lane), so one text serves a single number and a row of them, and what you write is
//! compiled into the same loop as what the crate brings. A [`Term`](term::Term) is the more general
//! form of an effect between pairs.
//!
//! Mark the methods of kernels, artificial viscosities and terms `#[inline(always)]`, as the examples do: the
//! loop over pairs is compiled for wider instructions than the rest of a program, and what is not inlined into
//! it runs without them. That loop is compiled in your crate, with your profile, and without optimisation it is
//! a hundred times slower. For a debug build that is 8 to 20 times slower than a release put this into your
//! `Cargo.toml`:
//!
//! ```toml
//! [profile.dev]
//! opt-level = 2
//! ```
//!
//! In a release build leave `lto` at its default or above: with `lto = "off"` what the loop calls is not inlined across
//! units of code, and steps take two to six times as long.
//!
//! # Pages
//!
//! Pages of the repository, with figures and tables:
//!
//! | page | what it holds |
//! |---|---|
//! | [tutorials](https://github.com/meshfree/meshfree/blob/main/docs/tutorials.md) | programs, from a channel with open ends to a mechanism |
//! | [output in time](https://github.com/meshfree/meshfree/blob/main/docs/how_to_output.md) | observers by schedule, criteria that end a run, receipts |
//! | [ParaView and films](https://github.com/meshfree/meshfree/blob/main/docs/how_to_paraview.md) | particle files and films, and how to look at them |
//! | [restart](https://github.com/meshfree/meshfree/blob/main/docs/how_to_restart.md) | checkpoints and restarts |
//! | [paddles, gauges and sponges](https://github.com/meshfree/meshfree/blob/main/docs/how_to_waves.md) | wave makers from rows of time, gauges, absorbing layers |
//! | [scenes from files](https://github.com/meshfree/meshfree/blob/main/docs/how_to_scene_files.md) | scenes in TOML, run by the program `meshfree` without Rust |
//! | [shapes from STL files](https://github.com/meshfree/meshfree/blob/main/docs/how_to_stl.md) | bodies and tanks from triangle meshes |
//! | [loads and coupling](https://github.com/meshfree/meshfree/blob/main/docs/how_to_coupling.md) | loads, columns without copies, neighbours, forces for another code |
//! | [troubleshooting](https://github.com/meshfree/meshfree/blob/main/docs/how_to_troubleshoot.md) | error messages and symptoms, with cause and remedy |
//! | [units and other codes](https://github.com/meshfree/meshfree/blob/main/docs/how_to_units_and_other_codes.md) | SI, and the terms of LS-DYNA, DualSPHysics and PySPH |
//! | [heat](https://github.com/meshfree/meshfree/blob/main/docs/how_to_heat.md) | conduction, convection and radiation |
//! | [what enters and leaves](https://github.com/meshfree/meshfree/blob/main/docs/how_to_openings.md) | inlets, outlets, sources and drains |
//! | [gallery](https://github.com/meshfree/meshfree/blob/main/docs/gallery.md) | a picture of each example |
//! | [theory](https://github.com/meshfree/meshfree/blob/main/docs/theory.md) | what is solved |
//! | [extending](https://github.com/meshfree/meshfree/blob/main/docs/extending.md) | a kernel, law, boundary, integrator or effect of your own |
//! | [validation](https://github.com/meshfree/meshfree/blob/main/docs/validation.md) | every case with its reference and its error |
//! | [rods, artificial viscosities](https://github.com/meshfree/meshfree/blob/main/docs/rods.md) | rods: convergence, strength, rise and overshoot of a front by each artificial viscosity |
//! | [gentle and closed flows](https://github.com/meshfree/meshfree/blob/main/docs/liquids.md) | waves, channels, cavities and vortices |
//! | [dam breaks and sloshing](https://github.com/meshfree/meshfree/blob/main/docs/dam_breaks.md) | dam breaks and a rolling tank, with experiments |
//! | [sloshing, crushed cells](https://github.com/meshfree/meshfree/blob/main/docs/sloshing.md) | a tank at 30 g, and water in cells that are crushed |
//! | [solids](https://github.com/meshfree/meshfree/blob/main/docs/solids.md) | plates, rings and bars |
//! | [contact](https://github.com/meshfree/meshfree/blob/main/docs/contact.md) | contact of solids |
//! | [liquid and structure](https://github.com/meshfree/meshfree/blob/main/docs/liquid_structure.md) | plates, gates and beams in a flow |
//! | [hard cases](https://github.com/meshfree/meshfree/blob/main/docs/hard-cases.md) | cases that break methods, each with a control |
//! | [accuracy and cost](https://github.com/meshfree/meshfree/blob/main/docs/accuracy_and_cost.md) | error and cost on seventeen problems |
//! | [error indicators](https://github.com/meshfree/meshfree/blob/main/docs/error_indicators.md) | what limits the accuracy of a run |
//! | [what effects cost](https://github.com/meshfree/meshfree/blob/main/docs/effects.md) | what each effect costs |
//! | [defaults](https://github.com/meshfree/meshfree/blob/main/docs/defaults.md) | reasons for the defaults |
//! | [speed](https://github.com/meshfree/meshfree/blob/main/docs/speed.md) | speed, memory and time to compile |
//! | [on a GPU](https://github.com/meshfree/meshfree/blob/main/docs/gpu.md) | what runs on a device, how, and what does not |
//! | [on many processes](https://github.com/meshfree/meshfree/blob/main/docs/ranks.md) | ranks: what runs on many processes, how, and what it costs |
//! | [compared with other codes](https://github.com/meshfree/meshfree/blob/main/docs/comparison.md) | what other codes have, and how fast they are |
//! | [architecture](https://github.com/meshfree/meshfree/blob/main/docs/architecture.md) | layers, the data of a step, decisions |
//! | [licences](https://github.com/meshfree/meshfree/blob/main/docs/licences.md) | licences, versions, sources of data |
//!
//! # Features
//!
//! | feature | default | what it adds | by |
//! |---|---|---|---|
//! | `parallel` | yes | threads; without it a run takes one, to the same bits | `rayon` |
//! | `pictures` | no | [`output::picture`] as PNG and SVG files, films | `png` |
//! | `progress` | no | the drawing of [`output::progress`] | `indicatif` |
//! | `checkpoint` | no | `Simulation::save` and `Scene::resume` | `safetensors` |
//! | `meshes` | no | shapes from STL files | `stl_io` |
//! | `serde` | no | reports written, laws of materials and settings written and read ([below](#reports-and-settings-in-files)) | `serde` |
//! | `devices` | no | records of sweeps, laws, rates and limits, from which a device runs them | |
//! | `precompiled` | no | nothing but time: what runs a scene is compiled with the crate, in all dimensions and scalars, and not with each program | |
//!
//! On two cores the first program above takes 40 s to compile for release from nothing, and 10 s when a line of it changes.
//! With `precompiled` it takes 76 s from nothing and 4 s for a line; bits are the same ([speed](crate#pages)).
//!
//! # Reports and settings in files
//!
//! With the feature `serde` reports (ledgers, energy, stability, indicators, cost, contacts, rigid bodies, advice, summaries of runs,
//! results of studies) are `Serialize`; equations of state, strengths, failures, viscosities, kernels, integrators, settings of effects
//! and contacts, [`StepControl`](simulation::StepControl), [`Thresholds`](simulation::Thresholds) and
//! [`Known`](scene::advice::Known) are `Serialize` and `Deserialize`. What holds functions or erased laws, as
//! [`Material`](material::Material), [`Scene`](scene::Scene), schemes, motions and loads, is left out, as are shapes, boundaries and
//! effects with places.
//!
#![cfg_attr(feature = "serde", doc = "```")]
#![cfg_attr(not(feature = "serde"), doc = "```ignore")]
//! use meshfree::material::eos::Tait;
//! use meshfree::prelude::*;
//! let law: Tait = serde_json::from_str(r#"{"reference_density": 1000.0, "sound_speed": 20.0, "gamma": -7.0}"#).unwrap();
//! let water = Body::block("water", Material::new("water", law), [0.0], [0.1], 0.01);
//! let refused = Scene::<f64, 1>::new(schemes::weakly_compressible()).body(water).build().unwrap_err();
//! assert!(refused.to_string().contains("gamma of material `water` of body `water` is -7"), "{refused}");
//! ```
//!
//! - A number is written so that it is read back to the same bits; `serde_json` reads so with its feature `float_roundtrip`.
//! - JSON has no infinity and no NaN. In a setting that may be infinite, infinity is the text `"inf"` or `"-inf"`; in a report either
//!   is `null`.
//! - Reading does not check ranges. A scene checks what was read as it checks what a program writes, with the same
//!   [`Error`](error::Error).
//! - An unknown name is an error. `StepControl`, `Thresholds`, `Known` and contacts have their defaults for what is not named; other
//!   types need every number.
//! - A time of the clock is `{"secs", "nanos"}`, and a choice without numbers its name: `"WendlandC2"` of
//!   [`KernelKind`](kernel::KernelKind). A type without fields, as [`WendlandC2`](kernel::WendlandC2), is `null`.
//! - Names of fields are those of the Rust types, and change with them.
//!
//! # Without default features
//!
//! Without default features the crate builds for `wasm32-unknown-unknown`, where the clock stands still.
#![warn(missing_docs)]
// Items name the feature that they need; docs.rs sets this and builds with a nightly compiler.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod boundary;
mod clock;
mod collective;
pub mod coupling;
pub mod effect;
pub mod error;
pub mod geometry;
pub mod integrator;
pub mod kernel;
pub mod material;
#[doc(hidden)]
pub mod neighbors;
pub mod observe;
mod once;
mod origin;
pub mod output;
mod parallel;
pub mod particles;
pub mod prelude;
pub mod ranks;
pub mod run;
pub mod scalar;
pub mod scene;
pub mod scheme;
pub mod schemes;
#[cfg(feature = "serde")]
mod serial;
pub mod simulation;
pub mod study;
pub mod sweep;
pub mod tensor;
pub mod term;

/// The programs of README and docs, kept compiling.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    pub struct Readme;
    #[doc = include_str!("../docs/tutorials.md")]
    pub struct Tutorials;
    #[doc = include_str!("../docs/how_to_output.md")]
    pub struct Output;
    #[doc = include_str!("../docs/how_to_paraview.md")]
    pub struct ParaView;
    #[doc = include_str!("../docs/ranks.md")]
    pub struct OnRanks;
    #[doc = include_str!("../docs/how_to_restart.md")]
    pub struct Restart;
    #[doc = include_str!("../docs/how_to_waves.md")]
    pub struct Waves;
    #[doc = include_str!("../docs/how_to_stl.md")]
    pub struct Stl;
    #[doc = include_str!("../docs/how_to_coupling.md")]
    pub struct CouplingToOthers;
    #[doc = include_str!("../docs/how_to_heat.md")]
    pub struct Heat;
    #[doc = include_str!("../docs/how_to_openings.md")]
    pub struct Openings;
    #[doc = include_str!("../docs/extending.md")]
    pub struct Extending;
}
