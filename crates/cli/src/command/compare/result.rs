//! Result of a comparison, as text and JSON.

use super::noise;
use juggler::comparison::NoiseTest;
use juggler::imaging::Difference;
use juggler::imaging::flip::Flip;
use serde_json::json;

/// Largest errors of equal pictures. Without any, equal pictures have equal bits, or noise explains
/// the difference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CompareLimits {
    /// Root mean square error (`--tolerance`).
    pub rmse: Option<f64>,
    /// Mean FLIP (`--flip`).
    pub flip: Option<f64>,
}

/// Result of a comparison.
#[derive(Debug)]
pub struct Comparison {
    /// Errors of the picture.
    pub difference: Difference,
    /// Perceived difference; `None` if it was not measured.
    pub flip: Option<Flip>,
    /// Test whether noise explains the difference; `None` without variances.
    pub noise: Option<NoiseTest>,
    /// Limits of the user.
    pub limits: CompareLimits,
}

impl Comparison {
    /// Whether the pictures are equal.
    pub fn is_equal(&self) -> bool {
        if self.limits == CompareLimits::default() {
            return self.difference.same_bits || self.noise.as_ref().and_then(NoiseTest::is_same) == Some(true);
        }
        self.exceeded().is_empty()
    }

    /// Name, value, flag and value of each limit that is exceeded.
    fn exceeded(&self) -> Vec<String> {
        let flip = self.flip.as_ref().map_or(f64::INFINITY, |flip| flip.mean);
        let found = [
            ("RMSE", self.difference.rmse, "--tolerance", self.limits.rmse),
            ("FLIP", flip, "--flip", self.limits.flip),
        ];
        let exceeded = found.into_iter().filter_map(|(name, value, flag, most)| {
            let most = most.filter(|most| value > *most)?;
            Some(format!("{name} {value:.3e} is more than {flag} {most}"))
        });
        exceeded.collect()
    }

    /// First line of the text.
    fn verdict(&self) -> String {
        if self.difference.same_bits {
            return "identical, bit for bit".to_owned();
        }
        if self.limits != CompareLimits::default() {
            let exceeded = self.exceeded();
            return match exceeded.is_empty() {
                true => "equal within the limits".to_owned(),
                false => format!("different: {}", exceeded.join(", ")),
            };
        }
        match (self.is_equal(), self.noise.as_ref().and_then(noise::p_value)) {
            (true, p_value) => format!("same up to noise, {}", p_value.unwrap_or_default()),
            (false, Some(p_value)) => format!("different, {p_value}"),
            (false, None) => "different".to_owned(),
        }
    }

    /// Lines of text about images of a width: verdict, errors with limits, and where they are largest.
    pub fn to_words(&self, width: u32) -> String {
        let Difference { rmse, relative_mse, largest, largest_at, .. } = self.difference;
        let limit = |most: Option<f64>| most.map_or_else(String::new, |most| format!(", limit {most}"));
        let at = |at: Option<[u32; 2]>| at.map_or_else(String::new, |[x, y]| format!(" at {x},{y}"));
        let mut lines = vec![
            self.verdict(),
            format!("RMSE    {rmse:.6e}{}", limit(self.limits.rmse)),
            format!("relMSE  {relative_mse:.6e}"),
            format!("max     {largest:.6e}{}", at(largest_at)),
        ];
        lines.push(match &self.flip {
            Some(Flip { mean, range, .. }) => {
                format!("FLIP    {mean:.6e} ({}){}", range.name(), limit(self.limits.flip))
            }
            None => "FLIP    not measured: the pictures are too large".to_owned(),
        });
        if let Some((value, pixel)) = self.flip.as_ref().and_then(|flip| flip.largest(width)) {
            lines.push(format!("        most{}: {value:.6e}", at(Some(pixel))));
        }
        lines.extend(self.noise.iter().flat_map(noise::to_words));
        lines.join("\n")
    }

    /// Results as JSON; numbers that JSON cannot represent are null.
    pub fn to_json(&self, width: u32) -> String {
        let Difference { rmse, relative_mse, largest, largest_at, same_bits } = self.difference;
        let flip = self.flip.as_ref().map(|flip| {
            let (most, pixel) = flip.largest(width).unzip();
            let range = flip.range.name().to_lowercase();
            json!({"mean": flip.mean, "range": range, "max": most.unwrap_or(0.0), "max_at": pixel})
        });
        let mut json = json!({
            "version": 1, "equal": self.is_equal(), "same_bits": same_bits,
            "rmse": rmse, "relative_mse": relative_mse, "max": largest, "max_at": largest_at, "flip": flip,
            "limits": {"rmse": self.limits.rmse, "flip": self.limits.flip},
        });
        if let (Some(object), Some(noise)) = (json.as_object_mut(), &self.noise) {
            object.insert("noise".to_owned(), noise::to_json(noise));
        }
        json.to_string()
    }
}
