//! Units, as schemas give them.

use serde_json::Value;

/// The key of a schema that holds its number's unit, or its list's.
pub const UNIT_KEY: &str = "x-unit";

/// Every unit that a schema may give; "1" says that the number has none.
pub const UNITS: &[&str] = &[
    "1", "m", "rad", "degrees", "s", "kg", "N", "N·m", "m/s", "m/s²", "rad/s", "rad/s²", "N/m", "N·m/rad",
    "s⁻¹",
];

/// The unit of a schema's number: `m`, or `rad; m where prismatic` where it depends. `None` where the number
/// has none, or where the schema does not say.
pub fn unit(schema: &Value) -> Option<&str> {
    schema.get(UNIT_KEY)?.as_str().filter(|unit| *unit != "1")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn units_stand_in_the_schema() {
        assert_eq!(unit(&json!({"x-unit": "m"})), Some("m"));
        assert_eq!(unit(&json!({"x-unit": "1"})), None);
        assert_eq!(unit(&json!({"description": "Radius (m)."})), None);
    }
}
