//! The step program: what effects do in a step, stage by stage, beside their pair terms.
//! A scheme holds it, a group runs it, and it can be printed.

use super::{Evolved, Law, Limit, Rate, Setting, When, reads_and_writes, sequence};
use crate::error::Problem;
use crate::material::Material;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::term::{Stage, TermDoc};

/// A field of the state that an effect declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Declared {
    pub field: Field,
    /// The value that every component starts with.
    pub start: f64,
}

/// A number of each particle whose sum over a body the ledger keeps.
#[derive(Clone, Copy, Debug)]
pub struct LedgerColumn {
    /// Its name, as `heat`.
    pub name: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// The field.
    pub field: Field,
    /// Whether it is taken times the mass.
    pub times_mass: bool,
    /// What the sum is multiplied with; 1 for none.
    pub factor: f64,
}

/// What a scene is made of, as far as an effect may ask.
#[derive(Debug)]
pub struct SceneFacts<'a, T: Real> {
    /// Names and materials of the bodies that share the scheme.
    pub bodies: Vec<(&'a str, &'a Material<T>)>,
    /// The integrator's name.
    pub integrator: String,
    /// Whether it changes velocity by kicks alone.
    pub kicks: bool,
    /// Whether smoothing lengths vary or differ.
    pub lengths_vary: bool,
    /// The fields that the scheme integrates in time.
    pub integrated: Fields,
    /// The fields that laws of the scheme write.
    pub written: Fields,
}

/// What an effect asks of the scene that it is used in.
pub type Requirement<T> = Box<dyn Fn(&SceneFacts<'_, T>) -> Option<Problem> + Send + Sync>;

/// What effects do in a step beside their pair terms.
pub struct StepProgram<T: Real, const D: usize> {
    pub(crate) setting: Setting,
    pub(crate) declared: Vec<Declared>,
    /// Parts of the rates of fields that nothing has begun to integrate.
    pub(crate) pending: Vec<(Field, Box<dyn Rate<T, D>>)>,
    pub(crate) evolved: Vec<Evolved<T, D>>,
    pub(crate) laws: [Vec<Box<dyn Law<T, D>>>; Stage::COUNT],
    pub(crate) limits: Vec<Box<dyn Limit<T, D>>>,
    pub(crate) ledger: Vec<LedgerColumn>,
    pub(crate) documents: Vec<TermDoc>,
    pub(crate) requirements: Vec<Requirement<T>>,
    step_factors: Vec<f64>,
    pub(crate) wall_normals: bool,
    /// Whether laws give pressure and sound speed, and equations of state are not evaluated.
    pub(crate) gives_state: bool,
    /// Whether particles move with their velocities.
    pub(crate) moves: bool,
    /// Fields of rigid bodies that are walls: of which the smallest is taken, and which it is written to.
    pub(crate) least_on_rigid: Vec<[Field; 2]>,
    /// Fields of energy over mass that is stored, and of what has been dissipated.
    pub(crate) stored: Vec<Field>,
    pub(crate) dissipated: Vec<Field>,
    /// Fields of heat that laws of the rates give over mass and time.
    pub(crate) heating: Vec<Field>,
    /// Whether all effects say what they store, and whether the pressure is that of the equation of state.
    pub(crate) books_energy: bool,
    pub(crate) presses: bool,
    needed: Fields,
    /// Fields of effects that share their name with others.
    namesakes: Fields,
}

impl<T: Real, const D: usize> core::fmt::Debug for StepProgram<T, D> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("StepProgram")
            .field("evolved", &self.evolved)
            .field("laws", &self.laws)
            .finish_non_exhaustive()
    }
}

impl<T: Real, const D: usize> StepProgram<T, D> {
    pub(crate) fn new(setting: Setting) -> Self {
        Self {
            setting,
            declared: Vec::new(),
            pending: Vec::new(),
            evolved: Vec::new(),
            laws: core::array::from_fn(|_| Vec::new()),
            limits: Vec::new(),
            ledger: Vec::new(),
            documents: Vec::new(),
            requirements: Vec::new(),
            step_factors: Vec::new(),
            wall_normals: false,
            gives_state: false,
            moves: true,
            least_on_rigid: Vec::new(),
            stored: Vec::new(),
            dissipated: Vec::new(),
            heating: Vec::new(),
            books_energy: true,
            presses: true,
            needed: Fields::NONE,
            namesakes: Fields::NONE,
        }
    }

    /// What the scheme is, as far as its effects may ask.
    #[must_use]
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// Makes a field part of the state, and says what each of its components starts with.
    pub fn declare(&mut self, field: Field, start: f64) {
        self.declared.push(Declared { field, start });
    }

    /// Integrates a field in time.
    pub fn evolve(&mut self, mut evolved: Evolved<T, D>) {
        let (own, others) = core::mem::take(&mut self.pending)
            .into_iter()
            .partition(|(field, _)| *field == evolved.field);
        self.pending = others;
        let parts: Vec<(Field, Box<dyn Rate<T, D>>)> = own;
        evolved
            .rates
            .extend(parts.into_iter().map(|(_, rate)| rate));
        self.evolved.push(evolved);
    }

    /// Adds a part to the rate of a field that another effect, or the scheme, integrates; a scheme in which none
    /// does is refused.
    pub fn contribute(&mut self, field: Field, rate: impl Rate<T, D> + 'static) {
        match self.evolved.iter_mut().find(|own| own.field == field) {
            Some(evolved) => evolved.rates.push(Box::new(rate)),
            None => self.pending.push((field, Box::new(rate))),
        }
    }

    /// Runs a law at a stage, where its [declarations](Law) say.
    pub fn law(&mut self, stage: Stage, law: impl Law<T, D> + 'static) {
        self.laws[stage.number()].push(Box::new(law));
    }

    /// Limits the time step.
    pub fn limit(&mut self, limit: impl Limit<T, D> + 'static) {
        self.limits.push(Box::new(limit));
    }

    /// Multiplies the step factor, for what lowers the stable step by a known share.
    pub fn shorten_step(&mut self, factor: f64) {
        self.step_factors.push(factor);
    }

    /// The product of the shares by which the step is shortened.
    pub(crate) fn step_factor(&self) -> f64 {
        self.step_factors.iter().product()
    }

    /// Keeps the sum of a scalar field over every body in the ledger, as [`Budget::totals`].
    ///
    /// [`Budget::totals`]: crate::simulation::Budget::totals
    pub fn ledger(&mut self, column: LedgerColumn) {
        self.ledger.push(column);
    }

    /// Says that a field holds energy over mass \[J/kg\] that is stored, as a function of the state alone: in addition to that of
    /// the equation of state, or in place of it where the effect [replaces the pressure](Self::replace_pressure).
    pub fn store(&mut self, field: Field) {
        self.stored.push(field);
    }

    /// Says that a field holds energy over mass \[J/kg\] that was dissipated since the start, and is in the internal energy.
    pub fn dissipate(&mut self, field: Field) {
        self.dissipated.push(field);
    }

    /// Says that a field, which laws of [`Stage::Rates`] write, is heat over mass and time \[W/kg\]: it joins the internal energy,
    /// where the scheme has one, as the heat of [loads](crate::simulation::Load::heating) does.
    pub fn heat(&mut self, field: Field) {
        self.heating.push(field);
    }

    /// Says that forces do not follow from the pressure of the equation of state, which then stores nothing.
    pub fn replace_pressure(&mut self) {
        self.presses = false;
    }

    /// Says that laws of [`Stage::State`] give every particle its pressure and sound speed, so that equations of state are not
    /// evaluated.
    pub fn give_state(&mut self) {
        self.gives_state = true;
    }

    /// Says in words what the effect does in addition to its terms.
    pub fn document(&mut self, document: TermDoc) {
        self.documents.push(document);
    }

    /// Asks something of the scene.
    pub fn require(
        &mut self,
        requirement: impl Fn(&SceneFacts<'_, T>) -> Option<Problem> + Send + Sync + 'static,
    ) {
        self.requirements.push(Box::new(requirement));
    }

    /// Asks for the normals of walls in [`WallSurface`](crate::boundary::WallSurface).
    pub fn ask_for_wall_normals(&mut self) {
        self.wall_normals = true;
    }

    /// Holds particles in their places, whatever their velocities.
    pub fn stay(&mut self) {
        self.moves = false;
    }

    /// Writes to every particle of a [rigid body](crate::scene::Scene::rigid) that liquid meets as a wall the smallest value that a
    /// field has on those of them that liquid reaches, after the laws of walls: a number of the whole body, which no law can find.
    pub fn least_on_rigid_bodies(&mut self, of: Field, to: Field) {
        self.needed = self.needed.union(Fields::of(&[of, to]));
        self.least_on_rigid.push([of, to]);
    }

    /// Asks for a column that keeps its values from step to step: nothing here writes it, or a law does for the step
    /// after. It starts with zeros.
    pub fn carry(&mut self, field: Field) {
        self.needed = self.needed.union(Fields::of(&[field]));
    }

    /// Fields that are asked for by [`carry`](Self::carry).
    pub(crate) fn carried(&self) -> Fields {
        self.needed
    }

    /// The fields that the program names.
    pub(crate) fn fields(&self) -> Fields {
        let laws = self.laws.iter().flatten();
        let laws = laws.fold(self.needed, |all, law| {
            let own = law.reads().union(law.writes());
            all.union(own.minus(law.optional()))
        });
        let limits = self.limits.iter();
        let laws = limits.fold(laws, |all, limit| all.union(limit.reads()));
        let evolved = self.evolved.iter().fold(laws, |all, own| {
            let residual = own.residual.map_or(Fields::NONE, |r| Fields::of(&[r]));
            let read = own.rates.iter().fold(Fields::NONE, |all, rate| {
                all.union(rate.reads().minus(rate.optional()))
            });
            all.union(Fields::of(&[own.field]))
                .union(residual)
                .union(read)
        });
        let declared = self.declared.iter().map(|own| own.field);
        declared
            .chain(self.ledger.iter().map(|own| own.field))
            .fold(evolved, |all, field| all.union(Fields::of(&[field])))
    }

    /// Whether a field other than velocity and energy changes at a time.
    pub(crate) fn evolves_at(&self, when: When) -> bool {
        let mut evolved = self.evolved.iter();
        evolved.any(|own| own.when == when && own.field != Field::ENERGY)
    }

    /// The fields that are integrated in time.
    pub(crate) fn integrated(&self) -> Fields {
        let evolved = self.evolved.iter();
        evolved.fold(Fields::NONE, |all, own| all.union(Fields::of(&[own.field])))
    }

    /// The fields that laws write.
    pub(crate) fn written(&self) -> Fields {
        let (laws, carried) = (self.laws.iter().flatten(), self.fields());
        laws.fold(Fields::NONE, |all, law| {
            let [_, writes] = reads_and_writes(&**law, carried);
            all.union(writes)
        })
    }

    /// Whether a field belongs to the state: an effect declares it, or it is integrated in time.
    pub(crate) fn keeps(&self, field: Field) -> bool {
        self.declared.iter().any(|own| own.field == field)
            || self.evolved.iter().any(|own| own.field == field)
    }

    /// Why a field with so many components cannot be set between steps.
    pub(crate) fn cannot_set(&self, field: Field, components: usize) -> Option<Problem> {
        let name = self.name_of(field);
        if field != Field::VELOCITY && !self.keeps(field) {
            return Some(Problem::Incompatible {
                what: format!("the field {name} is no part of the state under this scheme"),
                remedy: "set the velocity, a field that is integrated in time, or one that an effect declares: \
                         all others follow from these",
            });
        }
        (components != field.components(D)).then(|| Problem::Parameter {
            what: format!("number of components given for the field {name}"),
            value: components as f64,
            must_be: "it must be 1 for a scalar, the dimension for a vector, 6 for a symmetric tensor, the square \
                      of the dimension for a matrix",
        })
    }

    /// Why bodies cannot start with values of a field with so many components.
    pub(crate) fn cannot_start(&self, field: Field, components: usize) -> Option<Problem> {
        let own = [Field::VELOCITY, Field::DENSITY, Field::ENERGY];
        if own.contains(&field) {
            return Some(Problem::Incompatible {
                what: format!("bodies start with a {} of their own", field.name()),
                remedy: "give it by Body::velocity, Body::density, Body::energy or Body::start",
            });
        }
        self.cannot_set(field, components)
    }

    /// The fields of the state other than position and velocity, each once, in the order of their names.
    pub(crate) fn state(&self) -> impl Iterator<Item = Field> + use<T, D> {
        let declared = self.declared.iter().map(|own| own.field);
        let evolved = self.evolved.iter().map(|own| own.field);
        let mut all: Vec<Field> = declared.chain(evolved).collect();
        all.sort_by_key(|field| field.full_name());
        all.dedup();
        all.into_iter()
    }

    /// The order of the laws of a stage, as indices of those that there are.
    pub(crate) fn sequence(&self, stage: Stage) -> Result<Vec<usize>, Problem> {
        let laws = &self.laws[stage.number()];
        sequence(laws, stage, &|field| self.name_of(field))
    }

    /// Puts all that effects have said into an order that does not depend on that of their list. Laws and evolved fields that
    /// have none stand by their names, and the scheme is refused.
    pub(crate) fn arrange(&mut self) {
        for stage in Stage::ALL {
            let laws = &mut self.laws[stage.number()];
            laws.sort_by_cached_key(|law| (law.name(), format!("{law:?}")));
            let Ok(order) = self.sequence(stage) else {
                continue;
            };
            let laws = core::mem::take(&mut self.laws[stage.number()]);
            let mut laws: Vec<_> = laws.into_iter().map(Some).collect();
            let ordered = order.into_iter().filter_map(|k| laws[k].take());
            self.laws[stage.number()] = ordered.collect();
        }
        let fields = self.fields();
        let is_clear = |field: &Field| field.name_among(fields.iter()) == field.name();
        let clear: Vec<Field> = fields.iter().filter(is_clear).collect();
        self.namesakes = fields.minus(Fields::of(&clear));
        self.arrange_evolved();
        self.pending.sort_by_key(|(field, _)| field.full_name());
        self.declared.sort_by(|a, b| {
            let names = a.field.full_name().cmp(b.field.full_name());
            names.then(a.start.total_cmp(&b.start))
        });
        // Of limits that ask for the same step the first is named.
        self.limits.sort_by_key(|limit| limit.name());
        self.ledger.sort_by_cached_key(|own| format!("{own:?}"));
        self.documents.sort_by_cached_key(|own| format!("{own:?}"));
        self.stored.sort_by_key(|field| field.full_name());
        self.dissipated.sort_by_key(|field| field.full_name());
        self.heating.sort_by_key(|field| field.full_name());
        self.step_factors.sort_by(f64::total_cmp);
    }

    /// A field whose rate reads another stands before it, so that it sees the value of before; fields stand by their names else.
    fn arrange_evolved(&mut self) {
        let mut left = core::mem::take(&mut self.evolved);
        for own in &mut left {
            let rates = &mut own.rates;
            rates.sort_by_cached_key(|rate| (rate.name(), format!("{rate:?}")));
        }
        left.sort_by_cached_key(|own| (own.field.full_name(), format!("{own:?}")));
        while !left.is_empty() {
            let is_first = |own: &Evolved<T, D>| !left.iter().any(|other| other.precedes(own));
            let at = left.iter().position(is_first).unwrap_or(0);
            self.evolved.push(left.remove(at));
        }
    }

    /// Puts all that effects have said into another order, as another list of effects does, and then into its own again.
    pub(crate) fn permute(&mut self, mut seed: u64) {
        let seed = &mut seed;
        for laws in &mut self.laws {
            shuffle(laws, seed);
        }
        for own in &mut self.evolved {
            shuffle(&mut own.rates, seed);
        }
        shuffle(&mut self.evolved, seed);
        shuffle(&mut self.pending, seed);
        shuffle(&mut self.declared, seed);
        shuffle(&mut self.limits, seed);
        shuffle(&mut self.ledger, seed);
        shuffle(&mut self.documents, seed);
        shuffle(&mut self.requirements, seed);
        shuffle(&mut self.stored, seed);
        shuffle(&mut self.dissipated, seed);
        shuffle(&mut self.heating, seed);
        shuffle(&mut self.step_factors, seed);
        self.arrange();
    }

    /// The name of a field in files and messages: the full one if another field of the program has the same name.
    pub(crate) fn name_of(&self, field: Field) -> &'static str {
        if self.namesakes.contains(field) {
            return field.full_name();
        }
        field.name()
    }
}

fn shuffle<X>(all: &mut [X], seed: &mut u64) {
    for k in (1..all.len()).rev() {
        // Knuth's generator of 64 bits, of which the high ones are random.
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        all.swap(k, (*seed >> 33) as usize % (k + 1));
    }
}
