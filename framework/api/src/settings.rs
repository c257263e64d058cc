//! Settings of plugins: plain structs whose schema says what they may be.

use crate::{SettingsError, check_described, check_schema, schema_of};
use serde::{Serialize, de::DeserializeOwned};
use serde_json::Value;

/// A plugin's settings: a plain struct with `#[serde(deny_unknown_fields, default)]`.
///
/// A number's range stands in its schema, `#[schemars(range(min = 0.1, max = 1.0))]`, and its unit beside it,
/// `extend("x-unit" = "m")` ("1" where it has none). Checks, messages, tables and the book take both from
/// there.
pub trait Settings: Serialize + DeserializeOwned + schemars::JsonSchema + Default {
    /// Checks what the schema cannot say: how values depend on one another.
    fn check_further(&self) -> Result<(), SettingsError> {
        Ok(())
    }

    /// Checks every value: against the schema first.
    fn validate(&self) -> Result<(), SettingsError> {
        check_described(self, "")?;
        self.check_further()
    }

    /// Reads and checks settings from JSON text; the empty text stands for the defaults.
    fn from_json(text: &str) -> Result<Self, SettingsError> {
        let text = if text.trim().is_empty() { "{}" } else { text };
        let form = |error: serde_json::Error| SettingsError::Form(error.to_string());
        let value: Value = serde_json::from_str(text).map_err(form)?;
        check_schema(&value, &schema_of::<Self>())?;
        let settings: Self = serde_json::from_value(value).map_err(form)?;
        settings.check_further()?;
        Ok(settings)
    }

    /// The JSON schema, with defaults and descriptions.
    fn schema() -> String {
        schema_of::<Self>().to_string()
    }
}

/// Settings of a plugin that has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NoSettings {}

impl Settings for NoSettings {}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Default, Serialize, serde::Deserialize, schemars::JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    struct Slide {
        #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "m"))]
        length: f64,
        #[schemars(range(min = 3, max = 64))]
        edges: Option<usize>,
    }

    impl Settings for Slide {}

    fn refusal(slide: &Slide) -> String {
        slide.validate().unwrap_err().to_string()
    }

    #[test]
    fn ranges_refuse_what_is_outside_and_nan() {
        assert!(Slide { length: 0.5, edges: Some(3) }.validate().is_ok());
        let long = Slide { length: 1.5, edges: None };
        assert_eq!(refusal(&long), "`length` = 1.5 is outside 0..=1 m");
        assert_eq!(
            refusal(&Slide { length: f64::NAN, edges: None }),
            "`length`: infinity or NaN is not a finite number"
        );
        assert_eq!(refusal(&Slide { length: 0.0, edges: Some(2) }), "`edges` = 2 is outside 3..=64");
    }

    #[test]
    fn empty_text_means_defaults_and_unknown_keys_are_refused() {
        assert!(NoSettings::from_json("").is_ok());
        let error = NoSettings::from_json(r#"{"edges": 3}"#).unwrap_err().to_string();
        assert!(error.contains("edges"), "{error}");
        assert_eq!(NoSettings::from_json("[1]").unwrap_err().to_string(), "a list is not a table");
    }
}
