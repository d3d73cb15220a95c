//! Solids that cannot be: elastic constants, strength beyond the limit of tension, bodies too thin, contacts that overlap, joints.
//! Each is an error that names the field and its value and says what to do.

use super::joints::{OUT, bar, scene};
use meshfree::coupling::{ContactDensity, Joint};
use meshfree::effect::{Damage, Hypoelastic, NeoHookean, Plasticity};
use meshfree::material::eos::Linear;
use meshfree::material::failure::SpallStrength;
use meshfree::material::strength::DruckerPrager;
use meshfree::prelude::*;

/// All that is wrong with a scene, as a user reads it; nothing if it can be built.
fn wrong<const D: usize>(scene: Scene<f64, D>) -> String {
    let problems = scene.problems();
    let texts: Vec<_> = problems.iter().map(ToString::to_string).collect();
    texts.join("\n")
}

/// A material by Young's modulus \[Pa\] and Poisson's ratio.
fn elastic(young: f64, poisson: f64) -> Material<f64> {
    Material::new(
        "metal",
        Linear::from_elastic_constants(8000.0, young, poisson),
    )
    .with_shear_modulus(young / (2.0 * (1.0 + poisson)))
}

fn kept(bodies: impl IntoIterator<Item = Body<f64, 2>>) -> Scene<f64, 2> {
    let scene = Scene::new(schemes::total_lagrangian().with(NeoHookean));
    bodies.into_iter().fold(scene, Scene::body)
}

fn flowing(material: Material<f64>) -> Scene<f64, 1> {
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Plasticity)
        .with(Damage);
    Scene::new(scheme).body(Body::block("bar", material, [0.0], [1.0], 0.05))
}

fn block(material: Material<f64>) -> Body<f64, 2> {
    Body::block("block", material, [0.0; 2], [0.1; 2], 0.01)
}

#[test]
fn elastic_constants_out_of_their_range() {
    let spalls = |material: Material<f64>| {
        material
            .with_yield_stress(1e8)
            .with_failure(SpallStrength::new(1e9))
    };
    for (young, poisson, says) in [
        (1e11, 0.3, ""),
        (1e11, -0.5, ""),
        (1e11, 0.5, "Poisson ratio above -1 and below 0.5"),
        (1e11, 0.6, "Poisson ratio above -1 and below 0.5"),
        (1e11, -1.0, "Poisson ratio above -1"),
        (1e11, -1.5, "Poisson ratio above -1"),
        (-1e11, 0.3, "moduli above 0"),
        (0.0, 0.3, "moduli above 0"),
        (f64::NAN, 0.3, "moduli above 0"),
    ] {
        let found = [
            wrong(kept([block(elastic(young, poisson))])),
            wrong(flowing(spalls(elastic(young, poisson)))),
        ];
        for found in found {
            assert_eq!(
                found.is_empty(),
                says.is_empty(),
                "{young} {poisson}: {found}"
            );
            assert!(found.contains(says), "{young} {poisson}: {found}");
        }
    }
    // Both moduli by themselves.
    let stiff = Material::new("metal", Linear::from_bulk_modulus(8000.0, 1e11));
    for (modulus, says) in [
        (
            -1e9,
            "shear_modulus of material `metal` of body `block` is -1000000000: finite and not negative",
        ),
        (0.0, "needs a positive one"),
    ] {
        let found = wrong(kept([block(stiff.clone().with_shear_modulus(modulus))]));
        assert!(found.contains(says), "{modulus}: {found}");
    }
    // Close to a half volumes lock, where density follows from positions alone.
    let locked = wrong(kept([block(elastic(1e8, 0.4999))]));
    assert!(
        locked.contains("Poisson ratio of body `block`") && locked.contains("below 0.495"),
        "{locked}"
    );
}

#[test]
fn strength_beyond_the_limit_of_tension() {
    let metal = || elastic(2e11, 0.3).with_yield_stress(4e8);
    let spalling = |at: f64| metal().with_failure(SpallStrength::new(at));
    assert_eq!(wrong(flowing(spalling(1.2e9))), "");
    let weak = wrong(flowing(spalling(3e8)));
    assert!(
        weak.contains("body `bar`, of metal, yields at 400000000 Pa"),
        "{weak}"
    );
    assert!(
        weak.contains("a tension of only 300000000 Pa") && weak.contains("set the cut-off"),
        "{weak}"
    );
    // A cut-off of the pressure is such a limit too, and needs no damage.
    let scheme = || {
        schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(Plasticity)
    };
    let bar =
        |material| Scene::new(scheme()).body(Body::block("bar", material, [0.0], [1.0], 0.05));
    let cut = wrong(bar(metal().with_pressure_cut_off(-1e8)));
    assert!(cut.contains("a tension of only 100000000 Pa"), "{cut}");
    assert_eq!(wrong(bar(metal().with_pressure_cut_off(-1e9))), "");
    // Without damage in the scheme nothing spalls.
    assert_eq!(wrong(bar(spalling(3e8))), "");
    // A strength that is gone before the tension is.
    let soil = metal()
        .with_strength(DruckerPrager::new(1e6, 0.9))
        .with_pressure_cut_off(-1e6);
    assert_eq!(wrong(bar(soil)), "");
}

#[test]
fn bodies_of_one_layer() {
    let rubber = || elastic(1e6, 0.3);
    let plate = |layers: f64| Body::block("plate", rubber(), [0.0; 2], [0.4, 0.01 * layers], 0.01);
    for layers in [1.0, 2.0, 3.0] {
        let found = wrong(kept([plate(layers)]));
        assert_eq!(
            found.contains("body `plate` is thinner than two spacings"),
            layers < 2.0,
            "{found}"
        );
        assert!(
            layers > 1.0
                || found.contains("40 of its 40 particles")
                    && found.contains("half of its thickness")
        );
    }
    // However it lies.
    let turned = |layers: u32| {
        let places =
            (0..40).flat_map(move |i| (0..layers).map(move |j| [f64::from(i), f64::from(j)]));
        let turn = |[x, y]: [f64; 2]| [0.01 * (0.8 * x - 0.6 * y), 0.01 * (0.6 * x + 0.8 * y)];
        Body::points_of("plate", rubber(), places.map(turn).collect(), 0.01)
    };
    assert!(wrong(kept([turned(1)])).contains("thinner"));
    assert_eq!(wrong(kept([turned(2)])), "");
    // A plane of symmetry makes two layers of one, and what follows the present needs none.
    let half = kept([plate(1.0)]).boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]));
    assert_eq!(wrong(half), "");
}

#[test]
fn contacts_that_start_overlapped() {
    let rubber = || elastic(1e6, 0.3);
    let at = |name: &str, low: f64| Body::block(name, rubber(), [low, 0.0], [low + 0.1, 0.1], 0.01);
    let pair = |apart: f64| {
        kept([at("left", 0.0), at("right", apart)]).couple("left", "right", ContactDensity::new())
    };
    assert_eq!(wrong(pair(0.1)), "");
    for apart in [0.095, 0.09, 0.05, 0.0] {
        let found = wrong(pair(apart));
        assert!(
            found.contains("bodies `left` and `right` overlap")
                && found.contains("move one of them"),
            "{apart}: {found}"
        );
    }
}

#[test]
fn wrong_joints_are_refused_by_name() {
    let one = || scene().body(bar("one", [0.0; 2], [0.2; 2], 0.1));
    let text = |scene: Scene<f64, 2>| match scene.build() {
        Err(error @ Error::Build(_)) => error.to_string(),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("it was built"),
    };
    let says = |scene: Scene<f64, 2>, parts: &[&str]| {
        let text = text(scene);
        for part in parts {
            assert!(text.contains(part), "{text}");
        }
    };
    let hinge = || Joint::hinge([0.0; 2], OUT);
    says(
        one().joint_to_ground("one", hinge()),
        &["`one`", "not rigid", "Scene::rigid"],
    );
    let rigid = || one().rigid("one");
    says(rigid().joint_to_ground("two", hinge()), &["`two`", "one"]);
    says(rigid().joint("one", "one", hinge()), &["to itself"]);
    says(
        rigid().joint_to_ground("one", Joint::slider([0.0; 2], [0.0; 2])),
        &["length of the axis", "is 0", "direction"],
    );
    says(
        rigid().joint_to_ground("one", Joint::hinge([0.0; 2], [1.0, 0.0, 0.0])),
        &["axis in the plane"],
    );
    says(
        rigid().joint_to_ground("one", hinge().stiffness(-1.0)),
        &["stiffness of the joint (hinge)", "-1", "not negative"],
    );
    says(
        rigid().joint_to_ground("one", Joint::ball([0.0; 2]).stiffness(1.0)),
        &["no coordinate"],
    );
    says(
        rigid()
            .joint_to_ground("one", hinge())
            .joint_to_ground("one", hinge()),
        &["hinge of `one` and the ground", "twice", "leave it out"],
    );
    let clamped = rigid().fix("one", |_| true);
    says(
        clamped.joint_to_ground("one", hinge()),
        &["that no body has"],
    );
    let wild = rigid()
        .joint_to_ground("one", hinge().force(|_| f64::NAN))
        .build()
        .err();
    assert!(matches!(wild, Some(Error::Function { value, .. }) if value.is_nan()));
}
