//! `juggler compare`: how different two pictures are.

use crate::console;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::value;
use clap::Args;
use juggler::imaging::{self, Difference};
use serde_json::json;
use std::path::Path;

/// Flags of `juggler compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// A picture
    picture: String,
    /// What it should look like
    reference: String,
    /// The root mean squared difference up to which they count as equal; without it every bit must be
    #[arg(long, value_name = "RMSE", value_parser = value::tolerance)]
    tolerance: Option<f64>,
    /// Write the numbers as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,
}

impl Compare {
    /// Prints the differences, and says no when there are too many.
    pub fn run(self) -> Result<(), Failure> {
        let read = |name: &str| imaging::read(Path::new(name));
        let difference = imaging::compare(&read(&self.picture)?, &read(&self.reference)?)?;
        let equal = match self.tolerance {
            Some(most) => difference.rmse <= most,
            None => difference.same_bits,
        };
        if let Some(file) = &self.stats {
            output::write_text(file, &to_json(&difference, equal))?;
        }
        if self.stats.as_deref() != Some(STANDARD_OUTPUT) {
            console::print(&to_words(&difference, equal))?;
        }
        if equal { Ok(()) } else { Err(Failure::No) }
    }
}

fn to_words(difference: &Difference, equal: bool) -> String {
    let answer = match (equal, difference.same_bits) {
        (_, true) => "equal to the bit",
        (true, false) => "equal within the tolerance",
        (false, _) => "different",
    };
    let Difference { rmse, relative_mse, largest, .. } = difference;
    format!("{answer}\nRMSE    {rmse:.6e}\nrelMSE  {relative_mse:.6e}\nmax     {largest:.6e}")
}

/// Numbers that JSON cannot hold become null.
fn to_json(difference: &Difference, equal: bool) -> String {
    let Difference { rmse, relative_mse, largest, same_bits } = difference;
    json!({
        "version": 1, "equal": equal, "same_bits": same_bits,
        "rmse": rmse, "relative_mse": relative_mse, "max": largest,
    })
    .to_string()
}
