//! `bindgen FILE.wasm FOLDER`: writes the module and the JavaScript that loads it into the folder.

use std::path::PathBuf;
use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder] = arguments.as_slice() else {
        eprintln!("usage: bindgen FILE.wasm FOLDER");
        return ExitCode::from(2);
    };
    let mut bindgen = Bindgen::new();
    // The page does not need the names of functions.
    bindgen.remove_name_section(true).remove_producers_section(true);
    // The name of the files: `juggler.js`, `juggler_bg.wasm`.
    let ready = bindgen.input_path(module).out_name("juggler").typescript(false).web(true);
    match ready.and_then(|bindgen| bindgen.generate(folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bindgen: {error:#}");
            ExitCode::FAILURE
        }
    }
}
