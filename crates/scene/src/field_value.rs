//! Values of fields that programs animate.

use crate::description::Visible;
use juggler_math::{DVec3, Rgb, Vec2, Vec3};
use juggler_texture::{Input, InputValue};

/// Value of a field that a source may give at each frame.
///
/// [`Animated`](crate::Animated) finds the place of a field in the scene format by a change of the
/// field, for which it needs a second value.
pub trait FieldValue {
    /// Returns a value of which every number differs from this value's.
    #[must_use]
    fn other(&self) -> Self;
}

impl FieldValue for f32 {
    fn other(&self) -> Self {
        // JSON has no infinities: all of these are written as null.
        if *self == 0.0 || !self.is_finite() { 1.0 } else { 0.0 }
    }
}

impl FieldValue for f64 {
    fn other(&self) -> Self {
        if *self == 0.0 || !self.is_finite() { 1.0 } else { 0.0 }
    }
}

impl FieldValue for bool {
    fn other(&self) -> Self {
        !*self
    }
}

impl FieldValue for Visible {
    fn other(&self) -> Self {
        Self(!self.0)
    }
}

impl FieldValue for i32 {
    fn other(&self) -> Self {
        !*self
    }
}

impl FieldValue for u32 {
    fn other(&self) -> Self {
        !*self
    }
}

impl FieldValue for u64 {
    fn other(&self) -> Self {
        !*self
    }
}

impl FieldValue for String {
    fn other(&self) -> Self {
        format!("{self}~")
    }
}

impl<T: FieldValue, const N: usize> FieldValue for [T; N] {
    fn other(&self) -> Self {
        std::array::from_fn(|i| self[i].other())
    }
}

impl FieldValue for Vec2 {
    fn other(&self) -> Self {
        self.to_array().other().into()
    }
}

impl FieldValue for Vec3 {
    fn other(&self) -> Self {
        self.to_array().other().into()
    }
}

impl FieldValue for DVec3 {
    fn other(&self) -> Self {
        self.to_array().other().into()
    }
}

impl FieldValue for Rgb {
    fn other(&self) -> Self {
        let [r, g, b] = [self.r, self.g, self.b].other();
        Self::new(r, g, b)
    }
}

impl<T: FieldValue + Default> FieldValue for Option<T> {
    fn other(&self) -> Self {
        Some(self.as_ref().map_or_else(|| T::default().other(), T::other))
    }
}

impl<T: FieldValue + InputValue> FieldValue for Input<T> {
    fn other(&self) -> Self {
        let value = if let Self::Value(value) = self { value.other() } else { T::ONE };
        Self::Value(value)
    }
}
