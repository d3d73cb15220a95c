//! What processes show each other between calls: questions and answers, beside the messages of all.
//! Whoever waits for something answers meanwhile, so no two wait for each other.

use ferrompi::{Communicator, Request, Source};
use meshfree::error::Failure;
use meshfree::ranks::Offer;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Tags of messages between two processes.
const QUESTION: i32 = 7001;
const ANSWER: i32 = 7002;

/// First byte of an answer: whether the offer stands.
const WITHDRAWN: u8 = 0;
const STANDS: u8 = 1;

/// Offers of this process, and what has come and waits.
#[derive(Default)]
struct Post {
    made: u64,
    standing: Vec<(u64, Offer)>,
    /// Who asks for which part of which offer.
    questions: Vec<(i32, [u64; 2])>,
    answers: Vec<(i32, Vec<u8>)>,
}

#[derive(Default)]
pub(crate) struct Offers(Mutex<Post>);

impl Offers {
    fn post(&self) -> MutexGuard<'_, Post> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn make(&self, own: Offer) -> u64 {
        let mut post = self.post();
        let number = post.made;
        post.standing.push((number, own));
        post.made += 1;
        number
    }

    pub fn withdraw(&self, number: u64) {
        self.post().standing.retain(|own| own.0 != number);
    }

    /// Whether another process may ask.
    pub fn stand(&self) -> bool {
        !self.post().standing.is_empty()
    }

    /// Waits for what all processes do at once.
    pub fn wait(&self, world: &Communicator, mut request: Request<'_>) -> ferrompi::Result<()> {
        while request.test()?.is_none() {
            self.post().answer(world)?;
            std::thread::yield_now();
        }
        Ok(())
    }

    /// Asks another process, and waits for its answer.
    pub fn ask(
        &self,
        world: &Communicator,
        rank: i32,
        question: [u64; 2],
    ) -> Result<Vec<u8>, Failure> {
        let mut post = self.post();
        post.send(
            world,
            question.map(u64::to_ne_bytes).as_flattened(),
            rank,
            QUESTION,
        )?;
        loop {
            post.answer(world)?;
            if let Some(k) = post.answers.iter().position(|own| own.0 == rank) {
                let (_, mut answer) = post.answers.swap_remove(k);
                return match answer.pop() {
                    Some(STANDS) => Ok(answer),
                    _ => Err(format!("rank {rank} has withdrawn what it has offered").into()),
                };
            }
            std::thread::yield_now();
        }
    }
}

impl Post {
    /// Answers what others have asked of offers that were made.
    fn answer(&mut self, world: &Communicator) -> ferrompi::Result<()> {
        loop {
            self.take_in(world)?;
            let of_made = |own: &(i32, [u64; 2])| own.1[0] < self.made;
            let Some(k) = self.questions.iter().position(of_made) else {
                return Ok(());
            };
            let (to, [number, part]) = self.questions.swap_remove(k);
            let offer = self.standing.iter().find(|own| own.0 == number);
            let mut answer = offer.map_or_else(Vec::new, |own| own.1(part as usize));
            answer.push(if offer.is_some() { STANDS } else { WITHDRAWN });
            self.send(world, &answer, to, ANSWER)?;
        }
    }

    /// Sends a message, and takes in what comes meanwhile: the other process may be sending too.
    fn send(
        &mut self,
        world: &Communicator,
        bytes: &[u8],
        to: i32,
        tag: i32,
    ) -> ferrompi::Result<()> {
        ferrompi::scope(|scope| {
            let mut sent = world.isend(scope, bytes, to, tag)?;
            while sent.test()?.is_none() {
                self.take_in(world)?;
                std::thread::yield_now();
            }
            Ok(())
        })
    }

    fn take_in(&mut self, world: &Communicator) -> ferrompi::Result<()> {
        for tag in [QUESTION, ANSWER] {
            while let Some(there) = world.iprobe::<u8>(Source::Any, tag)? {
                let mut bytes = vec![0; there.count.unwrap_or(0)];
                world.recv(&mut bytes, there.source, tag)?;
                let Source::Rank(from) = there.source else {
                    continue;
                };
                if tag == ANSWER {
                    self.answers.push((from, bytes));
                } else if let Ok([number, part]) = <[[u8; 8]; 2]>::try_from(bytes.as_chunks().0) {
                    let question = [number, part].map(u64::from_ne_bytes);
                    self.questions.push((from, question));
                }
            }
        }
        Ok(())
    }
}
