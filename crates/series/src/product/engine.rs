//! The sum of many products, computed window by window.
//!
//! The codes of a result are cut into windows. Each window is so small that its sums stay in the cache of a core (after F. Biscani, *Parallel sparse polynomial
//! multiplication on modern hardware architectures*, ISSAC 2012, whose segments are those of a hash table). Both factors are sorted by code, so the products of
//! a window are found along a staircase. A window holds its sums in an array if most codes are in use, otherwise in a table that is sized before it is filled.
//! It is emptied in the order of the codes. The result is therefore sorted, the windows are independent, and any number of threads adds the same numbers in the
//! same order.

use std::sync::{Mutex, PoisonError};

use super::arithmetic::Arithmetic;
use super::code::{Key, Layout};
use super::pause::{PRODUCTS_PER_PAUSE, Pause};
use super::piece::{Collection, Piece};
use super::store::{Array, Store, Table};
use crate::error::Error;
use crate::threads::{map, shared, sort};

/// Smallest number of products for which several threads are used.
const PARALLEL_PRODUCTS: usize = 1 << 18;
/// Number of windows for each thread between two pauses, for numbers and for sums that own memory. At the end of a batch a thread waits for half a window on
/// average.
const WINDOWS_PER_BATCH: [usize; 2] = [128, 16];
/// Number of windows, evenly distributed, that are computed in advance to count their terms, if there are many times more.
const PROBES: usize = 16;
/// Cells of the array of a window: a megabyte of 16-byte sums.
const ARRAY_CELLS: i128 = 1 << 16;
/// Products of one window with an array: some milliseconds.
const ARRAY_PRODUCTS: i128 = 1 << 22;
const FEWEST_CELLS: i128 = 1 << 8;
/// Largest number of cells for each product if an array is used.
pub(super) const CELLS_PER_PRODUCT: i128 = 4;
/// Bytes of a window's table with one slot for every two products. With twice or four times as many bytes the sum takes a tenth to a third longer.
const TABLE_BYTES: usize = 1 << 18;
/// Products of one window with a table, for sums that own memory. Each such product takes tenths of a microsecond.
const HEAVY_TABLE_PRODUCTS: usize = 1 << 13;
/// Number of sampled codes for each boundary between windows.
const SAMPLES_PER_WINDOW: usize = 32;

/// A polynomial ready for products: codes in ascending order and lifted coefficients.
pub(super) struct Operand<K, F> {
    pub(super) codes: Vec<K>,
    pub(super) factors: Vec<F>,
}

/// The factor of a pair of terms.
pub(super) enum Weights {
    Constant(i64),
    /// j₁ k₂ − k₁ j₂; `outer` and `inner` hold (j, k) for every term of the two factors.
    Bracket {
        outer: Vec<[i64; 2]>,
        inner: Vec<[i64; 2]>,
    },
}

/// One product: every outer term times every inner term.
pub(super) struct Part<'a, K, F> {
    pub(super) outer: &'a Operand<K, F>,
    pub(super) inner: &'a Operand<K, F>,
    /// The shift that is added to every code.
    pub(super) shift: K,
    pub(super) weights: Weights,
}

/// A callback that receives numbers of products; its error ends the sum.
type Count<'a> = dyn FnMut(usize) -> Result<(), Error> + 'a;

/// The codes c with `low` ≤ c < `high`.
#[derive(Clone, Copy)]
struct Window<K> {
    low: K,
    high: K,
}

impl<K: Key, F> Part<'_, K, F> {
    pub(super) fn pairs(&self) -> usize {
        self.outer.codes.len().saturating_mul(self.inner.codes.len())
    }

    /// Smallest and largest code, or `None` if there is no pair.
    fn range(&self) -> Option<(K, K)> {
        let low = self.outer.codes.first()?.plus(self.shift).plus(*self.inner.codes.first()?);
        let high = self.outer.codes.last()?.plus(self.shift).plus(*self.inner.codes.last()?);
        Some((low, high))
    }

    /// Calls `row` with each outer position and the range of inner positions whose products lie in the window.
    #[inline(always)]
    fn rows(
        &self,
        window: Window<K>,
        mut row: impl FnMut(usize, K, std::ops::Range<usize>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let inner = &self.inner.codes;
        let Some(&top) = inner.last() else { return Ok(()) };
        let start = self.outer.codes.partition_point(|code| code.plus(self.shift).plus(top) < window.low);
        let (mut first, mut last) = (inner.len(), inner.len());
        for (position, code) in self.outer.codes.iter().enumerate().skip(start) {
            let base = code.plus(self.shift);
            while first > 0 && base.plus(inner[first - 1]) >= window.low {
                first -= 1;
            }
            while last > 0 && base.plus(inner[last - 1]) >= window.high {
                last -= 1;
            }
            if last == 0 {
                break;
            }
            if first < last {
                row(position, base, first..last)?;
            }
        }
        Ok(())
    }

    /// Adds the products in the window, and reports their number to `count`.
    fn add<A: Arithmetic<Factor = F>, S: Store<K, A::Sum>>(
        &self,
        window: Window<K>,
        store: &mut S,
        count: &mut Count<'_>,
    ) -> Result<(), Error> {
        let (codes, factors) = (&self.inner.codes, &self.inner.factors);
        let mut done = 0;
        self.rows(window, |position, base, range| {
            done += range.len();
            if done >= PRODUCTS_PER_PAUSE {
                count(std::mem::take(&mut done))?;
            }
            let first = &self.outer.factors[position];
            let inner = codes[range.clone()].iter().zip(&factors[range.clone()]);
            match &self.weights {
                Weights::Constant(1) => {
                    for (&code, second) in inner {
                        A::add(store.cell(base.plus(code)), first, second, 1);
                    }
                }
                Weights::Constant(weight) => {
                    for (&code, second) in inner {
                        A::add(store.cell(base.plus(code)), first, second, *weight);
                    }
                }
                Weights::Bracket { outer, inner: exponents } => {
                    let [j, k] = outer[position];
                    if [j, k] == [0, 0] {
                        return Ok(());
                    }
                    for ((&code, second), exponents) in inner.zip(&exponents[range]) {
                        let weight = j * exponents[1] - k * exponents[0];
                        if weight != 0 {
                            A::add(store.cell(base.plus(code)), first, second, weight);
                        }
                    }
                }
            }
            Ok(())
        })?;
        count(done)
    }
}

/// A sum of products, ready to be computed.
pub(super) struct Sum<'a, K, A: Arithmetic> {
    pub(super) arithmetic: &'a A,
    pub(super) parts: &'a [Part<'a, K, A::Factor>],
    pub(super) layout: &'a Layout,
    /// The largest code that is kept, if there is a truncation.
    pub(super) last_kept: Option<i128>,
}

impl<K: Key, A: Arithmetic> Sum<'_, K, A> {
    /// All terms of the sum.
    pub(super) fn form(&self, pause: &mut Pause<'_>) -> Result<Piece<A::Value>, Error> {
        let ranges = || self.parts.iter().filter_map(Part::range);
        let (Some(low), Some(high)) = (ranges().map(|r| r.0).min(), ranges().map(|r| r.1).max()) else {
            return Ok(Piece::new());
        };
        let high = self.last_kept.map_or(high.widened(), |last| high.widened().min(last)) + 1;
        if low.widened() >= high {
            return Ok(Piece::new());
        }
        let whole = Window { low, high: K::narrowed(high) };
        let pairs = self.parts.iter().fold(0_usize, |pairs, part| pairs.saturating_add(part.pairs()));
        if A::LIGHT && high - low.widened() <= CELLS_PER_PRODUCT * pairs as i128 {
            self.windows::<Array<K, A::Sum>>(Array::new, &even(whole, pairs), pairs, pause)
        } else {
            self.windows::<Table<K, A::Sum>>(Table::new, &self.quantiles(whole, pairs), pairs, pause)
        }
    }

    /// Windows with about equal numbers of products.
    fn quantiles(&self, whole: Window<K>, pairs: usize) -> Vec<Window<K>> {
        let products = if A::LIGHT { 2 * TABLE_BYTES / size_of::<(K, A::Sum)>() } else { HEAVY_TABLE_PRODUCTS };
        // The steps along the staircases must cost less than the products.
        let steps: usize = self.parts.iter().map(|part| part.outer.codes.len() + 2 * part.inner.codes.len()).sum();
        let count = (pairs / products).min(pairs / (2 * steps + 1)).max(1);
        let wanted = SAMPLES_PER_WINDOW * count;
        let mut sums = Vec::new();
        for part in self.parts.iter().filter(|_| count > 1) {
            let (outer, inner) = (&part.outer.codes, &part.inner.codes);
            let share = (wanted as f64 * part.pairs() as f64 / pairs as f64).sqrt() as usize + 1;
            let (across, along) = (outer.len().div_ceil(share), inner.len().div_ceil(share));
            for code in outer.iter().step_by(across.max(1)) {
                let base = code.plus(part.shift);
                sums.extend(inner.iter().step_by(along.max(1)).map(|&code| base.plus(code)));
            }
        }
        sums.retain(|&code| code > whole.low && code < whole.high);
        if pairs < PARALLEL_PRODUCTS {
            sums.sort_unstable()
        } else {
            sort(&mut sums)
        }
        let mut boundaries = vec![whole.low];
        boundaries.extend((1..count).filter_map(|at| sums.get(at * sums.len() / count)));
        boundaries.push(whole.high);
        boundaries.dedup();
        boundaries.windows(2).map(|pair| Window { low: pair[0], high: pair[1] }).collect()
    }

    /// Computes the windows in order, with several threads if the work is large enough.
    fn windows<S: Store<K, A::Sum> + Send>(
        &self,
        store: impl Fn() -> S + Sync,
        windows: &[Window<K>],
        pairs: usize,
        pause: &mut Pause<'_>,
    ) -> Result<Piece<A::Value>, Error> {
        let threads = if pairs < PARALLEL_PRODUCTS { 1 } else { shared(windows.len(), |threads| threads) };
        let expected = pairs / windows.len().max(1);
        if threads > 1 {
            return self.windows_of_threads(store, windows, (threads, expected), pause);
        }
        let (mut piece, mut store, mut done) = (Piece::new(), store(), 0);
        let mut count = |products| {
            done += products;
            if done < PRODUCTS_PER_PAUSE {
                return Ok(());
            }
            done = 0;
            pause()
        };
        for &window in windows {
            self.window(window, expected, &mut store, &mut piece, &mut count)?;
        }
        Ok(piece)
    }

    /// Computes the windows with `threads` threads. Stores and pieces are used again, since memory that is new to a process costs as much time as the sums.
    fn windows_of_threads<S: Store<K, A::Sum> + Send>(
        &self,
        store: impl Fn() -> S + Sync,
        windows: &[Window<K>],
        (threads, products): (usize, usize),
        pause: &mut Pause<'_>,
    ) -> Result<Piece<A::Value>, Error> {
        let stores = Mutex::new(Vec::new());
        let held = || stores.lock().unwrap_or_else(PoisonError::into_inner);
        let compute = |windows: &[Window<K>], pieces: &mut [Piece<A::Value>]| {
            let each = |(&window, piece): (&Window<K>, &mut Piece<A::Value>)| {
                let free = held().pop();
                let mut store = free.unwrap_or_else(&store);
                self.window(window, products, &mut store, piece, &mut |_| Ok(()))?;
                held().push(store);
                Ok(())
            };
            map(windows.iter().zip(pieces).collect(), each).into_iter().collect::<Result<(), Error>>()
        };
        let in_batch = threads * WINDOWS_PER_BATCH[usize::from(!A::LIGHT)];
        let mut pieces: Vec<_> = std::iter::repeat_with(Piece::new).take(in_batch.min(windows.len())).collect();
        let mut expected = 0;
        if windows.len() > 32 * PROBES && A::LIGHT {
            let probes: Vec<_> = windows.iter().copied().step_by(windows.len() / PROBES).collect();
            compute(&probes, &mut pieces)?;
            let terms: usize = pieces.iter().map(|piece| piece.keys.len()).sum();
            expected = terms * windows.len() / probes.len() * 9 / 8;
            pieces.iter_mut().for_each(Piece::clear);
        }
        let mut collection = Collection::new(expected);
        for batch in windows.chunks(in_batch) {
            pause()?;
            compute(batch, &mut pieces)?;
            collection.append(&mut pieces[..batch.len()], &A::zero());
        }
        Ok(collection.finish())
    }

    /// Computes the sums of one window, which has about `expected` products.
    fn window<S: Store<K, A::Sum>>(
        &self,
        window: Window<K>,
        expected: usize,
        store: &mut S,
        piece: &mut Piece<A::Value>,
        count: &mut Count<'_>,
    ) -> Result<(), Error> {
        store.open(window.low, window.high.offset(window.low), expected);
        for part in self.parts {
            part.add::<A, S>(window, store, count)?;
        }
        store.drain(&mut |key: K, sum| {
            if let Some(value) = self.arithmetic.value(sum) {
                piece.keys.push(key.decoded(self.layout));
                piece.values.push(value);
            }
        });
        Ok(())
    }
}

/// Windows with as many codes as an array has cells, or with fewer codes if each cell receives very many products.
fn even<K: Key>(whole: Window<K>, pairs: usize) -> Vec<Window<K>> {
    let (low, high) = (whole.low.widened(), whole.high.widened());
    let cells = ((high - low) * ARRAY_PRODUCTS / pairs.max(1) as i128).clamp(FEWEST_CELLS, ARRAY_CELLS);
    let bounds = (low..high).step_by(cells as usize);
    bounds.map(|start| Window { low: K::narrowed(start), high: K::narrowed(high.min(start + cells)) }).collect()
}
