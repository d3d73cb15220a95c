//! How a chain of rods is put together: the same for its acoustic solution and for that by Godunov's method.
//! Each has segments of its own.

/// The methods of a chain with the fields `start`, `segments`, `contacts`, `next` and `ends`.
macro_rules! chain_of_rods {
    () => {
        /// Puts the left end of the chain at `x` \[m\].
        #[must_use]
        pub fn starting_at(mut self, x: f64) -> Self {
            self.start = x;
            self
        }
        /// Appends a segment on the right.
        #[must_use]
        pub fn segment(mut self, segment: RodSegment) -> Self {
            if !self.segments.is_empty() {
                self.contacts.push(self.next);
            }
            self.next = Contact::Bonded;
            self.segments.push(segment);
            self
        }
        /// How the last segment and the one that is appended next touch.
        #[must_use]
        pub fn contact(mut self, contact: Contact) -> Self {
            self.next = contact;
            self
        }
        /// What is at the left end; [`End::Free`] unless set.
        #[must_use]
        pub fn left_end(mut self, end: End) -> Self {
            self.ends[0] = end;
            self
        }
        /// What is at the right end; [`End::Free`] unless set.
        #[must_use]
        pub fn right_end(mut self, end: End) -> Self {
            self.ends[1] = end;
            self
        }

        /// Refuses a chain that is nowhere or has no segments.
        fn check_chain(&self) -> Result<(), StudyError> {
            finite("the left end of the chain [m]", self.start)?;
            if self.segments.is_empty() {
                return Err(StudyError::Count {
                    quantity: "the number of segments needed",
                    value: 1,
                    available: 0,
                    action: "call `segment` before `solve`",
                });
            }
            Ok(())
        }
    };
}
pub(super) use chain_of_rods;
