//! Functions whose results are the same bits on every platform. The platform's own `sin` or `pow` are
//! not, so nothing that decides a pixel may call them (`clippy.toml` bans them).

/// Sine and cosine of an angle in radians.
pub fn sin_cos(radians: f32) -> (f32, f32) {
    libm::sincosf(radians)
}

/// `x` to the power of `y`. Whole exponents up to 1024 go by repeated squaring.
pub fn powf(x: f32, y: f32) -> f32 {
    if y >= 0.0 && y <= 1024.0 && y == y.trunc() { powi(x, y as u32) } else { libm::powf(x, y) }
}

/// `x` to a whole power, by squaring.
pub fn powi(x: f32, mut n: u32) -> f32 {
    let (mut result, mut square) = (1.0, x);
    while n > 0 {
        if n & 1 == 1 {
            result *= square;
        }
        square *= square;
        n >>= 1;
    }
    result
}
