//! What the feature `serde` writes and reads: numbers come back to the same bits, settings that are read pass the same checks as
//! those of a program, and reports have the numbers of the run.

use meshfree::coupling::Coulomb;
use meshfree::effect::{
    AcousticDamping, ArtificialPressure, ConsistentSmoothing, DensityDiffusion, During,
    ExtrapolatedPressure, HeatConduction, Hypoelastic, Plasticity, SurfaceTension,
};
use meshfree::error::Problem;
use meshfree::kernel::KernelKind;
use meshfree::material::eos::{
    Hugoniot, Jwl, MieGruneisen, Murnaghan, Polynomial, StiffenedGas, TensionCutOff, Tillotson,
};
use meshfree::material::failure::{
    JohnsonCookFailure, PlasticStrainLimit, PrincipalStressLimit, SpallStrength,
};
use meshfree::material::rheology::{CarreauYasuda, Cross, HerschelBulkley, Newtonian, PowerLaw};
use meshfree::material::strength::{
    CowperSymonds, DruckerPrager, JohnsonCook, LinearHardening, PerfectPlasticity, PlasticHeating,
    PowerHardening, SteinbergGuinan, TensionCompression,
};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::run::{Run, Stop};
use meshfree::scalar::InstructionSet;
use meshfree::scene::advice::Known;
use meshfree::simulation::{RigidBody, Thresholds};
use meshfree::study::norms::Norms;
use meshfree::study::with_error_bar;
use meshfree::study::work_precision::{Outcome, Quantity, WorkPrecision};
use meshfree::term::viscosity::{LimitedMonaghanGingold, ViscosityKind};
use meshfree::term::{Antuono, Fourtakas, Molteni};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

const DX: f64 = 2e-4;

/// What a user's file may have: laws, a contact, and how the scene is advanced.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Settings {
    law: TensionCutOff<MieGruneisen>,
    strength: CowperSymonds<JohnsonCook>,
    viscosity: LimitedMonaghanGingold,
    contact: ContactDensity,
    steps: StepControl,
    integrator: DriftKickDrift,
    instructions: InstructionSet,
}

/// Numbers that have no short decimal form, and one that is infinite.
fn settings() -> Settings {
    let law = MieGruneisen::new(8930.0 + 1.0 / 3.0, 3940.0 + 0.1, 1.489, 2.02);
    let law = law.with_form(Hugoniot::LsDyna {
        s2: 0.1 + 0.2,
        s3: 0.0,
        a: 0.47,
    });
    let steps = StepControl {
        courant: 0.1 + 0.2,
        growth: f64::INFINITY,
        ..StepControl::default()
    };
    Settings {
        law: TensionCutOff::new(law, -1.2e9),
        strength: CowperSymonds {
            slow: JohnsonCook::new(90e6 / 7.0, 292e6, 0.31),
            doubling_rate: 1e5 / 3.0,
            exponent: 5.0,
        },
        viscosity: LimitedMonaghanGingold {
            alpha: 2.0 / 3.0,
            beta: 1.0 / 7.0,
        },
        contact: ContactDensity::new().stiffness_factor(1.0 / 3.0),
        steps,
        integrator: DriftKickDrift,
        instructions: InstructionSet::Baseline,
    }
}

fn scheme(viscosity: LimitedMonaghanGingold) -> Scheme<f64, 1> {
    schemes::impact_by_continuity()
        .with_viscosity(viscosity)
        .with(Hypoelastic)
        .with(Plasticity)
        .compose()
}

/// A striker and a target.
fn rods(own: Settings) -> Scene<f64, 1> {
    let mut copper = Material::new("copper", own.law)
        .with_strength(own.strength)
        .with_plastic_heating(PlasticHeating::new(385.0));
    copper.shear_modulus = Some(47e9);
    let rod = |name, low: f64| Body::block(name, copper.clone(), [low], [low + 4e-3], DX);
    Scene::new(scheme(own.viscosity))
        .body(rod("striker", 0.0).velocity([120.0]))
        .body(rod("target", 4e-3))
        .couple("striker", "target", own.contact)
        .integrator(own.integrator)
        .steps(|_| own.steps)
        .instructions(own.instructions)
}

fn text(of: &impl Serialize) -> String {
    serde_json::to_string(of).expect("it can be written")
}

fn read<T: DeserializeOwned>(text: &str) -> T {
    serde_json::from_str(text).unwrap_or_else(|cause| panic!("{cause} in {text}"))
}

/// What was written and read back.
fn again<T: Serialize + DeserializeOwned>(of: &T) -> T {
    read(&text(of))
}

/// The bits of a number of a report; serde_json calls numbers of its parts by their path.
fn bits(report: &Value, path: &str) -> u64 {
    let number = report.pointer(path).and_then(Value::as_f64);
    number
        .unwrap_or_else(|| panic!("no number at {path} of {report}"))
        .to_bits()
}

#[test]
fn a_scene_of_settings_that_were_read_runs_to_the_same_bits() -> Result<(), Error> {
    let hash = |own: Settings| -> Result<u64, Error> {
        let mut rods = rods(own).build()?;
        rods.run_until(1e-6)?;
        assert!(rods.steps() > 20, "it does not run");
        Ok(rods.bits_hash())
    };
    let own = settings();
    let reference = hash(own)?;
    assert_eq!(hash(again(&own))?, reference);
    // Each part that was read does something: the last bit of a number is another run.
    let next = |value: f64| f64::from_bits(value.to_bits() + 1);
    let mut others = [own; 4];
    others[0].viscosity.alpha = next(own.viscosity.alpha);
    others[1].strength.doubling_rate *= 2.0;
    others[2].steps.courant = next(own.steps.courant);
    others[3].contact = ContactDensity::new();
    for other in others {
        assert_ne!(hash(again(&other))?, reference);
    }
    Ok(())
}

/// The text of a law holds what it was made of, and what follows from that is found again.
#[test]
fn what_follows_from_the_numbers_of_a_law_is_not_in_its_text() {
    let law = MieGruneisen::new(8930.0, 3940.0, 1.489, 2.02).with_form(Hugoniot::LamCubic);
    let written = text(&law);
    assert_eq!(
        written,
        r#"{"reference_density":8930.0,"sound_speed":3940.0,"slope":1.489,"gruneisen":2.02,"form":"LamCubic"}"#
    );
    let own: MieGruneisen = read(&written);
    assert_eq!(own, law);
    assert!(own.compression_limit() > 0.1);
    assert!(serde_json::from_str::<MieGruneisen>(&written.replace("slope", "slopes")).is_err());
}

macro_rules! survive {
    ($($own:expr),* $(,)?) => {$({
        let own = $own;
        assert_eq!(again(&own), own, "{}", text(&own));
    })*};
}

#[test]
fn every_setting_comes_back_as_it_was() {
    let third = 1.0 / 3.0;
    // Equations of state.
    survive! {
        IdealGas::new(1.4 + 1e-15, third), StiffenedGas::new(4.4, 6e8 * third, 1000.0), Linear::new(1000.0, 1480.0 * third),
        Tait::new(1000.0, 30.0 * third), Murnaghan { reference_density: 1e3, bulk_modulus: 2.2e9 * third, derivative: 7.15 },
        Polynomial { reference_density: third, coefficients: [third; 7], fit_range: (-0.1, third) },
        Jwl::tnt(), Tillotson {
            reference_density: 2700.0, a: 0.5, b: 1.63, bulk_modulus: 75.2e9 * third, second_modulus: 65e9,
            characteristic_energy: 5e6, alpha: 5.0, beta: 5.0, incipient_vaporisation: 3e6, complete_vaporisation: 15e6,
        },
    }
    // Strength and failure; a melting temperature that is not given is infinite.
    survive! {
        PerfectPlasticity::new(third), LinearHardening::new(third, 2.0), PowerHardening::new(third, 2.0, 0.1 + 0.2),
        JohnsonCook::new(90e6, 292e6, third), CowperSymonds { slow: PerfectPlasticity::new(1e6), doubling_rate: third, exponent: 5.0 },
        SteinbergGuinan {
            yield_stress: third, greatest: 1e9, hardening: 36.0, exponent: 0.45, initial_strain: 0.0, pressure: 1e-11, softening: 1.0,
        },
        DruckerPrager { cohesion: 1e6 * third, slope: 0.2 }, TensionCompression { tension: third, compression: 1.0, passage: 0.1 },
        PlasticHeating::new(385.0 * third), SpallStrength { tension: 1e9 * third }, PlasticStrainLimit { strain: third },
        PrincipalStressLimit { stress: third }, JohnsonCookFailure {
            least: 0.54, triaxial: 4.89, exponent: -3.03, rate_sensitivity: 0.014, reference_rate: 1.0, heat_sensitivity: 1.12,
            reference_temperature: 293.0, melting_temperature: f64::INFINITY,
        },
    }
    // Viscosities of liquids, and sound speeds.
    survive! {
        Newtonian { dynamic_viscosity: 1e-3 * third }, PowerLaw { consistency: third, index: 0.5, least: 0.0, greatest: 1.0 },
        Cross { at_rest: 1.0, at_high_rate: third, time: 1.0, exponent: 0.7 },
        CarreauYasuda { at_rest: 1.0, at_high_rate: third, time: 1.0, index: 0.5, transition: 2.0 },
        HerschelBulkley { yield_stress: third, consistency: 1.0, index: 0.5, time: 1e-3, greatest: 1e3 },
        Liquid::new(920.0, 1450.0, 0.05 * third).linear(), SoundSpeed::Physical, SoundSpeed::artificial(third), SoundSpeed::Chosen(third),
    }
    // Choices by name.
    for own in KernelKind::ALL {
        survive!(*own);
    }
    for own in ViscosityKind::ALL {
        survive!(own.with_alpha(third));
    }
    survive! {
        WendlandC2, DensityForm::ContinuityByMass, EnergyForm::Compatible, Interaction::Unilateral, InstructionSet::Avx2,
        Shifting::Concentration { strength: third, free_surface: true },
        Smoothing::Consistent(ConsistentSmoothing { smallest: third, largest: 2.0 }),
    }
    // Effects; an end that is infinite, and a floor that is minus infinity.
    survive! {
        During { effect: AcousticDamping { strength: third }, from: f64::NEG_INFINITY, until: f64::INFINITY },
        ExtrapolatedPressure { floor: f64::NEG_INFINITY }, ArtificialPressure { share: third, exponent: 4 },
        HeatConduction { conductivity: third, specific_heat: 1.0, temperature: 300.0 },
        Molteni { delta: third }, Fourtakas { delta: third }, Antuono { delta: third },
        Coulomb { mu: third }, Penalty::new().stiffness(third).friction(0.1), Tied::new(), ContactDensity::new().friction(third),
    }
    let diffusion = again(&DensityDiffusion(Molteni { delta: third }));
    assert_eq!(diffusion.0, Molteni { delta: third });
    let tension = again(&SurfaceTension {
        tension: third,
        between: ["water".into(), "air".into()],
    });
    assert_eq!(
        (tension.tension, tension.between[1].as_str()),
        (third, "air")
    );
    // Settings of a run.
    survive! {
        StepControl { fixed: Some(third), growth: f64::INFINITY, ..StepControl::default() },
        Thresholds::default(), Known { wall: Some([2e11, 7850.0, third]), ..Known::default() },
    }
}

/// Extremes of f64, which a decimal text has to tell apart.
#[test]
fn numbers_come_back_to_the_bit() {
    let mut bits = 0x1234_5678_9ABC_DEF0_u64;
    let mut tried = 0;
    while tried < 2000 {
        // The generator of Knuth's MMIX.
        bits = bits
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let value = f64::from_bits(bits);
        if value.is_finite() {
            // As a plain number, and as one that may be infinite.
            let plain = again(&Coulomb { mu: value });
            let unbounded = again(&ExtrapolatedPressure { floor: value });
            assert_eq!(plain.mu.to_bits(), bits);
            assert_eq!(unbounded.floor.to_bits(), bits);
            tried += 1;
        }
    }
    for value in [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, -7.0] {
        let own = again(&ExtrapolatedPressure { floor: value });
        assert_eq!(own.floor.to_bits(), value.to_bits());
    }
    assert_eq!(
        text(&ExtrapolatedPressure {
            floor: f64::NEG_INFINITY
        }),
        r#"{"floor":"-inf"}"#
    );
    // Whole numbers are written by people without a point.
    assert_eq!(read::<ExtrapolatedPressure>(r#"{"floor":-7}"#).floor, -7.0);
}

#[test]
fn what_is_not_named_has_its_default_and_a_name_that_is_wrong_is_refused() {
    let steps: StepControl = read(r#"{"courant": 0.3}"#);
    let wanted = StepControl {
        courant: 0.3,
        ..StepControl::default()
    };
    assert_eq!(steps, wanted);
    assert_eq!(
        read::<Penalty>(r#"{"damping": 0.1}"#),
        Penalty::new().damping(0.1)
    );
    let refused = |cause: serde_json::Error, parts: &[&str]| {
        let message = cause.to_string();
        for part in parts {
            assert!(message.contains(part), "{message}");
        }
    };
    let wrong = serde_json::from_str::<StepControl>(r#"{"smalest": 1e-9}"#);
    refused(
        wrong.expect_err("a typo"),
        &["unknown field", "smalest", "smallest"],
    );
    let wrong = serde_json::from_str::<Linear>(r#"{"reference_density": 1000.0}"#);
    refused(wrong.expect_err("half a law"), &["missing", "sound_speed"]);
    // What JSON has in the place of a number that is none is no number.
    let wrong = serde_json::from_str::<Coulomb>(&text(&Coulomb { mu: f64::NAN }));
    refused(wrong.expect_err("a NaN"), &["null"]);
    for floor in ["null", r#""nan""#, r#""infinite""#] {
        let wrong =
            serde_json::from_str::<ExtrapolatedPressure>(&format!(r#"{{"floor":{floor}}}"#));
        refused(
            wrong.expect_err("no number"),
            &["expected a number, `inf` or `-inf`"],
        );
    }
}

/// Reading checks no range: the scene does, and it refuses what was read as it refuses what was written in Rust.
#[test]
fn a_wrong_number_is_refused_as_it_is_from_rust() {
    let written = text(&settings());
    let problems = |own: Settings| rods(own).problems();
    assert_eq!(problems(read(&written)), []);
    let refused = |from: &str, to: &str, own: Settings, what: &str| {
        let changed = written.replace(from, to);
        assert_ne!(changed, written, "{from} is not in {written}");
        let from_text: Settings = read(&changed);
        let Err(Error::Build(found)) = rods(from_text).build() else {
            panic!("{to} was not refused");
        };
        assert_eq!(found.problems, problems(own));
        let named = |problem: &Problem| matches!(problem, Problem::Parameter { what: name, .. } if name.contains(what));
        assert!(found.problems.iter().any(named), "{found}");
    };
    let own = settings();
    let mut other = own;
    other.viscosity.alpha = -0.5;
    let alpha = format!(r#""alpha":{}"#, own.viscosity.alpha);
    refused(
        &alpha,
        r#""alpha":-0.5"#,
        other,
        "alpha of the artificial viscosity",
    );
    let mut other = own;
    let law = MieGruneisen::new(-1.0, 3940.0 + 0.1, 1.489, 2.02);
    other.law.law = law.with_form(own.law.law.form());
    let density = format!(r#""reference_density":{}"#, 8930.0 + 1.0 / 3.0);
    refused(
        &density,
        r#""reference_density":-1.0"#,
        other,
        "reference_density of material `copper`",
    );
    let mut other = own;
    other.law.minimum_pressure = 1.0;
    refused(
        r#""minimum_pressure":-1200000000.0"#,
        r#""minimum_pressure":1.0"#,
        other,
        "minimum_pressure",
    );
    let mut other = own;
    other.strength.slow.hardening.exponent = -1.0;
    refused(
        r#""exponent":0.31"#,
        r#""exponent":-1.0"#,
        other,
        "exponent",
    );
    let mut other = own;
    other.contact = ContactDensity::new().stiffness_factor(0.0);
    refused(
        &format!(r#""factor":{}"#, 1.0 / 3.0),
        r#""factor":0.0"#,
        other,
        "stiffness factor",
    );
    let mut other = own;
    other.steps.courant = -1.0;
    refused(
        &format!(r#""courant":{}"#, 0.1 + 0.2),
        r#""courant":-1.0"#,
        other,
        "step factor (courant)",
    );

    // The viscosity of a liquid.
    let oil: Liquid = read(&text(&Liquid::new(920.0, 1450.0, 0.05)).replace("0.05", "-0.05"));
    let scene = |liquid: Liquid| {
        let material = liquid.material("oil", SoundSpeed::Physical);
        let oil = Body::block("oil", material, [0.0], [4e-3], DX);
        Scene::new(scheme(own.viscosity)).body(oil)
    };
    let Err(Error::Build(found)) = scene(oil).build() else {
        panic!("a negative viscosity was not refused");
    };
    assert_eq!(
        found.problems,
        scene(Liquid::new(920.0, 1450.0, -0.05)).problems()
    );
    assert!(found.to_string().contains("dynamic_viscosity"), "{found}");
}

#[test]
fn reports_have_the_numbers_of_the_run() -> Result<(), Error> {
    let mut rods = rods(settings()).build()?;
    rods.keep_stability(Thresholds::default());
    let advice = rods_advice();
    let summary = Run::new(&mut rods, 5e-7)
        .stop(Stop::at_rest(1e-12, 1e-7))
        .go()?;
    let json = |text: String| read::<Value>(&text);

    let (ledger, written) = (rods.ledger(), json(text(&rods.ledger())));
    let numbers = [
        ("/time", ledger.time),
        ("/whole/mass", ledger.whole.mass),
        ("/whole/momentum/0", ledger.whole.momentum[0]),
        ("/whole/kinetic", ledger.whole.kinetic),
        ("/bodies/1/1/internal", ledger.bodies[1].1.internal),
    ];
    for (path, number) in numbers {
        assert_eq!(bits(&written, path), number.to_bits(), "{path}");
    }
    assert_eq!(written["bodies"][0][0], "striker");
    assert_eq!(
        written["whole"]["totals"].as_array().map(Vec::len),
        Some(ledger.whole.totals.len())
    );

    let (contacts, written) = (rods.contacts(), json(text(&rods.contacts())));
    assert!(contacts[0].penetration > 0.0, "they do not touch");
    assert_eq!(bits(&written, "/0/force/0"), contacts[0].force[0].to_bits());
    assert_eq!(written[0]["bodies"][1], "target");

    let (report, written) = (rods.stability(), json(text(&rods.stability())));
    let [_, densest] = report.density.as_ref().expect("it is watched");
    assert_eq!(bits(&written, "/density/1/value"), densest.value.to_bits());
    assert_eq!(written["density"][1]["body"], densest.body.as_str());
    assert_eq!(written["verdict"]["watched"], true);
    assert_eq!(written["steps"], report.steps);

    let (found, written) = (rods.indicators(), json(text(&rods.indicators())));
    let unity = found.unity.as_ref().expect("particles inside");
    assert_eq!(bits(&written, "/unity/median"), unity.median.to_bits());
    assert_eq!(
        written["limits"].as_array().map(Vec::len),
        Some(found.limits.len())
    );

    let (work, written) = (rods.work(), json(text(&rods.work())));
    assert_eq!(written["pairs"], work.pairs);
    assert_eq!(written["time"]["secs"], work.time.as_secs());
    assert_eq!(written["time"]["nanos"], work.time.subsec_nanos());

    let (cost, written) = (rods.cost(), json(text(&rods.cost())));
    assert!(!cost.lines.is_empty());
    assert_eq!(
        bits(&written, "/lines/0/share"),
        cost.lines[0].share.to_bits()
    );

    let (vote, written) = (rods.vote()?, json(text(&rods.vote()?)));
    assert_eq!(bits(&written, "/step"), vote.step.to_bits());
    assert_eq!(written["criterion"], format!("{:?}", vote.criterion));

    let (stored, written) = (rods.stored_energy(), json(text(&rods.stored_energy())));
    assert_eq!(
        written["parts"].as_array().map(Vec::len),
        Some(stored.parts.len())
    );

    let written = json(text(&summary));
    assert_eq!(written["steps"], rods.steps());
    assert_eq!(bits(&written, "/end/Time/end"), 5e-7_f64.to_bits());

    let written = json(text(&advice));
    assert!(!advice.lines.is_empty());
    assert_eq!(written["lines"][0]["effect"], advice.lines[0].effect);
    assert_eq!(
        written["lines"][0]["need"],
        format!("{:?}", advice.lines[0].need)
    );
    Ok(())
}

fn rods_advice() -> meshfree::scene::advice::Advice {
    rods(settings()).advise(1e-6, &Known::default())
}

/// A body in two dimensions has two numbers where one in three has three, and what is no number is `null`.
#[test]
fn vectors_have_the_length_of_the_dimension() {
    let body = RigidBody::<2> {
        mass: 1.0 / 3.0,
        inertia: [[0.0; 3]; 3],
        centre: [0.1 + 0.2, -0.0],
        orientation: [[0.0; 3]; 3],
        velocity: [1.0, f64::NAN],
        angular_velocity: [0.0; 3],
        angular_momentum: [0.0; 3],
        force: [f64::INFINITY, 5e-324],
        moment: [0.0; 3],
        joint_force: [0.0; 2],
        joint_moment: [0.0; 3],
    };
    let written: Value = read(&text(&body));
    assert_eq!(written["centre"].as_array().map(Vec::len), Some(2));
    assert_eq!(bits(&written, "/centre/0"), (0.1_f64 + 0.2).to_bits());
    assert_eq!(bits(&written, "/centre/1"), (-0.0_f64).to_bits());
    assert_eq!(bits(&written, "/force/1"), 5e-324_f64.to_bits());
    assert_eq!(written["velocity"][1], Value::Null);
    assert_eq!(written["force"][0], Value::Null);
    let norms = Norms {
        l1: f64::NAN,
        l2: 0.5,
        linf: f64::INFINITY,
    };
    assert_eq!(text(&norms), r#"{"l1":null,"l2":0.5,"linf":null}"#);
}

/// Results of studies, of which one has an answer that is a refusal.
#[test]
fn studies_are_written_with_their_error_bars() {
    let falls = |dx: f64| 1.0 + dx * dx / 3.0;
    let bar = with_error_bar([0.4, 0.2, 0.1, 0.05], |dx| Ok(falls(dx))).expect("a law");
    let written: Value = read(&text(&bar));
    assert_eq!(bits(&written, "/value"), bar.value.to_bits());
    assert_eq!(bits(&written, "/uncertainty"), bar.uncertainty.to_bits());
    assert_eq!(bits(&written, "/results/3/1"), falls(0.05).to_bits());

    let report = WorkPrecision::new("a law", |case| {
        let error = case.spacing() * case.number("factor")?;
        Ok(Outcome::default().value("error", error))
    })
    .quantity(Quantity::measured("error"))
    .spacings([0.4, 0.2, 0.1])
    .sweep("factor", [1.0 / 3.0])
    .run()
    .expect("three spacings");
    let written: Value = read(&text(&report));
    assert_eq!(written["name"], "a law");
    assert_eq!(written["rows"].as_array().map(Vec::len), Some(3));
    assert_eq!(written["rows"][0]["status"], "Done");
    let error = written["rows"][2]["errors"][0]["Ok"].as_f64();
    assert_eq!(
        error.map(f64::to_bits),
        Some((0.1 * (1.0_f64 / 3.0)).to_bits())
    );
    let refusal = report
        .for_error(1e-30)
        .expect_err("far beyond what was run");
    assert!(!text(&refusal).is_empty());
}
