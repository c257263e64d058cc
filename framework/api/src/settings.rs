//! Settings of plugins: plain structs that check themselves.

use crate::SettingsError;
use serde::{Serialize, de::DeserializeOwned};

/// A plugin's settings: a plain struct with `#[serde(deny_unknown_fields, default)]`.
pub trait Settings: Serialize + DeserializeOwned + schemars::JsonSchema + Default {
    /// Checks every value against its range.
    fn validate(&self) -> Result<(), SettingsError>;

    /// Reads and checks settings from JSON text; the empty text stands for the defaults.
    fn from_json(text: &str) -> Result<Self, SettingsError> {
        let text = if text.trim().is_empty() { "{}" } else { text };
        // serde would read a list as the fields in their order.
        if !text.trim_start().starts_with('{') {
            return Err(SettingsError::Form("settings are a table of keys and values".into()));
        }
        let settings: Self =
            serde_json::from_str(text).map_err(|error| SettingsError::Form(error.to_string()))?;
        settings.validate()?;
        Ok(settings)
    }

    /// The JSON schema, with defaults and descriptions.
    fn schema() -> String {
        schemars::schema_for!(Self).as_value().to_string()
    }
}

/// Settings of a plugin that has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NoSettings {}

impl Settings for NoSettings {
    fn validate(&self) -> Result<(), SettingsError> {
        Ok(())
    }
}

/// Refuses a number outside `low..=high`, and NaN.
pub fn check_range(key: &'static str, value: f64, low: f64, high: f64) -> Result<(), SettingsError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(SettingsError::Range { key, value: value.to_string(), range: format!("{low}..={high}") })
}

/// Refuses a count outside `low..=high`.
pub fn check_count(key: &'static str, value: usize, low: usize, high: usize) -> Result<(), SettingsError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(SettingsError::Range { key, value: value.to_string(), range: format!("{low}..={high}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_refuse_what_is_outside_and_nan() {
        assert!(check_range("mu", 0.5, 0.0, 1.0).is_ok());
        let error = check_range("mu", 1.5, 0.0, 1.0).unwrap_err();
        assert_eq!(error.to_string(), "`mu` = 1.5 is outside 0..=1");
        assert!(check_range("mu", f64::NAN, 0.0, 1.0).is_err());
        assert!(check_count("edges", 2, 3, 64).is_err());
    }

    #[test]
    fn empty_text_means_defaults_and_unknown_keys_are_refused() {
        assert!(NoSettings::from_json("").is_ok());
        let error = NoSettings::from_json(r#"{"edges": 3}"#).unwrap_err().to_string();
        assert!(error.contains("edges"), "{error}");
        assert!(NoSettings::from_json("[1]").is_err());
    }
}
