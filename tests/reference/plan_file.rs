//! The page of plan files names every key that a plan has, and no other; the page of exit codes says what happens.
