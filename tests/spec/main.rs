//! What pontoon promises, one file a topic.

mod errors;
