//! Forces of one side.

/// Forces of one side and their derivatives with respect to the rates: `[top edge, bottom edge, axial force, axial force times R cos φ]`, then
/// one value per elastic shape.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SideLoads {
    /// Film, forces on the displacements of the upper and lower edge \[N\]; the axial force on the skirt away from the head \[N\] and its moment
    /// arm `∫ τ R cos φ dA` \[N m\].
    pub film: [f64; 4],
    /// Forces on the elastic shapes \[N\].
    pub elastic: Vec<f64>,
    /// Solid contact: forces on both edges \[N\], normal force `∫ p dA` \[N\], `∫ p R cos φ dA` \[N m\]; where friction asks for the real area of contact, that
    /// area `∫ A_c/A dA` \[m²\] and `∫ A_c/A R cos φ dA` \[m³\].
    pub contact: [f64; 6],
    /// Derivative of `film`, then of `elastic`, with respect to the rates, rate after rate.
    pub slope: Vec<f64>,
}

/// Derivatives of the forces with respect to the rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Slopes {
    /// Not wanted.
    #[default]
    None,
    /// Of the film as it is.
    Film,
    /// Of a film that does not cavitate: larger than those of the film as it is.
    Full,
}
