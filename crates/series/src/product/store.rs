//! Storage for the sums of one window of codes: an array, or an open-addressing table.
//!
//! Both return their sums in ascending order of the codes, so the order of a table has no effect.

use super::code::Key;

/// Sums by code.
pub(super) trait Store<K, S> {
    /// Prepares for `span` codes from `low` on, with about `pairs` products.
    fn open(&mut self, low: K, span: usize, pairs: usize);

    /// The sum at a code of the window.
    fn cell(&mut self, key: K) -> &mut S;

    /// Passes all sums to `take` in the order of their codes, and empties the store.
    fn drain(&mut self, take: &mut impl FnMut(K, S));
}

/// A cell for every code of the window.
pub(super) struct Array<K, S> {
    low: K,
    cells: Vec<S>,
}

impl<K: Key, S> Array<K, S> {
    pub(super) fn new() -> Self {
        Array { low: K::NONE, cells: Vec::new() }
    }
}

impl<K: Key, S: Clone + Default> Store<K, S> for Array<K, S> {
    fn open(&mut self, low: K, span: usize, _pairs: usize) {
        self.low = low;
        // Draining leaves the cells at zero.
        self.cells.resize(span, S::default());
    }

    #[inline(always)]
    fn cell(&mut self, key: K) -> &mut S {
        &mut self.cells[key.offset(self.low)]
    }

    fn drain(&mut self, take: &mut impl FnMut(K, S)) {
        let low = self.low.widened();
        for (code, cell) in (low..).zip(&mut self.cells) {
            take(K::narrowed(code), std::mem::take(cell));
        }
    }
}

/// A hash table with linear probing, at most half full. It is reused from window to window.
pub(super) struct Table<K, S> {
    low: K,
    /// 2 to this power exceeds the number of codes of the window.
    span_bits: u32,
    slots: Vec<(K, S)>,
    /// Number of leading bits of the hash that are not part of the position.
    shift: u32,
    held: usize,
    /// Codes minus the first code of the window, each with its position in the low bits; and space to sort them.
    order: Vec<u64>,
    sorted: Vec<u64>,
}

/// The first table has one slot for this many products: about a quarter of the products give a term of their own.
const PRODUCTS_PER_SLOT: usize = 2;
const SMALLEST: usize = 1 << (NEIGHBOURS + 1);
/// Number of lowest bits of a code that the hash does not change, so that neighbouring terms lie in the same or the next cache line.
const NEIGHBOURS: u32 = 4;

impl<K: Key, S: Clone + Default> Table<K, S> {
    pub(super) fn new() -> Self {
        Table {
            low: K::NONE,
            span_bits: 0,
            slots: Vec::new(),
            shift: 0,
            held: 0,
            order: Vec::new(),
            sorted: Vec::new(),
        }
    }

    fn allocate(&mut self, length: usize) {
        let length = length.next_power_of_two().max(SMALLEST);
        self.slots = vec![(K::NONE, S::default()); length];
        self.shift = u64::BITS - (length.trailing_zeros() - NEIGHBOURS);
    }

    /// The position of a code, or of the free slot where it belongs.
    #[inline(always)]
    fn position(&self, key: K) -> usize {
        let last = self.slots.len() - 1;
        let mut at = (((key.hash() >> self.shift) as usize) << NEIGHBOURS | key.low_bits(NEIGHBOURS)) & last;
        while self.slots[at].0 != key && self.slots[at].0 != K::NONE {
            at = (at + 1) & last;
        }
        at
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        let old = std::mem::take(&mut self.slots);
        self.allocate(2 * old.len());
        for slot in old.into_iter().filter(|slot| slot.0 != K::NONE) {
            let at = self.position(slot.0);
            self.slots[at] = slot;
        }
    }
}

impl<K: Key, S: Clone + Default> Store<K, S> for Table<K, S> {
    fn open(&mut self, low: K, span: usize, pairs: usize) {
        self.low = low;
        self.span_bits = usize::BITS - span.leading_zeros();
        if self.slots.is_empty() {
            self.allocate((pairs / PRODUCTS_PER_SLOT).min(span.saturating_mul(2)));
        }
    }

    #[inline(always)]
    fn cell(&mut self, key: K) -> &mut S {
        let mut at = self.position(key);
        if self.slots[at].0 != key {
            if 2 * self.held >= self.slots.len() {
                self.grow();
                at = self.position(key);
            }
            self.held += 1;
            self.slots[at].0 = key;
        }
        &mut self.slots[at].1
    }

    fn drain(&mut self, take: &mut impl FnMut(K, S)) {
        let position_bits = self.slots.len().trailing_zeros();
        let mut give = |slot: &mut (K, S)| {
            let key = std::mem::replace(&mut slot.0, K::NONE);
            take(key, std::mem::take(&mut slot.1));
        };
        let full = self.slots.iter().enumerate().filter(|(_, slot)| slot.0 != K::NONE);
        if self.span_bits + position_bits <= u64::BITS {
            let low = self.low;
            self.order.clear();
            self.order.extend(full.map(|(at, slot)| (slot.0.offset(low) as u64) << position_bits | at as u64));
            sort_by_bits(&mut self.order, &mut self.sorted, position_bits, self.span_bits);
            let last = self.slots.len() - 1;
            self.order.iter().for_each(|&packed| give(&mut self.slots[packed as usize & last]));
        } else {
            let mut order: Vec<(K, usize)> = full.map(|(at, slot)| (slot.0, at)).collect();
            order.sort_unstable();
            order.into_iter().for_each(|(_, at)| give(&mut self.slots[at]));
        }
        self.held = 0;
    }
}

/// Number of bits of one digit of the sort.
const DIGIT: u32 = 11;
/// Below this count, numbers are sorted by comparison.
const FEW: usize = 1 << 9;

/// Sorts numbers that differ only in `count` bits from bit `first` on, from the least digit to the greatest.
fn sort_by_bits(numbers: &mut Vec<u64>, space: &mut Vec<u64>, first: u32, count: u32) {
    if numbers.len() < FEW {
        numbers.sort_unstable();
        return;
    }
    space.resize(numbers.len(), 0);
    for low in (first..first + count).step_by(DIGIT as usize) {
        let digit = |number: u64| (number >> low) as usize & ((1 << DIGIT) - 1);
        let mut starts = [0_u32; 1 << DIGIT];
        for &number in numbers.iter() {
            starts[digit(number)] += 1;
        }
        let mut start = 0;
        for entry in &mut starts {
            start += std::mem::replace(entry, start);
        }
        for &number in numbers.iter() {
            let place = &mut starts[digit(number)];
            space[*place as usize] = number;
            *place += 1;
        }
        std::mem::swap(numbers, space);
    }
}
