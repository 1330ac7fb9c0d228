//! The macro that declares the error type of a crate: each variant once, with its sentence, fields, kind and facts.

/// Declares an error type from a table of its variants.
///
/// ```text
/// /// An exponent that is too large.
/// #[error("exponent {exponent} exceeds {bound}")]
/// Exponent { exponent: u32 = "The exponent.", bound: u32 = "The bound." } => Kind::Input, facts("exponents", *exponent, *bound);
/// ```
///
/// The lines are its documentation, its sentence as `thiserror` reads it, and its fields, each with its documentation, its kind, and its facts.
/// Kind and facts are expressions in the fields, which are references. The type gets the methods `kind`, `argument`, `value` and `bound`. They are inherent
/// ones, so that a caller needs no trait in scope.
#[doc(hidden)]
#[macro_export]
macro_rules! error_table {
    (
        $(#[$($attribute:tt)*])*
        pub enum $name:ident {
            $(
                $(#[$($line:tt)*])*
                $variant:ident
                $({ $($field:ident: $type:ty = $meaning:literal),+ $(,)? })?
                $(($inner:ident: $inner_type:ty))?
                => $kind:expr, $facts:expr;
            )+
        }
    ) => {
        $(#[$($attribute)*])*
        pub enum $name {
            $(
                $(#[$($line)*])*
                $variant $({ $(#[doc = $meaning] $field: $type,)+ })? $(($inner_type))?,
            )+
        }

        impl $name {
            /// What a caller can do about this error.
            #[must_use]
            #[allow(unused_variables)]
            pub fn kind(&self) -> $crate::error::Kind {
                match self {
                    $(Self::$variant $({ $($field),+ })? $(($inner))? => $kind,)+
                }
            }

            /// The argument that is wrong, without an index; `None` if only the caller knows its name. For a file it is the key with its table.
            #[must_use]
            pub fn argument(&self) -> Option<&str> {
                self.facts().argument
            }

            /// The given value, or the number computed from it that breaks the bound.
            #[must_use]
            pub fn value(&self) -> Option<$crate::error::Value> {
                self.facts().value
            }

            /// The requirement on the value: a number, an interval or words.
            #[must_use]
            pub fn bound(&self) -> Option<$crate::error::Value> {
                self.facts().bound
            }

            #[allow(unused_variables)]
            fn facts(&self) -> $crate::error::Facts<'_> {
                match self {
                    $(Self::$variant $({ $($field),+ })? $(($inner))? => $facts,)+
                }
            }
        }
    };
}
