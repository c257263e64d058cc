//! What the page of a hand is told.

use super::{Understood, fingers};
use crate::Failure;
use regrasp::api::FingerIndex;
use regrasp::view::{BallPlace, HandView, hand_page};
use regrasp::world::FingerWorkspace;

impl Understood<'_> {
    /// The page that shows the hand.
    pub(super) fn page(&self) -> Result<String, Failure> {
        let ball = self.places.first();
        let lists = self.lists().into_iter().filter(|(_, lines)| !lines.is_empty());
        hand_page(&HandView {
            hand: self.hand.description(),
            ball_radius: self.ball,
            ball: ball.map(|place| BallPlace { position: place.p_HO.into(), quality: place.quality }),
            facts: self.facts(),
            lists: lists.map(|(heading, lines)| (heading.to_owned(), lines)).collect(),
        })
        .map_err(Failure::bad_input)
    }

    fn facts(&self) -> Vec<(String, String)> {
        let description = self.hand.description();
        let how = if self.report.tips_guessed { "guessed" } else { "as given" };
        let mut facts = vec![
            ("Frame".to_owned(), format!("that of link `{}`", self.report.palm)),
            ("Fingertips".to_owned(), format!("links {} ({how})", self.report.tips.join(", "))),
            ("Radius".to_owned(), format!("{:.1} mm", 1e3 * description.fingertip_radius)),
        ];
        facts.extend(fingers(self.hand).zip(&self.reach).map(|(finger, reach)| self.fact(finger, reach)));
        facts
    }

    /// A finger in one line.
    fn fact(&self, finger: FingerIndex, reach: &FingerWorkspace) -> (String, String) {
        let description = &self.hand.description().finger[finger.index()];
        let driven = description.joint.iter().filter(|joint| joint.mimic.is_some()).count();
        let solved = if self.hand.is_closed_form(finger) { "in closed form" } else { "numerically" };
        let joints = match driven {
            0 => description.joint.len().to_string(),
            driven => format!("{} ({driven} driven)", description.joint.len()),
        };
        let volume = 1e6 * reach.volume;
        let text = format!("{joints} joints, inverse kinematics {solved}, reaches {volume:.0} cm³");
        (description.name.clone(), text)
    }
}
