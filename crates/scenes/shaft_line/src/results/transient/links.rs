//! Torque, twist, stress and heat of the shafts over time.

use super::motion::Motion;
use crate::machine::LinkPoint;
use crate::results::Results;

impl Results<'_> {
    /// Results of one shaft, and what its limits are held against.
    pub(super) fn link_over_time(&mut self, m: &Motion<'_>, l: usize) -> LinkPoint {
        let (name, k) = (&m.a.line.links[l].name, l + 1);
        let [top, bottom] = m.window_extremes(|r| m.torque(l, r));
        let amplitude = 0.5 * (top - bottom);
        let [highest, lowest] = m.all_extremes(|r| m.torque(l, r));
        let peak = highest.abs().max(lowest.abs());
        self.result(
            format!("shaft{k}.torque_amplitude"),
            amplitude,
            "N m",
            format!("half of peak to peak torque of {name} within the window"),
        );
        self.result(
            format!("shaft{k}.torque_peak"),
            peak,
            "N m",
            format!("largest torque of {name} of all rows, either way"),
        );
        let mean = m.window_mean(|r| m.torque(l, r));
        self.law(l, mean, m.a, "at its mean torque within the window");
        let [more, less] = m.all_extremes(|r| m.twist(l, r)[0]);
        self.result(
            format!("shaft{k}.twist_peak"),
            more.abs().max(less.abs()).to_degrees(),
            "deg",
            format!("largest twist of {name} of all rows, either way"),
        );
        if let Some(s) = m.a.stress[l] {
            self.result(
                format!("shaft{k}.stress_peak"),
                s * peak / 1e6,
                "MPa",
                format!("largest shear stress of {name} of all rows"),
            );
        }
        // Heat: the loss of the dampers, mean over the window.
        let heat = m.window_mean(|r| m.loss(l, r));
        self.result(
            format!("shaft{k}.heat"),
            heat,
            "W",
            format!("mean power lost in {name} within the window"),
        );
        LinkPoint { amplitude, peak, heat, order: 0.0 }
    }
}
