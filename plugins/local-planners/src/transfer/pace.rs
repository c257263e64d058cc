//! How long the steps of a transfer are.

/// How long steps are: halved where the contacts bend, doubled again behind.
pub(crate) struct Pace {
    full: f64,
    /// The shortest step that is tried.
    pub finest: f64,
    now: f64,
}

impl Pace {
    pub fn new(full: f64, halvings: usize) -> Self {
        Self { full, finest: full * 0.5_f64.powi(halvings as i32), now: full }
    }

    /// The next step's length, at most `longest`; what remains is divided evenly, so that no splinter is left
    /// over.
    pub fn next(&mut self, longest: f64, remains: f64) -> f64 {
        let longest = self.now.max(self.finest).min(longest);
        self.now = (2.0 * self.now).min(self.full);
        remains / (remains / longest - 1e-9).ceil().max(1.0)
    }

    /// Half of `h`, to be kept to for the next step too.
    pub fn halve(&mut self, h: f64) -> f64 {
        self.now = 0.5 * h;
        self.now
    }
}
