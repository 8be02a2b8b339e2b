//! The one macro: a closed family of kinds.

/// Declares a family: the enum, its conversions, and the single `match`.
///
/// `pub enum AnyShape: Shape { sphere::Sphere }` stands for everything that a new kind needs besides its
/// own file and its `mod` line. Methods are called through the trait, so a new method needs no line here.
#[macro_export]
macro_rules! closed_set {
    ($(#[$attribute:meta])* $vis:vis enum $Set:ident: $Trait:ident { $($file:ident::$Kind:ident),+ $(,)? }) => {
        $(pub use $file::$Kind;)+

        $(#[$attribute])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(rename_all = "snake_case")]
        $vis enum $Set {
            $(
                #[allow(missing_docs, reason = "the kind's own documentation says it")]
                $Kind($Kind)
            ),+
        }

        $(impl From<$Kind> for $Set {
            fn from(kind: $Kind) -> Self {
                Self::$Kind(kind)
            }
        })+

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

        #[cfg(any(test, feature = "testing"))]
        #[allow(dead_code, reason = "families without contract tests do not ask")]
        impl $Set {
            /// At least one of each kind: what the contract tests run over.
            pub fn examples() -> Vec<Self> {
                [$($Kind::examples().into_iter().map(Self::from).collect::<Vec<_>>()),+].concat()
            }
        }
    };
}
