//! What is written comes back; what was not written is refused.

mod hostile;
mod round_trips;
