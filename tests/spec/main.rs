//! The specification: one binary, a file a topic, each test a sentence.

mod checks;
