//! Values as data, with the feature `serde`: materials, bodies, grids, profiles and shapes are structures of
//! the arguments that make them, under the names that Python uses. Reading them checks them as their
//! constructors do.

/// Makes a type data, with the feature `serde`: its fields, the expressions that read them from `of`, and the
/// call that makes the value of `fields`.
#[cfg(feature = "serde")]
macro_rules! value {
    (
        $kind:ident by $data:ident { $($(#[$meta:meta])* $field:ident: $type:ty = $read:expr;)* }
        $of:ident, $fields:ident => $make:expr
    ) => {
        const _: () = {
            use ::serde::de::Error as _;
            use ::serde::{Deserialize, Deserializer, Serialize, Serializer};

            #[derive(Serialize, Deserialize)]
            #[serde(deny_unknown_fields)]
            struct $data {
                $($(#[$meta])* $field: $type,)*
            }

            impl Serialize for $kind {
                fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
                    let $of = self;
                    $data { $($field: $read,)* }.serialize(to)
                }
            }

            impl<'de> Deserialize<'de> for $kind {
                fn deserialize<D: Deserializer<'de>>(of: D) -> std::result::Result<Self, D::Error> {
                    let $fields = $data::deserialize(of)?;
                    let make = || -> $crate::error::Result<Self> { $make };
                    make().map_err(D::Error::custom)
                }
            }
        };
    };
}

/// Nothing, without the feature `serde`.
#[cfg(not(feature = "serde"))]
macro_rules! value {
    ($($tokens:tt)*) => {};
}

pub(crate) use value;

/// Whether a field says nothing, and can be left out.
#[cfg(feature = "serde")]
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
