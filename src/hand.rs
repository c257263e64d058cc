//! `regrasp hand`: how a robot's file is understood, and the hand file that it becomes.

mod page;
mod scenario;
mod values;
mod xacro;

use crate::numbers::whole;
use crate::outputs::{self, HAND_MARK, Kind, OverwriteArgs};
use crate::table::Table;
use crate::terminal::printable;
use crate::view::PageArgs;
use crate::{Failure, inputs, say, say_json};
use clap::{Args, FromArgMatches};
use regrasp::api::{FingerIndex, Hand, HandDescription, JointDescription, Vec3};
use regrasp::hands::{HandOptions, HandReport, JointChoice, ReadHand, read_hand, read_urdf_text};
use regrasp::world::{ChainHand, FingerWorkspace, ObjectPlace, finger_workspace, object_places};
use scenario::beside;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use values::{point, position, radius, range, rate};

/// Show how a hand's URDF or MJCF is understood: fingers, joints, limits, reach, shapes, and what is ignored.
#[derive(Debug, Args)]
#[command(after_help = "\
A scenario uses the URDF itself (`[hand] urdf = \"my-hand.urdf\"`, with keys of the same names as the \
options here) or the hand file that `-o` writes (`[hand] file = \"my-hand.toml\"`), which can be edited. \
The position that is proposed for an \
 object is a place to start from: \
`regrasp plan` tells whether it is a good one.\n\n\
Examples:\n  regrasp hand my-hand.urdf\n  regrasp hand my-hand.urdf --tips \
 thumb_tip,index_tip,middle_tip,ring_tip --fingertip-radius 0.012\n  \
regrasp hand my-hand.urdf --packages ~/ros/src -o my-hand.toml\n  regrasp hand my-hand.urdf --view")]
pub struct HandArgs {
    /// A URDF or MJCF file, or a xacro file, which `xacro` expands if it is installed.
    pub file: PathBuf,
    /// What a xacro file's arguments are, as xacro has them: `NAME:=VALUE`.
    #[arg(value_name = "NAME:=VALUE")]
    pub values: Vec<String>,
    /// The fingertip links, one a finger, in the order in which the fingers are counted; guessed where
    /// absent.
    #[arg(long, value_name = "LINK,…", value_delimiter = ',')]
    pub tips: Vec<String>,
    /// Radius of the balls that stand for the fingertips (m); where absent, that of the tip links' own
    /// balls, or fitted.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub fingertip_radius: Option<f64>,
    /// Centre of these balls in the frames of the tip links (m), given once or once for each finger; where
    /// absent, they are fitted.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub tip_offset: Vec<Vec3>,
    /// The link whose frame is the hand's; where absent, the last one that all fingertips hang on.
    #[arg(long, value_name = "LINK")]
    pub palm: Option<String>,
    /// The posture of an MJCF (a key frame) in which joints stand that no finger has, and in which the
    /// fingers rest.
    #[arg(long, value_name = "NAME")]
    pub keyframe: Option<String>,
    /// A folder that holds packages of `package://` paths; can be repeated.
    #[arg(long, value_name = "DIR")]
    pub packages: Vec<PathBuf>,
    /// Take each mesh apart into at most this many convex pieces, 1 to 64; by default its convex hull is
    /// used.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize, 1, 64>)]
    pub mesh_pieces: Option<usize>,
    /// What all lengths of the file are multiplied with, such as 0.001 for millimetres.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub scale: Option<f64>,
    /// What the coordinates of all its meshes are multiplied with.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub mesh_scale: Option<f64>,
    /// The range of joints (rad): `-0.3..1.6` for those without one, or with a name, `*` standing for any
    /// letters; can be repeated.
    #[arg(long, value_name = "[NAME=]LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    pub limits: Vec<JointChoice>,
    /// Where a joint that no finger has stands (rad); can be repeated.
    #[arg(long, value_name = "NAME=POSITION", value_parser = position)]
    pub posture: Vec<JointChoice>,
    /// Largest acceleration of every joint (rad/s²); by default what the URDF says, or else 20.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub acceleration: Option<f64>,
    /// Largest velocity (rad/s) of joints for which the file says none, or 0; with a name, of these joints;
    /// can be repeated.
    #[arg(long, value_name = "[NAME=]V", allow_hyphen_values = true, value_parser = rate)]
    pub velocity: Vec<(Option<String>, f64)>,
    /// Largest effort (N·m) of joints for which the file says none, or 0; with a name, of these joints; can
    /// be repeated.
    #[arg(long, value_name = "[NAME=]E", allow_hyphen_values = true, value_parser = rate)]
    pub effort: Vec<(Option<String>, f64)>,
    /// Propose a position for a ball of this radius (m).
    #[arg(
        long,
        value_name = "M",
        default_value_t = 0.03,
        allow_negative_numbers = true,
        value_parser = radius
    )]
    pub ball: f64,
    /// Write a scenario with a ball where the fingers surround it best, instead of the hand file.
    #[arg(long, requires = "output")]
    pub scenario: bool,
    /// Write the hand file, with all meshes in it; `-` is standard output, and the report then goes to
    /// standard error.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub page: PageArgs,
    #[command(flatten)]
    pub overwrite: OverwriteArgs,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &HandArgs) -> Result<(), Failure> {
    let kind = if args.scenario { Kind::Scenario } else { Kind::Hand };
    let hand_beside =
        args.output.as_deref().map(beside).filter(|_| args.scenario && xacro::is_needed(&args.file));
    let mut wished: Vec<(&Path, Kind)> =
        args.output.as_deref().map(|path| (path, kind)).into_iter().collect();
    wished.extend(hand_beside.as_deref().map(|path| (path, Kind::Hand)));
    args.page.check(&inputs::of_robot(&args.file, &args.packages), &wished, args.overwrite)?;
    let ReadHand { description, report } = read(args)?;
    let hand = ChainHand::new(description).map_err(Failure::refused)?;
    let understood = Understood::of(&hand, &report, args.ball);
    if let Some(path) = &args.output {
        let text =
            if args.scenario { understood.scenario(args, path)? } else { hand_file(hand.description())? };
        write(path, &text)?;
    }
    if args.page.wanted() {
        args.page.show(&understood.page()?, args.output.as_deref())?;
    }
    if args.page.is_standard() || args.output.as_deref().is_some_and(outputs::is_standard) {
        // Standard output is the hand file's, or the page's.
        let _ = std::io::stderr().write_all(printable(&understood.text(None)).as_bytes());
        return Ok(());
    }
    if args.json { say_json(&understood.json()) } else { say(&understood.text(args.output.as_deref())) }
}

/// The page of a robot's file, read as without any option.
pub fn page_of(file: &str) -> Result<String, Failure> {
    let command = HandArgs::augment_args(clap::Command::new("hand"));
    let words = command.try_get_matches_from(["hand", file]).map_err(Failure::bad_input)?;
    let args = HandArgs::from_arg_matches(&words).map_err(Failure::bad_input)?;
    let ReadHand { description, report } = read(&args)?;
    let hand = ChainHand::new(description).map_err(Failure::refused)?;
    Understood::of(&hand, &report, args.ball).page()
}

fn read(args: &HandArgs) -> Result<ReadHand, Failure> {
    let options = options(args);
    if xacro::is_needed(&args.file) {
        let text = xacro::expand(&args.file, &args.values, &args.packages)?;
        return read_urdf_text(&args.file, &text, &options).map_err(Failure::refused);
    }
    if let Some(value) = args.values.first() {
        return Err(Failure::bad_input(format!("`{value}`: only a xacro file takes arguments")));
    }
    read_hand(&args.file, &options).map_err(Failure::refused)
}

fn options(args: &HandArgs) -> HandOptions {
    let for_all = |rates: &[(Option<String>, f64)]| {
        rates.iter().rev().find(|(name, _)| name.is_none()).map(|(_, value)| *value)
    };
    HandOptions {
        tips: args.tips.clone(),
        fingertip_radius: args.fingertip_radius,
        tip_offset: args.tip_offset.iter().map(|&offset| offset.into()).collect(),
        palm: args.palm.clone(),
        keyframe: args.keyframe.clone(),
        packages: args.packages.clone(),
        mesh_pieces: args.mesh_pieces,
        scale: args.scale,
        mesh_scale: args.mesh_scale,
        acceleration: args.acceleration,
        velocity: for_all(&args.velocity),
        effort: for_all(&args.effort),
        limits: args.limits.iter().rev().find(|choice| choice.name.is_empty()).and_then(both),
        joints: joints(args),
    }
}

fn both(choice: &JointChoice) -> Option<[f64; 2]> {
    Some([choice.lower?, choice.upper?])
}

/// What is given for joints by name.
fn joints(args: &HandArgs) -> Vec<JointChoice> {
    let named = |rates: &[(Option<String>, f64)], set: fn(&mut JointChoice, f64)| -> Vec<JointChoice> {
        let choice = |(name, value): &(Option<String>, f64)| {
            let mut choice = JointChoice { name: name.clone()?, ..Default::default() };
            set(&mut choice, *value);
            Some(choice)
        };
        rates.iter().filter_map(choice).collect()
    };
    let ranges = args.limits.iter().filter(|choice| !choice.name.is_empty()).cloned();
    ranges
        .chain(named(&args.velocity, |choice, value| choice.velocity = Some(value)))
        .chain(named(&args.effort, |choice, value| choice.effort = Some(value)))
        .chain(args.posture.iter().cloned())
        .collect()
}

fn fingers(hand: &ChainHand) -> impl Iterator<Item = FingerIndex> + use<> {
    (0..hand.finger_count() as u8).map(FingerIndex)
}

fn hand_file(hand: &HandDescription) -> Result<String, Failure> {
    let text = toml::to_string(hand).map_err(Failure::bad_input)?;
    Ok(format!("{HAND_MARK}\n{text}"))
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    if outputs::is_standard(path) {
        return say(text);
    }
    regrasp::plan::write_file(path, |out| out.write_all(text.as_bytes())).map_err(Failure::refused)
}

/// A hand and everything that is told about it.
struct Understood<'a> {
    hand: &'a ChainHand,
    report: &'a HandReport,
    reach: Vec<FingerWorkspace>,
    /// Where the fingers surround a ball, the best place first.
    places: Vec<ObjectPlace>,
    ball: f64,
}

impl<'a> Understood<'a> {
    fn of(hand: &'a ChainHand, report: &'a HandReport, ball: f64) -> Self {
        let reach = fingers(hand).map(|finger| finger_workspace(hand, finger)).collect();
        Self { hand, report, reach, places: object_places(hand, ball), ball }
    }
}

impl Understood<'_> {
    fn json(&self) -> Value {
        let description = self.hand.description();
        let finger = |(index, reach): (FingerIndex, &FingerWorkspace)| {
            let model = self.hand.finger(index);
            let spare: Vec<&String> = model.spare.iter().map(|&joint| &model.joints[joint].name).collect();
            json!({
                "name": model.name,
                "tip_link": self.report.tips[index.index()],
                "closed_form": self.hand.is_closed_form(index),
                "spare_joints": spare,
                "reach": {
                    "lower": reach.lower.as_slice(), "upper": reach.upper.as_slice(), "volume": reach.volume,
                },
            })
        };
        json!({
            "hand": description,
            "fingers": fingers(self.hand).zip(&self.reach).map(finger).collect::<Vec<_>>(),
            "object_place": self.places.first().map(|place| json!({
                "ball_radius": self.ball, "position": place.p_HO.as_slice(), "quality": place.quality,
            })),
            "report": self.report,
        })
    }

    fn text(&self, written: Option<&Path>) -> String {
        let description = self.hand.description();
        let joints: usize = description.finger.iter().map(|finger| finger.joint.len()).sum();
        let mut text = format!(
            "{}: {} fingers, {joints} joints, fingertips of {:.1} mm radius; the hand's frame is that of \
             link `{}`\n",
            description.name,
            description.finger.len(),
            1e3 * description.fingertip_radius,
            self.report.palm,
        );
        let how = if self.report.tips_guessed { "guessed; `--tips` chooses others" } else { "as given" };
        text += &format!("\nfingers ({how}; boxes of their tips' centres in mm)\n{}", self.finger_table());
        text += &format!("\njoints (degrees, rad/s, rad/s², N·m)\n{}", self.joint_table());
        for (heading, lines) in self.lists() {
            text += &listed(heading, &lines);
        }
        text += &self.proposal();
        text + &written.map(|path| format!("\nwritten to {}\n", path.display())).unwrap_or_default()
    }

    /// What is told line by line; headings without lines are none.
    fn lists(&self) -> [(&'static str, Vec<String>); 6] {
        let report = self.report;
        let pairs = report.touching.iter().map(|[a, b]| format!("`{a}` and `{b}`")).collect();
        let often = |([a, b], share): &([String; 2], f64)| {
            format!("`{a}` and `{b}` in {:.0} % of the postures: not excluded", 100.0 * share)
        };
        [
            ("fingertips' centres", report.tip_centers.clone()),
            ("collision shapes", report.shapes.clone()),
            ("pairs that always touch, excluded (beside neighbours)", pairs),
            ("pairs that touch often", report.often_touching.iter().map(often).collect()),
            ("ignored", report.ignored.clone()),
            ("notes", report.notes.clone()),
        ]
    }

    fn finger_table(&self) -> String {
        let mut table = Table::new("<<<<", &["finger", "joints", "inverse kinematics", "reach", "volume"]);
        for (index, reach) in fingers(self.hand).zip(&self.reach) {
            let model = self.hand.finger(index);
            let driven =
                self.hand.description().finger[index.index()].joint.iter().filter(|j| j.mimic.is_some());
            let spare: Vec<&str> =
                model.spare.iter().map(|&joint| model.joints[joint].name.as_str()).collect();
            let mut joints = model.joints.len().to_string();
            if !spare.is_empty() {
                joints += &format!(", spare {}", spare.join(" "));
            }
            match driven.count() {
                0 => {}
                count => joints += &format!(", driven {count}"),
            }
            let axis = |k: usize| format!("{:.0}..{:.0}", 1e3 * reach.lower[k], 1e3 * reach.upper[k]);
            table.row([
                model.name.clone(),
                joints,
                if self.hand.is_closed_form(index) { "closed form" } else { "numeric" }.into(),
                format!("x {} y {} z {}", axis(0), axis(1), axis(2)),
                format!("{:.0} cm³", 1e6 * reach.volume),
            ]);
        }
        table.text()
    }

    fn joint_table(&self) -> String {
        let head = ["joint", "finger", "from", "to", "velocity", "acceleration", "effort", "driven by"];
        let mut table = Table::new("<<>>>>><", &head);
        for finger in &self.hand.description().finger {
            for joint in &finger.joint {
                table.row([
                    joint.name.clone(),
                    finger.name.clone(),
                    format!("{:.1}", joint.lower.to_degrees()),
                    format!("{:.1}", joint.upper.to_degrees()),
                    short(joint.velocity),
                    short(joint.acceleration),
                    short(joint.effort),
                    driver(joint),
                ]);
            }
        }
        table.text()
    }

    fn proposal(&self) -> String {
        let diameter = 2e3 * self.ball;
        match self.places.first() {
            Some(ObjectPlace { p_HO, quality }) => format!(
                "\nthe fingertips surround a ball of {diameter:.0} mm best at\n  position = [{:.3}, {:.3}, \
                 {:.3}]   (quality {quality:.2} of 1)\n",
                p_HO.x, p_HO.y, p_HO.z
            ),
            None => format!(
                "\nno place was found at which all fingertips reach a ball of {diameter:.0} mm (`--ball`)\n"
            ),
        }
    }
}

fn driver(joint: &JointDescription) -> String {
    let say =
        |mimic: &regrasp::api::Mimic| format!("{} × {} + {}", mimic.multiplier, mimic.joint, mimic.offset);
    joint.mimic.as_ref().map(say).unwrap_or_default()
}

/// A figure without the digits that conversions of units leave: 7.329, not 7.328999999999999.
fn short(x: f64) -> String {
    ((x * 1e4).round() / 1e4).to_string()
}

/// A heading and its lines; nothing where there are none.
fn listed(heading: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
    format!("\n{heading}\n{lines}")
}
