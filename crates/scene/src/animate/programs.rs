//! Compiled expressions of a scene, kept from frame to frame.

use juggler_expression::{ExpressionError, Names, Program};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Maximum length of all expressions whose programs are kept, in bytes. Others are compiled each
/// time.
const MAX_KEPT: usize = 1 << 20;

/// Compiled expressions by text, shared by a scene, its copies and its other frames. A program
/// depends on its text only, so it stays valid whatever else changes in the scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Programs(Arc<Mutex<Cache>>);

#[derive(Debug, Default)]
struct Cache {
    by_text: HashMap<Box<str>, Arc<Program>>,
    /// Length of all texts in bytes.
    length: usize,
}

impl Programs {
    /// Program of an expression whose names are checked when it is compiled first.
    pub fn compile(&self, text: &str, names: &Names) -> Result<Arc<Program>, ExpressionError> {
        self.get_or_compile(text, |text| Program::compile(text, names))
    }

    /// Program of an expression whose names are checked at evaluation only.
    pub fn parse(&self, text: &str) -> Result<Arc<Program>, ExpressionError> {
        self.get_or_compile(text, Program::parse)
    }

    fn get_or_compile(
        &self,
        text: &str,
        compile: impl FnOnce(&str) -> Result<Program, ExpressionError>,
    ) -> Result<Arc<Program>, ExpressionError> {
        let mut cache = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(program) = cache.by_text.get(text) {
            return Ok(Arc::clone(program));
        }
        let program = Arc::new(compile(text)?);
        if cache.length + text.len() <= MAX_KEPT {
            cache.length += text.len();
            cache.by_text.insert(text.into(), Arc::clone(&program));
        }
        Ok(program)
    }
}

/// Kept programs are no part of a scene's value.
impl PartialEq for Programs {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_compiled_once() {
        let (programs, names) = (Programs::default(), Names::from_iter([("x", 1.0.into())]));
        let program = programs.compile("x + 1", &names).unwrap();
        assert!(Arc::ptr_eq(&program, &programs.clone().parse("x + 1").unwrap()));
        assert!(programs.compile("x +", &names).is_err());
    }

    #[test]
    fn program_cache_limits_the_total_text_length() {
        let programs = Programs::default();
        let text = |i: usize| format!("{i:<width$}", width = juggler_expression::MAX_LENGTH);
        let is_kept = |i: usize| {
            let [first, second] = [(); 2].map(|()| programs.parse(&text(i)).unwrap());
            Arc::ptr_eq(&first, &second)
        };
        assert!((0..256).all(is_kept) && !is_kept(256) && is_kept(0));
    }
}
