//! Orders of torques and angles: results, table and bars.

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::{Bar, Figure, FigureKind, Series};
use gudgeon_numerics::elementary;

use crate::assemble::Assembled;
use crate::names::ORDERS;
use crate::results::{Results, column};

/// Maximum number of bars of a figure.
const BARS: usize = 24;

/// Amplitude of a phasor.
fn size([re, im]: [f64; 2]) -> f64 {
    elementary::hypot(re, im)
}

impl Results<'_> {
    /// Torque of the lowest orders in each shaft.
    pub(super) fn order_results(&mut self, out: &TorsionOut, a: &Assembled) {
        for o in out.orders.iter().take(ORDERS) {
            for (l, link) in a.line.links.iter().enumerate() {
                let name = format!("shaft{}.order{}", l + 1, o.order);
                let what = format!("torque of order {} in {}", o.order, link.name);
                self.result(name, size(o.torque[l]), "N m", what);
            }
        }
    }

    /// Table `orders`: amplitudes of torque, stress and angle by order.
    pub(super) fn order_table(&mut self, out: &TorsionOut, a: &Assembled) {
        let of = |f: &dyn Fn(usize) -> f64| (0..out.orders.len()).map(f).collect::<Vec<f64>>();
        let mut table =
            Series { axis: column("order", "", of(&|k| out.orders[k].order)), columns: Vec::new() };
        for l in 0..a.line.links.len() {
            let rows = of(&|k| size(out.orders[k].torque[l]));
            table.columns.push(column(format!("shaft{}.torque", l + 1), "N m", rows));
            if let Some(s) = a.stress[l] {
                let rows = of(&|k| s / 1e6 * size(out.orders[k].torque[l]));
                table.columns.push(column(format!("shaft{}.stress", l + 1), "MPa", rows));
            }
        }
        for i in 0..a.line.nodes.len() {
            let rows = of(&|k| size(out.orders[k].angle[i]));
            table.columns.push(column(format!("inertia{}.angle", i + 1), "rad", rows));
        }
        self.out.tables.insert("orders".into(), table);
    }

    /// Bars of the orders of the shaft with the maximum vibratory torque.
    pub(super) fn order_bars(&mut self, out: &TorsionOut, a: &Assembled, vibratory: &[f64]) {
        let Some(l) = (0..vibratory.len()).max_by(|x, y| vibratory[*x].total_cmp(&vibratory[*y])) else {
            return;
        };
        let bar = |o: &gudgeon_core::kinds::OrderResponse| Bar {
            label: format!("order {}", o.order),
            value: size(o.torque[l]),
            limit: None,
        };
        let bars = out.orders.iter().take(BARS).map(bar).collect();
        self.out.figures.push(Figure {
            title: format!("Order spectrum of {}", a.line.links[l].name),
            hint: "torque amplitude per order, in the shaft that vibrates most; table `orders` has all"
                .into(),
            table: String::new(),
            kind: FigureKind::Bars { unit: "N m".into(), bars },
        });
    }

    /// Bars of the vibratory torques beside the limits that the case names.
    pub(super) fn torque_bars(&mut self, a: &Assembled, vibratory: &[f64]) {
        if vibratory.is_empty() {
            return;
        }
        let bars = a.line.links.iter().zip(vibratory).take(BARS).map(|(l, v)| Bar {
            label: l.name.clone(),
            value: *v,
            limit: self.torque_limit(&l.name),
        });
        let bars = bars.collect();
        self.out.figures.push(Figure {
            title: "Vibratory torque".into(),
            hint: "half of peak to peak, with the limits that the case names".into(),
            table: String::new(),
            kind: FigureKind::Bars { unit: "N m".into(), bars },
        });
    }
}
