//! juggler
