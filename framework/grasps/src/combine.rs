//! Combinations of the fingers' contacts at one pose that are grasps.

use crate::pools::{Pools, Posture};
use regrasp_api::{
    CallError, Configuration, Context, FingerIndex, FingerSet, MAX_FINGERS, Random, Reason, Task,
};

/// What a finger does in a combination: the number of its contact in its pool, `None` where it rests.
pub(crate) type Choice = [Option<u8>; MAX_FINGERS];

/// Draws combinations, and remembers which postures of two fingers go together.
pub(crate) struct Combiner<'p> {
    task: &'p Task<'p>,
    pools: &'p Pools,
    fingers: FingerSet,
    able: FingerSet,
    /// How few and how many fingers hold.
    sizes: (usize, usize),
    /// For each pair of postures whether they are apart, as far as it was asked: 0 unknown, 1 apart, 2 not.
    apart: Vec<u8>,
    /// The number of each finger's first posture, the resting one, among all; and how many there are.
    first: [usize; MAX_FINGERS],
    postures: usize,
    /// The combinations that were drawn so far.
    drawn: Vec<Choice>,
}

impl<'p> Combiner<'p> {
    /// Of the pools of one pose, so few to so many fingers holding.
    pub fn new(task: &'p Task<'p>, pools: &'p Pools, (least, most): (usize, usize)) -> Self {
        let (fingers, able) = (FingerSet::first(task.hand.finger_count()), pools.able());
        let (mut first, mut postures) = ([0; MAX_FINGERS], 0);
        for finger in fingers.iter() {
            first[finger.index()] = postures;
            postures += 1 + pools.touching(finger).len();
        }
        // Fingers that may not rest must hold.
        let must = fingers.len() - pools.restful.len();
        let sizes = (least.max(must), most.min(able.len()));
        Self {
            task,
            pools,
            fingers,
            able,
            sizes,
            apart: vec![0; postures * postures],
            first,
            postures,
            drawn: Vec::new(),
        }
    }

    /// Whether the combination was not drawn before; remembers it.
    pub fn is_new(&mut self, choice: &Choice) -> bool {
        let is_new = !self.drawn.contains(choice);
        if is_new {
            self.drawn.push(*choice);
        }
        is_new
    }

    /// Whether there is any combination at all.
    pub fn is_hopeful(&self) -> bool {
        let bound = self.fingers.iter().filter(|finger| !self.pools.restful.contains(*finger));
        self.sizes.0 <= self.sizes.1 && bound.into_iter().all(|finger| self.able.contains(finger))
    }

    /// A random combination: the number of holding fingers uniform, then the fingers, then their contacts.
    pub fn draw(&self, random: &mut Random) -> Choice {
        let size = self.sizes.0 + random.index(self.sizes.1 - self.sizes.0 + 1);
        let mut holding: FingerSet =
            self.fingers.iter().filter(|f| !self.pools.restful.contains(*f)).collect();
        while holding.len() < size {
            let left = self.able.len() - self.able.intersection(holding).len();
            let mut others = self.able.iter().filter(|finger| !holding.contains(*finger));
            holding = others.nth(random.index(left)).map_or(holding, |finger| holding.with(finger));
        }
        let mut choice = [None; MAX_FINGERS];
        for finger in holding.iter() {
            choice[finger.index()] = Some(random.index(self.pools.touching(finger).len()) as u8);
        }
        choice
    }

    /// The same combination but for one finger, which touches elsewhere, comes or goes where that may be.
    pub fn vary(&self, choice: &Choice, random: &mut Random) -> Choice {
        let mut varied = *choice;
        let all: Vec<FingerIndex> = self.able.iter().collect();
        let finger = all[random.index(all.len())];
        let holding = choice.iter().flatten().count();
        let number = random.index(self.pools.touching(finger).len() + 1);
        let rests = number == self.pools.touching(finger).len();
        let was = choice[finger.index()].is_some();
        let fits = match (rests, was) {
            (true, true) => holding > self.sizes.0 && self.pools.restful.contains(finger),
            (true, false) => false,
            (false, true) => true,
            (false, false) => holding < self.sizes.1,
        };
        if fits {
            varied[finger.index()] = if rests { None } else { Some(number as u8) };
        }
        varied
    }

    /// The configuration of a combination in which all fingers keep clear of each other; else why not.
    pub fn configuration(&mut self, choice: &Choice) -> Result<Configuration, Reason> {
        for finger in self.fingers.iter() {
            for other in FingerSet::first(finger.index()).iter() {
                if !self.are_apart((other, choice[other.index()]), (finger, choice[finger.index()])) {
                    return Err(Reason::Collision);
                }
            }
        }
        let mut q = self.pools.resting.clone();
        for finger in self.fingers.iter() {
            (q.contacts[finger], q.joints[finger]) = self.posture(finger, choice[finger.index()]);
        }
        Ok(q)
    }

    /// Whether the combination's grasp is stable, at rest and while the object moves; otherwise why not.
    pub fn refusal(&self, q: &Configuration, context: &mut Context<'_>) -> Result<Option<Reason>, CallError> {
        self.task.admissible.admit_grasp(self.task, q, context)
    }

    fn posture(&self, finger: FingerIndex, choice: Option<u8>) -> Posture {
        match choice {
            Some(number) => self.pools.touching(finger)[usize::from(number)],
            None => (None, self.pools.resting.joints[finger]),
        }
    }

    fn are_apart(
        &mut self,
        (a, first): (FingerIndex, Option<u8>),
        (b, second): (FingerIndex, Option<u8>),
    ) -> bool {
        let number = |finger: FingerIndex, choice: Option<u8>| {
            self.first[finger.index()] + choice.map_or(0, |number| usize::from(number) + 1)
        };
        let place = number(a, first) * self.postures + number(b, second);
        if self.apart[place] == 0 {
            let (of_a, of_b) = (self.posture(a, first).1, self.posture(b, second).1);
            let free = self.task.clearance.fingers_free((a, &of_a), (b, &of_b)).is_ok();
            self.apart[place] = if free { 1 } else { 2 };
        }
        self.apart[place] == 1
    }
}
