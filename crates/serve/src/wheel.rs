//! Which page steers. Any number of pages may watch; one steers.

/// A page, by a number that none had before it.
pub type PageId = u64;

/// The wheel, and who watches.
#[derive(Debug, Default)]
pub struct Wheel {
    /// Counts up with every change.
    pub number: u64,
    steering: Option<PageId>,
    pages: Vec<PageId>,
}

impl Wheel {
    /// A page comes; it steers when nobody else does.
    pub fn come(&mut self, page: PageId) {
        self.number += 1;
        self.pages.push(page);
        self.steering.get_or_insert(page);
    }

    /// A page goes. If it steered, the only page that is left steers; of several none does before one asks.
    pub fn go(&mut self, page: PageId) {
        self.number += 1;
        self.pages.retain(|other| *other != page);
        self.steering = self.steering.filter(|steering| *steering != page);
        if let [alone] = self.pages[..] {
            self.steering.get_or_insert(alone);
        }
    }

    /// A page takes it, from whomever has it: the people who watch can talk to each other.
    pub fn take(&mut self, page: PageId) {
        self.number += 1;
        self.steering = Some(page);
    }

    /// Whether this page steers.
    pub fn is_steered_by(&self, page: PageId) -> bool {
        self.steering == Some(page)
    }

    /// Whether nobody steers.
    pub fn is_free(&self) -> bool {
        self.steering.is_none()
    }

    /// How many pages are there.
    pub fn watching(&self) -> usize {
        self.pages.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_steers_and_it_can_change_hands() {
        let mut wheel = Wheel::default();
        wheel.come(1);
        wheel.come(2);
        assert!(wheel.is_steered_by(1) && !wheel.is_steered_by(2));
        wheel.go(2);
        assert!(wheel.is_steered_by(1) && wheel.watching() == 1);
        wheel.come(3);
        wheel.take(3);
        assert!(wheel.is_steered_by(3) && !wheel.is_steered_by(1));
        wheel.come(4);
        wheel.go(3);
        assert!(wheel.is_free() && wheel.watching() == 2, "two are left: neither is preferred");
        wheel.go(4);
        assert!(wheel.is_steered_by(1) && wheel.watching() == 1, "one is left");
        wheel.go(1);
        assert!(wheel.is_free() && wheel.watching() == 0);
        wheel.come(5);
        assert!(wheel.is_steered_by(5));
    }
}
