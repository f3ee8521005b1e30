//! What may stand on the command line.

use std::path::{Path, PathBuf};

use clap::{Args as ClapArgs, Parser, Subcommand};
use clap_complete::Shell;

/// What the program is called.
pub const NAME: &str = "gudgeon";

/// Simulates the power cylinder of reciprocating machines: gas between the rings, films, contact, ring motion.
///
/// A case is a TOML file that names its models. `gudgeon models` lists them, `gudgeon explain CASE` tells what a case does.
#[derive(Debug, Parser)]
#[command(name = NAME, version, max_term_width = 110, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

impl Args {
    /// Whether anything but results and errors is unwanted.
    pub const fn quiet(&self) -> bool {
        match &self.command {
            Command::Run(a) => a.quiet,
            Command::Compare(a) => a.quiet,
            Command::Bench(a) => a.quiet,
            Command::Gradient(a) => a.quiet,
            Command::Validate(a) => a.quiet,
            Command::Study(StudyCommand::Run(a)) => a.quiet,
            Command::Study(StudyCommand::Collect(a)) => a.quiet,
            _ => false,
        }
    }
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a case file to be filled in; without arguments, list the templates
    New(NewArgs),
    /// Run a case; results go to `out/<case>/`
    Run(RunArgs),
    /// Read, resolve and validate a case without running it
    Check(CheckArgs),
    /// Show the resolved case: models, equations, defaults, what runs and what is skipped
    Explain(CheckArgs),
    /// List the models, of one kind or of all
    Models(ModelsArgs),
    /// Tell everything about one model, or the keys of a case
    Describe(DescribeArgs),
    /// Print the JSON schema of a case file, for editors
    Schema,
    /// Run cases with every combination of some values, compare the results, and tell which choice matters
    Compare(CompareArgs),
    /// Measure run time and work against error: solvers, models of the same equations, numerical settings
    Bench(BenchArgs),
    /// Tell how results of a case change with its inputs: derivatives
    Gradient(GradientArgs),
    /// Compare cases with the values of their sources
    Validate(ValidateArgs),
    /// Make, run and collect a study of many runs in a folder
    #[command(subcommand)]
    Study(StudyCommand),
    /// Write report.html of a result folder again
    Report(ReportArgs),
    /// Print a script that completes commands and options in a shell
    Completions(CompletionsArgs),
    /// Print the manual page of the program, or write those of all commands
    Man(ManArgs),
}

/// The case and its changes.
#[derive(Debug, ClapArgs)]
pub struct CaseArgs {
    /// Case file
    pub case: PathBuf,
    /// Change a value of the case: rings.0.gap="0.5 mm", models.gas_flow.model=narrow_channel
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

#[derive(Debug, ClapArgs)]
pub struct NewArgs {
    /// Template [default: list them]
    pub template: Option<String>,
    /// File to be written; one that exists is left alone [default: TEMPLATE.toml]
    pub file: Option<PathBuf>,
    /// Print the templates as JSON
    #[arg(long, conflicts_with = "template")]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct RunArgs {
    #[command(flatten)]
    pub case: CaseArgs,
    /// Folder for the results [default: out/<case>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Refine every numerical setting until the uncertainty of each result is known, and look for another periodic state from other starts (several runs)
    #[arg(long)]
    pub verify: bool,
    /// Threads for the points of its sweeps, 0: one a core; with 1 the case itself does not use a second core either
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Print all results, not only those that lead
    #[arg(long)]
    pub all: bool,
    /// Print the summary as JSON and nothing else
    #[arg(long)]
    pub json: bool,
    /// No progress, no table
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    #[command(flatten)]
    pub case: CaseArgs,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct ModelsArgs {
    /// Only this kind; with `--sets` also a table of a case, such as `engine`
    pub kind: Option<String>,
    /// List parameter sets instead: named groups of values, each with its source or marked as assumed
    #[arg(long)]
    pub sets: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct DescribeArgs {
    /// KIND/MODEL, or a kind or a model alone; a scene or a table of its cases, ring_pack.rings
    #[arg(value_name = "KIND/MODEL")]
    pub what: String,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct CompareArgs {
    /// Case files, each with changes of its own where it has any: cases/turbo-diesel-120.toml,engine.speed="1500 rpm"
    #[arg(value_name = "CASE[,PATH=VALUE]", required = true)]
    pub cases: Vec<String>,
    /// Change a value of all cases: solver.method=implicit
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Values to try, the first one being the base: gas_flow=orifice_network,narrow_channel
    #[arg(long, value_name = "PATH=A,B,C", required = true)]
    pub swap: Vec<String>,
    /// Results that the table of shares shows [default: those of the whole scene, blow_by but not ring1.h_min]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub results: Vec<String>,
    /// Refine every combination until the uncertainty of its results is known, and mark differences that are within it
    #[arg(long)]
    pub verify: bool,
    /// Folder for the results [default: out/<case>-compare, of several cases out/<case>+<case>-compare]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// No progress, no table
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct BenchArgs {
    /// Case files
    #[arg(value_name = "CASE", required = true)]
    pub cases: Vec<PathBuf>,
    /// Change a value of every case
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Models or values to race instead of the methods that the scene knows, each along its own numerical settings:
    /// rig.film_1d.model=front_tracking,complementarity
    #[arg(long, value_name = "PATH=A,B,C")]
    pub contender: Vec<String>,
    /// Results whose error is measured
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub results: Vec<String>,
    /// Folder for the results; of several cases, one folder each in it [default: out/<case>-bench]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// No progress, no table
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct GradientArgs {
    #[command(flatten)]
    pub case: CaseArgs,
    /// Inputs: rings.0.cold_gap,engine.speed
    #[arg(long, value_name = "PATH,PATH", value_delimiter = ',', required = true)]
    pub by: Vec<String>,
    /// Results to be told, each with its derivatives [default: a table of all]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub results: Vec<String>,
    /// By differences of runs, although the scene has a method of its own
    #[arg(long)]
    pub by_runs: bool,
    /// Folder for gradients.json and gradients.csv [default: out/<case>-gradient]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print JSON and nothing else; no files
    #[arg(long)]
    pub json: bool,
    /// No progress, no table
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct ValidateArgs {
    /// Cases, files of comparisons or folders of them [default: validation]
    #[arg(value_name = "CASE")]
    pub files: Vec<PathBuf>,
    /// Write the comparisons as pages of Markdown: an index FILE, and a folder beside it with a page for each case
    #[arg(long, value_name = "FILE")]
    pub pages: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// No progress, only what does not hold
    #[arg(long, short)]
    pub quiet: bool,
}

/// What to do with the folder of a study.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Make the folder of a study from a study file; nothing is run
    New(StudyNewArgs),
    /// Run what is missing; broken off, the same command goes on
    Run(StudyRunArgs),
    /// Tell how far a study is
    Status(StudyStatusArgs),
    /// Put all rows into one table, and tell what the results depend on
    Collect(StudyCollectArgs),
}

#[derive(Debug, ClapArgs)]
pub struct StudyNewArgs {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Study file: cases, inputs, design
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub struct StudyRunArgs {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Only the k-th of N jobs: for arrays of jobs
    #[arg(long, value_name = "K/N")]
    pub part: Option<String>,
    /// Threads; 0: one a core
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// No progress, no summary
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct StudyStatusArgs {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, ClapArgs)]
pub struct StudyCollectArgs {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Write table.csv beside table.parquet
    #[arg(long)]
    pub csv: bool,
    /// Collect although points are missing
    #[arg(long)]
    pub partial: bool,
    /// No table on the terminal
    #[arg(long, short)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct ReportArgs {
    /// Folder with the results of a run, a comparison or a benchmark
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub struct CompletionsArgs {
    /// Shell
    pub shell: Shell,
}

#[derive(Debug, ClapArgs)]
pub struct ManArgs {
    /// Folder for a page of every command
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The folder that results go to. A case whose file is called `...toml` must not get a folder beside `out`.
pub fn out_dir(given: Option<&Path>, case: &str, suffix: &str) -> PathBuf {
    let name = if case.chars().all(|c| c == '.') { "case" } else { case };
    given.map_or_else(|| Path::new("out").join(format!("{name}{suffix}")), Path::to_owned)
}
