//! URDF: what the XML says, in which line, and what of it is not used.
//!
//! Format: "XML Robot Description Format (URDF)", ROS wiki, elements `robot`, `link`, `joint`. Numbers that
//! are missing stay missing: what may be left out, and what then holds, is decided by those who use them.
//! Nothing is skipped in silence: `ledger.rs` lists every element and attribute that has no say, and refuses
//! what a macro left behind.

mod joint;
mod ledger;
mod link;
mod pose;
#[cfg(test)]
mod tests;

use crate::error::RobotFault as Fault;
use crate::robot::Robot;
use crate::xml::{children, line, parse};

/// Reads the text of a URDF.
pub fn parse_urdf(text: &str) -> Result<Robot, Fault> {
    let document = parse(text)?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        let name = root.tag_name().name();
        return Err(Fault::at(
            line(&root),
            format!("the outermost element is <{name}>, a URDF's is <robot>"),
        ));
    }
    let ledger = ledger::account(&root)?;
    let mut robot = Robot { name: root.attribute("name").unwrap_or("hand").to_owned(), ..Robot::default() };
    robot.links = children(&root, "link").map(|element| link::link(&element)).collect::<Result<_, _>>()?;
    robot.joints =
        children(&root, "joint").map(|element| joint::joint(&element)).collect::<Result<_, _>>()?;
    robot.remarks = ledger.remarks;
    robot.ignored = ledger.ignored;
    Ok(robot)
}
