//! Names of variants: one table for each enum, which texts, files and serde have in common.

/// Gives the variants of an enum their names: `of_name`, `Display`, and serde's traits. A variant of a feature repeats its attribute.
macro_rules! names {
    ($type:ident: $($(#[$there:meta])* $variant:ident = $name:literal),+) => {
        impl $type {
            /// The variant with this name.
            fn of_name(name: &str) -> Option<Self> {
                match name {
                    $($(#[$there])* $name => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(match self {
                    $($(#[$there])* Self::$variant => $name,)+
                })
            }
        }

        #[cfg(feature = "serde")]
        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        #[cfg(feature = "serde")]
        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = String::deserialize(deserializer)?;
                Self::of_name(&name).ok_or_else(|| serde::de::Error::unknown_variant(&name, &[$($(#[$there])* $name),+]))
            }
        }
    };
}

/// As `names`, and reads a name. The error of an unknown one has the name of the type.
macro_rules! named {
    ($type:ident: $($rest:tt)+) => {
        $crate::input::names::names!($type: $($rest)+);

        impl std::str::FromStr for $type {
            type Err = $crate::error::Error;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                Self::of_name(text).ok_or_else(|| $crate::error::Error::$type { value: text.to_owned() })
            }
        }
    };
}

pub(crate) use {named, names};
