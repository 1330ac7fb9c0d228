//! The terms of a sum: those of one window, and those of all windows in one pair of arrays.

use crate::threads::map;

/// The terms of a part of the result, in the order of their codes.
pub(super) struct Piece<V> {
    pub(super) keys: Vec<u128>,
    pub(super) values: Vec<V>,
}

impl<V> Piece<V> {
    pub(super) fn new() -> Self {
        Piece { keys: Vec::new(), values: Vec::new() }
    }

    /// Removes all terms and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.keys.clear();
        self.values.clear();
    }
}

/// The terms of the windows that are done.
///
/// The arrays of numbers have room for the terms that are expected. Zeros that nobody has written to take no memory, so too much room costs nothing.
pub(super) struct Collection<V> {
    whole: Piece<V>,
    /// Number of terms in `whole`; its arrays are longer if the values are numbers.
    terms: usize,
    expected: usize,
}

impl<V: Clone + Send + Sync> Collection<V> {
    /// No terms yet, and about `expected` to come.
    pub(super) fn new(expected: usize) -> Self {
        Collection { whole: Piece::new(), terms: 0, expected }
    }

    /// Takes the terms of the next windows, in order, and empties the pieces. All threads copy numbers; values that own memory are moved.
    pub(super) fn append(&mut self, pieces: &mut [Piece<V>], zero: &V) {
        if std::mem::needs_drop::<V>() {
            for piece in pieces {
                self.whole.keys.append(&mut piece.keys);
                self.whole.values.append(&mut piece.values);
            }
            self.terms = self.whole.keys.len();
            return;
        }
        let added = pieces.iter().map(|piece| piece.keys.len()).sum::<usize>();
        self.make_room(self.terms + added, zero);
        let (mut free_keys, mut free_values) =
            (&mut self.whole.keys[self.terms..], &mut self.whole.values[self.terms..]);
        let mut places = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let (keys, rest_of_keys) = free_keys.split_at_mut(piece.keys.len());
            let (values, rest_of_values) = free_values.split_at_mut(piece.keys.len());
            places.push((piece, keys, values));
            (free_keys, free_values) = (rest_of_keys, rest_of_values);
        }
        let copy = |(piece, keys, values): (&mut Piece<V>, &mut [u128], &mut [V])| {
            keys.copy_from_slice(&piece.keys);
            values.clone_from_slice(&piece.values);
            piece.clear();
        };
        map(places, copy);
        self.terms += added;
    }

    /// Makes the arrays long enough for `terms` terms.
    fn make_room(&mut self, terms: usize, zero: &V) {
        if terms <= self.whole.keys.len() {
            return;
        }
        let length = self.expected.max(terms + terms / 4);
        let mut longer = Piece { keys: vec![0; length], values: vec![zero.clone(); length] };
        longer.keys[..self.terms].copy_from_slice(&self.whole.keys[..self.terms]);
        longer.values[..self.terms].clone_from_slice(&self.whole.values[..self.terms]);
        self.whole = longer;
    }

    /// All terms.
    pub(super) fn finish(mut self) -> Piece<V> {
        self.whole.keys.truncate(self.terms);
        self.whole.values.truncate(self.terms);
        self.whole.keys.shrink_to_fit();
        self.whole.values.shrink_to_fit();
        self.whole
    }
}
