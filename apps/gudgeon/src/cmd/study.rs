//! `gudgeon study new|run|status|collect DIR`

use std::fmt::Write as _;

use gudgeon_core::result::Grade;
use gudgeon_report::{StudyPage, study_page};
use gudgeon_study::study::{Analysis, Dependence, Finding, Group, Job, Said, Status, Study, Table};

use crate::args::{StudyCollectArgs, StudyCommand, StudyNewArgs, StudyRunArgs, StudyStatusArgs};
use crate::failure::Failure;
use crate::ui::{Ui, number, table, wrapped};

pub fn study(a: &StudyCommand, ui: &Ui) -> Result<(), Failure> {
    match a {
        StudyCommand::New(a) => new(a, ui),
        StudyCommand::Run(a) => run(a, ui),
        StudyCommand::Status(a) => status(a, ui),
        StudyCommand::Collect(a) => collect(a, ui),
    }
}

fn new(a: &StudyNewArgs, ui: &Ui) -> Result<(), Failure> {
    let study = Study::create(&a.dir, &a.file)?;
    ui.out(&format!("{}: {} points in {} parts", a.dir.display(), study.record.points, study.parts()));
    Ok(())
}

fn run(a: &StudyRunArgs, ui: &Ui) -> Result<(), Failure> {
    let job = a.part.as_deref().map_or(Ok(Job::ALL), job)?;
    let study = Study::open(&a.dir)?;
    let status = {
        let bar = ui.bar();
        study.run(job, a.threads, &mut |p| bar.show(p))?
    };
    if !ui.quiet() {
        ui.out(&text(&status));
    }
    failures(&status)
}

fn status(a: &StudyStatusArgs, ui: &Ui) -> Result<(), Failure> {
    let status = Study::open(&a.dir)?.status();
    if a.json {
        // Numbers alone: JSON refuses none of them.
        ui.json(&serde_json::to_value(&status).unwrap_or_default());
    } else {
        ui.out(&text(&status));
    }
    Ok(())
}

/// `3/8`.
fn job(text: &str) -> Result<Job, Failure> {
    let parsed =
        text.split_once('/').and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
    match parsed {
        Some((number, of)) if (1..=of).contains(&number) => Ok(Job { number, of }),
        _ => Err(Failure::argument(
            format!("`--part {text}` is not one of some parts"),
            "write `--part K/N` with K from 1 to N, for example `--part 3/8`",
        )),
    }
}

fn text(s: &Status) -> String {
    let mut out =
        format!("{} of {} points done, {} of {} parts", s.done, s.points, s.parts - s.missing.len(), s.parts);
    if s.left_out > 0 {
        let _ = write!(
            out,
            "; {} points cannot be and are left out: their rows carry the reason in `message`",
            s.left_out
        );
    }
    if s.failed > 0 {
        let _ = write!(out, "; {} points failed: their rows carry `code` and `message`", s.failed);
    }
    out
}

fn failures(s: &Status) -> Result<(), Failure> {
    match s.failed {
        0 => Ok(()),
        n => {
            Err(Failure::Run(format!("{n} of {} points failed (their rows are written and marked)", s.done)))
        }
    }
}

fn collect(a: &StudyCollectArgs, ui: &Ui) -> Result<(), Failure> {
    let study = Study::open(&a.dir)?;
    let missing = study.status().missing.len();
    if missing > 0 && !a.partial {
        return Err(Failure::argument(
            format!("{missing} of {} parts are missing", study.parts()),
            format!("`gudgeon study run {}` runs them; `--partial` collects what is there", a.dir.display()),
        ));
    }
    let collected = study.write_table(a.csv)?;
    let mut told = format!("{} rows in {}", collected.table.rows(), collected.path.display());
    if let Some(analysis) = &collected.analysis {
        let (figures, tables) = study.figures(&collected.table, analysis);
        let said = collected.table.said();
        let page = study_page(&StudyPage {
            title: title(&study),
            cases: headings(&study, |h| vec![h.title.to_owned()]),
            verdict: verdict(&study.status(), &said),
            said: said.iter().map(|s| in_words(&study, &collected.table, s)).collect(),
            assumptions: headings(&study, |h| h.assumptions.to_vec()),
            facts: facts(&study),
            figures,
            tables,
        });
        let path = study.write_page(&page)?;
        told = format!("{}{}\n{told}\n{}", dependences(analysis), left_out(&study.status()), path.display());
    }
    if !ui.quiet() {
        ui.out(&told);
    }
    Ok(())
}

/// What the figures above do not rest on.
fn left_out(s: &Status) -> String {
    let mut out = String::new();
    if s.left_out > 0 {
        let _ = writeln!(out, "{} of {} points cannot be and are left out", s.left_out, s.done);
    }
    if s.failed > 0 {
        let _ =
            writeln!(out, "{} of {} points failed or are marked, and take no part in this", s.failed, s.done);
    }
    out
}

/// Whether the points can be relied on.
fn verdict(s: &Status, said: &[Said]) -> (Grade, String) {
    let ran = s.done - s.failed - s.left_out;
    let reserved = said.iter().filter(|s| !s.is_missing()).count();
    let mut title = format!("{ran} of {} points have a result", s.points);
    if s.left_out > 0 {
        let _ = write!(title, ", {} cannot be and are left out", s.left_out);
    }
    if s.failed > 0 {
        let _ = write!(title, ", {} failed or are marked", s.failed);
    }
    let grade = match (s.failed, s.left_out + reserved) {
        (0, 0) => Grade::Green,
        (0, _) => Grade::Amber,
        _ => Grade::Red,
    };
    (grade, title)
}

/// What some points say: how many they are, where the first is, and its words.
fn in_words(study: &Study, table: &Table, said: &Said) -> String {
    let row = said.rows.first().copied().unwrap_or_default();
    let inputs = study.plan.varied.iter().filter_map(|v| Some((v, table.columns.get(&v.path)?)));
    let at: Vec<String> = inputs
        .map(|(v, c)| format!("`{}` {} {}", v.path, c.values.text(row), c.unit).trim_end().to_owned())
        .collect();
    let what = if said.is_missing() { "no result" } else { "reservation" };
    format!(
        "{what} at {} of {} points, the first at {}: {}",
        said.rows.len(),
        table.rows(),
        at.join(", "),
        said.text
    )
}

/// What the cases say of themselves, each thing once.
fn headings(study: &Study, of: impl Fn(gudgeon_scene::Heading<'_>) -> Vec<String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for case in study.record.checked().iter().flatten() {
        all.extend(of(case.case.heading()));
    }
    let mut once = Vec::new();
    all.retain(|line| {
        !line.is_empty() && !once.contains(line) && {
            once.push(line.clone());
            true
        }
    });
    all
}

fn title(study: &Study) -> String {
    match study.record.study.title.trim() {
        "" => study.dir().file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned()),
        title => title.to_owned(),
    }
}

/// What was run.
fn facts(study: &Study) -> Vec<(String, String)> {
    let record = &study.record;
    let cases = record.cases.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
    let inputs = study.plan.varied.iter().map(|v| v.path.as_str()).collect::<Vec<_>>().join(", ");
    let status = study.status();
    [
        ("cases", cases),
        ("inputs", inputs),
        ("points", record.points.to_string()),
        ("points that cannot be", status.left_out.to_string()),
        ("failed points", status.failed.to_string()),
        ("Gudgeon", record.gudgeon.clone()),
        ("SHA-256 of the study", record.sha256.clone()),
    ]
    .map(|(name, text)| (name.to_owned(), text))
    .to_vec()
}

/// Results of which the terminal tells; the rest stands in the file.
const SHOWN: usize = 6;

fn dependences(a: &Analysis) -> String {
    let mut out = String::new();
    for group in &a.groups {
        if !group.name.is_empty() {
            let _ = writeln!(out, "{}\n", group.name);
        }
        out.push_str(&of_group(a, group));
        if group.results.len() > SHOWN {
            let _ = writeln!(out, "  {} more results in analysis.json\n", group.results.len() - SHOWN);
        }
    }
    out
}

fn of_group(a: &Analysis, group: &Group) -> String {
    let mut out = String::new();
    for f in group.results.iter().take(SHOWN) {
        let unit = if f.unit.is_empty() || f.unit == "1" { String::new() } else { format!(" [{}]", f.unit) };
        let _ = writeln!(out, "  {}{unit}", f.result);
        match rows(a, f) {
            Ok(rows) => {
                let columns: Vec<usize> = (1..rows.first().map_or(1, Vec::len)).collect();
                for line in table(&rows, &columns).lines() {
                    let _ = writeln!(out, "  {line}");
                }
                if let Dependence::Shares(s) = &f.dependence {
                    out.push_str(&wrapped(&s.without().unwrap_or_default(), 4));
                }
            }
            Err(why) => {
                let _ = writeln!(out, "    {why}");
            }
        }
        out.push('\n');
    }
    out
}

fn cells<const N: usize>(name: &str, values: [f64; N]) -> Vec<String> {
    std::iter::once(name.to_owned()).chain(values.map(number)).collect()
}

fn heads<const N: usize>(words: [&str; N]) -> Vec<String> {
    words.map(str::to_owned).to_vec()
}

/// A table of what a result depends on.
fn rows(a: &Analysis, f: &Finding) -> Result<Vec<Vec<String>>, String> {
    let input = |k: usize| a.inputs[k].as_str();
    let mut out = Vec::new();
    match &f.dependence {
        Dependence::Unknown(why) => return Err(why.clone()),
        Dependence::Tornado(t) => {
            out.push(heads(["input", "low", "high", "range"]));
            let at = |v: Option<f64>| v.unwrap_or(f64::NAN);
            out.extend(t.swings.iter().map(|s| cells(input(s.input), [at(s.low), at(s.high), s.range])));
        }
        Dependence::Morris(effects) => {
            out.push(heads(["input", "mu", "mu*", "sigma"]));
            out.extend(effects.iter().enumerate().map(|(k, e)| cells(input(k), [e.mu, e.mu_star, e.sigma])));
        }
        Dependence::Sobol(s) => {
            out.push(heads(["input", "first", "from", "to", "total", "from", "to"]));
            out.extend(s.inputs.iter().enumerate().map(|(k, i)| {
                let (f, t) = (i.first, i.total);
                cells(input(k), [f.value, f.low, f.high, t.value, t.low, t.high])
            }));
        }
        Dependence::Sample { band: b, effects } => {
            out.push(heads(["", "mean", "deviation", "5 %", "median", "95 %"]));
            let [low, middle, high] = b.quantiles;
            out.push(cells("all", [b.mean, b.deviation, low, middle, high]));
            out.push(heads(["input", "range of mean", "share"]));
            out.extend(effects.iter().enumerate().map(|(k, e)| cells(input(k), [e.range, e.share])));
        }
        Dependence::Linear(l) => {
            out.push(heads(["input", "effect of one deviation", "share"]));
            out.extend(l.inputs.iter().enumerate().map(|(k, p)| cells(input(k), [p.effect, p.share])));
            out.push(cells("value, deviation", [l.value, l.deviation]));
            if l.undefined > 0 {
                out.push(vec![format!("without {} inputs by which it has no derivative", l.undefined)]);
            }
        }
        Dependence::Shares(s) => {
            out.push(heads(["input", "share of the variance", "largest effect"]));
            out.extend(s.anova.effects.iter().map(|e| {
                let name = e.factors.iter().map(|k| input(*k)).collect::<Vec<_>>().join(" × ");
                cells(&name, [e.share, e.largest])
            }));
        }
    }
    Ok(out)
}
