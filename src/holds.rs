//! What a plan's grasps hold, in words.

use regrasp::api::Problem;
use regrasp::page::place_text;
use regrasp::plan::Holds;

/// What a plan's grasps hold, and one line where they cannot carry the object.
pub fn holds_lines(holds: Option<&Holds>, problem: &Problem) -> String {
    let Some(holds) = holds else { return String::new() };
    let (object, friction) = (&problem.object, &holds.friction);
    if friction.value > object.friction * (1.0 + 1e-9) {
        let needed = match friction.value {
            value if value < 99.0 => {
                format!("friction {value:.2} would be needed, {} is given", object.friction)
            }
            _ => "no friction would do".into(),
        };
        let place = place_text(&friction.place, problem);
        let advice = if problem.hold.is_none() { "; `[hold]` plans for it" } else { "" };
        return format!("  cannot carry  its {} kg ({place}): {needed}{advice}\n", object.mass);
    }
    let effort = holds
        .effort
        .as_ref()
        .map_or(String::new(), |effort| format!(", with {:.0} % of a joint's effort", effort.value * 100.0));
    format!(
        "  holds         at friction {:.2} ({}), {:.2} kg, {:.2} N from any side{effort}\n",
        friction.value,
        place_text(&friction.place, problem),
        holds.mass.value,
        holds.disturbance.value,
    )
}
