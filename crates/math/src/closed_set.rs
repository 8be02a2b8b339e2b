//! The macro that declares closed families of kinds, such as shapes: a kind is one file and two
//! lines. [`NamedKind`] is what users choose by name.

/// Kind of a closed family, or another member of a closed set, that users choose by name.
pub trait NamedKind: Copy + Eq + 'static {
    /// All kinds, in the order in which messages and user interfaces list them.
    const ALL: &'static [Self];

    /// Name of the kind, as JSON and command lines have it.
    fn name(self) -> &'static str;

    /// Kind of this name; `None` for an unknown name.
    fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }
}

/// Declares a family of kinds: an enum with one variant per kind, its conversions, and method
/// dispatch.
///
/// `pub enum AnyShape: Shape { sphere::Sphere, ... }` declares descriptions, as scene files hold
/// them. The enum has JSON, a schema and the methods of the trait `Shape`, called through
/// `dyn Shape`, so a new method of the trait needs no line here. `name` is the kind's name in JSON.
///
/// `pub enum Lobe: static ScatteringLobe { lambert::Lambert, ... } fn ...;` declares values for
/// inner loops. The methods listed after the kinds dispatch statically: each is a `match` that
/// calls the trait's method.
///
/// `{ sobol::Sobol => SobolPoints, ... }` declares both at once: descriptions, and the values that
/// they compile to.
///
/// `pub enum AnySampler: SamplerDescription, kind SamplerKind { ... }` declares descriptions and
/// the enum of their kinds, a [`NamedKind`]. A kind stands for the `Default` of its description. `pub enum ToneCurveKind of AnyCurve { Srgb, ... }` declares the kinds of another
/// enum.
#[macro_export]
macro_rules! closed_set {
    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: $Trait:ident, kind $Kinds:ident {
            $($file:ident::$Kind:ident),+ $(,)?
        }
    ) => {
        $crate::closed_set! { $(#[$attribute])* $vis enum $Set: $Trait { $($file::$Kind),+ } }
        $crate::closed_set! { $vis enum $Kinds of $Set { $($Kind),+ } }
    };

    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: $Trait:ident, kind $Kinds:ident {
            $($file:ident::$Kind:ident => $Compiled:ident),+ $(,)?
        }
        $($compiled:tt)+
    ) => {
        $crate::closed_set! {
            $(#[$attribute])* $vis enum $Set: $Trait { $($file::$Kind => $Compiled),+ } $($compiled)+
        }
        $crate::closed_set! { $vis enum $Kinds of $Set { $($Kind),+ } }
    };

    ($vis:vis enum $Kinds:ident of $Set:ident { $($Kind:ident),+ $(,)? }) => {
        #[doc = concat!("Kind of [`", stringify!($Set), "`], without its parameters.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $vis enum $Kinds {
            $(
                #[allow(missing_docs, reason = "the kind's own documentation says it")]
                $Kind
            ),+
        }

        impl $crate::NamedKind for $Kinds {
            const ALL: &'static [Self] = &[$(Self::$Kind),+];

            fn name(self) -> &'static str {
                match self { $(Self::$Kind => $crate::kind_name!($Kind)),+ }
            }
        }

        impl From<&$Set> for $Kinds {
            fn from(member: &$Set) -> Self {
                match member { $($Set::$Kind(_) => Self::$Kind),+ }
            }
        }

        impl From<$Kinds> for $Set {
            fn from(kind: $Kinds) -> Self {
                match kind { $($Kinds::$Kind => Self::$Kind($Kind::default())),+ }
            }
        }
    };

    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: static $Trait:ident { $($file:ident::$Kind:ident),+ $(,)? }
        $($method:tt)+
    ) => {
        $crate::closed_set! { @enum $(#[$attribute])* $vis enum $Set { $($file::$Kind),+ } }
        $crate::closed_set! { @methods $Set $Trait {$($Kind)+} $($method)+ }
    };

    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: $Trait:ident {
            $($file:ident::$Kind:ident => $Compiled:ident),+ $(,)?
        }
        $(#[$compiled_attribute:meta])* $compiled_vis:vis enum $CompiledSet:ident: static $CompiledTrait:ident;
        $($method:tt)+
    ) => {
        $crate::closed_set! {
            $(#[$attribute])* $vis enum $Set: $Trait { $($file::$Kind),+ }
        }
        $crate::closed_set! {
            $(#[$compiled_attribute])* $compiled_vis enum $CompiledSet: static $CompiledTrait { $($file::$Compiled),+ }
            $($method)+
        }
    };

    (@enum $(#[$attribute:meta])* $vis:vis enum $Set:ident { $($file:ident::$Kind:ident),+ }) => {
        $(pub use $file::$Kind;)+

        $(#[$attribute])*
        $vis enum $Set {
            $(
                #[allow(missing_docs, reason = "the kind's own documentation says it")]
                $Kind($Kind)
            ),+
        }

        $(impl From<$Kind> for $Set {
            #[inline]
            fn from(kind: $Kind) -> Self {
                Self::$Kind(kind)
            }
        })+
    };

    (@methods $Set:ident $Trait:ident $kinds:tt
        $(fn $method:ident(&self $(, $argument:ident: $Argument:ty)*) $(-> $Result:ty)?;)+
    ) => {
        impl $Set {
            $($crate::closed_set! {
                @method $Trait $kinds ($($argument)*) fn $method(&self $(, $argument: $Argument)*) $(-> $Result)?;
            })+
        }
    };

    (@method $Trait:ident {$($Kind:ident)+} $arguments:tt
        fn $method:ident(&self $(, $argument:ident: $Argument:ty)*) $(-> $Result:ty)?;
    ) => {
        #[doc = concat!("Calls [`", stringify!($Trait), "::", stringify!($method), "`] of the kind.")]
        #[inline]
        pub fn $method(&self $(, $argument: $Argument)*) $(-> $Result)? {
            match self {
                $(Self::$Kind(kind) => $crate::closed_set!(@call $Trait $method kind $arguments)),+
            }
        }
    };

    (@call $Trait:ident $method:ident $kind:ident ($($argument:ident)*)) => {
        $Trait::$method($kind $(, $argument)*)
    };

    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: $Trait:ident { $($file:ident::$Kind:ident),+ $(,)? }) => {
        $crate::closed_set! {
            @enum $(#[$attribute])*
            #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
            #[serde(rename_all = "snake_case")]
            $vis enum $Set { $($file::$Kind),+ }
        }

        impl std::ops::Deref for $Set {
            type Target = dyn $Trait;
            fn deref(&self) -> &Self::Target {
                match self { $(Self::$Kind(kind) => kind),+ }
            }
        }

        impl std::ops::DerefMut for $Set {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self { $(Self::$Kind(kind) => kind),+ }
            }
        }

        impl $Set {
            /// Name of the kind, as JSON has it.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$Kind(_) => $crate::kind_name!($Kind)),+ }
            }
        }

        #[cfg(any(test, feature = "testing"))]
        #[allow(dead_code, reason = "families without contract tests do not ask")]
        impl $Set {
            /// At least one example of each kind, for the contract tests.
            pub fn examples() -> Vec<Self> {
                [$($Kind::examples().into_iter().map(Self::from).collect::<Vec<_>>()),+].concat()
            }
        }
    };
}

/// Name of a type in snake case, as a constant: `"thin_lens"` for `ThinLens`.
#[macro_export]
macro_rules! kind_name {
    ($Kind:ident) => {{
        const NAME: &str = stringify!($Kind);
        const SNAKE: [u8; $crate::closed_set::snake_case_length(NAME)] = $crate::closed_set::snake_case(NAME);
        const TEXT: &str = match core::str::from_utf8(&SNAKE) {
            Ok(text) => text,
            Err(_) => NAME,
        };
        TEXT
    }};
}

/// Length of `name` in snake case.
#[doc(hidden)]
pub const fn snake_case_length(name: &str) -> usize {
    let bytes = name.as_bytes();
    let mut length = bytes.len();
    let mut i = 1;
    while i < bytes.len() {
        length += bytes[i].is_ascii_uppercase() as usize;
        i += 1;
    }
    length
}

/// Converts `name`, an ASCII type name, to snake case.
#[doc(hidden)]
pub const fn snake_case<const LENGTH: usize>(name: &str) -> [u8; LENGTH] {
    let bytes = name.as_bytes();
    let mut snake = [b'_'; LENGTH];
    let (mut i, mut end) = (0, 0);
    while i < bytes.len() {
        if i > 0 && bytes[i].is_ascii_uppercase() {
            end += 1;
        }
        snake[end] = bytes[i].to_ascii_lowercase();
        (i, end) = (i + 1, end + 1);
    }
    snake
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_are_in_snake_case() {
        assert_eq!(kind_name!(Sphere), "sphere");
        assert_eq!(kind_name!(ThinLens), "thin_lens");
        assert_eq!(kind_name!(AmbientOcclusion), "ambient_occlusion");
    }
}
