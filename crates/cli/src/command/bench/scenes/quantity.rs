//! Measured quantities.

/// A measure of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Instructions, counted by valgrind.
    Instructions,
    /// CPU time.
    CpuTime,
}

impl Quantity {
    pub const ALL: [Self; 2] = [Self::Instructions, Self::CpuTime];

    pub fn name(self) -> &'static str {
        match self {
            Self::Instructions => "instructions",
            Self::CpuTime => "cpu-time",
        }
    }

    /// Samples per pixel of the measured render.
    pub fn samples(self) -> u32 {
        match self {
            Self::Instructions => 8,
            Self::CpuTime => 64,
        }
    }

    /// Samples per pixel of a render whose cost is subtracted, so that the difference is free of
    /// start, reading and building; 0 if there is no such render.
    pub fn subtracted_samples(self) -> u32 {
        match self {
            Self::Instructions => 4,
            // The program reports the CPU time of rendering alone.
            Self::CpuTime => 0,
        }
    }
}
