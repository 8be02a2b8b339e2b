//! Color pipeline of FLIP (2020, section 4.1): contrast sensitivity filtering in an opponent space,
//! then HyAB distances in Hunt-adjusted CIE L*a*b*, with large distances compressed.

use super::filter::{Kernel, Plane, gaussian};
use crate::tone::Matrix;
use juggler_math::{Rgb, portable};

/// Linear sRGB to CIE XYZ, with the fractions of the authors' program.
const XYZ: Matrix = Matrix([
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
]);
/// Exponent q_c of color distances, and the knee of their compression: distances below p_c = 0.4 of
/// the maximum map to 0 to p_t = 0.95.
const EXPONENT: f32 = 0.7;
const BEND: [f32; 2] = [0.4, 0.95];

/// Contrast sensitivity functions (2020, table 1): Gaussian widths b in squared degrees, for
/// blue-yellow pairs of amplitude a and width b.
const LIGHTNESS: f64 = 0.0047;
const RED_GREEN: f64 = 0.0053;
const BLUE_YELLOW: [[f64; 2]; 2] = [[34.1, 0.04], [13.5, 0.025]];

/// Image in luminance and the opponent channels red-green and blue-yellow, all linear (the paper's
/// YCxCz without its factors and offset, which do not affect the filters).
pub(super) struct Opponent {
    /// Y of CIE XYZ, 1 for white.
    pub luminance: Plane,
    red_green: Plane,
    blue_yellow: Plane,
}

impl Opponent {
    /// Converts linear RGB from 0 to 1.
    pub fn from_linear(width: usize, pixels: impl Iterator<Item = Rgb>) -> Self {
        let rows = relative_xyz();
        let plane = || Plane { width, values: Vec::with_capacity(pixels.size_hint().0) };
        let mut opponent = Self { luminance: plane(), red_green: plane(), blue_yellow: plane() };
        for pixel in pixels {
            let [x, y, z] = product(&rows, pixel.to_array());
            opponent.luminance.values.push(y);
            opponent.red_green.values.push(x - y);
            opponent.blue_yellow.values.push(y - z);
        }
        opponent
    }
}

/// Filters and color transforms for one viewing distance.
pub(super) struct ColorFilters {
    lightness: Kernel,
    red_green: Kernel,
    /// Two Gaussians with their weights.
    blue_yellow: [(Kernel, f32); 2],
    to_light: [[f32; 3]; 3],
    to_xyz: [[f32; 3]; 3],
    /// Distance between green and blue, the maximum, after applying the exponent.
    max_distance: f32,
}

impl ColorFilters {
    pub fn new(pixels_per_degree: f64) -> Self {
        // Kernel radius: three standard deviations of the widest Gaussian, in pixels.
        let deviation = |width: f64| (width / 2.0).sqrt() / std::f64::consts::PI * pixels_per_degree;
        let radius = portable::floor_f64(3.0 * deviation(BLUE_YELLOW[0][1])) as i32 + 1;
        let weight = |width: f64| move |t: f64| gaussian(t, deviation(width));
        // Weight of a Gaussian: its amplitude times its sum over both dimensions.
        let share = |[amplitude, width]: [f64; 2]| {
            let sum: f64 = (-radius..=radius).map(|t| weight(width)(f64::from(t))).sum();
            amplitude * (std::f64::consts::PI / width).sqrt() * sum * sum
        };
        let total: f64 = BLUE_YELLOW.into_iter().map(share).sum();
        let kernel = |width: f64| Kernel::new(radius, weight(width)).trimmed();
        let mut filters = Self {
            lightness: kernel(LIGHTNESS),
            red_green: kernel(RED_GREEN),
            blue_yellow: BLUE_YELLOW.map(|gaussian| (kernel(gaussian[1]), (share(gaussian) / total) as f32)),
            to_light: single(&relative().inverse()),
            to_xyz: relative_xyz(),
            max_distance: 0.0,
        };
        let to_lab = |light: [f32; 3]| lab(product(&filters.to_xyz, light));
        filters.max_distance = portable::powf(distance(to_lab([0.0, 1.0, 0.0]), to_lab([0.0, 0.0, 1.0])), EXPONENT);
        filters
    }

    /// Color differences of all pixels, 0 to 1.
    pub fn differences(&self, picture: &Opponent, reference: &Opponent) -> Vec<f32> {
        let [picture, reference] = [picture, reference].map(|image| self.filtered_lab(image));
        picture.into_iter().zip(reference).map(|(a, b)| self.compressed(distance(a, b))).collect()
    }

    /// Filters an image by contrast sensitivity and converts it to L*a*b*.
    fn filtered_lab(&self, image: &Opponent) -> Vec<[f32; 3]> {
        let lightness = image.luminance.filtered(&self.lightness, &self.lightness);
        let red_green = image.red_green.filtered(&self.red_green, &self.red_green);
        let [wide, narrow] = self.blue_yellow.each_ref().map(|(kernel, _)| image.blue_yellow.filtered(kernel, kernel));
        let shares = self.blue_yellow.each_ref().map(|(_, share)| *share);
        let blue_yellow = wide.values.iter().zip(&narrow.values).map(|(a, b)| a * shares[0] + b * shares[1]);
        let opponents = lightness.values.iter().zip(&red_green.values).zip(blue_yellow);
        let one = |((y, red_green), blue_yellow): ((&f32, &f32), f32)| {
            let light = product(&self.to_light, [y + red_green, *y, y - blue_yellow]);
            lab(product(&self.to_xyz, light.map(|v| v.clamp(0.0, 1.0))))
        };
        opponents.map(one).collect()
    }

    /// Compresses large distances, so that small ones take most of the range (section 4.1.3).
    fn compressed(&self, distance: f32) -> f32 {
        let (powered, bend) = (portable::powf(distance, EXPONENT), BEND[0] * self.max_distance);
        if powered < bend {
            return powered * BEND[1] / bend;
        }
        BEND[1] + (powered - bend) / (self.max_distance - bend) * (1.0 - BEND[1])
    }
}

/// Linear sRGB to CIE XYZ relative to white.
fn relative() -> Matrix {
    let [x, y, z] = XYZ.apply([1.0; 3]);
    Matrix::diagonal([1.0 / x, 1.0 / y, 1.0 / z]).times(&XYZ)
}

fn relative_xyz() -> [[f32; 3]; 3] {
    single(&relative())
}

fn single(matrix: &Matrix) -> [[f32; 3]; 3] {
    matrix.0.map(|row| row.map(|v| v as f32))
}

fn product(rows: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// CIE L*a*b* of XYZ relative to white, with chroma reduced for dark colors (Hunt 1952).
fn lab(xyz: [f32; 3]) -> [f32; 3] {
    const KNEE: f32 = 6.0 / 29.0;
    let bent = |v: f32| {
        if v > KNEE * KNEE * KNEE { portable::powf(v, 1.0 / 3.0) } else { v / (3.0 * KNEE * KNEE) + 4.0 / 29.0 }
    };
    let [x, y, z] = xyz.map(bent);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// HyAB color distance (Abasi, Tehran and Fairchild 2020), suited to large differences.
fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [l, u, v] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    l.abs() + (u * u + v * v).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colors_in_lab() {
        let rows = relative_xyz();
        let plain = |light: [f32; 3]| {
            let [l, a, b] = lab(product(&rows, light));
            let hunt = (0.01 * l).max(1e-9);
            [l, a / hunt, b / hunt]
        };
        // White, red and blue of sRGB in CIE L*a*b* under D65.
        for (light, expected) in [
            ([1.0, 1.0, 1.0], [100.0, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
            ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86]),
        ] {
            let found = plain(light);
            assert!(found.iter().zip(expected).all(|(a, b): (_, f32)| (a - b).abs() < 0.1), "{found:?}");
        }
    }

    #[test]
    fn opponent_color_transform_is_invertible() {
        let filters = ColorFilters::new(67.0);
        let light = [0.3, 0.7, 0.1];
        let [x, y, z] = product(&filters.to_xyz, light);
        let back = product(&filters.to_light, [y + (x - y), y, y - (y - z)]);
        assert!(back.iter().zip(light).all(|(a, b)| (a - b).abs() < 1e-5), "{back:?}");
        assert!(filters.compressed(0.0) == 0.0 && filters.compressed(1e3) > 1.0 - 0.06);
        let greens = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|light| lab(product(&filters.to_xyz, light)));
        assert!((filters.compressed(distance(greens[0], greens[1])) - 1.0).abs() < 1e-6);
    }
}
