//! Speeds and angles of the inertias at constant mean speed.

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::Note;
use gudgeon_numerics::elementary;

use super::LINEAR;
use crate::machine::{Machine, speed_fluctuation};
use crate::results::Results;

impl Results<'_> {
    /// Speed fluctuation and angle of one inertia.
    pub(super) fn periodic_inertia(&mut self, out: &TorsionOut, machine: &mut Machine<'_>, i: usize) {
        let node = &machine.a.line.nodes[i];
        let (name, n, ratio) = (&node.name, i + 1, node.ratio.abs());
        let mean = out.speed * ratio;
        let fluctuation = speed_fluctuation(machine.extremes(out), out, i) / ratio;
        if fluctuation > LINEAR {
            self.note(&[Note::caution(
                format!("linear_speed.inertia{n}"),
                format!("the speed of {name} goes up and down by {fluctuation:.3e} of its mean: such a motion is no small vibration about it"),
            )
            .amount("speed_fluctuation", fluctuation, "1")]);
        }
        self.result(
            format!("inertia{n}.speed_swing"),
            fluctuation * mean,
            "rad/s",
            format!("peak to peak speed of {name}"),
        );
        self.result(
            format!("inertia{n}.irregularity"),
            fluctuation,
            "",
            format!("coefficient of speed fluctuation of {name}: peak to peak speed by mean speed"),
        );
        let [re, im] = out.orders.angle(i);
        let amplitude = re.iter().zip(im).map(|(re, im)| elementary::hypot(*re, *im)).fold(0.0, f64::max);
        self.result(
            format!("inertia{n}.angle_amplitude"),
            amplitude.to_degrees(),
            "deg",
            format!("largest amplitude of a single order of {name}"),
        );
    }
}
