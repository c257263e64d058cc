//! How much memory a run has in use.

/// Counts the bytes that the thread which asks has in use. A library has no allocator of its own: the program
/// that runs studies injects one that counts.
pub trait Memory: Sync {
    /// Begins to look for the most, from what is in use now.
    fn begin(&self);
    /// The most that this thread had in use at once since [`Memory::begin`], beyond what it had then (bytes).
    fn most(&self) -> u64;
}
