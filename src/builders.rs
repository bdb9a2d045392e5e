//! Methods `with_…` of options.

/// Declares methods that set one public field each: `with_field(field: Type)`, where the type converts into that of the field.
macro_rules! builders {
    ($($name:ident { $($method:ident($field:ident: $type:ty)),* $(,)? })*) => {$(
        impl $name {$(
            #[doc = concat!("This, with another [`", stringify!($field), "`](field@Self::", stringify!($field), ").")]
            #[must_use]
            pub fn $method(mut self, $field: $type) -> Self {
                self.$field = $field.into();
                self
            }
        )*}
    )*};
}
