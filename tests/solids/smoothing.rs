//! Smoothing lengths that follow the flow: by the divergence of velocity, within limits.
//! h^D ρ stays what it was, and a length that is held at a limit is counted.

use approx::assert_relative_eq;
use meshfree::effect::DivergenceSmoothing;
use meshfree::kernel::CubicSpline;
use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{DensityForm, SchemeBuilder};
use meshfree::simulation::Simulation;
use meshfree::term::viscosity::MonaghanGingold;

/// A copper rod that strikes another at 400 m/s, with dh/dt = h ∇·v within limits.
fn strike(smallest: f64, largest: f64) -> Simulation<f64, 1> {
    let scheme = SchemeBuilder::new(CubicSpline, MonaghanGingold::STANDARD)
        .density(DensityForm::Continuity)
        .with(DivergenceSmoothing { smallest, largest });
    let copper = catalogue::copper::<f64>;
    let mut simulation = Scene::<f64, 1>::new(scheme)
        .body(Body::block("striker", copper(), [0.0], [0.01], 1e-4).velocity([400.0]))
        .body(Body::block("target", copper(), [0.01], [0.03], 1e-4))
        .build()
        .unwrap();
    simulation.run_until(1.5e-6).unwrap();
    simulation
}

#[test]
fn smoothing_length_times_density_is_constant_where_density_is_integrated() {
    let simulation = strike(0.2, 2.0);
    let first = 1.2 * 1e-4 * 8930.0;
    let mut compressed = 0;
    for particle in simulation.all() {
        let product = particle.smoothing_length() * particle.density();
        assert_relative_eq!(product, first, epsilon = 0.0, max_relative = 1e-9);
        compressed += usize::from(particle.density() > 1.03 * 8930.0);
    }
    assert!(compressed > 20, "{compressed}");
    assert_eq!(simulation.limited_smoothing_lengths(), 0);
}

#[test]
fn a_length_held_at_a_limit_is_counted() {
    let simulation = strike(0.99, 2.0);
    assert!(simulation.limited_smoothing_lengths() > 0);
    let least = simulation
        .all()
        .map(|p| p.smoothing_length())
        .fold(f64::INFINITY, f64::min);
    assert_relative_eq!(least, 0.99 * 1.2e-4, epsilon = 0.0, max_relative = 1e-12);
}
