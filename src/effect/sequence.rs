//! The order of the laws of a stage: it follows from what they declare, and not from the list of effects.
//! A law that reads a field comes after those that write it; those that change one field stand on rungs.

use super::Law;
use crate::error::Problem;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::term::Stage;

/// Where a law stands among those of its stage that change the same field: from the value that a step tries to the one that it
/// keeps.
///
/// A stress is tried as elastic, returned by flow, taken away by failure, held by constraints, and cut at bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// A value before anything limits it.
    Trial,
    /// What flow makes of it.
    Flow,
    /// What failure leaves of it.
    Failure,
    /// What a constraint allows.
    Constraint,
    /// The bounds of what it may be.
    Bound,
}

/// What makes one law come before another.
enum Because {
    /// The first writes a field that the other reads or changes.
    Writes(Field),
    /// The first reads a field as it is before the other writes it.
    ReadsBefore(Field),
    /// The rung of the first is lower.
    Rung(Field),
}

/// The laws of a stage in the order in which they run, as indices.
///
/// # Errors
/// If two laws make the same field, or change it without an order, or if each is to come after the other.
pub(crate) fn sequence<T: Real, const D: usize>(
    laws: &[Box<dyn Law<T, D>>],
    stage: Stage,
    name_of: &dyn Fn(Field) -> &'static str,
) -> Result<Vec<usize>, Problem> {
    // From here on the order of the list is gone: laws of one name differ by what they hold, or are the same.
    let mut names: Vec<_> = (0..laws.len()).collect();
    names.sort_by_cached_key(|&k| (laws[k].name(), format!("{:?}", laws[k])));
    let first = earlier(laws, &names, stage, name_of)?;
    let (mut order, mut left) = (Vec::with_capacity(laws.len()), names);
    while !left.is_empty() {
        let is_ready = |k: &usize| first[*k].iter().all(|(before, _)| order.contains(before));
        let Some(at) = left.iter().position(is_ready) else {
            return Err(cycle(laws, &first, &left, stage, name_of));
        };
        order.push(left.remove(at));
    }
    Ok(order)
}

/// The laws that come before each, with the reason.
type Earlier = Vec<Vec<(usize, Because)>>;

fn earlier<T: Real, const D: usize>(
    laws: &[Box<dyn Law<T, D>>],
    names: &[usize],
    stage: Stage,
    name_of: &dyn Fn(Field) -> &'static str,
) -> Result<Earlier, Problem> {
    let mut earlier: Earlier = laws.iter().map(|_| Vec::new()).collect();
    let mut ties = Vec::new();
    let written = laws.iter().map(|law| law.writes());
    let written = written.fold(Fields::NONE, |all, own| all.union(own));
    for field in written.iter() {
        let with = |what: &dyn Fn(&dyn Law<T, D>) -> bool| -> Vec<usize> {
            names.iter().copied().filter(|&k| what(&*laws[k])).collect()
        };
        let reads = |law: &dyn Law<T, D>| law.reads().contains(field);
        let writes = |law: &dyn Law<T, D>| law.writes().contains(field);
        let before = |law: &dyn Law<T, D>| law.before().contains(field);
        let adds = |law: &dyn Law<T, D>| law.adds().contains(field);
        let makers = with(&|law| writes(law) && !reads(law) && !adds(law));
        let changers = with(&|law| writes(law) && (reads(law) || adds(law)));
        if let [a, b, ..] = makers[..] {
            return Err(Problem::Incompatible {
                what: format!(
                    "the laws `{}` and `{}` of the stage {} both make the field {}",
                    laws[a].name(),
                    laws[b].name(),
                    stage.name(),
                    name_of(field)
                ),
                remedy: "leave one of the two effects out, or let one of the laws read the field too and so change what the \
                         other makes (Law::reads)",
            });
        }
        for (n, &a) in changers.iter().enumerate() {
            for &b in &changers[n + 1..] {
                match (laws[a].rung(), laws[b].rung()) {
                    (Some(own), Some(other)) if own < other => {
                        earlier[b].push((a, Because::Rung(field)));
                    }
                    (Some(own), Some(other)) if own > other => {
                        earlier[a].push((b, Because::Rung(field)));
                    }
                    _ if adds(&*laws[a]) && adds(&*laws[b]) => {}
                    _ => ties.push((field, a, b)),
                }
            }
        }
        for &maker in &makers {
            for &changer in &changers {
                earlier[changer].push((maker, Because::Writes(field)));
            }
        }
        let writers = || makers.iter().chain(&changers).copied();
        for k in with(&|law| reads(law) && !writes(law) && !before(law)) {
            earlier[k].extend(writers().map(|own| (own, Because::Writes(field))));
        }
        for k in with(&|law| reads(law) && !writes(law) && before(law)) {
            for writer in writers() {
                earlier[writer].push((k, Because::ReadsBefore(field)));
            }
        }
    }
    // What other fields say of two laws settles their tie.
    let tied = |(_, a, b): &&(Field, usize, usize)| {
        !comes_before(&earlier, *a, *b) && !comes_before(&earlier, *b, *a)
    };
    let Some(&(field, a, b)) = ties.iter().find(tied) else {
        return Ok(earlier);
    };
    Err(Problem::Incompatible {
        what: format!(
            "the laws `{}` and `{}` of the stage {} both change the field {}, and nothing says which comes first",
            laws[a].name(),
            laws[b].name(),
            stage.name(),
            name_of(field)
        ),
        remedy: "put them on different rungs (Law::rung), or leave one of the two effects out",
    })
}

/// Whether a law comes before another, directly or by laws between them.
fn comes_before(earlier: &Earlier, first: usize, then: usize) -> bool {
    let (mut seen, mut next) = (vec![false; earlier.len()], vec![then]);
    while let Some(k) = next.pop() {
        for &(before, _) in &earlier[k] {
            if !core::mem::replace(&mut seen[before], true) {
                next.push(before);
            }
        }
    }
    seen[first]
}

/// Laws that are each to come after the other.
fn cycle<T: Real, const D: usize>(
    laws: &[Box<dyn Law<T, D>>],
    earlier: &Earlier,
    left: &[usize],
    stage: Stage,
    name_of: &dyn Fn(Field) -> &'static str,
) -> Problem {
    // Each of those that are left waits for one of them: going back, one comes again.
    let mut way: Vec<usize> = vec![left[0]];
    let start = loop {
        let last = way[way.len() - 1];
        let waits = earlier[last].iter().find(|(k, _)| left.contains(k));
        let next = waits.map_or(last, |(k, _)| *k);
        if let Some(start) = way.iter().position(|&k| k == next) {
            break start;
        }
        way.push(next);
    };
    let mut round: Vec<usize> = way.split_off(start);
    round.reverse();
    let reasons = round.iter().enumerate().map(|(n, &k)| {
        let then = round[(n + 1) % round.len()];
        let why = earlier[then].iter().find(|(own, _)| *own == k);
        let why = why.map_or(String::new(), |(_, because)| match because {
            Because::Writes(field) => format!("writes {}", name_of(*field)),
            Because::ReadsBefore(field) => {
                format!("reads {} before it is written", name_of(*field))
            }
            Because::Rung(field) => format!("changes {} on a lower rung", name_of(*field)),
        });
        format!(
            "`{}` {why}, so it comes before `{}`",
            laws[k].name(),
            laws[then].name()
        )
    });
    Problem::Incompatible {
        what: format!(
            "laws of the stage {} are each to come before the other: {}",
            stage.name(),
            reasons.collect::<Vec<_>>().join("; ")
        ),
        remedy: "let one of them read the value before the other writes it (Law::before), or add its change to a rate \
                 instead (StepProgram::contribute)",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::{Chunk, Tally};
    use crate::name;

    const STRESS: Field = Field::tensor(name!("stress", "Pa"));
    const STRAIN: Field = Field::scalar(name!("strain", "1"));
    const FAILED: Field = Field::scalar(name!("failed", "1"));

    /// A law of a test.
    #[derive(Clone, Copy, Debug)]
    struct Plain {
        name: &'static str,
        reads: Fields,
        before: Fields,
        writes: Fields,
        adds: Fields,
        rung: Option<Rung>,
    }

    impl Plain {
        fn new(name: &'static str, reads: &[Field], writes: &[Field]) -> Self {
            Self {
                name,
                reads: Fields::of(reads),
                before: Fields::NONE,
                writes: Fields::of(writes),
                adds: Fields::NONE,
                rung: None,
            }
        }
        fn on(self, rung: Rung) -> Self {
            Self {
                rung: Some(rung),
                ..self
            }
        }
        fn adding(self) -> Self {
            Self {
                adds: self.writes,
                ..self
            }
        }
        fn before(self, field: Field) -> Self {
            let before = Fields::of(&[field]);
            Self {
                before,
                reads: self.reads.union(before),
                ..self
            }
        }
    }

    impl<T: Real, const D: usize> Law<T, D> for Plain {
        fn name(&self) -> &'static str {
            self.name
        }
        fn reads(&self) -> Fields {
            self.reads
        }
        fn writes(&self) -> Fields {
            self.writes
        }
        fn before(&self) -> Fields {
            self.before
        }
        fn adds(&self) -> Fields {
            self.adds
        }
        fn rung(&self) -> Option<Rung> {
            self.rung
        }
        fn apply(&self, _chunk: &mut Chunk<'_, T, D>) -> Tally {
            Tally::default()
        }
    }

    /// All orders of some laws.
    fn orders(laws: &[Plain]) -> Vec<Vec<Plain>> {
        if laws.is_empty() {
            return vec![Vec::new()];
        }
        let each = (0..laws.len()).flat_map(|k| {
            let mut others = laws.to_vec();
            let first = others.remove(k);
            orders(&others).into_iter().map(move |mut own| {
                own.insert(0, first);
                own
            })
        });
        each.collect()
    }

    /// The names of laws in their order, or why there is none; the same whatever the order of the list.
    fn found(laws: &[Plain]) -> Result<Vec<&'static str>, String> {
        let mut all = orders(laws).into_iter().map(|list| {
            let boxed: Vec<Box<dyn Law<f64, 2>>> = (list.iter())
                .map(|law| Box::new(*law) as Box<dyn Law<f64, 2>>)
                .collect();
            let order = sequence(&boxed, Stage::Continuity, &|field| field.name());
            let order = order.map_err(|problem| problem.to_string())?;
            Ok(order.into_iter().map(|k| list[k].name).collect())
        });
        let first = all.next().expect("an order");
        assert!(all.all(|own| own == first), "{first:?}");
        first
    }

    fn flow() -> Plain {
        Plain::new("plastic flow", &[STRESS, STRAIN], &[STRESS, STRAIN])
            .on(Rung::Flow)
            .before(FAILED)
    }

    fn failure() -> Plain {
        Plain::new("failure", &[STRESS, STRAIN], &[STRESS, FAILED]).on(Rung::Failure)
    }

    #[test]
    fn readers_follow_writers_and_rungs_rise() {
        let laws = [
            flow(),
            failure(),
            Plain::new("a look at both", &[STRESS, FAILED], &[]),
            Plain::new("stress of the trial", &[], &[STRESS]),
            Plain::new("by itself", &[], &[Field::DIVERGENCE]),
        ];
        let order = [
            "by itself",
            "stress of the trial",
            "plastic flow",
            "failure",
            "a look at both",
        ];
        assert_eq!(found(&laws).as_deref(), Ok(&order[..]));
    }

    #[test]
    fn another_field_settles_a_tie() {
        let reads = Plain::new("a", &[STRESS, STRAIN], &[STRESS]);
        let writes = Plain::new("b", &[STRESS], &[STRESS, STRAIN]);
        assert_eq!(found(&[reads, writes]).as_deref(), Ok(&["b", "a"][..]));
    }

    #[test]
    fn laws_that_add_follow_each_other_in_any_order() {
        let adds = |name| Plain::new(name, &[], &[Field::POSITION]).adding();
        let reads = Plain::new("a look", &[Field::POSITION], &[]);
        let order = ["one", "two", "a look"];
        assert_eq!(
            found(&[adds("two"), adds("one"), reads]).as_deref(),
            Ok(&order[..])
        );
        // One that changes what others add to has to say where it stands.
        let bounds = Plain::new("bounds", &[Field::POSITION], &[Field::POSITION]);
        let text = found(&[adds("one"), bounds]).expect_err("a tie");
        assert!(text.contains("`bounds` and `one`"), "{text}");
        let laws = [adds("one").on(Rung::Flow), bounds.on(Rung::Bound)];
        assert_eq!(found(&laws).as_deref(), Ok(&["one", "bounds"][..]));
    }

    #[test]
    fn what_has_no_order_is_refused_by_names() {
        let same = Plain::new("creep", &[STRESS], &[STRESS]).on(Rung::Flow);
        for other in [same, Plain::new("creep", &[STRESS], &[STRESS])] {
            let text = found(&[flow(), other]).expect_err("a tie");
            for part in [
                "`creep` and `plastic flow`",
                "the field stress",
                "Law::rung",
            ] {
                assert!(text.contains(part), "{part} in {text}");
            }
        }
        let makes = |name| Plain::new(name, &[], &[Field::PRESSURE]);
        let text = found(&[makes("two"), makes("one")]).expect_err("two makers");
        assert!(
            text.contains("`one` and `two`") && text.contains("pressure"),
            "{text}"
        );
    }

    #[test]
    fn a_circle_is_refused_with_the_way_round() {
        let a = Plain::new("a", &[Field::ENERGY], &[Field::PRESSURE]);
        let b = Plain::new("b", &[Field::PRESSURE], &[Field::DENSITY]);
        let c = Plain::new("c", &[Field::DENSITY], &[Field::ENERGY]);
        let text = found(&[a, b, c]).expect_err("a circle");
        for part in [
            "`a` writes pressure, so it comes before `b`",
            "`b` writes density, so it comes before `c`",
            "`c` writes energy, so it comes before `a`",
            "Law::before",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        // Of what the step before has left there is no circle.
        let old = Plain::new("a", &[], &[Field::PRESSURE]).before(Field::ENERGY);
        assert_eq!(found(&[old, b, c]).as_deref(), Ok(&["a", "b", "c"][..]));
    }
}
