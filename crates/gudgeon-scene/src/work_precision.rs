//! What a scene says of its solvers, for diagrams of run time against error.

/// One solver at one setting.
pub struct MethodSetting {
    /// Solver: settings of one method form one curve.
    pub method: &'static str,
    /// The setting: `tolerance 1e-4`, `16 sub-steps`.
    pub setting: String,
    /// Whether a case that says nothing has it.
    pub is_default: bool,
    /// The setting as `--set` takes it.
    pub set: Vec<String>,
}

/// What `bench` runs for a scene.
pub struct WorkPrecision {
    /// Methods, in the order in which they are named.
    pub methods: Vec<&'static str>,
    /// Every method at every setting.
    pub settings: Vec<MethodSetting>,
    /// Settings that give the reference.
    pub reference: Vec<String>,
    /// Settings that tell how far the reference can be trusted.
    pub reference_check: Vec<String>,
    /// Both in words, up to "by at most".
    pub reference_is: &'static str,
    /// Results that are looked at unless told otherwise; those that the case has.
    pub results: Vec<&'static str>,
}
