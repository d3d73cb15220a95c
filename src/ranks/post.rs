//! Numbers that ranks send each other: so many to each, who learns first how many come.
//! Where a rank has failed nothing comes.

use super::{Letters, Plain, Taken, Team, put_numbers};

impl Team {
    /// Sends each rank so many of these, one rank after another, and gets what each sends to this one, and how many.
    pub fn letters<V: Plain>(
        &self,
        (own, to): (&[V], &[usize]),
        letters: Letters,
    ) -> (Vec<V>, Vec<usize>) {
        let from = self.counts(to);
        match self.post((own, to), &from, letters) {
            Some(come) => (come, from),
            None => (Vec::new(), vec![0; self.count()]),
        }
    }

    /// How many each rank sends to this one, which sends so many to each.
    pub fn counts(&self, to: &[usize]) -> Vec<usize> {
        let own: Vec<u32> = to.iter().map(|count| *count as u32).collect();
        let each = vec![1; self.count()];
        let come = self.post((&own, &each), &each, Letters::Each(size_of::<u32>()));
        let come = come.unwrap_or_else(|| vec![0; self.count()]);
        come.into_iter().map(|count| count as usize).collect()
    }

    /// Sends each rank so many of these, and gets so many of each.
    pub fn post<V: Plain>(
        &self,
        (own, to): (&[V], &[usize]),
        from: &[usize],
        letters: Letters,
    ) -> Option<Vec<V>> {
        let (mut message, mut numbers) = (Vec::with_capacity(size_of_val(own)), Vec::new());
        put_numbers(own, &mut message);
        let come = self.post_bytes((&message, to), from, (size_of::<V>(), letters))?;
        Taken(&come).more(from.iter().sum(), &mut numbers)?;
        Some(numbers)
    }

    /// The same of what takes so many bytes each.
    pub fn post_bytes(
        &self,
        (own, to): (&[u8], &[usize]),
        from: &[usize],
        (each, letters): (usize, Letters),
    ) -> Option<Vec<u8>> {
        let bytes = |counts: &[usize]| -> Vec<usize> { counts.iter().map(|n| each * n).collect() };
        let (to, from) = (bytes(to), bytes(from));
        let mut come = vec![0; from.iter().sum()];
        self.exchange(letters, (own, &to), (&mut come, &from))
            .then_some(come)
    }
}

#[cfg(test)]
mod tests {
    use super::super::in_threads;
    use super::*;
    use crate::error::{Error, Problem};

    #[test]
    fn each_gets_what_is_meant_for_it() {
        let all = in_threads(3, 1, |ranks| {
            let team = Team::new(ranks);
            let rank = team.rank();
            // Rank r sends k numbers to rank k, of which each says from whom to whom it goes.
            let own: Vec<[f64; 2]> = [1, 2, 2].map(|k| [rank as f64, f64::from(k)]).into();
            let all = team.letters((&own, &[0, 1, 2]), Letters::Moved);
            // Nothing comes where a rank has failed, and all know.
            if rank == 2 {
                let wrong = Err::<(), _>(Error::Argument(Problem::EmptyScene));
                assert!(team.agree(None, wrong).is_err());
            }
            let none = team.letters((&own, &[0, 1, 2]), Letters::Moved);
            (all, none)
        });
        for (rank, (all, none)) in all.expect("threads").into_iter().enumerate() {
            let come = (0..3).flat_map(|from| vec![[f64::from(from), rank as f64]; rank]);
            assert_eq!(all, (come.collect(), vec![rank; 3]));
            assert_eq!(none, (Vec::new(), vec![0; 3]));
        }
    }
}
