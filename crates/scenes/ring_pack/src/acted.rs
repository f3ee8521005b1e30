//! How long a limit acted and by how much, and the times that a ring was off the liner.

use gudgeon_core::result::Note;
use gudgeon_numerics::elementary;

/// How long something acted, and how much at most.
#[derive(Debug, Clone, Copy, Default)]
pub struct Acted {
    /// Crank angle over which it did \[rad\].
    pub span: f64,
    /// Greatest amount.
    pub most: f64,
    /// Where it was greatest \[rad\].
    pub at: f64,
}

impl Acted {
    /// Adds an instant at `theta` \[rad\] that stands for `weight` \[rad\]; amounts of zero and below are none.
    pub fn see(&mut self, amount: f64, theta: f64, weight: f64) {
        if amount > 0.0 {
            self.span += weight;
            if amount > self.most {
                (self.most, self.at) = (amount, theta);
            }
        }
    }

    /// Whether it acted at all.
    #[must_use]
    pub fn acted(&self) -> bool {
        self.span > 0.0
    }
}

/// One time that a ring was off the liner.
#[derive(Debug, Clone, Copy)]
pub struct Retreat {
    /// Where it left \[rad\].
    pub from: f64,
    /// Where it was back \[rad\]; `None` when the cycle ended before.
    pub to: Option<f64>,
    /// Furthest film thickness \[m\].
    pub most: f64,
}

/// The times that a ring was off the liner.
#[derive(Debug, Clone, Default)]
pub struct Retreats {
    /// In the order of the cycle.
    pub all: Vec<Retreat>,
    /// Angle and film thickness seen last.
    last: Option<(f64, f64)>,
}

impl Retreats {
    /// Adds the film thickness `h` \[m\] at `theta` \[rad\]; a ring is off the liner further than `away` \[m\].
    pub fn see(&mut self, theta: f64, h: f64, away: f64) {
        let (before, thickness) = self.last.unwrap_or((theta, h));
        self.last = Some((theta, h));
        // The logarithm of the film is nearly straight between two looks.
        let crossing = || {
            let (a, b) = (elementary::ln(thickness), elementary::ln(h));
            before
                + if b == a { 0.0 } else { ((elementary::ln(away) - a) / (b - a)).clamp(0.0, 1.0) }
                    * (theta - before)
        };
        match self.all.last_mut().filter(|r| r.to.is_none()) {
            Some(r) if h <= away => r.to = Some(crossing()),
            Some(r) => r.most = r.most.max(h),
            None if h > away => self.all.push(Retreat { from: crossing(), to: None, most: h }),
            None => {}
        }
    }

    /// The note on ring `ring` over a cycle of `period` \[rad\]; none when it never left.
    #[must_use]
    pub fn note(&self, ring: usize, period: f64, away: f64) -> Option<Note> {
        let most = self.all.iter().map(|r| r.most).reduce(f64::max)?;
        let span: f64 = self.all.iter().map(|r| r.to.unwrap_or(period) - r.from).sum();
        let share = (span / period).min(1.0);
        let times = match self.all.len() {
            1 => "once".to_owned(),
            n => format!("{n} times"),
        };
        let text = format!(
            "ring {ring} leaves the liner {times}, by up to {:.4} mm, for {:.2} % of the cycle (more than {:.0} um away). After another \
             start it may not: `--verify` and `solver.starts` tell",
            1e3 * most,
            100.0 * share,
            1e6 * away
        );
        let note = Note::caution(format!("off_the_liner.ring{ring}"), text);
        Some(note.amount("retreat", 1e3 * most, "mm").amount("share_of_cycle", share, "1"))
    }
}
