//! Liquids and total-Lagrangian solids on the device against the host.
//! The scenes are those of the head of this program.

use super::{Fill, plate, stirred, vortices, water};
use crate::common::device;
use crate::compare::{in_both, in_double, on_device, on_host};
use approx::assert_relative_eq;
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree_gpu::Device;

fn tank_in_both<const D: usize>(device: &Device, fill: Fill, steps: usize)
where
    WendlandC2: Kernel<D>,
{
    let double = |fused| water::<f64, D>(fill, fused);
    let single = || water::<f32, D>(fill, false);
    in_both(device, &format!("{fill:?}"), double, single, steps);
}

#[test]
fn water_in_the_plane_is_that_of_the_host() {
    let Some(device) = device("water in the plane") else {
        return;
    };
    for fill in [Fill::Still, Fill::Dam] {
        tank_in_both::<2>(&device, fill, 200);
    }
}

/// Particles leave on one side and enter on the other, where their images are.
#[test]
fn a_periodic_flow_is_that_of_the_host() {
    let Some(device) = device("a periodic flow") else {
        return;
    };
    let single = || vortices::<f32>(false);
    in_both(&device, "Vortices", vortices::<f64>, single, 200);
}

/// Deformation gradients, stresses, hourglass control, and energy by the work of kicks.
#[test]
fn a_plate_that_bends_is_that_of_the_host() {
    let Some(device) = device("a plate that bends") else {
        return;
    };
    let single = || plate::<f32>(false);
    in_both(&device, "Plate", plate::<f64>, single, 200);
    // Internal energy takes what kinetic energy loses.
    let found = on_device(&device, plate::<f64>(false), 200);
    let host = on_host(plate::<f64>(false), 200);
    let [start, a, b] =
        [&on_host(plate::<f64>(false), 0), &found, &host].map(|own| own.ledger().whole);
    assert_relative_eq!(a.internal, b.internal, max_relative = 1e-10);
    assert!(a.internal - start.internal > 1e-3 * start.kinetic);
    assert_relative_eq!(a.total_energy(), start.total_energy(), max_relative = 1e-12);
    assert!(found.stored_energy().largest().is_some());
}

/// Viscous forces, walls without slip, shifts, and walls that move and show their acceleration.
#[test]
fn a_viscous_liquid_in_a_tank_that_swings_is_that_of_the_host() {
    let Some(device) = device("a viscous liquid in a tank that swings") else {
        return;
    };
    in_double(&device, "Swinging", stirred::<f64>, 200);
}

#[test]
fn water_in_space_is_that_of_the_host() {
    let Some(device) = device("water in space") else {
        return;
    };
    for fill in [Fill::Still, Fill::Dam] {
        tank_in_both::<3>(&device, fill, 100);
    }
}
