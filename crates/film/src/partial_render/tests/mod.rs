//! Round trips of valid files; rejection of damaged ones.

mod hostile;
mod round_trips;
