//! Both halves of a cycle at once, gas and grooves in a second thread.
//!
//! Films follow gas and grooves through the cycle ([`super::growing`]). Neither half asks for anything that it would not have when they come one after the other: results are the same
//! to the bit. What films change is undone where gas and grooves fail, for in turn they would not have begun.

use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};

use gudgeon_numerics::ode::{IntegrateError, Options, Stats};
use gudgeon_scene::receive;

use super::super::implicit::Follower;
use super::super::pack::Pack;
use super::super::twin::Twin;
use super::Waveform;
use super::grid::Rule;
use super::growing::{Bundle, Growing};
use super::half::{Done, Half, Setting, Side};
use super::joint::Part;
use super::track::Track;

/// Gas and grooves on their way to another thread, with all that they need for a cycle.
struct Task {
    half: Half,
    pack: Box<Pack>,
    /// What they see of the films.
    before: [Track; 2],
    films: Arc<Part>,
    begin: Vec<f64>,
    breakpoints: Vec<f64>,
    options: Options,
    rule: (Option<Rule>, bool),
    to: Sender<Bundle>,
}

/// On their way back.
struct Back {
    half: Half,
    pack: Box<Pack>,
    before: [Track; 2],
    work: Stats,
    outcome: Result<Done, IntegrateError>,
}

impl Task {
    fn run(self) -> Back {
        let Self { mut half, mut pack, before, films, begin, breakpoints, options, rule, to } = self;
        let mut work = Stats::default();
        let mut setting = Setting { breakpoints: &breakpoints, options: &options, stats: &mut work };
        let seen = (&*films, &before);
        let outcome = half.grooves(&mut pack, &begin, rule, seen, &mut setting, Some(to));
        Back { half, pack, before, work, outcome }
    }
}

impl Waveform {
    /// Integrates both halves of a cycle from `y`, gas and grooves by `rule`.
    pub(super) fn at_once(
        &mut self,
        (pack, twin): (&mut Pack, Twin),
        (y, q): (&mut [f64], &mut [f64]),
        rule: Option<Rule>,
        setting: &mut Setting<'_>,
        follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        let begin = y.to_vec();
        let (repeat, repeats, counters) = (self.films.grid.repeat.clone(), self.repeats, pack.counters);
        let recorded = follower.is_some();
        let films_rule = self.again(Side::Films, pack, &begin, setting.options.rtol, recorded);
        let grooves = Arc::clone(&self.grooves.part);
        let ((to, more), (done, come)) = (channel(), channel());
        let task = Task {
            half: std::mem::take(&mut self.grooves),
            pack: twin.pack,
            before: std::mem::take(&mut self.before),
            films: Arc::clone(&self.films.part),
            begin: begin.clone(),
            breakpoints: setting.breakpoints.to_vec(),
            options: setting.options.clone(),
            rule: (rule, recorded),
            to,
        };
        // Where nobody waits for it any more its owner panicked.
        let run = move || drop(done.send(task.run()));
        // The twin remembers what rings did in their last stage: gas and grooves stay with it.
        if twin.thread.is_crowded() {
            run()
        } else {
            twin.thread.begin(run)
        }
        let wave = Growing::begin(std::mem::take(&mut self.beside), grooves.width(), more);
        let (mut work, mut leaves) = (Stats::default(), false);
        let mut own = Setting { stats: &mut work, ..*setting };
        let first = self.is_first();
        let told = (&mut self.forces, first.then_some(&mut leaves));
        let films = self.films.films(pack, (&begin, films_rule), (&grooves, &wave), &mut own, told, follower);
        let Ok(mut back) = receive(&come) else { twin.thread.panicked() };
        let counted = std::mem::take(&mut back.pack.counters);
        pack.twin = Some(Twin { pack: back.pack, ..twin });
        (self.grooves, self.before, self.beside) = (back.half, back.before, wave.into_wave());
        setting.stats.add(&back.work);
        match back.outcome {
            Ok(done) => self.took(&done, y, q),
            Err(e) => {
                // Films are as if they had not begun.
                self.films.wave.clone_from(&self.before[0]);
                self.forces.clone_from(&self.before[1]);
                (self.films.grid.repeat, self.repeats, pack.counters) = (repeat, repeats, counters);
                pack.counters.add(counted);
                return Err(e);
            }
        }
        pack.counters.add(counted);
        std::mem::swap(&mut self.grooves.wave, &mut self.beside);
        setting.stats.add(&work);
        self.retreats |= leaves;
        films?.put(&self.films.part, y, q);
        Ok(())
    }
}
