//! The members of a JSON object in the order of the file.

use super::tree::Member;
use foldhash::fast::RandomState;
use hashbrown::HashTable;
use std::hash::BuildHasher;

/// Maximum number of members for linear search; larger objects have a hash table. Most objects of a
/// scene have one to four members, and a hash table costs more than their search.
const MAX_SEARCHED: usize = 8;

/// The members of a JSON object in the order of the file, each key once.
#[derive(Clone, Debug, Default)]
pub struct Members {
    entries: Vec<(String, Member)>,
    /// Positions in `entries` by key; `None` for few members.
    positions: Option<Positions>,
}

#[derive(Clone, Debug, Default)]
struct Positions {
    table: HashTable<usize>,
    state: RandomState,
}

impl Members {
    /// Number of members.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether the object is empty.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    fn position(&self, key: &str) -> Option<usize> {
        match &self.positions {
            None => self.entries.iter().position(|(known, _)| known == key),
            Some(Positions { table, state }) => {
                let is_key = |at: &usize| self.entries.get(*at).is_some_and(|(known, _)| known == key);
                table.find(state.hash_one(key), is_key).copied()
            }
        }
    }

    /// Whether there is a member with a key.
    pub fn contains_key(&self, key: &str) -> bool {
        self.position(key).is_some()
    }

    /// Returns the member with a key.
    pub fn get(&self, key: &str) -> Option<&Member> {
        self.get_key_value(key).map(|(_, member)| member)
    }

    /// Returns the member with a key, and the key.
    pub fn get_key_value(&self, key: &str) -> Option<(&String, &Member)> {
        self.entries.get(self.position(key)?).map(|(key, member)| (key, member))
    }

    /// Returns the member with a key for modification.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Member> {
        let at = self.position(key)?;
        self.at_mut(at)
    }

    /// Returns the member at a position.
    pub fn at_mut(&mut self, at: usize) -> Option<&mut Member> {
        Some(&mut self.entries.get_mut(at)?.1)
    }

    /// Replaces the member with a key, or appends a member.
    pub fn insert(&mut self, key: String, member: Member) {
        match self.get_mut(&key) {
            Some(known) => *known = member,
            None => self.append(key, member),
        }
    }

    /// Returns the member with a key and appends `new` if no member has the key.
    pub fn get_or_append(&mut self, key: &str, new: Member) -> Option<&mut Member> {
        let at = self.position(key).unwrap_or(self.entries.len());
        if at == self.entries.len() {
            self.append(key.to_owned(), new);
        }
        self.at_mut(at)
    }

    /// Appends a member whose key is new.
    pub fn append(&mut self, key: String, member: Member) {
        let at = self.entries.len();
        let hash = self.positions.as_ref().map(|positions| positions.state.hash_one(&key));
        self.entries.push((key, member));
        match (&mut self.positions, hash) {
            (Some(Positions { table, state }), Some(hash)) => {
                let entries = &self.entries;
                table.insert_unique(hash, at, |at| state.hash_one(entries.get(*at).map_or("", |(key, _)| key)));
            }
            _ => self.find_positions(),
        }
    }

    /// Inserts members with new keys one after another, each at its position, or at the end if the
    /// position is beyond it.
    pub fn insert_each(&mut self, new: impl IntoIterator<Item = (usize, String, Member)>) {
        for (at, key, member) in new {
            self.entries.insert(at.min(self.entries.len()), (key, member));
        }
        self.find_positions();
    }

    /// Removes the member with a key; the others keep their order.
    pub fn remove(&mut self, key: &str) -> Option<Member> {
        let (_, member) = self.entries.remove(self.position(key)?);
        self.find_positions();
        Some(member)
    }

    /// Rebuilds the hash table.
    fn find_positions(&mut self) {
        self.positions = None;
        if self.entries.len() > MAX_SEARCHED {
            let Positions { mut table, state } = Positions::default();
            let hash = |at: &usize| state.hash_one(self.entries.get(*at).map_or("", |(key, _)| key));
            for at in 0..self.entries.len() {
                table.insert_unique(hash(&at), at, hash);
            }
            self.positions = Some(Positions { table, state });
        }
    }

    /// The members with their keys.
    pub fn iter(&self) -> impl Iterator<Item = (&String, &Member)> {
        self.entries.iter().map(|(key, member)| (key, member))
    }

    /// The members with their keys.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (&String, &mut Member)> {
        self.entries.iter_mut().map(|(key, member)| (&*key, member))
    }

    /// The keys.
    pub fn keys(&self) -> impl Iterator<Item = &String> + Clone {
        self.entries.iter().map(|(key, _)| key)
    }

    /// The members.
    pub fn values(&self) -> impl Iterator<Item = &Member> {
        self.entries.iter().map(|(_, member)| member)
    }
}

impl IntoIterator for Members {
    type Item = (String, Member);
    type IntoIter = std::vec::IntoIter<(String, Member)>;

    fn into_iter(self) -> Self::IntoIter {
        self.entries.into_iter()
    }
}

impl FromIterator<(String, Member)> for Members {
    fn from_iter<I: IntoIterator<Item = (String, Member)>>(members: I) -> Self {
        let mut all = Self::default();
        members.into_iter().for_each(|(key, member)| all.insert(key, member));
        all
    }
}

/// Objects are equal whatever the order of their members.
impl PartialEq for Members {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().all(|(key, member)| other.get(key) == Some(member))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(value: usize) -> Member {
        Member { key_place: None, node: serde_json::Value::from(value).into() }
    }

    #[test]
    fn members_are_found_in_small_and_large_objects() {
        let mut members = Members::default();
        for i in 0..100 {
            members.insert(format!("k{i}"), member(i));
            members.insert("k0".to_owned(), member(i));
            assert_eq!((members.len(), members.get(&format!("k{i}"))), (i + 1, Some(&member(i))));
        }
        for i in 0..90 {
            assert_eq!(members.remove(&format!("k{i}")), Some(member(if i == 0 { 99 } else { i })));
            assert_eq!(members.keys().next(), Some(&format!("k{}", i + 1)));
            assert!(!members.contains_key("k0") && members.contains_key("k99"));
        }
        members.insert_each([(1, "new".to_owned(), member(7))]);
        let keys: Vec<&String> = members.keys().collect();
        assert_eq!(keys[..3], ["k90", "new", "k91"]);
        let mut other: Members = members.clone().into_iter().rev().collect();
        assert_eq!(members, other);
        other.insert("new".to_owned(), member(8));
        assert_ne!(members, other);
    }
}
