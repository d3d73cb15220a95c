//! What a scheme says of itself is what it runs, and what the architecture page shows.
//! The page has the step program of a liquid as the crate prints it.

use super::filled::{FILLED, WHERE_GRADIENTS_ARE};
use meshfree::effect::{
    BySum, Chunk, Damage, Effect, HourglassFree, Hypoelastic, Law, Setting, StepProgram,
    SurfaceTension, Tally,
};
use meshfree::error::Problem;
use meshfree::material::eos::Linear;
use meshfree::material::failure::SpallStrength;
use meshfree::name;
use meshfree::particles::{Name, Output, Outputs};
use meshfree::prelude::*;
use meshfree::term::{
    In, LaminarViscosity, Layout, MidpointReconstruction, Pair, Stage, Sums, Term, TermDoc, stage,
    viscosity,
};

#[test]
fn the_architecture_page_shows_the_step_as_it_is_printed() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/architecture.md"));
    let liquid: Scheme<f64, 2> = schemes::weakly_compressible().compose();
    let (page, program) = (page.expect("the page"), liquid.step_program());
    assert!(
        page.contains(&program),
        "put into docs/architecture.md:\n{program}"
    );
}

/// What a particle and a step pay for an effect that is not named: nothing.
#[test]
fn an_effect_that_is_not_named_is_not_in_the_program() {
    // In one dimension, where a scheme compiles soonest.
    let plain: Scheme<f64, 1> = schemes::weakly_compressible().compose();
    let text = plain.to_string() + &plain.step_program();
    for (name, scheme) in [
        (
            "divergence",
            schemes::weakly_compressible()
                .with(AcousticDamping { strength: 0.3 })
                .compose(),
        ),
        (
            "dynamic_viscosity",
            schemes::weakly_compressible()
                .with(Laminar(LaminarViscosity))
                .compose(),
        ),
        (
            "expansion",
            schemes::weakly_compressible()
                .with(ExpansionMemory)
                .compose(),
        ),
        (
            "concentration_gradient",
            schemes::weakly_compressible()
                .with(Shifting::STANDARD)
                .compose(),
        ),
        (
            "summed_density",
            schemes::weakly_compressible()
                .with(VolumeConsistency { strength: 0.05 })
                .compose(),
        ),
        (
            "correction",
            schemes::weakly_compressible().renormalised().compose(),
        ),
    ] as [(&str, Scheme<f64, 1>); 6]
    {
        let own = scheme.to_string() + &scheme.step_program();
        let lines = |text: &str| text.matches(name).count();
        assert!(
            lines(&own) > lines(&text),
            "{name} is in the program that names it:\n{own}"
        );
        assert!(
            lines(&text) == 0,
            "{name} is not in the one that does not:\n{text}"
        );
    }
    // 3 + 3 + 6 numbers: places, velocities, and what pressure and continuity need.
    assert_eq!(plain.fields().width(3), 12);
}

/// A field and a sum of its own.
const OWN: Field = Field::scalar(name!("colour", "1"));
const SUM: Output = Output::vector(name!("own_sum", "1"));

/// A law that reads and writes what a test says, and does nothing.
#[derive(Clone, Copy, Debug)]
struct Reads {
    fields: Fields,
    sums: Outputs,
    writes: Fields,
}

const NOTHING: Reads = Reads {
    fields: Fields::NONE,
    sums: Outputs::NONE,
    writes: Fields::NONE,
};

impl<T: Real, const D: usize> Law<T, D> for Reads {
    fn name(&self) -> &'static str {
        "a law of a test"
    }
    fn reads(&self) -> Fields {
        self.fields
    }
    fn sums(&self) -> Outputs {
        self.sums
    }
    fn writes(&self) -> Fields {
        self.writes
    }
    fn apply(&self, _chunk: &mut Chunk<'_, T, D>) -> Tally {
        Tally::default()
    }
}

/// A law at a stage, and a field that is part of the state.
#[derive(Clone, Copy, Debug)]
struct At {
    stage: Stage,
    law: Reads,
    declares: Option<Field>,
}

impl<const D: usize> Effect<D> for At {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(self.stage, self.law);
        if let Some(field) = self.declares {
            program.declare(field, 0.0);
        }
    }
}

/// A term that reads the own field and writes the own sum.
#[derive(Clone, Copy, Debug)]
struct OwnTerm;

impl<const D: usize> Effect<D> for OwnTerm {
    type Terms = (In<stage::Rates, OwnTerm>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
}

impl<const D: usize> Term<D> for OwnTerm {
    const NAME: &'static str = "tests::own_term";
    const READS: Fields = Fields::of(&[OWN]);
    const WRITES: Outputs = Outputs::of(&[SUM]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        for d in 0..D {
            sums.add_at(SUM, d, pair.j(OWN) * pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "a term of a test".into(),
            equation: "Σ c r",
            source: "none",
        }
    }
}

fn problems(scheme: impl Into<Scheme<f64, 1>>) -> Vec<Problem> {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3);
    Scene::new(scheme).body(rod).problems()
}

#[test]
fn a_stage_that_reads_what_nothing_wrote_is_refused_by_name() {
    let at = |stage, law| At {
        stage,
        law,
        declares: None,
    };
    let reads = |field| Reads {
        fields: Fields::of(&[field]),
        ..NOTHING
    };
    for (stage, law, quantity) in [
        // Equations of state come after the densities, coefficients of the force after the walls.
        (
            Stage::Density,
            reads(Field::PRESSURE),
            Some("field pressure"),
        ),
        (Stage::State, reads(Field::PRESSURE), None),
        (
            Stage::State,
            reads(Field::PRESSURE_COEFFICIENT),
            Some("field pressure_coefficient"),
        ),
        (Stage::Rates, reads(Field::PRESSURE_COEFFICIENT), None),
        // Of gradients the scheme asks for those of velocity and pressure.
        (
            Stage::Flow,
            reads(Field::DENSITY_GRADIENT),
            Some("field density_gradient"),
        ),
        (
            Stage::State,
            reads(Field::PRESSURE_GRADIENT),
            Some("field pressure_gradient"),
        ),
        (Stage::Flow, reads(Field::PRESSURE_GRADIENT), None),
        // What an evaluation has written is there in the drift after it.
        (Stage::Continuity, reads(Field::PRESSURE_GRADIENT), None),
        (
            Stage::Rates,
            Reads {
                sums: Outputs::of(&[Output::FORCE, Output::UNITY]),
                ..NOTHING
            },
            Some("sum unity"),
        ),
    ] {
        let found = problems(schemes::impact().with(at(stage, law)));
        let Some(quantity) = quantity else {
            assert!(found.is_empty(), "{found:?}");
            continue;
        };
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(matches!(found[0], Problem::NotWritten { .. }));
        let text = found[0].to_string();
        for part in [quantity, stage.name(), "a law of a test", "impact"] {
            assert!(text.contains(part), "{part} in {text}");
        }
    }
}

#[test]
fn a_field_of_ones_own_is_written_at_a_stage_before_it_is_read() {
    let writes = |stage, declares| At {
        stage,
        law: Reads {
            writes: Fields::of(&[OWN]),
            ..NOTHING
        },
        declares,
    };
    // Declared, it belongs to the state, whoever writes it.
    let own = schemes::impact().with(OwnTerm);
    assert!(problems(own.clone().with(writes(Stage::Rates, Some(OWN)))).is_empty());
    // Not declared, it has a value from where it is written on.
    assert!(problems(own.clone().with(writes(Stage::Flow, None))).is_empty());
    let late = problems(own.with(writes(Stage::Rates, None)));
    assert!(
        matches!(&late[..], [Problem::NotWritten { reader, .. }] if reader == "the term `a term of a test`"),
        "{late:?}"
    );
}

#[test]
fn two_fields_of_one_full_name_are_refused() {
    let declares = |field| At {
        stage: Stage::Rates,
        law: NOTHING,
        declares: Some(field),
    };
    let scheme = || schemes::impact().with(OwnTerm).with(declares(OWN));
    // What means the same is the same constant.
    assert!(problems(scheme().with(declares(OWN))).is_empty());
    let tensor = Field::tensor(name!("colour", "1"));
    let other_unit = Field::scalar(name!("colour", "K"));
    for (other, says) in [(tensor, "tensor [1]"), (other_unit, "scalar [K]")] {
        let found = problems(scheme().with(declares(other)));
        assert!(matches!(found[..], [Problem::Names { .. }]), "{found:?}");
        let text = found[0].to_string();
        let own = "`meshfree::colour` is a scalar [1]";
        assert!(text.contains(own) && text.contains(says), "{text}");
    }
    // Another package may have the name.
    const OTHER: Name = Name {
        full: "other::colour",
        unit: "K",
    };
    let scheme: Scheme<f64, 1> = scheme().with(declares(Field::tensor(&OTHER))).compose();
    let printed = scheme.step_program();
    assert!(printed.contains("starts meshfree::colour [1]"), "{printed}");
    assert!(printed.contains("starts other::colour [K]"), "{printed}");
}

#[test]
fn surface_tension_stands_with_effects_of_solids_that_fail() {
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Damage)
        .with(HourglassFree::default())
        .with(SurfaceTension::between("first", "second", 0.03));
    let body = |name, low: f64| {
        let material = Material::new(name, Linear::new(1000.0, 100.0)).with_shear_modulus(1e6);
        let material = material.with_failure(SpallStrength::new(1e5));
        Body::block(name, material, [low], [low + 0.5], 0.05)
    };
    let scene = Scene::<f64, 1>::new(scheme);
    let scene = scene.body(body("first", 0.0)).body(body("second", 0.5));
    let mut rods = scene.build().expect("two rods");
    rods.step().expect("a step");
    let first = rods.all().next().expect("a particle");
    assert_eq!(first.named("colour"), Some(vec![1.0]));
    assert_eq!(first.named("failed"), Some(vec![0.0]));
}

#[test]
fn no_two_effects_of_the_crate_have_one_name() {
    let mut names: Vec<String> = Vec::new();
    for (path, code) in files("effect") {
        // Tests have names of their own.
        let code = code.split("#[cfg(test)]").next().unwrap_or_default();
        if path.ends_with("declared.rs") {
            continue;
        }
        for kind in ["Field::", "Output::"] {
            let made = code.split(kind).skip(1);
            let made = made.filter_map(|text| text.split_once("(name!(\""));
            let made = made.filter(|(shape, _)| shape.len() <= "scalar".len());
            let local = made.filter_map(|(_, text)| text.split_once('"'));
            names.extend(local.map(|(local, _)| format!("{kind}{local}")));
        }
    }
    let of_crate = Field::ALL
        .iter()
        .map(|own| format!("Field::{}", own.name()));
    let sums = Output::ALL
        .iter()
        .map(|own| format!("Output::{}", own.name()));
    let of_effects = names.len();
    names.extend(of_crate.chain(sums));
    names.sort();
    let twice = names.windows(2).find(|pair| pair[0] == pair[1]);
    assert!(
        of_effects > 35 && twice.is_none(),
        "{of_effects}, {twice:?}"
    );
}

/// A law of smoothing lengths that names no loops.
#[derive(Clone, Copy, Debug)]
struct Unnamed;

impl<const D: usize> Effect<D> for Unnamed {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn smoothing(&self) -> Option<Smoothing> {
        Some(Smoothing::Mixed)
    }
}

#[test]
fn forms_that_do_not_go_together_are_refused() {
    let total = SchemeBuilder::total_lagrangian(CubicSpline, viscosity::Inviscid).with(NeoHookean);
    let bends = total.with(MidpointReconstruction::STANDARD);
    let heats = schemes::weakly_compressible().energy(EnergyForm::Symmetric);
    for (found, part) in [
        (problems(bends), "sums over the present neighbours"),
        (problems(heats), "carries no internal energy"),
        (problems(schemes::impact().with(Unnamed)), "Effect::MODES"),
    ] {
        let found: Vec<_> = found.iter().map(ToString::to_string).collect();
        assert!(found.iter().any(|text| text.contains(part)), "{found:?}");
    }
    assert!(problems(schemes::impact().with(MixedSpacing)).is_empty());
}

#[test]
fn the_last_law_of_smoothing_lengths_holds() {
    let printed = |scheme: Scheme<f64, 1>| scheme.to_string();
    let wide = ConsistentSmoothing {
        smallest: 0.1,
        largest: 7.0,
    };
    assert!(printed(schemes::gas().with(wide).compose()).contains("largest: 7.0"));
    let fixed = schemes::gas().with(Smoothing::Fixed).compose();
    assert!(printed(fixed).contains("smoothing Fixed"));
    // What varies may differ from body to body already.
    let mixed = schemes::gas().with(MixedSpacing).compose();
    assert!(printed(mixed).contains("smoothing Consistent"));
}

/// A law that declares the pressure, and reads the density.
#[derive(Clone, Copy, Debug)]
struct Lies;

impl<const D: usize> Effect<D> for Lies {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::State, *self);
    }
}

impl<T: Real, const D: usize> Law<T, D> for Lies {
    fn name(&self) -> &'static str {
        "a law that lies"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::PRESSURE])
    }
    fn writes(&self) -> Fields {
        Fields::NONE
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let ([pressure, density], []) = chunk.columns([Field::PRESSURE, Field::DENSITY], []);
        assert_eq!(pressure.len(), density.len());
        Tally::default()
    }
}

#[test]
#[should_panic(expected = "the law `a law that lies` reads the field `density`")]
fn a_law_that_reads_what_it_does_not_declare_ends_the_run() {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3);
    let scene = Scene::<f64, 1>::new(schemes::impact().with(Lies)).body(rod);
    let mut rod = scene.build().expect("a rod");
    rod.step().expect("a step");
}

/// So many laws at one stage, and fields of its own.
#[derive(Clone, Copy, Debug)]
struct Many {
    laws: usize,
    fields: usize,
}

impl<const D: usize> Effect<D> for Many {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        for _ in 0..self.laws {
            program.law(Stage::Rates, NOTHING);
        }
        for number in 0..self.fields {
            let full = format!("test::{number}").leak();
            let name = Box::leak(Box::new(Name { full, unit: "1" }));
            let shapes = [Field::scalar, Field::vector, Field::tensor, Field::matrix];
            program.declare(shapes[number % 4](name), 0.0);
        }
    }
}

#[test]
fn more_laws_and_fields_than_there_is_room_for_are_refused() {
    let many = |laws, fields| problems(schemes::impact().with(Many { laws, fields }));
    assert!(many(32, 32).is_empty());
    for (laws, fields, what) in [
        (33, 0, "has room for 32 laws, and not for `a law of a test`"),
        (0, 33, "no room for `test::9` beside 32 others"),
    ] {
        let found = many(laws, fields);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].to_string().contains(what), "{found:?}");
    }
}

/// An effect that adds to the rate of what nothing integrates.
#[derive(Clone, Copy, Debug)]
struct Adds;

impl<const D: usize> Effect<D> for Adds {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let sum = Output::FORCE;
        program.contribute(Field::DENSITY, BySum { sum, over: None });
    }
}

#[test]
fn a_rate_of_what_nothing_integrates_is_refused() {
    let found = problems(schemes::impact().with(Adds));
    assert!(
        found[0].to_string().contains("rate of density"),
        "{found:?}"
    );
}

/// Every ready scheme, with every effect and switch, reads what has been written.
#[test]
fn ready_schemes_are_in_order() {
    assert!(problems(schemes::impact()).is_empty());
    assert!(problems(schemes::impact_by_continuity()).is_empty());
    assert!(
        problems(schemes::impact().with_viscosity(viscosity::CullenDehnen::default())).is_empty()
    );
    assert!(
        problems(schemes::impact().with_viscosity(viscosity::MorrisMonaghan::default())).is_empty()
    );
}

/// The text of every file of a folder of the crate and of the folders in it, without comments.
fn files(folder: &str) -> Vec<(String, String)> {
    let mut folders = vec![
        std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("src")
            .join(folder),
    ];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder") {
            let path = entry.expect("a file").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("text");
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            let code: Vec<_> = code.collect();
            files.push((path.display().to_string(), code.join("\n")));
        }
    }
    files
}

#[test]
fn the_driver_names_no_effect_and_effects_do_not_import_the_driver() {
    let effects = files("effect");
    let mut names = Vec::new();
    for (path, code) in &effects {
        assert!(!code.contains("crate::simulation"), "{path}");
        let after = code.split("Effect<D> for ").skip(1);
        let name = |text: &str| {
            let end = text.find(|c: char| !c.is_alphanumeric());
            text[..end.unwrap_or(text.len())].to_string()
        };
        names.extend(after.map(name));
    }
    // `Option` of an effect is one too, and a macro names its own by a variable.
    names.retain(|name| name != "Option" && !name.is_empty());
    assert!(
        names.len() > 10 && names.contains(&"Shifting".into()),
        "{names:?}"
    );
    for (path, code) in files("simulation") {
        let words: Vec<&str> = code.split(|c: char| !c.is_alphanumeric()).collect();
        for name in &names {
            assert!(!words.contains(&name.as_str()), "{path} names {name}");
        }
    }
}

/// Schemes without and with gradients of their own take a term of an effect at their stage.
#[test]
fn a_term_of_an_effect_at_the_stage_of_gradients_is_summed() {
    let plain: Scheme<f64, 2> = schemes::impact().with(WHERE_GRADIENTS_ARE).compose();
    let corrected: Scheme<f64, 2> = schemes::updated_lagrangian()
        .with(WHERE_GRADIENTS_ARE)
        .compose();
    for scheme in [plain, corrected] {
        let copper = catalogue::copper().with_shear_modulus(46e9);
        let block = Body::block("block", copper, [0.0; 2], [0.02, 0.02], 1e-3);
        let mut simulation = Scene::new(scheme).body(block).build().expect("a block");
        simulation.evaluate().expect("sums");
        let middle = |p: &meshfree::simulation::ParticleView<'_, f64, 2>| {
            p.position().iter().all(|x| (0.008..0.012).contains(x))
        };
        let inside = simulation.all().filter(middle);
        let filled: Vec<f64> = inside.filter_map(|p| p.scalar(FILLED)).collect();
        assert!(!filled.is_empty());
        // All but the particle itself, whose own share is no pair.
        let even = filled.iter().all(|own| (0.5..1.1).contains(own));
        assert!(even, "{filled:?}");
    }
}
