//! Orders of torques and angles: results, table and bars.

use gudgeon_core::kinds::{PhasorRow, TorsionOut};
use gudgeon_core::result::{Bar, Figure, FigureKind, Series};
use gudgeon_numerics::elementary;

use crate::assemble::Assembled;
use crate::names::ORDERS;
use crate::results::{Results, column};

/// Maximum number of bars of a figure.
const BARS: usize = 24;

/// Amplitudes of phasors.
fn sizes([re, im]: PhasorRow<'_>) -> Vec<f64> {
    re.iter().zip(im).map(|(re, im)| elementary::hypot(*re, *im)).collect()
}

impl Results<'_> {
    /// Torque of the lowest orders in each shaft.
    pub(super) fn order_results(&mut self, out: &TorsionOut, a: &Assembled) {
        let amplitudes: Vec<Vec<f64>> =
            (0..a.line.links.len()).map(|l| sizes(out.orders.torque(l))).collect();
        for (k, order) in out.orders.orders().iter().enumerate().take(ORDERS) {
            for (l, link) in a.line.links.iter().enumerate() {
                let name = format!("shaft{}.order{order}", l + 1);
                let what = format!("torque of order {order} in {}", link.name);
                self.result(name, amplitudes[l][k], "N m", what);
            }
        }
    }

    /// Table `orders`: amplitudes of torque, stress and angle by order.
    pub(super) fn order_table(&mut self, out: &TorsionOut, a: &Assembled) {
        let mut table =
            Series { axis: column("order", "", out.orders.orders().to_vec()), columns: Vec::new() };
        for l in 0..a.line.links.len() {
            let torques = sizes(out.orders.torque(l));
            let stresses = a.stress[l].map(|s| torques.iter().map(|t| s / 1e6 * t).collect());
            table.columns.push(column(format!("shaft{}.torque", l + 1), "N m", torques));
            if let Some(rows) = stresses {
                table.columns.push(column(format!("shaft{}.stress", l + 1), "MPa", rows));
            }
        }
        for i in 0..a.line.nodes.len() {
            table.columns.push(column(format!("inertia{}.angle", i + 1), "rad", sizes(out.orders.angle(i))));
        }
        self.out.tables.insert("orders".into(), table);
    }

    /// Bars of the orders of the shaft with the maximum vibratory torque.
    pub(super) fn order_bars(&mut self, out: &TorsionOut, a: &Assembled, vibratory: &[f64]) {
        let Some(l) = (0..vibratory.len()).max_by(|x, y| vibratory[*x].total_cmp(&vibratory[*y])) else {
            return;
        };
        let bar = |(order, value): (&f64, f64)| Bar { label: format!("order {order}"), value, limit: None };
        let bars = out.orders.orders().iter().zip(sizes(out.orders.torque(l))).take(BARS).map(bar).collect();
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
