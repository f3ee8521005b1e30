//! Cases run in child processes, one after the other, so that a case which never ends, or takes its process with it, costs only itself.
//!
//! A child reads one [`Job`] a line and answers each with one [`Outcome`] a line.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::execute::{End, Job, Outcome, execute, keep_panics};

/// The argument that makes the program a child.
pub const SERVE: &str = "--serve";
/// Memory of a child [KiB]: a hundred times what the largest shipped case takes.
const MEMORY: u64 = 3 << 20;
/// Jobs that one child does; what a case leaves behind does not add up.
const JOBS: usize = 200;
/// Lines of its last words that are kept.
const LAST_WORDS: usize = 4;

/// Answers jobs until there are no more.
///
/// # Errors
/// The pipes of the parent are gone.
pub fn serve(folder: &Path) -> std::io::Result<()> {
    keep_panics();
    let mut out = std::io::stdout();
    for line in std::io::stdin().lock().lines() {
        let job: Job = serde_json::from_str(&line?)?;
        serde_json::to_writer(&mut out, &execute(folder, &job))?;
        out.write_all(b"\n")?;
        out.flush()?;
    }
    Ok(())
}

/// Runs jobs in children of a program that answers [`SERVE`].
#[derive(Debug)]
pub struct Executor {
    program: PathBuf,
    folder: PathBuf,
    running: Option<Running>,
}

#[derive(Debug)]
struct Running {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
    last_words: Arc<Mutex<VecDeque<String>>>,
    left: usize,
}

impl Executor {
    /// With the program that becomes the children, and the folder of the cases.
    #[must_use]
    pub fn new(program: PathBuf, folder: PathBuf) -> Self {
        Self { program, folder, running: None }
    }

    /// Runs one job, for at most `limit`.
    ///
    /// # Errors
    /// No child can be started.
    pub fn run(&mut self, job: &Job, limit: Duration) -> std::io::Result<Outcome> {
        let begin = Instant::now();
        let mut r = match self.running.take() {
            Some(r) => r,
            None => self.start()?,
        };
        let mut line = serde_json::to_string(job)?;
        line.push('\n');
        // A child that cannot be written to has ended; its answer says so.
        let _ = r.input.write_all(line.as_bytes()).and_then(|()| r.input.flush());
        let answer = r.answers.recv_timeout(limit);
        let seconds = begin.elapsed().as_secs_f64();
        let ended = |end| Outcome { end, seconds, ..Outcome::default() };
        Ok(match answer {
            Ok(text) => {
                r.left -= 1;
                if r.left > 0 {
                    self.running = Some(r);
                } else {
                    end(r);
                }
                serde_json::from_str(&text)?
            }
            Err(RecvTimeoutError::Timeout) => {
                end(r);
                ended(End::Hang)
            }
            Err(RecvTimeoutError::Disconnected) => {
                // Its pipe closes before it has ended; how it ends is wanted, not that it was killed.
                for _ in 0..200 {
                    if !matches!(r.child.try_wait(), Ok(None)) {
                        break;
                    }
                    std::thread::sleep(Duration::from_millis(10));
                }
                ended(End::Died(end(r)))
            }
        })
    }

    fn start(&self) -> std::io::Result<Running> {
        let mut child = limited(&self.program)
            .arg(SERVE)
            .arg(&self.folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let gone = || std::io::Error::other("a pipe of the child is missing");
        let input = child.stdin.take().ok_or_else(gone)?;
        let output = child.stdout.take().ok_or_else(gone)?;
        let errors = child.stderr.take().ok_or_else(gone)?;
        let (tell, answers) = channel();
        std::thread::spawn(move || {
            let lines = BufReader::new(output).lines().map_while(Result::ok);
            lines.take_while(|line| tell.send(line.clone()).is_ok()).for_each(drop);
        });
        let last_words = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&last_words);
        std::thread::spawn(move || {
            for line in BufReader::new(errors).lines().map_while(Result::ok).filter(|l| !l.trim().is_empty())
            {
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                kept.push_back(line);
                if kept.len() > LAST_WORDS {
                    kept.pop_front();
                }
            }
        });
        Ok(Running { child, input, answers, last_words, left: JOBS })
    }
}

impl Drop for Executor {
    fn drop(&mut self) {
        if let Some(r) = self.running.take() {
            end(r);
        }
    }
}

/// Ends a child; how it ended, with its last words.
fn end(mut r: Running) -> String {
    drop(r.input);
    // One that ended by itself cannot be killed, which is no matter.
    let _ = r.child.kill();
    let status = r.child.wait().map_or_else(|e| e.to_string(), |s| s.to_string());
    // The thread that reads them needs a moment behind the end of the process.
    std::thread::sleep(Duration::from_millis(20));
    let words = r.last_words.lock().unwrap_or_else(PoisonError::into_inner);
    let words: Vec<&str> = words.iter().map(|s| s.trim()).collect();
    if words.is_empty() { status } else { format!("{} ({status})", words.join(" ")) }
}

/// The program with bounded memory, where the shell can bound it.
fn limited(program: &Path) -> Command {
    if cfg!(target_os = "linux") {
        let mut c = Command::new("sh");
        c.arg("-c").arg(format!("ulimit -v {MEMORY} 2>/dev/null; exec \"$0\" \"$@\"")).arg(program);
        return c;
    }
    Command::new(program)
}
