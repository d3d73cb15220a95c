//! Questions for the offers of other processes, and answers: messages between two processes.
//! A process that waits answers meanwhile, so two processes never wait for each other.

use ferrompi::{Communicator, Request, Source};
use meshfree::error::Failure;
use meshfree::ranks::{Offer, Offers};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Tags of messages between two processes.
const QUESTION: i32 = 7001;
const ANSWER: i32 = 7002;

/// Last byte of an answer: whether the offer stands.
const WITHDRAWN: u8 = 0;
const STANDS: u8 = 1;

/// The offers of this process, and messages that have come.
#[derive(Default)]
struct Post {
    offers: Offers,
    /// Ranks that ask, with the numbers of the offer and of its part.
    questions: Vec<(i32, [u64; 2])>,
    /// Ranks that answer, and their answers.
    answers: Vec<(i32, Vec<u8>)>,
}

/// Questions and answers of this process.
#[derive(Default)]
pub(crate) struct PostOffice(Mutex<Post>);

impl PostOffice {
    fn post(&self) -> MutexGuard<'_, Post> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn make(&self, offer: Offer) -> u64 {
        self.post().offers.make(offer)
    }

    pub fn withdraw(&self, number: u64) {
        self.post().offers.withdraw(number);
    }

    /// Whether another process may ask.
    pub fn has_offers(&self) -> bool {
        !self.post().offers.is_empty()
    }

    /// Waits for a request, and answers questions meanwhile.
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
    /// Answers all questions for offers that were made.
    fn answer(&mut self, world: &Communicator) -> ferrompi::Result<()> {
        loop {
            self.receive(world)?;
            let of_made = |own: &(i32, [u64; 2])| self.offers.was_made(own.1[0]);
            let Some(k) = self.questions.iter().position(of_made) else {
                return Ok(());
            };
            let (to, [number, part]) = self.questions.swap_remove(k);
            let offer = self.offers.find(number);
            let mut answer = offer.map_or_else(Vec::new, |own| own(part as usize));
            answer.push(if offer.is_some() { STANDS } else { WITHDRAWN });
            self.send(world, &answer, to, ANSWER)?;
        }
    }

    /// Sends a message, and receives others meanwhile: the other process may be sending too.
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
                self.receive(world)?;
                std::thread::yield_now();
            }
            Ok(())
        })
    }

    /// Receives all questions and answers that have come.
    fn receive(&mut self, world: &Communicator) -> ferrompi::Result<()> {
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
