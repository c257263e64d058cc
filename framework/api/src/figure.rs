//! Figures that plugins note under names of their own.

use serde::{Deserialize, Serialize};

/// What was noted under one name: how often, and the values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// How often.
    pub count: u64,
    /// The mean of the values.
    pub mean: f64,
    /// The smallest value.
    pub least: f64,
    /// The largest value.
    pub most: f64,
}

impl Figure {
    /// One value.
    pub fn one(value: f64) -> Self {
        Self { count: 1, mean: value, least: value, most: value }
    }

    /// Both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let count = self.count + other.count;
        let part = other.count as f64 / count as f64;
        Self {
            count,
            mean: self.mean + (other.mean - self.mean) * part,
            least: self.least.min(other.least),
            most: self.most.max(other.most),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_add_up_in_any_grouping() {
        let values = [3.0, -1.0, 4.0, 2.0].map(Figure::one);
        let all = values.into_iter().reduce(Figure::and).unwrap();
        let pairs = values[0].and(values[1]).and(values[2].and(values[3]));
        assert_eq!((all.count, all.least, all.most), (4, -1.0, 4.0));
        assert!((all.mean - 2.0).abs() < 1e-15 && (pairs.mean - 2.0).abs() < 1e-15);
    }
}
