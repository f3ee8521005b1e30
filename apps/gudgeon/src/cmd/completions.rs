//! `gudgeon completions SHELL`

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use crate::args::{Args, NAME};
use crate::ui::Ui;

pub fn completions(shell: Shell, ui: &Ui) {
    let mut script = Vec::new();
    generate(shell, &mut Args::command(), NAME, &mut script);
    ui.out(&String::from_utf8_lossy(&script));
}
