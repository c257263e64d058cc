//! What a call is handed besides the task: its random stream, its budget, and a recorder of what happened.

use crate::{CallError, Figure, Random, Reason, Slot, pending_fault};

/// Whether the run should stop now: a deadline, Ctrl-C. The command line implements it; libraries own no
/// clock.
pub trait Interrupt: Sync {
    /// True once the run should end. Called often (every 10 to 100 µs); must be cheap.
    fn interrupted(&self) -> bool;
}

/// Never interrupts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uninterrupted;

impl Interrupt for Uninterrupted {
    fn interrupted(&self) -> bool {
        false
    }
}

/// Counts of calls and of rejections by cause, for each slot, and the figures that plugins noted.
///
/// A plugin counts its own calls, first thing ([`Context::count_call`] with its slot), so that every caller
/// is counted and none twice. What is handed no context counts nothing: contact models, and all of a surface
/// but `geodesic`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    calls: [u64; Slot::ALL.len()],
    rejections: [[u64; Reason::ALL.len()]; Slot::ALL.len()],
    notes: Vec<Note>,
    messages: Vec<Message>,
}

/// How much a message matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// The plan may be worse than it could be.
    Warning,
    /// What a user may want to know.
    Info,
    /// What its author wants to know.
    Debug,
}

impl Level {
    /// Every level, the most important first.
    pub const ALL: [Self; 3] = [Self::Warning, Self::Info, Self::Debug];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Warning => "warning",
            Self::Info => "info",
            Self::Debug => "debug",
        }
    }
}

/// What the plugin in a slot said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The slot.
    pub slot: Slot,
    /// How much it matters.
    pub level: Level,
    /// The text.
    pub text: String,
}

/// So many messages of a run are kept, the first ones.
pub const MOST_MESSAGES: usize = 1000;

/// What the plugin in a slot noted under a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Note {
    /// The slot.
    pub slot: Slot,
    /// The name, the plugin's own.
    pub name: &'static str,
    /// The values.
    pub figure: Figure,
}

impl Tally {
    /// How often the plugin in `slot` was called.
    pub fn calls(&self, slot: Slot) -> u64 {
        self.calls[slot as usize]
    }

    /// How often the plugin in `slot` said no because of `reason`.
    pub fn rejections(&self, slot: Slot, reason: Reason) -> u64 {
        self.rejections[slot as usize][reason as usize]
    }

    /// What plugins noted, in the order in which the names came up.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// What plugins said, in the order of the calls that count; the first [`MOST_MESSAGES`].
    pub fn messages(&self) -> &[Message] {
        &self.messages
    }

    fn note(&mut self, slot: Slot, name: &'static str, figure: Figure) {
        match self.notes.iter_mut().find(|note| (note.slot, note.name) == (slot, name)) {
            Some(note) => note.figure = note.figure.and(figure),
            None => self.notes.push(Note { slot, name, figure }),
        }
    }

    /// What was counted since `earlier`, a copy of these counts; of notes and messages it says nothing.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        let mut since = self.clone();
        since.calls.iter_mut().zip(earlier.calls).for_each(|(now, then)| *now -= then);
        let then = earlier.rejections.iter().flatten();
        since.rejections.iter_mut().flatten().zip(then).for_each(|(now, then)| *now -= then);
        since.notes.clear();
        since.messages.clear();
        since
    }

    /// Adds the counts of another call.
    pub fn add(&mut self, other: &Self) {
        self.calls.iter_mut().zip(other.calls).for_each(|(a, b)| *a += b);
        let theirs = other.rejections.iter().flatten();
        self.rejections.iter_mut().flatten().zip(theirs).for_each(|(a, b)| *a += b);
        other.notes.iter().for_each(|note| self.note(note.slot, note.name, note.figure));
        let room = MOST_MESSAGES.saturating_sub(self.messages.len());
        self.messages.extend(other.messages.iter().take(room).cloned());
    }
}

/// The mutable side of one call: random stream, budget, counts. One a call chain and thread; never shared.
pub struct Context<'a> {
    /// The call's random stream: the only source of randomness a plugin may use.
    pub random: Random,
    /// What happened so far.
    pub tally: Tally,
    interrupt: &'a dyn Interrupt,
}

impl Context<'static> {
    /// The context of a call that is made by hand, in a test or an experiment: nothing interrupts it.
    pub fn seeded(seed: u64) -> Self {
        Self::new(Random::from_key(seed, 0, 0, 0), &Uninterrupted)
    }
}

impl<'a> Context<'a> {
    /// A context with the given random stream and interrupt and empty counts.
    pub fn new(random: Random, interrupt: &'a dyn Interrupt) -> Self {
        Self { random, tally: Tally::default(), interrupt }
    }

    /// A context of its own with the same random stream and interrupt, and empty counts: for a call that is
    /// to be made as if this were its.
    #[must_use]
    pub fn twin(&self) -> Self {
        Self::new(self.random.clone(), self.interrupt)
    }

    /// Ends the call with [`CallError::Interrupted`] where the run should stop, or with the panic of a plugin
    /// that this call asked for a value and that could not return it as an error. Call it once per step of a
    /// long loop.
    pub fn proceed(&self) -> Result<(), CallError> {
        if let Some(fault) = pending_fault() {
            return Err(fault);
        }
        if self.interrupt.interrupted() { Err(CallError::Interrupted) } else { Ok(()) }
    }

    /// Counts one call of the plugin in `slot`; the plugin itself does, first thing.
    pub fn count_call(&mut self, slot: Slot) {
        self.tally.calls[slot as usize] += 1;
    }

    /// Counts one "no" of the plugin in `slot`, and hands the reason back.
    pub fn reject(&mut self, slot: Slot, reason: Reason) -> Reason {
        self.tally.rejections[slot as usize][reason as usize] += 1;
        reason
    }

    /// Counts one "no" of the plugin in `slot` for a cause that only the plugin knows: as [`Reason::Other`],
    /// and under the plugin's own word.
    pub fn reject_for(&mut self, slot: Slot, word: &'static str) -> Reason {
        self.note(slot, word, 1.0);
        self.reject(slot, Reason::Other)
    }

    /// Notes a figure of the plugin in `slot` under a name of its own, such as `edge_distance_m`: its count,
    /// mean, least and largest value stand in the plan file and in a study's tables. A value that is not
    /// finite is left out.
    ///
    /// A counter notes 1. Results that are thrown away take their notes with them, so that figures do not
    /// depend on the threads.
    pub fn note(&mut self, slot: Slot, name: &'static str, value: f64) {
        if value.is_finite() {
            self.tally.note(slot, name, Figure::one(value));
        }
    }

    /// Says something in words: the program prints it on standard error where `--log` asks for its level. A
    /// plugin prints nothing itself.
    ///
    /// As with notes, what is said in a call whose result is thrown away is not said at all, so that the
    /// order depends on no thread.
    pub fn log(&mut self, slot: Slot, level: Level, text: impl Into<String>) {
        if self.tally.messages.len() < MOST_MESSAGES {
            self.tally.messages.push(Message { slot, level, text: text.into() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Always;
    impl Interrupt for Always {
        fn interrupted(&self) -> bool {
            true
        }
    }

    #[test]
    fn counts_by_slot_and_reason_and_adds_up() {
        let mut context = Context::seeded(0);
        context.count_call(Slot::Sampler);
        assert_eq!(context.reject(Slot::Sampler, Reason::Reach), Reason::Reach);
        let mut sum = context.tally.clone();
        sum.add(&context.tally);
        assert_eq!(sum.rejections(Slot::Sampler, Reason::Reach), 2);
        assert_eq!(sum.rejections(Slot::Sampler, Reason::Slip), 0);
        assert_eq!((sum.calls(Slot::Sampler), sum.calls(Slot::Surface)), (2, 0));
        assert_eq!(sum.since(&context.tally), context.tally);
    }

    #[test]
    fn notes_are_kept_by_slot_and_name() {
        let mut context = Context::seeded(0);
        context.note(Slot::Sampler, "tries", 3.0);
        context.note(Slot::Sampler, "tries", f64::NAN);
        assert_eq!(context.reject_for(Slot::Sampler, "slippery"), Reason::Other);
        let mut sum = context.tally.clone();
        sum.add(&context.tally);
        let found: Vec<_> = sum.notes().iter().map(|note| (note.name, note.figure.count)).collect();
        assert_eq!(found, [("tries", 2), ("slippery", 2)]);
        assert_eq!(sum.rejections(Slot::Sampler, Reason::Other), 2);
    }

    #[test]
    fn messages_are_kept_in_order_and_bounded() {
        let mut context = Context::seeded(0);
        (0..2 * MOST_MESSAGES).for_each(|k| context.log(Slot::Sampler, Level::Info, k.to_string()));
        let mut sum = Tally::default();
        (0..2).for_each(|_| sum.add(&context.tally));
        assert_eq!(sum.messages().len(), MOST_MESSAGES);
        assert_eq!((sum.messages()[0].text.as_str(), sum.messages()[1].text.as_str()), ("0", "1"));
        assert!(sum.since(&Tally::default()).messages().is_empty());
        assert!(Level::Warning < Level::Debug);
    }

    #[test]
    fn an_interrupt_ends_the_call() {
        let context = Context::new(Random::from_key(0, 0, 0, 0), &Always);
        assert!(matches!(context.proceed(), Err(CallError::Interrupted)));
    }
}
