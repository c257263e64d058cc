//! Lists of goals: files of `[[goal]]` tables as scenarios have them, each row by itself right or wrong.

use super::{Document, ScenarioError, read};
use regrasp_api::{GoalDescription, KeyPath, PoseError, Refuse};
use std::path::Path;

/// The goals of a list in turn, those that are wrong with what is wrong with them.
pub struct GoalList {
    /// The rows.
    pub goals: Vec<Result<GoalDescription, ScenarioError>>,
    document: Document,
}

impl GoalList {
    /// Reads a TOML or JSON file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        Self::from_text(&path.display().to_string(), &read(path)?)
    }

    /// Reads the text of a file.
    pub fn from_text(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let document = Document::parse(file, text)?;
        let goals = document.rows::<GoalDescription>("goal")?;
        let place = KeyPath::default().key("goal");
        if goals.is_empty() {
            let message = "the list has no goals: give a `[[goal]]` table for each, with a `pose` as in a \
                           scenario";
            return Err(document.refuse(&place, message.into()));
        }
        let mut list = Self { goals: Vec::new(), document };
        for (row, goal) in goals.into_iter().enumerate() {
            let goal = goal.and_then(|goal| list.checked(row, goal));
            list.goals.push(goal);
        }
        Ok(list)
    }

    fn checked(&self, row: usize, goal: GoalDescription) -> Result<GoalDescription, ScenarioError> {
        let named = |error: PoseError| self.refuse(row, &error.refusal().below("pose"));
        goal.pose.pose().map_err(named).map(|_| goal)
    }

    /// The refusal of a row, counted from 0, for something that was found wrong later; its key is that within
    /// the row.
    pub fn refuse(&self, row: usize, error: &impl Refuse) -> ScenarioError {
        self.document.refused(&error.refusal().below(&format!("goal[{row}]")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_row_leaves_the_others_alone() {
        let text = "[[goal]]\npose = { position = [0.0, 0.0, 0.085] }\n[[goal]]\npose = { positon = [0, 0, \
                    0] }\n[[goal]]\npose = { axis = [0.0, 0.0, 1.0] }\n";
        let list = GoalList::from_text("goals.toml", text).unwrap();
        assert!(list.goals[0].is_ok());
        let said = |row: usize| list.goals[row].as_ref().unwrap_err().to_string();
        assert!(said(1).contains("position") && said(1).contains("goals.toml:4"), "{}", said(1));
        assert!(said(2).contains("angle_deg") && said(2).contains("goal[2].pose"), "{}", said(2));
    }

    #[test]
    fn what_is_no_list_of_goals_is_refused() {
        for text in ["", "goal = 3", "[[goals]]\npose = {}", "goal = []"] {
            let refused = GoalList::from_text("goals.toml", text).err().unwrap().to_string();
            assert!(refused.contains("goal"), "{refused}");
        }
        assert!(GoalList::from_text("goals.toml", "[[goal").is_err());
    }
}
