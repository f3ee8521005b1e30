//! Vibration at constant mean speed.

use std::f64::consts::PI;

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::{Bar, Figure, FigureKind, Note, Series};

use super::{DRAWN, MOST, Results, TURN, column};
use crate::machine::{Machine, irregularity_of, twist_amplitude};
use crate::names::ORDERS;

/// Vibratory twist \[rad\] and speed fluctuation beyond which small vibration about an even rotation is no longer what is computed.
pub const LINEAR: f64 = 1.0;

impl Results<'_> {
    /// Vibration at constant mean speed.
    pub fn periodic(&mut self, out: &TorsionOut, machine: &mut Machine<'_>) {
        let a = machine.a;
        let mut vibratory_torque = Vec::new();
        for (name, n) in &out.counters {
            self.count(name, *n);
        }
        self.note(&out.notes);
        let (links, nodes) = (a.line.links.len(), a.line.nodes.len());
        let turns = a.period / (2.0 * PI);
        let points = (TURN as f64 * turns).round() as usize;
        let mut torque = vec![vec![0.0; points + 1]; links];
        let mut swing = vec![vec![0.0; points + 1]; nodes];
        for i in 0..=points {
            let at = a.period * i as f64 / points as f64;
            for (l, t) in torque.iter_mut().enumerate() {
                t[i] = out.mean_torque[l];
            }
            for o in &out.orders {
                let (sin, cos) = (o.order * at).sin_cos();
                for (t, p) in torque.iter_mut().zip(&o.torque) {
                    t[i] += p[0] * cos - p[1] * sin;
                }
                let rate = o.order * out.speed;
                for (w, p) in swing.iter_mut().zip(&o.angle) {
                    w[i] -= rate * (p[0] * sin + p[1] * cos);
                }
            }
        }
        self.result(
            "balance_torque",
            out.balance_torque,
            "N m",
            "mean torque that holds the mean speed, at the reference shaft",
        );
        let mut series = Series {
            axis: column(
                "angle",
                "deg",
                (0..=points).step_by(DRAWN).map(|i| 360.0 * turns * i as f64 / points as f64).collect(),
            ),
            columns: Vec::new(),
        };
        let (mut torques, mut stresses, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        for l in 0..links {
            let name = &a.line.links[l].name;
            let n = l + 1;
            let [top, bottom] =
                machine.extremes(out).extremes(out.mean_torque[l], |k| out.orders[k].torque[l]);
            let vibratory = 0.5 * (top - bottom);
            vibratory_torque.push(vibratory);
            let twist = twist_amplitude(machine.extremes(out), a, out, l);
            if twist > LINEAR {
                self.note(&[Note::caution(
                    format!("linear_twist.shaft{n}"),
                    format!("{name} twists by {twist:.3e} rad: small vibration about even rotation ends at about {LINEAR} rad"),
                )
                .amount("twist", twist, "rad")]);
            }
            self.result(
                format!("shaft{n}.mean_torque"),
                out.mean_torque[l],
                "N m",
                format!("mean torque of {name}"),
            );
            self.result(format!("shaft{n}.torque_max"), top, "N m", format!("largest torque of {name}"));
            self.result(format!("shaft{n}.torque_min"), bottom, "N m", format!("smallest torque of {name}"));
            self.result(
                format!("shaft{n}.torque_amplitude"),
                vibratory,
                "N m",
                format!("half of peak to peak torque of {name}"),
            );
            let strongest = out.orders.iter().max_by(|x, y| {
                x.torque[l][0].hypot(x.torque[l][1]).total_cmp(&y.torque[l][0].hypot(y.torque[l][1]))
            });
            if let Some(o) = strongest {
                self.result(
                    format!("shaft{n}.strongest_order"),
                    o.order,
                    "",
                    format!("order of the largest torque in {name}"),
                );
            }
            self.law(l, out.mean_torque[l], a, "at its mean torque");
            let heat: f64 = out.orders.iter().map(|o| o.heat[l]).sum();
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
            if l < MOST {
                let rows = |f: f64| torque[l].iter().step_by(DRAWN).map(|t| t * f).collect::<Vec<f64>>();
                series.columns.push(column(format!("shaft{n}.torque"), "N m", rows(1.0)));
                torques.push((name.clone(), format!("shaft{n}.torque")));
                if let Some(s) = a.stress[l] {
                    series.columns.push(column(format!("shaft{n}.stress"), "MPa", rows(s / 1e6)));
                    stresses.push((name.clone(), format!("shaft{n}.stress")));
                }
            }
        }
        for i in 0..nodes {
            let name = &a.line.nodes[i].name;
            let n = i + 1;
            let mean = out.speed * a.line.nodes[i].ratio.abs();
            let fluctuation = irregularity_of(machine.extremes(out), out, i) / a.line.nodes[i].ratio.abs();
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
                format!("degree of irregularity of {name}: speed swing by mean speed"),
            );
            let amplitude = out.orders.iter().map(|o| o.angle[i][0].hypot(o.angle[i][1])).fold(0.0, f64::max);
            self.result(
                format!("inertia{n}.angle_amplitude"),
                amplitude.to_degrees(),
                "deg",
                format!("largest amplitude of a single order of {name}"),
            );
            if i < MOST {
                let rows = swing[i].iter().step_by(DRAWN).copied().collect();
                series.columns.push(column(format!("inertia{n}.speed"), "rad/s", rows));
                speeds.push((name.clone(), format!("inertia{n}.speed")));
            }
        }
        let over = if turns > 1.5 { "over two turns" } else { "over a turn" };
        self.out.series = series;
        self.lines("Torque in the shafts", over, "series", "angle", torques, false);
        if !stresses.is_empty() {
            self.lines(
                "Shear stress",
                &format!("{over}, concentration factors included"),
                "series",
                "angle",
                stresses,
                false,
            );
        }
        self.lines(
            "Speed fluctuation",
            &format!("{over}, against the mean speed"),
            "series",
            "angle",
            speeds,
            false,
        );
        // Spectra.
        let mut table = Series {
            axis: column("order", "", out.orders.iter().map(|o| o.order).collect()),
            columns: Vec::new(),
        };
        for l in 0..links {
            let rows = out.orders.iter().map(|o| o.torque[l][0].hypot(o.torque[l][1])).collect();
            table.columns.push(column(format!("shaft{}.torque", l + 1), "N m", rows));
            if let Some(s) = a.stress[l] {
                let rows =
                    out.orders.iter().map(|o| s / 1e6 * o.torque[l][0].hypot(o.torque[l][1])).collect();
                table.columns.push(column(format!("shaft{}.stress", l + 1), "MPa", rows));
            }
        }
        for i in 0..nodes {
            let rows = out.orders.iter().map(|o| o.angle[i][0].hypot(o.angle[i][1])).collect();
            table.columns.push(column(format!("inertia{}.angle", i + 1), "rad", rows));
        }
        for o in out.orders.iter().take(ORDERS) {
            for l in 0..links {
                let size = o.torque[l][0].hypot(o.torque[l][1]);
                let name = format!("shaft{}.order{}", l + 1, o.order);
                self.result(
                    name,
                    size,
                    "N m",
                    format!("torque of order {} in {}", o.order, a.line.links[l].name),
                );
            }
        }
        self.out.tables.insert("orders".into(), table);
        let worst = (0..links).max_by(|x, y| vibratory_torque[*x].total_cmp(&vibratory_torque[*y]));
        if let Some(l) = worst {
            let bars = out
                .orders
                .iter()
                .take(24)
                .map(|o| Bar {
                    label: format!("order {}", o.order),
                    value: o.torque[l][0].hypot(o.torque[l][1]),
                    limit: None,
                })
                .collect();
            self.out.figures.push(Figure {
                title: format!("Order spectrum of {}", a.line.links[l].name),
                hint: "torque amplitude per order, in the shaft that vibrates most; table `orders` has all"
                    .into(),
                table: String::new(),
                kind: FigureKind::Bars { unit: "N m".into(), bars },
            });
        }
        if links > 0 {
            let bars = (0..links.min(24))
                .map(|l| Bar {
                    label: a.line.links[l].name.clone(),
                    value: vibratory_torque[l],
                    limit: self.torque_limit(&a.line.links[l].name),
                })
                .collect();
            self.out.figures.push(Figure {
                title: "Vibratory torque".into(),
                hint: "half of peak to peak, with the limits that the case names".into(),
                table: String::new(),
                kind: FigureKind::Bars { unit: "N m".into(), bars },
            });
        }
    }
}
