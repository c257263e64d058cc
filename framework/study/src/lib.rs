//! Comparisons of plugin combinations: studies, their runs, statistics and reports.

pub mod compare;
