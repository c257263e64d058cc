//! `contact-model/soft-finger`: point contact with friction and a torque about the normal.

use regrasp_api::{
    Build, Cone, Contact, ContactModel, Entry, FingerIndex, Settings, SettingsError, Slot, check_settings,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Settings of [`SoftFinger`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SoftFingerSettings {
    /// Torsional friction radius γ (m): the largest torque about the normal per newton of normal force.
    ///
    /// A patch of radius a under uniform pressure gives γ = 2/3 μ a, under Hertz's pressure 3π/16 μ a. The
    /// default 0.002 is a neutral choice: what a soft tip with a patch of 4 mm radius and μ = 0.8 transmits.
    #[schemars(range(min = 1e-6, max = 0.1), extend("x-unit" = "m"))]
    pub gamma: f64,
}

impl Default for SoftFingerSettings {
    fn default() -> Self {
        Self { gamma: 0.002 }
    }
}

impl Settings for SoftFingerSettings {}

/// Soft finger: friction forces and a torque about the normal that share one ellipsoid, `|f_t|²/μ² + m²/γ² ≤
/// f_n²`.
///
/// The elliptic approximation of the limit surface: Howe & Cutkosky, "Practical force-motion models for
/// sliding manipulation", IJRR 1996. Two such contacts can hold an object, so the planner works in GS_3. The
/// radius does not change with the friction coefficient; where a fingertip spins about its normal it
/// transmits no torque, which is the planner's business.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftFinger {
    gamma: f64,
}

impl SoftFinger {
    /// A soft finger with checked settings.
    pub fn new(settings: SoftFingerSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { gamma: settings.gamma })
    }
}

impl ContactModel for SoftFinger {
    fn cone(&self, _finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: self.gamma }
    }

    fn fewest_contacts(&self) -> usize {
        2
    }
}

regrasp_api::inventory::submit! {
    Entry {
        id: "contact-model/soft-finger",
        slots: &[Slot::ContactModel],
        summary: "Soft finger: friction force and torque about the normal inside one ellipsoid; two \
            contacts can hold.",
        references: &[
            "Howe, Cutkosky, Practical force-motion models for sliding manipulation, IJRR 1996",
        ],
        schema: SoftFingerSettings::schema,
        check: check_settings::<SoftFingerSettings>,
        build: Build::ContactModel(|json, _| {
            Ok(Box::new(SoftFinger::new(SoftFingerSettings::from_json(json)?)?))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_outside_its_range_is_refused_with_the_range() {
        for gamma in [f64::NAN, f64::INFINITY] {
            let error = SoftFinger::new(SoftFingerSettings { gamma }).unwrap_err().to_string();
            assert!(error.contains("`gamma`") && error.contains("is not a finite number"), "{error}");
        }
        for gamma in [0.0, -0.001, 0.2] {
            let error = SoftFinger::new(SoftFingerSettings { gamma }).unwrap_err().to_string();
            assert!(error.contains("`gamma`") && error.contains("0.000001..=0.1"), "{error}");
        }
        for gamma in [1e-6, 0.1] {
            assert!(SoftFinger::new(SoftFingerSettings { gamma }).is_ok());
        }
    }

    #[test]
    fn unknown_keys_are_refused_and_the_schema_names_gamma() {
        assert!(SoftFingerSettings::from_json(r#"{"gama": 0.01}"#).unwrap_err().to_string().contains("gama"));
        assert_eq!(SoftFingerSettings::from_json("").unwrap(), SoftFingerSettings::default());
        assert!(SoftFingerSettings::schema().contains("gamma"));
    }
}
