//! Normal forms that serve more than one scene.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

use andoyer_series::Error;
use andoyer_series::periodic::DrivenForm;

/// The largest memory of the normal forms that a process keeps \[bytes\].
const MOST_MEMORY: usize = 256 << 20;

/// The forms of this process.
static FORMS: LazyLock<KeptForms> = LazyLock::new(KeptForms::default);

/// Normal forms by what they depend on, as bits. They affect only the time of a solution. The oldest ones are dropped where the memory does not suffice.
#[derive(Default)]
pub(crate) struct KeptForms(Mutex<Forms>);

/// A normal form, once it is made.
type FormSlot = Arc<Mutex<Option<Arc<DrivenForm>>>>;

#[derive(Default)]
struct Forms {
    by_key: HashMap<Vec<u64>, FormSlot>,
    /// The keys of the forms that are made, the oldest first, with their memory.
    made: VecDeque<(Vec<u64>, usize)>,
    memory: usize,
}

impl KeptForms {
    /// Those that all scenes of this process share.
    pub(crate) fn shared() -> &'static Self {
        &FORMS
    }

    /// The normal form of a key, or the one that `make` makes. If another thread is making it, this thread waits.
    ///
    /// # Errors
    /// Those of `make`.
    pub(crate) fn of(
        &self,
        key: Vec<u64>,
        make: impl FnOnce() -> Result<DrivenForm, Error>,
    ) -> Result<Arc<DrivenForm>, Error> {
        self.of_within(MOST_MEMORY, key, make)
    }

    fn of_within(
        &self,
        most: usize,
        key: Vec<u64>,
        make: impl FnOnce() -> Result<DrivenForm, Error>,
    ) -> Result<Arc<DrivenForm>, Error> {
        let slot = Arc::clone(self.forms().by_key.entry(key.clone()).or_default());
        // If another thread panicked, the slot is still empty.
        let mut made = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(form) = made.as_ref() {
            return Ok(Arc::clone(form));
        }
        let form = Arc::new(make()?);
        *made = Some(Arc::clone(&form));
        drop(made);
        let memory = form.memory();
        let mut forms = self.forms();
        forms.memory += memory;
        forms.made.push_back((key, memory));
        while forms.memory > most
            && let Some((oldest, memory)) = forms.made.pop_front()
        {
            forms.by_key.remove(&oldest);
            forms.memory -= memory;
        }
        Ok(form)
    }

    /// Each change leaves the maps and the memory in accord, also if a thread panicked after it.
    fn forms(&self) -> MutexGuard<'_, Forms> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use andoyer_series::Monomial;
    use andoyer_series::periodic::{DrivenOptions, MOST_WORK, SampledHamiltonian};
    use andoyer_series::progress::quiet;

    fn pendulum(order: usize) -> Result<DrivenForm, Error> {
        let term = |q, p, c| Ok((Monomial::new(&[q, p])?, c));
        let terms = |_: &[f64]| [term(0, 2, 0.5), term(2, 0, 0.5), term(4, 0, -1.0 / 24.0)].into_iter().collect();
        let options =
            DrivenOptions { order, tolerance: 1e-12, harmonics: 252, smallest_divisor: 1e-9, work: MOST_WORK };
        DrivenForm::new(&SampledHamiltonian::new(1, terms), &[], options, &mut quiet)
    }

    #[test]
    fn a_form_is_made_once_and_the_oldest_one_goes_where_memory_ends() -> Result<(), Error> {
        let (kept, most) = (KeptForms::default(), 2 * pendulum(4)?.memory());
        let of = |key: u64| kept.of_within(most, vec![key], || pendulum(4));
        let first = of(1)?;
        assert!(Arc::ptr_eq(&first, &of(1)?));
        of(2)?;
        assert!(Arc::ptr_eq(&first, &of(1)?) && kept.forms().memory == most);
        of(3)?;
        assert!(!Arc::ptr_eq(&first, &of(1)?) && kept.forms().memory <= most);
        Ok(())
    }

    #[test]
    fn a_form_that_fails_is_tried_again() {
        let kept = KeptForms::default();
        let failed = kept.of(vec![1], || Err(Error::Interrupted { done: 1, of: 2 }));
        assert!(failed.is_err() && kept.of(vec![1], || pendulum(2)).is_ok());
    }
}
