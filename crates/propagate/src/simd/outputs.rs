//! The arrays that an evaluation fills.

/// The requested outputs, one row for each time.
pub(crate) enum Outputs<'a> {
    Attitudes(&'a mut [[f64; 4]]),
    Rates(&'a mut [[f64; 3]]),
    Both(&'a mut [[f64; 4]], &'a mut [[f64; 3]]),
}

impl<'a> Outputs<'a> {
    /// The rows before an index, and the rows from this index on.
    pub(crate) fn split_at(self, place: usize) -> (Self, Self) {
        match self {
            Self::Attitudes(attitudes) => {
                let (left, right) = attitudes.split_at_mut(place);
                (Self::Attitudes(left), Self::Attitudes(right))
            }
            Self::Rates(rates) => {
                let (left, right) = rates.split_at_mut(place);
                (Self::Rates(left), Self::Rates(right))
            }
            Self::Both(attitudes, rates) => {
                let (left, right) = attitudes.split_at_mut(place);
                let (left_rates, right_rates) = rates.split_at_mut(place);
                (Self::Both(left, left_rates), Self::Both(right, right_rates))
            }
        }
    }
}
