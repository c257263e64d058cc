//! `regrasp schema`

use crate::args::{Kind, SchemaArgs};
use crate::{Failure, say};
use regrasp::run::scenario;
use regrasp::study::compare;

pub fn run(args: &SchemaArgs) -> Result<(), Failure> {
    let schema = match args.kind {
        Kind::Scenario => scenario::schema(),
        Kind::Hand => scenario::hand_schema(),
        Kind::Study => compare::study_schema(),
    };
    say(&format!("{schema}\n"))
}
