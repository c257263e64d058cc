//! Units, as descriptions give them.

/// Every unit that a description may give.
const UNITS: &[&str] = &[
    "m", "rad", "degrees", "s", "kg", "N", "N·m", "m/s", "m/s²", "rad/s", "rad/s²", "N/m", "N·m/rad", "s⁻¹",
];

/// The unit that the description of a number gives in parentheses: `m` in "Radius (m)." and in "Longest edge (m, of a tree).", or
/// `rad; m where prismatic` where it depends. `None` where the number has no unit.
///
/// Descriptions of settings and of keys in files keep to this, so that tables and messages can tell the unit.
pub fn unit(description: &str) -> Option<&str> {
    let groups = description.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    groups.map(|group| group.split(',').next().unwrap_or(group).trim()).find(|group| {
        let first = group.split(';').next().unwrap_or(group).trim();
        UNITS.contains(&first)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_in_parentheses() {
        assert_eq!(unit("Radius (m)."), Some("m"));
        assert_eq!(unit("How far (degrees, 0..=180) it may turn."), Some("degrees"));
        assert_eq!(unit("Position (rad; m where prismatic)."), Some("rad; m where prismatic"));
        assert_eq!(unit("Facets (as plan files carry them) about the origin (m)"), Some("m"));
        assert_eq!(unit("Probability of α = 1 (the paper's), metres"), None);
    }
}
