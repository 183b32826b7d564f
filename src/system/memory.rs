//! Memory of arrays, from their lengths.

/// Memory of an array of `T`, B.
pub(super) fn bytes<T>(array: &[T]) -> usize {
    size_of_val(array)
}

/// Memory of an array that there may be, B.
pub(super) fn optional_bytes<T>(array: &Option<Vec<T>>) -> usize {
    array.as_deref().map_or(0, bytes)
}
