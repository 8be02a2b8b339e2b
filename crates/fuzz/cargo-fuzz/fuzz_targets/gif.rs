#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    juggler_fuzz::targets::by_name("gif").is_some_and(|target| (target.read)(bytes));
});
