//! Plain loops over numbers of several directions, the lanes. They are unrolled, unlike calls of
//! `map` and `zip` of arrays.

/// Number of each lane, by a function of its index.
#[inline(always)]
pub fn lanes<const N: usize>(number: impl Fn(usize) -> f32) -> [f32; N] {
    let mut all = [0.0; N];
    for (lane, value) in all.iter_mut().enumerate() {
        *value = number(lane);
    }
    all
}
