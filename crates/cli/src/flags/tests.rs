//! Tests of the table: it has the flags of all commands, and refuses what cannot act.

use super::*;
use crate::args::RenderArgs;
use crate::command_line::CommandLine;
use crate::failure::Failure;
use crate::plan::Plan;
use std::collections::BTreeSet;

/// Long flags of a command.
fn flags_of(command: &Command) -> BTreeSet<&str> {
    command.get_arguments().filter_map(clap::Arg::get_long).collect()
}

#[test]
fn the_table_has_every_flag_once() {
    let program = CommandLine::command_line();
    // The flags of `bench` do not concern a picture.
    let commands = program.get_subcommands().filter(|command| command.get_name() != "bench");
    let known: BTreeSet<&str> = commands.flat_map(flags_of).collect();
    let listed: BTreeSet<&str> = FLAGS.iter().map(|flag| flag.name).collect();
    assert_eq!(listed.len(), FLAGS.len(), "a flag is listed twice");
    #[cfg(all(feature = "view", feature = "serve"))]
    assert_eq!(listed, known);
    assert!(known.is_subset(&listed), "{known:?}");
}

#[test]
fn flags_have_the_headings_of_the_table() {
    let program = CommandLine::command_line();
    for (command, name, heading) in [
        ("render", "tone", Some("Output")),
        ("render", "checkpoint", Some("Partial renders")),
        ("merge", "max-memory", Some("Machine")),
        ("probe", "size", Some("Picture")),
        ("probe", "fireflies", None),
        ("compare", "tolerance", None),
    ] {
        let command = program.find_subcommand(command).unwrap();
        let flag = command.get_arguments().find(|flag| flag.get_long() == Some(name)).unwrap();
        assert_eq!(flag.get_help_heading(), heading, "{name}");
    }
}

#[test]
fn names_in_other_programs_lead_to_one_flag_of_ours() {
    let mut others = BTreeSet::new();
    for flag in FLAGS {
        let Some((tip, names)) = flag.tip else { continue };
        assert!(tip.contains(&format!("--{}", flag.name)), "{tip}");
        for name in names {
            assert!(others.insert(name), "{name} has two tips");
        }
    }
}

fn refused(line: &str) -> Option<String> {
    match Plan::new(RenderArgs::from_words(line.split(' ')).unwrap()) {
        Ok(_) => None,
        Err(Failure::Invalid(message)) => Some(message),
        Err(other) => panic!("{line}: {other:?}"),
    }
}

#[test]
fn display_flags_are_rejected_for_scene_referred_formats() {
    for flag in ["--tone agx", "--exposure 1", "--white-balance 3200", "--look ham", "--dither on"] {
        let name = flag.split(' ').next().unwrap();
        for ending in ["exr", "hdr", "pfm"] {
            let message = refused(&format!("a {flag} -o b.{ending}")).unwrap();
            assert!(message.starts_with(name) && message.contains(" file"), "{message}");
        }
        for ending in ["png", "jpg", "webp"] {
            assert_eq!(refused(&format!("a {flag} -o b.{ending}")), None, "{flag} {ending}");
        }
    }
    // The picture merged from a partial render, and frames of a movie, are tone mapped.
    for line in ["a --tone agx -o b.jfilm", "a --exposure 1 -o b.gif", "a --dither off -o b.exr"] {
        assert_eq!(refused(line), None, "{line}");
    }
    assert!(refused("a --dither on --bits 16").is_some() && refused("a --dither on -o b.gif").is_some());
}

#[test]
fn shards_of_a_picture_are_partial_renders() {
    assert!(refused("a --shard 0/2 -o a.png").unwrap().contains(".jfilm"));
    assert!(refused("a --sample-range 0..16 -o a.png").unwrap().contains(".jfilm"));
    assert!(refused("a --sample-range 0..16 -o a.gif").unwrap().contains(".jfilm"));
    assert_eq!(refused("a --shard 0/2 -o a.jfilm"), None);
}
