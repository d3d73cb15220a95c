//! What a rank offers to show the others between calls: the table that implementations of [`Ranks`](super::Ranks) keep.
//! Offers are numbered in the order in which they are made, which is the same on all ranks.

use std::sync::Arc;

/// Gives a part of what a rank shows, by the number of the part, as bytes.
pub type Offer = Arc<dyn Fn(usize) -> Vec<u8> + Send + Sync>;

/// The offers of a rank.
///
/// ```
/// use meshfree::ranks::Offers;
/// use std::sync::Arc;
/// let mut offers = Offers::default();
/// let number = offers.make(Arc::new(|part| vec![part as u8; 2]));
/// assert_eq!(offers.find(number).map(|offer| offer(7)), Some(vec![7, 7]));
/// offers.withdraw(number);
/// assert!(offers.find(number).is_none() && offers.was_made(number));
/// ```
#[derive(Clone, Default)]
pub struct Offers {
    made: u64,
    standing: Vec<(u64, Offer)>,
}

impl Offers {
    /// Adds an offer, and returns its number: how many were made before.
    pub fn make(&mut self, offer: Offer) -> u64 {
        let number = self.made;
        self.standing.push((number, offer));
        self.made += 1;
        number
    }

    /// Removes an offer.
    pub fn withdraw(&mut self, number: u64) {
        self.standing.retain(|offer| offer.0 != number);
    }

    /// The offer with a number, if it was made and is not withdrawn.
    #[must_use]
    pub fn find(&self, number: u64) -> Option<&Offer> {
        let offer = self.standing.iter().find(|offer| offer.0 == number);
        offer.map(|offer| &offer.1)
    }

    /// Whether the offer with a number was made; it may be withdrawn.
    #[must_use]
    pub fn was_made(&self, number: u64) -> bool {
        number < self.made
    }

    /// Whether all offers are withdrawn.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.standing.is_empty()
    }
}

impl core::fmt::Debug for Offers {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} of {} offers", self.standing.len(), self.made)
    }
}
