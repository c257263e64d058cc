//! The page itself: template, style, scripts and data put together.

use crate::assets::{
    HAND_PARTS, LOADER, MODEL, MODEL_STYLE, Modules, OBJECT_PARTS, PAGE, PLAN, PLAN_PARTS, PLAN_STYLE,
    SHARED, STYLE, THREE, THREE_LICENSE,
};
use crate::data::all;
use crate::{Extras, Shown, ViewError};
use regrasp_plan::Plan;
use serde::Serialize;

/// What a page shows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Plan,
    Hand,
    Object,
}

/// The page that shows `plan` with `extras`: one HTML file that needs nothing else.
///
/// The plan need not be valid, nor have a motion at all, but its states must fit its hand. About 0.9 MB, half
/// a kilobyte for each state, and meshes up to 1.5 MB: what has more facets is drawn with fewer, and the page
/// says so. A few milliseconds for each thousand states.
pub fn page(plan: &Plan, extras: &Extras) -> Result<String, ViewError> {
    page_beside(Shown { plan, extras, label: &plan.scenario.name }, &[])
}

/// The same with other plans beside the first, in step with it. What they share with it is written once.
pub fn page_beside(first: Shown<'_>, others: &[Shown<'_>]) -> Result<String, ViewError> {
    Ok(assembled(Kind::Plan, &first.plan.scenario.name, &all(first, others)?))
}

/// The page of a kind around its data.
pub(crate) fn assembled(kind: Kind, title: &str, data: &impl Serialize) -> String {
    let data = serde_json::to_string(data).expect("numbers and names can always be written");
    let (body, style, parts) = match kind {
        Kind::Plan => (PLAN, PLAN_STYLE, PLAN_PARTS),
        Kind::Hand => (MODEL, MODEL_STYLE, HAND_PARTS),
        Kind::Object => (MODEL, MODEL_STYLE, OBJECT_PARTS),
    };
    let fill = |name: &str| match name {
        "TITLE" => escape(title),
        "LICENSE" => THREE_LICENSE.replace("--", "- -"),
        "STYLE" => format!("{STYLE}{style}"),
        "BODY" => body.into(),
        "DATA" => json_in_script(&data),
        "MODULES" => modules(parts),
        "LOADER" => LOADER.into(),
        other => unreachable!("the template has no {other}"),
    };
    filled(PAGE, fill)
}

/// The template with every `{{NAME}}` replaced; what is put in is not looked at again.
fn filled(template: &str, fill: impl Fn(&str) -> String) -> String {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").expect("the template closes what it opens");
        page.push_str(&fill(name));
        page.push_str(rest);
    }
    page
}

/// The modules as inert scripts, which the loader brings to life.
fn modules(parts: Modules) -> String {
    let all = THREE.iter().chain(SHARED).chain(parts);
    all.map(|(name, text)| {
        format!("<script type=\"text/plain\" data-module=\"{name}\">\n{text}\n</script>\n")
    })
    .collect()
}

/// Text for an element or an attribute in quotes.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// JSON that can stand in a script: no name in it can end the element. `<` occurs in texts only, where it may
/// be written as a code.
fn json_in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_leave_their_place() {
        assert_eq!(escape("<b>\"&'"), "&lt;b&gt;&quot;&amp;&#39;");
        let json = json_in_script(r#"{"name":"</script><!-- {{DATA}}"}"#);
        assert!(!json.contains('<') && json.contains("\\u003c/script"));
        let back: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(back["name"], "</script><!-- {{DATA}}");
    }

    #[test]
    fn what_is_put_in_is_not_filled_again() {
        assert_eq!(filled("a {{X}} b {{Y}}", |name| format!("{{{{{name}{name}}}}}")), "a {{XX}} b {{YY}}");
    }
}
