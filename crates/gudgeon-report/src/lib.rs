//! Result files, plots and the HTML report.
