//! Torques of throws and drives over time.

use super::motion::Motion;
use crate::results::Results;

impl Results<'_> {
    /// Lag behind the first throw and gas torque of each throw.
    pub(super) fn throws_over_time(&mut self, m: &Motion<'_>) {
        let Some(gas) = m.out.gas.get(m.last()) else { return };
        for k in (0..gas.len()).filter(|k| !m.a.line.throws[*k].ends.is_empty()) {
            let n = k + 1;
            let [top, bottom] = m.window_extremes(|r| m.out.gas[r][k]);
            let turned = |k: usize, r: usize| {
                let i = m.a.line.throws[k].node;
                m.out.angles[r][i] / m.ratio[i]
            };
            let lag = m.window_mean(|r| turned(0, r) - turned(k, r));
            self.result(
                format!("throw{n}.lag"),
                lag.to_degrees(),
                "deg",
                format!(
                    "angle of the shaft that throw {n} lags behind throw 1 by twist, mean over the window"
                ),
            );
            self.result(
                format!("throw{n}.gas_max"),
                top,
                "N m",
                format!("largest gas torque of throw {n} within the window"),
            );
            self.result(
                format!("throw{n}.gas_min"),
                bottom,
                "N m",
                format!("smallest gas torque of throw {n} within the window"),
            );
        }
    }

    /// Mean and last torque of each drive.
    pub(super) fn drives_over_time(&mut self, m: &Motion<'_>) {
        let Some(drives) = m.out.drive.get(m.last()) else { return };
        for (k, end) in drives.iter().enumerate() {
            self.result(
                format!("drive{}.torque", k + 1),
                m.window_mean(|r| m.out.drive[r][k]),
                "N m",
                format!("mean torque of drive {} within the window", k + 1),
            );
            self.result(
                format!("drive{}.torque_end", k + 1),
                *end,
                "N m",
                format!("torque of drive {} at the end", k + 1),
            );
        }
    }
}
