//! Results that serve more than one scene or one call, kept within a bound of memory. They affect only the time of a later result.

use std::collections::{HashMap, VecDeque};
use std::fmt;
use std::hash::Hash;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A result that is kept.
pub(crate) trait Keep {
    /// Its memory, in bytes.
    fn memory(&self) -> usize;
}

/// Which result goes where the memory does not suffice.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Goes {
    /// The one that was kept first: for results that are asked for again soon.
    Oldest,
    /// The one that is to be kept: for results that are asked for in turn, where the oldest is the next.
    Newest,
}

/// Results by what they depend on.
pub(crate) struct Kept<K, V> {
    most: usize,
    goes: Goes,
    results: Mutex<Results<K, V>>,
}

/// A result, once it is made.
type Slot<V> = Arc<Mutex<Option<Arc<V>>>>;

struct Results<K, V> {
    /// With the memory of each, once it is made.
    by_key: HashMap<K, (Slot<V>, Option<usize>)>,
    /// The keys in the order in which they were first made, if the oldest goes.
    made: VecDeque<K>,
    memory: usize,
}

impl<K: Clone + Eq + Hash, V: Keep> Kept<K, V> {
    /// None yet, of `most` bytes together.
    pub(crate) fn new(most: usize, goes: Goes) -> Self {
        let results = Results { by_key: HashMap::new(), made: VecDeque::new(), memory: 0 };
        Self { most, goes, results: Mutex::new(results) }
    }

    /// The result of a key, if it is kept.
    pub(crate) fn get(&self, key: &K) -> Option<Arc<V>> {
        let slot = Arc::clone(&self.results().by_key.get(key)?.0);
        let result = slot.lock().unwrap_or_else(PoisonError::into_inner);
        result.clone()
    }

    /// The kept result of a key if it serves, otherwise the one that `make` makes. If another thread is making it, this thread waits.
    ///
    /// # Errors
    /// Those of `make`.
    pub(crate) fn of<E>(
        &self,
        key: K,
        serves: impl Fn(&V) -> bool,
        make: impl FnOnce() -> Result<V, E>,
    ) -> Result<Arc<V>, E> {
        let slot = Arc::clone(&self.results().by_key.entry(key.clone()).or_default().0);
        // If another thread panicked, the slot is as it was.
        let mut known = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(result) = known.as_ref().filter(|result| serves(result)) {
            return Ok(Arc::clone(result));
        }
        let result = Arc::new(make()?);
        *known = Some(Arc::clone(&result));
        drop(known);
        self.count(key, slot, result.memory());
        Ok(result)
    }

    /// Keeps a result. One that is kept already may have grown, and is counted anew.
    pub(crate) fn keep(&self, key: K, result: Arc<V>) {
        let memory = result.memory();
        self.count(key, Arc::new(Mutex::new(Some(result))), memory);
    }

    /// Keeps a result of so much memory, as far as there is room.
    fn count(&self, key: K, slot: Slot<V>, memory: usize) {
        let mut results = self.results();
        let counted = results.by_key.remove(&key).and_then(|(_, memory)| memory);
        results.memory -= counted.unwrap_or(0);
        if memory > self.most || self.goes == Goes::Newest && results.memory + memory > self.most {
            return;
        }
        while results.memory + memory > self.most
            && let Some(oldest) = results.made.pop_front()
        {
            let gone = results.by_key.remove(&oldest).and_then(|(_, memory)| memory);
            results.memory -= gone.unwrap_or(0);
        }
        if self.goes == Goes::Oldest && counted.is_none() {
            results.made.push_back(key.clone());
        }
        results.memory += memory;
        results.by_key.insert(key, (slot, Some(memory)));
    }

    /// Each change leaves the results and their memory in accord, also if a thread panicked after it.
    fn results(&self) -> MutexGuard<'_, Results<K, V>> {
        self.results.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<K, V> fmt::Debug for Kept<K, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let results = self.results.lock().unwrap_or_else(PoisonError::into_inner);
        write!(f, "{} results in {} bytes", results.by_key.len(), results.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Keep for Vec<u8> {
        fn memory(&self) -> usize {
            self.len()
        }
    }

    fn of(kept: &Kept<u64, Vec<u8>>, key: u64, bytes: usize) -> Arc<Vec<u8>> {
        let made: Result<_, ()> = kept.of(key, |known| known.len() >= bytes, || Ok(vec![0; bytes]));
        made.expect("made")
    }

    #[test]
    fn a_result_is_made_once_and_again_if_it_does_not_serve() {
        let kept = Kept::new(100, Goes::Oldest);
        let first = of(&kept, 1, 8);
        assert!([8, 5].iter().all(|&bytes| Arc::ptr_eq(&first, &of(&kept, 1, bytes))));
        let longer = of(&kept, 1, 9);
        assert!(!Arc::ptr_eq(&first, &longer) && Arc::ptr_eq(&longer, &of(&kept, 1, 8)));
        assert!(kept.results().memory == 9 && kept.get(&1).is_some() && kept.get(&2).is_none());
    }

    #[test]
    fn the_oldest_or_the_newest_goes_where_memory_ends() {
        let kept = Kept::new(20, Goes::Oldest);
        let [first, second] = [1, 2].map(|key| of(&kept, key, 10));
        let third = of(&kept, 3, 10);
        assert!(kept.get(&1).is_none() && Arc::ptr_eq(&second, &of(&kept, 2, 10)) && kept.results().memory == 20);
        assert!(Arc::ptr_eq(&third, &of(&kept, 3, 10)) && !Arc::ptr_eq(&first, &of(&kept, 1, 10)));
        assert!(of(&kept, 4, 21).len() == 21 && kept.get(&4).is_none() && kept.results().memory <= 20);

        let kept = Kept::new(20, Goes::Newest);
        for key in 1..=3 {
            kept.keep(key, Arc::new(vec![0; 10]));
        }
        assert!([1, 2].iter().all(|key| kept.get(key).is_some()) && kept.get(&3).is_none());
        kept.keep(2, Arc::new(vec![0; 4]));
        kept.keep(2, Arc::new(vec![0; 4]));
        let results = kept.results();
        assert_eq!((results.memory, results.by_key.len()), (14, 2));
    }

    #[test]
    fn a_result_that_fails_is_tried_again() {
        let kept: Kept<u64, Vec<u8>> = Kept::new(20, Goes::Oldest);
        assert_eq!(kept.of(1, |_| true, || Err("no")), Err("no"));
        assert_eq!(of(&kept, 1, 3).len(), 3);
    }
}
