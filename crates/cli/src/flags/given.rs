//! Flags that a command line gives, and refusals of flags that cannot act on its target.

use super::table::{FLAGS, Flag};
use crate::failure::Failure;
use crate::target::Target;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, Error, FromArgMatches};
use juggler::imaging::AnimationFormat;

/// The flags that a command line gives. As an argument it is the first of its command, since the
/// others are taken from the matches one after another.
#[derive(Clone, Debug, Default)]
pub struct GivenFlags(Vec<&'static Flag>);

impl GivenFlags {
    /// Fails for the first flag of the table that cannot act on the target.
    pub fn check(&self, target: Target) -> Result<(), Failure> {
        match self.0.iter().find_map(|flag| flag.refusal(target)) {
            Some(message) => Err(Failure::Invalid(message)),
            None => Ok(()),
        }
    }
}

impl Flag {
    /// Message about a flag that cannot act on the target.
    pub(super) fn refusal(&self, target: Target) -> Option<String> {
        let (_, reason) = self.idle.iter().find(|(targets, _)| targets.contain(target))?;
        let value = self.value.map(|value| format!(" {value}")).unwrap_or_default();
        let reason = reason.replace("{format}", &target.format()).replace("{movies}", &AnimationFormat::extensions());
        Some(format!("--{}{value} {reason}", self.name))
    }

    /// Whether the flag is given, with the value that matters.
    fn is_given(&self, matches: &ArgMatches) -> bool {
        let id = self.name.replace('-', "_");
        let is_typed =
            matches.ids().any(|known| *known == id) && matches.value_source(&id) == Some(ValueSource::CommandLine);
        let has_value = |value: &str| matches.get_raw(&id).is_some_and(|mut values| values.any(|typed| typed == value));
        is_typed && self.value.is_none_or(has_value)
    }
}

impl FromArgMatches for GivenFlags {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Ok(Self(FLAGS.iter().filter(|flag| flag.is_given(matches)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for GivenFlags {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}
