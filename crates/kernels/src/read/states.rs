//! Segments of states at unequal times: SPK type 9 (Lagrange polynomials of each of the six components) and 13 (Hermite polynomials of the positions with the velocities).
//!
//! A segment has the states, their times, every hundredth of the times, the number of states of a polynomial less 1, the number of states.

use crate::read::error::ReadError;
use crate::read::words::Words;
use crate::segments::DIRECTORY;

const STATE: usize = 6;
const LAST: usize = 2;
/// The highest degree of a polynomial that CSPICE allows, and the most states that it has.
const HIGHEST: usize = 27;
const WIDEST: usize = HIGHEST + 1;

/// How the words of a segment are divided.
pub(super) struct States {
    count: usize,
    window: usize,
    hermite: bool,
    directory: Vec<f64>,
}

impl States {
    /// Reads the last words and the directory.
    pub(super) fn of(words: &Words<'_>, hermite: bool) -> Result<Self, ReadError> {
        let all = words.count();
        if all < LAST + STATE + 1 {
            return Err(words.damaged("the number of words", all, format!("at least {}", LAST + STATE + 1)));
        }
        let [window, count] = words.array(all - LAST)?;
        let whole =
            |value: f64| (value.fract() == 0.0 && value >= 1.0 && value <= all as f64).then_some(value as usize);
        let hundredths = |count: usize| (count - 1) / DIRECTORY;
        let count = whole(count)
            .filter(|&count| count * (STATE + 1) + hundredths(count) + LAST == all)
            .ok_or_else(|| words.damaged("the number of states", count, format!("that of a segment of {all} words")))?;
        let most = if hermite { WIDEST / 2 } else { WIDEST }.min(count);
        let window = whole(window + 1.0).filter(|&window| window <= most).ok_or_else(|| {
            words.damaged("the number of states of a polynomial", window + 1.0, format!("1 to {most}"))
        })?;
        let directory = words.read(count * (STATE + 1), hundredths(count))?;
        if !directory.is_sorted_by(|one, next| one < next) {
            return Err(words.damaged("the directory of times", "others", "increasing"));
        }
        Ok(Self { count, window, hermite, directory })
    }

    /// Reads all times, and the states for a span with half a window on either side.
    pub(super) fn keep(&self, words: &Words<'_>, [start, end]: [f64; 2]) -> Result<(), ReadError> {
        let [first, last] = words.with_second(self.count * STATE, self.count, |times| {
            let [first, last] = [start, end].map(|et| times.partition_point(|&time| time < et));
            [first.saturating_sub(WIDEST), (last + WIDEST).min(self.count)]
        })?;
        words.with(first * STATE, last.saturating_sub(first) * STATE, |_| ())
    }

    /// Position and velocity at a time.
    pub(super) fn at(&self, words: &Words<'_>, et: f64) -> Result<[[f64; 3]; 2], ReadError> {
        let group = self.directory.partition_point(|&time| time < et) * DIRECTORY;
        let begin = group.saturating_sub(WIDEST);
        let end = (group + DIRECTORY + WIDEST).min(self.count);
        let (first, times) = words
            .with_second(self.count * STATE + begin, end - begin, |near| {
                let first = self.first(near, begin, et);
                let mut times = [0.0; WIDEST];
                let window = near.get(first.wrapping_sub(begin)..).and_then(|near| near.get(..self.window));
                times[..self.window].copy_from_slice(window?);
                Some((first, times))
            })?
            .filter(|(_, times)| times[..self.window].is_sorted_by(|one, next| one < next))
            .ok_or_else(|| words.damaged("the times of states", "others", format!("increasing, around {et}")))?;
        let times = &times[..self.window];
        words.with(first * STATE, self.window * STATE, |states| {
            if self.hermite { hermite(times, states, et) } else { lagrange(times, states, et) }
        })
    }

    /// The first state of the polynomial for a time: the window is about the nearest state if it has an odd number of them, otherwise about the two around the time.
    /// For a time outside the states it is a place outside the window.
    fn first(&self, near: &[f64], begin: usize, et: f64) -> usize {
        let high = near.partition_point(|&time| time < et);
        let low = high.saturating_sub(1);
        if !(high < near.len() && near[low] <= et && et <= near[high]) {
            return usize::MAX;
        }
        let closer = high > 0 && (et - near[low]).abs() < (et - near[high]).abs();
        let middle = if self.window.is_multiple_of(2) || closer { low } else { high };
        (begin + middle).saturating_sub((self.window - 1) / 2).min(self.count - self.window)
    }
}

/// Neville's scheme for the six components.
fn lagrange(times: &[f64], states: &[f64], et: f64) -> [[f64; 3]; 2] {
    let mut table = [[0.0; STATE]; WIDEST];
    for (row, state) in table.iter_mut().zip(states.chunks_exact(STATE)) {
        row.copy_from_slice(state);
    }
    for span in 1..times.len() {
        for (low, high) in (span..times.len()).enumerate() {
            let (before, after, width) = (times[low] - et, et - times[high], times[low] - times[high]);
            table[low] = std::array::from_fn(|k| (after * table[low][k] + before * table[low + 1][k]) / width);
        }
    }
    let [x, y, z, u, v, w] = table[0];
    [[x, y, z], [u, v, w]]
}

/// Neville's scheme for values and their derivatives, where each time counts twice.
fn hermite(times: &[f64], states: &[f64], et: f64) -> [[f64; 3]; 2] {
    let mut values = [[0.0; 3]; WIDEST];
    let mut slopes = [[0.0; 3]; WIDEST];
    let part =
        |place: usize, half: usize| -> [f64; 3] { std::array::from_fn(|k| states[place * STATE + 3 * half + k]) };
    let count = times.len();
    for place in 0..count {
        let (position, velocity) = (part(place, 0), part(place, 1));
        values[2 * place] = std::array::from_fn(|k| velocity[k] * (et - times[place]) + position[k]);
        slopes[2 * place] = velocity;
        if place + 1 < count {
            let next = part(place + 1, 0);
            let (after, before, width) = (times[place + 1] - et, et - times[place], times[place + 1] - times[place]);
            values[2 * place + 1] = std::array::from_fn(|k| (after * position[k] + before * next[k]) / width);
            slopes[2 * place + 1] = std::array::from_fn(|k| (next[k] - position[k]) / width);
        }
    }
    for span in 2..2 * count {
        for row in 0..2 * count - span {
            let (low, high) = (times[row / 2], times[(row + span) / 2]);
            let (after, before, width) = (high - et, et - low, high - low);
            let [value, above] = [values[row], values[row + 1]];
            slopes[row] = std::array::from_fn(|k| {
                (after * slopes[row][k] + before * slopes[row + 1][k] + (above[k] - value[k])) / width
            });
            values[row] = std::array::from_fn(|k| (after * value[k] + before * above[k]) / width);
        }
    }
    [values[0], slopes[0]]
}
