//! Torque, stress and heat of the shafts at constant mean speed.

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::Note;
use gudgeon_numerics::elementary;

use super::LINEAR;
use crate::assemble::Assembled;
use crate::machine::{Machine, twist_amplitude};
use crate::results::Results;

/// Part of the largest torque that is left of rounding where there is none.
const ROUNDING: f64 = 1e-12;

impl Results<'_> {
    /// Results of one shaft; its vibratory torque, half of peak to peak \[N m\].
    pub(super) fn periodic_link(&mut self, out: &TorsionOut, machine: &mut Machine<'_>, l: usize) -> f64 {
        let a = machine.a;
        let (name, n) = (&a.line.links[l].name, l + 1);
        let [top, bottom] = machine.extremes(out).extremes(out.mean_torque[l], out.orders.torque(l));
        let vibratory = 0.5 * (top - bottom);
        let twist = twist_amplitude(machine.extremes(out), a, out, l);
        if twist > LINEAR {
            self.note(&[Note::caution(
                format!("linear_twist.shaft{n}"),
                format!("{name} twists by {twist:.3e} rad: small vibration about even rotation ends at about {LINEAR} rad"),
            )
            .amount("twist", twist, "rad")]);
        }
        // Torques along the line add up to what is left of rounding where nothing goes through.
        let largest = out.mean_torque.iter().map(|t| t.abs()).fold(vibratory, f64::max);
        let mean = if out.mean_torque[l].abs() < ROUNDING * largest { 0.0 } else { out.mean_torque[l] };
        self.result(format!("shaft{n}.mean_torque"), mean, "N m", format!("mean torque of {name}"));
        self.result(format!("shaft{n}.torque_max"), top, "N m", format!("largest torque of {name}"));
        self.result(format!("shaft{n}.torque_min"), bottom, "N m", format!("smallest torque of {name}"));
        self.result(
            format!("shaft{n}.torque_amplitude"),
            vibratory,
            "N m",
            format!("half of peak to peak torque of {name}"),
        );
        self.strongest_order(out, a, l);
        self.law(l, out.mean_torque[l], a, "at its mean torque");
        let heat: f64 = out.orders.heat(l).iter().sum();
        self.result(format!("shaft{n}.heat"), heat, "W", format!("mean power lost in {name}"));
        if let Some(s) = a.stress[l] {
            self.result(
                format!("shaft{n}.stress_amplitude"),
                s * vibratory / 1e6,
                "MPa",
                format!("half of peak to peak shear stress of {name}"),
            );
            self.result(
                format!("shaft{n}.stress_max"),
                s * top.abs().max(bottom.abs()) / 1e6,
                "MPa",
                format!("largest shear stress of {name}"),
            );
        }
        vibratory
    }

    fn strongest_order(&mut self, out: &TorsionOut, a: &Assembled, l: usize) {
        let [re, im] = out.orders.torque(l);
        let sizes: Vec<f64> = re.iter().zip(im).map(|(re, im)| elementary::hypot(*re, *im)).collect();
        let orders = out.orders.orders().iter().zip(&sizes);
        if let Some((order, _)) = orders.max_by(|x, y| x.1.total_cmp(y.1)) {
            self.result(
                format!("shaft{}.strongest_order", l + 1),
                *order,
                "",
                format!("order of the largest torque in {}", a.line.links[l].name),
            );
        }
    }
}
