//! Rods that are unlike: a stiff one on one of a hundred-thousandth of its stiffness, and spacings of 2:1 and 4:1.
//! Others ring or stick at such contacts, and reflect waves where the spacing changes.

use super::harness::{Row, Varied, seed};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scheme::DensityForm;

const RHO: f64 = 1000.0;
const C: f64 = 1000.0;

/// A stiff striker of 10 mm on a soft rod of 40 mm is slowed as a mass on a dashpot of impedance ρ c, to v₀ e^(−c t/L), until
/// waves return: the largest error of its mean velocity over v₀ meanwhile, and the changes of momentum and energy.
fn slowed(form: DensityForm) -> [f64; 3] {
    const SPEED: f64 = 0.01;
    let soft = C / 1e5_f64.sqrt();
    let rod = |name, sound, [low, high]: [f64; 2]| {
        let law = Linear::new(RHO, sound);
        Body::block(name, Material::new(name, law), [low], [high], 2e-4).jitter(0.01, seed(2))
    };
    let mut rods = Scene::<f64, 1>::new(schemes::impact().density(form))
        .body(rod("stiff", C, [0.0, 0.01]).velocity([SPEED]))
        .body(rod("soft", soft, [0.01, 0.05]))
        .varied()
        .build()
        .expect("rods");
    let before = rods.ledger().whole;
    let mut worst = 0.0_f64;
    let ended = rods.run_with(5e-3, |now| {
        let striker = &now.ledger().bodies[0].1;
        let found = striker.momentum[0] / (striker.mass * SPEED);
        worst = worst.max((found - (-soft * now.time() / 0.01).exp()).abs());
    });
    if let Err(error) = ended {
        println!("{form:?}: {error}");
        return [f64::INFINITY; 3];
    }
    let after = rods.ledger().whole;
    println!("{form:?}: {worst}, {} steps", rods.steps());
    [
        worst,
        (after.momentum[0] / before.momentum[0] - 1.0).abs(),
        (after.total_energy() / before.total_energy() - 1.0).abs(),
    ]
}

/// The error is of first order: 0.059 at twice this spacing. The control sums masses, and so sees half a neighbourhood at every end
/// and at the joint, of which the stiff side makes stress.
#[test]
fn a_stiff_rod_is_slowed_by_a_soft_one() {
    let [value, momentum, energy] = slowed(DensityForm::NumberDensity);
    println!("momentum {momentum}, energy {energy}");
    assert!(momentum < 1e-12 && energy < 1e-10);
    Row {
        case: "stiff on soft, 10⁵:1, rods, 0.2 mm",
        criterion: "largest error of the striker's velocity; number density, control: summation",
        value,
        control: slowed(DensityForm::Summation)[0],
    }
    .at_most(0.03);
}

/// A bell of pressure that runs from a rod of one spacing into one of so many times that: what comes back, over what went in.
fn reflected(ratio: f64, form: DensityForm) -> f64 {
    const SPEED: f64 = 1.0;
    const DX: f64 = 1e-3;
    let rod = |name, [low, high]: [f64; 2], spacing| {
        let law = Linear::new(RHO, C);
        Body::block(name, Material::new(name, law), [low], [high], spacing)
    };
    let bell = |x: f64| SPEED * (-((x - 0.25) / 0.03).powi(2)).exp();
    let fine = rod("fine", [0.0, 0.5], DX).start(|[x]: [f64; 1], own| meshfree::scene::Start {
        velocity: [bell(x)],
        density: RHO * (1.0 + bell(x) / C),
        ..own
    });
    let scheme = schemes::impact()
        .density(form)
        .with(MixedSpacing)
        .between_bodies(Interaction::Bonded);
    let mut rods = Scene::<f64, 1>::new(scheme)
        .body(fine)
        .body(rod("coarse", [0.5, 1.0], ratio * DX))
        .varied()
        .build()
        .expect("rods");
    let before = rods.ledger().whole.momentum[0];
    rods.run_until(4.5e-4).expect("a run");
    let change = rods.ledger().whole.momentum[0] / before - 1.0;
    assert!(change.abs() < 1e-12, "{change}");
    let back = rods.body("fine").expect("a rod");
    let back = back
        .filter(|p| p.position()[0] < 0.45)
        .map(|p| p.velocity()[0].abs());
    let most = rods
        .body("coarse")
        .expect("a rod")
        .map(|p| p.velocity()[0])
        .fold(0.0, f64::max);
    let back = back.fold(0.0, f64::max) / SPEED;
    println!("{ratio}: back {back}, beyond {most}");
    back
}

#[test]
fn waves_pass_where_the_spacing_changes() {
    for (case, ratio) in [
        ("spacing 2:1, wave of 60 fine spacings", 2.0),
        ("spacing 4:1", 4.0),
    ] {
        Row {
            case,
            criterion: "reflected over sent; number density, control: summation",
            value: reflected(ratio, DensityForm::NumberDensity),
            control: reflected(ratio, DensityForm::Summation),
        }
        .at_most(0.05);
    }
}
