//! What is asked for.

use crate::{AtlasError, Member, Shape};
use serde::{Deserialize, Serialize};

/// What an atlas holds. Every field is public; [`Wish::validate`] checks the ranges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wish {
    /// The shapes of the objects.
    pub shapes: Vec<Shape>,
    /// Their sizes (m), each in 0.001 to 1; [`Shape`] says what is measured.
    pub sizes: Vec<f64>,
    /// Coefficients of friction, each in 0.01 to 10.
    pub frictions: Vec<f64>,
    /// Masses (kg) whose weight the grasps must hold within the joints' efforts, each in 1e-4 to 100; where
    /// there are none, closure is asked for, whatever the force.
    pub masses: Vec<f64>,
    /// Goals for each member, 1 to 100,000.
    pub goals: usize,
    /// How far (m) the object may be from where it was when it has turned, 0 to 1.
    pub reach: f64,
    /// Positions that are tried for each orientation, 1 to 100: first where the object was, then others
    /// within `reach`.
    pub tries: usize,
    /// The most nodes that a search for one position generates, 1 to 10,000,000.
    pub nodes: usize,
    /// Seed of all random choices.
    pub seed: u64,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            shapes: vec![Shape::Sphere, Shape::Cube],
            sizes: [20, 30, 40, 50, 60, 70, 80].map(|mm| f64::from(mm) * 1e-3).to_vec(),
            frictions: vec![0.8],
            masses: Vec::new(),
            goals: 40,
            reach: 0.01,
            tries: 3,
            nodes: 10,
            seed: 0,
        }
    }
}

impl Wish {
    /// Refuses the first value outside its range, and lists of nothing.
    pub fn validate(&self) -> Result<(), AtlasError> {
        let lists = [
            ("shapes", self.shapes.is_empty()),
            ("size", self.sizes.is_empty()),
            ("friction", self.frictions.is_empty()),
        ];
        if let Some((key, _)) = lists.into_iter().find(|(_, is_empty)| *is_empty) {
            return Err(AtlasError::Nothing { key });
        }
        let all = |key, values: &[f64], low, high| {
            values.iter().map(move |&value| (key, value, low, high)).collect::<Vec<_>>()
        };
        let bounds = [
            all("size", &self.sizes, 1e-3, 1.0),
            all("friction", &self.frictions, 0.01, 10.0),
            all("mass", &self.masses, 1e-4, 100.0),
            all("goals", &[self.goals as f64], 1.0, 1e5),
            all("reach", &[self.reach], 0.0, 1.0),
            all("tries", &[self.tries as f64], 1.0, 100.0),
            all("nodes", &[self.nodes as f64], 1.0, 1e7),
        ];
        let outside =
            bounds.concat().into_iter().find(|(_, value, low, high)| !(low..=high).contains(&value));
        match outside {
            Some((key, value, low, high)) => Err(AtlasError::Range { key, value, low, high }),
            None => Ok(()),
        }
    }

    /// The members of the family for hands of these names: for each hand all shapes, sizes, frictions and
    /// masses.
    pub fn members<'n>(&self, hands: impl IntoIterator<Item = &'n str>) -> Vec<Member> {
        let masses: Vec<Option<f64>> = match self.masses.is_empty() {
            true => vec![None],
            false => self.masses.iter().copied().map(Some).collect(),
        };
        let mut members = Vec::new();
        for hand in hands {
            for &shape in &self.shapes {
                for &friction in &self.frictions {
                    for &mass in &masses {
                        let of_size =
                            |&size: &f64| Member { hand: hand.to_owned(), shape, size, friction, mass };
                        members.extend(self.sizes.iter().map(of_size));
                    }
                }
            }
        }
        members
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_family_is_the_product_of_all_that_varies() {
        let wish = Wish { frictions: vec![0.5, 0.8], masses: vec![0.1], ..Wish::default() };
        let members = wish.members(["a", "b"]);
        assert_eq!(members.len(), 2 * 2 * 2 * 7);
        assert_eq!((members[0].hand.as_str(), members[0].mass), ("a", Some(0.1)));
        let without = Wish::default().members(["a"]);
        assert!(without.len() == 14 && without.iter().all(|member| member.mass.is_none()));
    }

    #[test]
    fn the_first_value_out_of_range_is_named() {
        assert!(Wish::default().validate().is_ok());
        let refused = |wish: Wish| wish.validate().unwrap_err().to_string();
        assert!(refused(Wish { sizes: vec![], ..Wish::default() }).contains("`size`"));
        assert!(refused(Wish { frictions: vec![0.5, -1.0], ..Wish::default() }).contains("`friction` = -1"));
        assert!(refused(Wish { reach: f64::NAN, ..Wish::default() }).contains("`reach`"));
        assert!(refused(Wish { goals: 0, ..Wish::default() }).contains("`goals` = 0"));
    }
}
