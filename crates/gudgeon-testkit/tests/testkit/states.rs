//! States, memory, columns, and what rates read.

use gudgeon_core::states::{ColumnInfo, Signals, StateInfo, Stateful};
use gudgeon_testkit::{assert_none, reads, stateful};

/// Right as [`Model::right`] makes it; every test spoils one thing.
struct Model {
    states: Vec<StateInfo>,
    start: f64,
    memory: Vec<f64>,
    saved: usize,
    keeps: bool,
    columns: usize,
}

impl Model {
    fn right() -> Self {
        let states = vec![StateInfo::new("a").at_least(0.5), StateInfo::new("b")];
        Self { states, start: 1.0, memory: vec![3.0, -0.0], saved: 2, keeps: true, columns: 1 }
    }
}

impl Stateful for Model {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn initial(&mut self, y: &mut [f64]) {
        y.fill(self.start);
    }
    fn save(&self, out: &mut Vec<f64>) {
        out.extend(&self.memory);
    }
    fn restore(&mut self, saved: &[f64]) -> usize {
        let n = self.memory.len();
        self.memory.copy_from_slice(&saved[..n]);
        if !self.keeps {
            self.memory[0] += 1.0;
        }
        self.saved
    }
    fn columns(&self) -> Vec<ColumnInfo> {
        vec![ColumnInfo::new("c", "m"); self.columns]
    }
    fn record(&self, y: &[f64], row: &mut Vec<f64>) {
        row.push(y[0]);
    }
}

type Spoil = fn(&mut Model);

#[test]
fn what_a_model_declares_is_checked() {
    assert_none(stateful(&mut Model::right()));
    let spoiled: [(&str, Spoil); 9] = [
        ("the state `a` stands twice", |m| m.states[1].name = "a".into()),
        ("a state has no name", |m| m.states[1].name = " ".into()),
        ("the scale of `b` is 0", |m| m.states[1].scale = 0.0),
        ("the cycle_scale of `a` is NaN", |m| m.states[0].cycle_scale = f64::NAN),
        ("`a` begins at 0.25, the minimum is 0.5", |m| m.start = 0.25),
        ("2 values of memory are saved and 1 are taken back", |m| m.saved = 1),
        ("comes back as [4.0", |m| m.keeps = false),
        ("1 values are recorded in 0 columns", |m| m.columns = 0),
        ("the column `c` stands twice", |m| m.columns = 2),
    ];
    for (complaint, spoil) in spoiled {
        let mut m = Model::right();
        spoil(&mut m);
        let found = stateful(&mut m);
        assert!(found.iter().any(|c| c.contains(complaint)), "{complaint}: {found:?}");
    }
}

#[test]
fn an_input_that_is_read_and_not_declared_is_noticed() {
    let rates = |x: &[f64], d: &mut [f64]| {
        d[0] = x[0];
        d[1] = x[0] * x[1];
    };
    let inputs =
        [(Signals::LIFT, 1.0, 2.0), (Signals::TEMPERATURE, 300.0, 301.0), (Signals::TWIST, 0.0, 1.0)];
    assert_none(reads(Signals::LIFT | Signals::TEMPERATURE, &inputs, 2, rates));
    let found = reads(Signals::LIFT, &inputs, 2, rates);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("rate 1 depends on input 1"), "{found:?}");
    assert_eq!(reads(Signals::NONE, &inputs, 2, rates).len(), 2);
}
