//! Rows of a pressure trace: reading, checking, closing the cycle.

use gudgeon_core::BuildError;

/// Highest pressure of a gas that is read \[Pa\]: ten times that of a gun.
const MAX_PRESSURE: f64 = 1e10;

pub(crate) fn equally_spaced(n: usize, period_deg: f64) -> Vec<f64> {
    let closed = n > 1 && (n - 1).is_multiple_of(90);
    let intervals = (if closed { n - 1 } else { n }) as f64;
    (0..n).map(|i| period_deg * i as f64 / intervals).collect()
}

#[derive(Clone, Copy)]
pub(crate) enum Column {
    Theta,
    Pressure,
}

#[derive(Debug)]
pub(crate) struct Rows {
    /// The name of the file the rows come from.
    pub file: Option<String>,
    /// Line of each row in that file.
    pub lines: Vec<usize>,
    pub theta_deg: Vec<f64>,
    pub pressure: Vec<f64>,
}

impl Rows {
    pub fn parse(file: &str, text: &str, period_deg: f64) -> Result<Self, BuildError> {
        let fault =
            |line: usize, what: String| BuildError::at("file", format!("{file}, line {line}: {what}"));
        let mut rows =
            Self { file: Some(file.into()), lines: Vec::new(), theta_deg: Vec::new(), pressure: Vec::new() };
        let mut format: Option<(Separator, usize)> = None;
        for (number, line) in text.strip_prefix('\u{feff}').unwrap_or(text).lines().enumerate() {
            let (number, line) = (number + 1, line.trim());
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let separator = format.map_or_else(|| Separator::of(line), |f| f.0);
            let mut values = [0.0; 2];
            let mut count = 0;
            for field in separator.split(line) {
                match separator.number(field) {
                    Some(v) if count < 2 => values[count] = v,
                    Some(_) => {}
                    None if format.is_none()
                        && !field.starts_with(|c: char| c.is_ascii_digit() || "+-.,".contains(c)) =>
                    {
                        // A header. Anything that begins like a number but is none is a fault, not a header.
                        count = 0;
                        break;
                    }
                    None => return Err(fault(number, format!("`{field}` is not a number"))),
                }
                count += 1;
            }
            if count == 0 {
                continue;
            }
            let columns = format.map_or(count, |f| f.1);
            if count > 2 || count != columns {
                let what = if count == columns { 2 } else { columns };
                let e = fault(number, format!("{count} columns where {what} are expected"));
                return Err(
                    e.help("keep the crank angle and the pressure of one cylinder, or pressures alone")
                );
            }
            format = Some((separator, columns));
            rows.lines.push(number);
            if columns == 2 {
                rows.theta_deg.push(values[0]);
            }
            rows.pressure.push(values[columns - 1]);
        }
        if format.is_some_and(|f| f.1 == 1) {
            rows.theta_deg = equally_spaced(rows.pressure.len(), period_deg);
        }
        Ok(rows)
    }

    pub fn fault(&self, row: usize, column: Column, what: &str) -> BuildError {
        let (name, value) = match column {
            Column::Theta => ("theta_deg", self.theta_deg.get(row)),
            Column::Pressure => ("pressure", self.pressure.get(row)),
        };
        let value = value.copied().unwrap_or(f64::NAN);
        match &self.file {
            Some(file) => {
                let line = self.lines.get(row).copied().unwrap_or(0);
                BuildError::at("file", format!("{file}, line {line}: {name} {value} {what}"))
            }
            None => {
                BuildError::at(format!("{name}.{row}"), format!("row {}: {name} {value} {what}", row + 1))
            }
        }
    }

    fn place(&self) -> (&'static str, String) {
        match &self.file {
            Some(file) => ("file", format!("{file}: ")),
            None => ("pressure", String::new()),
        }
    }

    /// Checks the rows, converts the pressures to pascal, and merges a row at the end of the cycle into the first one.
    pub fn check(&mut self, pascal: impl Fn(f64) -> f64, period_deg: f64) -> Result<(), BuildError> {
        self.check_angles()?;
        self.check_pressures(&pascal)?;
        let n = self.theta_deg.len();
        if n < 4 {
            return Err(self.too_few(n));
        }
        self.pressure.iter_mut().for_each(|p| *p = pascal(*p));
        self.close(period_deg)
    }

    fn check_angles(&self) -> Result<(), BuildError> {
        for (i, t) in self.theta_deg.iter().enumerate() {
            if !t.is_finite() {
                return Err(self.fault(i, Column::Theta, "is not a finite number"));
            }
            match i.checked_sub(1).map(|before| t - self.theta_deg[before]) {
                Some(0.0) => return Err(self.fault(i, Column::Theta, "repeats the row before")),
                Some(d) if d < 0.0 => {
                    let what =
                        format!("is below {}, the row before; angles must ascend", self.theta_deg[i - 1]);
                    return Err(self.fault(i, Column::Theta, &what));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn check_pressures(&self, pascal: impl Fn(f64) -> f64) -> Result<(), BuildError> {
        for (i, &p) in self.pressure.iter().enumerate() {
            if !p.is_finite() {
                return Err(self.fault(i, Column::Pressure, "is not a finite number"));
            }
            let si = pascal(p);
            if !(si.is_finite() && si > 0.0) {
                // Four digits: what a subtraction leaves behind them says nothing.
                let rounded = format!("{si:.3e}").parse::<f64>().unwrap_or(si);
                let what = format!("is {rounded} Pa absolute, it must be greater than zero");
                let gauge = "a trace of gauge pressures needs the ambient pressure: `offset = \"1.013 bar\"`";
                return Err(self.fault(i, Column::Pressure, &what).help(gauge));
            }
            if si > MAX_PRESSURE {
                let what = format!("is {si:e} Pa absolute, more than the {MAX_PRESSURE:e} Pa of any machine");
                return Err(self.fault(i, Column::Pressure, &what));
            }
        }
        Ok(())
    }

    fn too_few(&self, n: usize) -> BuildError {
        let (field, place) = self.place();
        BuildError::at(field, format!("{place}{n} rows over the cycle, at least 4 are needed"))
    }

    /// The rows, in pascal, cover one cycle: a row at its end becomes part of the first one.
    fn close(&mut self, period_deg: f64) -> Result<(), BuildError> {
        let (field, place) = self.place();
        let n = self.theta_deg.len();
        let span = self.theta_deg[n - 1] - self.theta_deg[0];
        // Degrees. Angles written with single precision are 6e-5 apart near 720.
        let slack = 1e-4;
        if span > period_deg + slack {
            let what = format!("{place}the rows span {span} deg, the cycle {period_deg} deg");
            return Err(BuildError::at(field, what).help("`cycle` sets the length of the cycle"));
        }
        if span >= period_deg - slack {
            let (first, last) = (self.pressure[0], self.pressure[n - 1]);
            if (first - last).abs() > 0.05 * first.min(last) {
                let what = format!(
                    "{place}the first and the last row are one cycle apart, but their pressures are {first} and {last} Pa"
                );
                return Err(BuildError::at(field, what)
                    .help("drop the last row, or mend the trace: a cycle is periodic"));
            }
            self.pressure[0] = 0.5 * (first + last);
            self.pressure.pop();
            self.theta_deg.pop();
            return if n - 1 < 4 { Err(self.too_few(n - 1)) } else { Ok(()) };
        }
        let widest = self.theta_deg.windows(2).map(|w| w[1] - w[0]).fold(0.0_f64, f64::max);
        if period_deg - span > 2.0 * widest + slack {
            let what = format!(
                "{place}the rows span {span} deg of a cycle of {period_deg} deg and leave the rest empty, more than twice the widest gap between them ({widest} deg)"
            );
            return Err(BuildError::at(field, what)
                .help("add the missing rows, repeat the first row at the end of the cycle, or set `cycle`"));
        }
        Ok(())
    }
}

#[derive(Clone, Copy)]
enum Separator {
    Char(char),
    Blank,
}

impl Separator {
    fn of(line: &str) -> Self {
        [';', '\t', ','].into_iter().find(|&c| line.contains(c)).map_or(Self::Blank, Self::Char)
    }
    fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let on = move |c: char| match self {
            Self::Char(s) => c == s,
            Self::Blank => c.is_whitespace(),
        };
        line.split(on).map(str::trim).filter(move |f| !(f.is_empty() && matches!(self, Self::Blank)))
    }
    fn number(self, field: &str) -> Option<f64> {
        let decimal_comma = matches!(self, Self::Char(';' | '\t')) && field.contains(',');
        if decimal_comma { field.replace(',', ".").parse().ok() } else { field.parse().ok() }
    }
}
