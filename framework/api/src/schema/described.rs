//! Plain data against the schema of their own type: the ranges that stand at its fields.

use super::walk::check_below;
use crate::{Departure, Fault, KeyPath};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use std::any::type_name;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Checks data against the schema of their type; `key` is their own place, above those of their fields.
///
/// An option that holds no finite number passes as none: JSON knows no such numbers.
pub fn check_described<T: Serialize + JsonSchema>(data: &T, key: &str) -> Result<(), Departure> {
    check(data, &schema_of::<T>(), None, key)
}

/// Checks data against what the schema of `T` says of its field `field`; `key` is their own place.
pub fn check_field<T: JsonSchema>(field: &str, data: &impl Serialize, key: &str) -> Result<(), Departure> {
    check(data, &schema_of::<T>(), Some(field), key)
}

fn check(data: &impl Serialize, root: &Value, field: Option<&str>, key: &str) -> Result<(), Departure> {
    let path = if key.is_empty() { KeyPath::default() } else { KeyPath::default().key(key) };
    let unreadable =
        |error: serde_json::Error| Fault::Type { expected: "plain data".into(), found: error.to_string() };
    let value = serde_json::to_value(data)
        .map_err(|error| Departure { path: path.clone(), fault: unreadable(error) })?;
    let schema = field.map_or(root, |field| &root["properties"][field]);
    check_below(&value, (schema, root), &path).map_err(not_finite)
}

/// The schema of a type, made once.
pub(crate) fn schema_of<T: JsonSchema>() -> Arc<Value> {
    static MADE: Mutex<BTreeMap<&str, Arc<Value>>> = Mutex::new(BTreeMap::new());
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let make = || Arc::new(schemars::schema_for!(T).to_value());
    made.entry(type_name::<T>()).or_insert_with(make).clone()
}

/// In plain data, null where a number must stand was none that JSON knows.
fn not_finite(mut departure: Departure) -> Departure {
    if let Fault::Type { expected, found } = &mut departure.fault
        && found == "null"
    {
        (*found, *expected) = ("infinity or NaN".into(), "a finite number".into());
    }
    departure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, Problem, Shape};

    fn told(answer: Result<(), Departure>) -> String {
        answer.unwrap_err().to_string()
    }

    #[test]
    fn ranges_of_fields_hold_wherever_the_data_come_from() {
        let mut limits = Limits::default();
        assert_eq!(check_described(&limits, "limits"), Ok(()));
        limits.resolution.retreat[1] = -1.0;
        let text = told(check_described(&limits, "limits"));
        assert_eq!(text, "`limits.resolution.retreat[1]` = -1 is outside 0..=0.2 m");
        let ball = Shape::Sphere { radius: 0.0 };
        let text = told(check_described(&ball, "obstacle[1].shape"));
        assert_eq!(text, "`obstacle[1].shape.radius` = 0 is outside 0.000001..=1000 m");
    }

    #[test]
    fn fields_are_checked_by_themselves_and_numbers_must_be_finite() {
        let check = |g| check_field::<Problem>("gravity", &[0.0, g, 0.0], "gravity");
        assert_eq!(check(9.81), Ok(()));
        assert_eq!(told(check(2e3)), "`gravity[1]` = 2000 is outside -1000..=1000 m/s²");
        assert_eq!(told(check(f64::NAN)), "`gravity[1]`: infinity or NaN is not a finite number");
    }
}
