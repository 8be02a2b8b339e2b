//! Steering: any number of pages may watch, one of them steers.

/// Unique number of a page.
pub type PageId = u64;

/// Steering state: the connected pages, and the one that steers.
#[derive(Debug, Default)]
pub struct Wheel {
    /// Sequence number, which increases with every change.
    pub number: u64,
    steering: Option<PageId>,
    pages: Vec<PageId>,
}

impl Wheel {
    /// Adds a page; it steers if no other does.
    pub fn add(&mut self, page: PageId) {
        self.number += 1;
        self.pages.push(page);
        self.steering.get_or_insert(page);
    }

    /// Removes a page. If it steered, a single remaining page steers; several wait until one takes
    /// the wheel.
    pub fn remove(&mut self, page: PageId) {
        self.number += 1;
        self.pages.retain(|other| *other != page);
        self.steering = self.steering.filter(|steering| *steering != page);
        if let [alone] = self.pages[..] {
            self.steering.get_or_insert(alone);
        }
    }

    /// Gives the wheel to a page, even if another one steers: people who watch can talk to each
    /// other.
    pub fn take(&mut self, page: PageId) {
        self.number += 1;
        self.steering = Some(page);
    }

    /// Returns whether this page steers.
    pub fn is_steered_by(&self, page: PageId) -> bool {
        self.steering == Some(page)
    }

    /// Returns whether no page steers.
    pub fn is_free(&self) -> bool {
        self.steering.is_none()
    }

    /// Returns the number of connected pages.
    pub fn watching(&self) -> usize {
        self.pages.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_page_at_a_time_has_control_and_can_pass_it_on() {
        let mut wheel = Wheel::default();
        wheel.add(1);
        wheel.add(2);
        assert!(wheel.is_steered_by(1) && !wheel.is_steered_by(2));
        wheel.remove(2);
        assert!(wheel.is_steered_by(1) && wheel.watching() == 1);
        wheel.add(3);
        wheel.take(3);
        assert!(wheel.is_steered_by(3) && !wheel.is_steered_by(1));
        wheel.add(4);
        wheel.remove(3);
        assert!(wheel.is_free() && wheel.watching() == 2, "two are left: neither is preferred");
        wheel.remove(4);
        assert!(wheel.is_steered_by(1) && wheel.watching() == 1, "one is left");
        wheel.remove(1);
        assert!(wheel.is_free() && wheel.watching() == 0);
        wheel.add(5);
        assert!(wheel.is_steered_by(5));
    }
}
