//! Resolved geometry of a ring pack, in SI numbers: what a scene hands to the models it builds.

/// Shape of a ring's running face: drop `h_s(x)` below its nearest point to the liner, `x` from the bottom edge (0) to
/// the top edge (`length`) \[m\].
#[derive(Debug, Clone, PartialEq)]
pub enum FaceProfile {
    /// `h_s = curvature (x - apex)^2`.
    Parabola {
        /// Axial length of the running face \[m\].
        length: f64,
        /// κ \[1/m\].
        curvature: f64,
        /// Position of the apex \[m\]; may lie outside the face.
        apex: f64,
    },
    /// Flat over `land` from the bottom edge, then straight to `drop` at the top edge.
    Taper {
        /// Axial length of the running face \[m\].
        length: f64,
        /// Width of the flat part \[m\], above zero and less than the length.
        land: f64,
        /// Drop at the top edge \[m\].
        drop: f64,
    },
    /// Piecewise linear through equally spaced nodes, bottom edge first. A taper without land has two nodes.
    Table {
        /// Axial length of the running face \[m\].
        length: f64,
        /// Drops at the nodes \[m\], at least two.
        drops: Vec<f64>,
    },
}

impl FaceProfile {
    /// Axial length of the running face \[m\].
    #[must_use]
    pub const fn length(&self) -> f64 {
        match self {
            Self::Parabola { length, .. } | Self::Taper { length, .. } | Self::Table { length, .. } => {
                *length
            }
        }
    }

    /// Drop at `x` \[m\], with the nearest point at zero as stored (nothing is shifted here).
    #[must_use]
    pub fn drop_at(&self, x: f64) -> f64 {
        match self {
            Self::Parabola { curvature, apex, .. } => curvature * (x - apex) * (x - apex),
            Self::Taper { length, land, drop } => drop * ((x - land) / (length - land)).clamp(0.0, 1.0),
            Self::Table { length, drops } => {
                let n = drops.len() - 1;
                let t = (x / length * n as f64).clamp(0.0, n as f64);
                let i = (t as usize).min(n - 1);
                let f = t - i as f64;
                drops[i] + f * (drops[i + 1] - drops[i])
            }
        }
    }

    /// Distance of the narrowest place from the bottom edge \[m\]: the middle of a flat one.
    #[must_use]
    pub fn narrowest(&self) -> f64 {
        match self {
            Self::Parabola { apex, length, .. } => apex.clamp(0.0, *length),
            Self::Taper { land, .. } => 0.5 * land,
            Self::Table { drops, length } => {
                let low = drops.iter().copied().fold(f64::INFINITY, f64::min);
                let first = drops.iter().position(|d| *d == low).unwrap_or(0);
                let last = drops.iter().rposition(|d| *d == low).unwrap_or(0);
                0.5 * (first + last) as f64 * length / (drops.len() - 1) as f64
            }
        }
    }

    /// The nodes of a face of straight lines as (`x`, drop) \[m\], bottom edge first; `None` for a curved face.
    #[must_use]
    pub fn nodes(&self) -> Option<Vec<(f64, f64)>> {
        match self {
            Self::Parabola { .. } => None,
            Self::Taper { length, land, drop } => Some(vec![(0.0, 0.0), (*land, 0.0), (*length, *drop)]),
            Self::Table { length, drops } => {
                let n = drops.len() - 1;
                let x = |i: usize| if i == n { *length } else { length * i as f64 / n as f64 };
                Some(drops.iter().enumerate().map(|(i, d)| (x(i), *d)).collect())
            }
        }
    }
}

/// Where the gas behind a ring is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BackVolume {
    /// From the groove's geometry; follows the ring's radial position.
    Geometric,
    /// A given constant volume \[m³\].
    Fixed(f64),
    /// Open to the space below the ring: no volume of its own, `p_back` is the pressure below.
    OpenBelow,
    /// Open to the space above the ring: no volume of its own, `p_back` is the pressure above.
    OpenAbove,
    /// A ring with no axial clearance (one rail that stands for two): no volume, `p_back` is the mean of above and below.
    Sealed,
}

/// Way of the gas in a groove or between two rings to the crankcase, beside those past the rings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Vent {
    /// None.
    #[default]
    Closed,
    /// Through openings.
    Drain(Drain),
    /// So wide that the gas has the pressure of the crankcase: no volume of its own.
    Open,
}

/// Holes or slots that lead to the crankcase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drain {
    /// Area of all of them \[m²\].
    pub area: f64,
    /// Effective over geometric area.
    pub discharge: f64,
}

/// A chamfer at an edge of a groove: opens an extra leak path at the end gap when the ring is seated on that side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Chamfer {
    /// Extra area \[m²\] when seated on the lower flank.
    pub area_lower: f64,
    /// Extra area \[m²\] when seated on the upper flank.
    pub area_upper: f64,
}

/// One ring with its groove.
#[derive(Debug, Clone, PartialEq)]
pub struct RingGeometry {
    /// Axial thickness `b` at the outer diameter \[m\].
    pub height: f64,
    /// Radial thickness `w` \[m\].
    pub width: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Tangential (closing) force \[N\].
    pub tangential_force: f64,
    /// Running end gap at the nominal bore \[m\]; a liner distortion `δ` adds `2πδ`.
    pub gap: f64,
    /// Flow area of the end gap \[m²\] when it is given instead of following from gap and land clearance.
    pub gap_area: Option<f64>,
    /// Piston radius above the groove \[m\].
    pub piston_radius_above: f64,
    /// Piston radius below the groove \[m\].
    pub piston_radius_below: f64,
    /// Groove root radius \[m\].
    pub root_radius: f64,
    /// Slope of the upper groove flank, positive when the groove opens outwards.
    pub slope_upper: f64,
    /// Slope of the lower groove flank.
    pub slope_lower: f64,
    /// Axial height of the groove at its root \[m\].
    pub groove_height_inner: f64,
    /// Axial clearance when the ring touches the groove root \[m\]; grows by `(slope_upper + slope_lower) * gap_behind`.
    pub clearance_inner: f64,
    /// Equivalent leak height of the seated upper flank \[m\].
    pub leak_upper: f64,
    /// Equivalent leak height of the seated lower flank \[m\].
    pub leak_lower: f64,
    /// Equivalent leak height of the running face \[m\].
    pub leak_face: f64,
    /// Groove-edge chamfers.
    pub chamfer: Chamfer,
    /// Where the gas behind the ring is.
    pub back: BackVolume,
    /// Way of that gas to the crankcase, of [`BackVolume::Geometric`] and [`BackVolume::Fixed`].
    pub vent: Vent,
    /// Gas temperature behind the ring \[K\].
    pub back_temperature: f64,
    /// Oil-filled fraction of the groove flanks, 0 to 1.
    pub oil_fill: f64,
    /// Running face of one land.
    pub face: FaceProfile,
    /// Lands of the running face: 1, or 2 for a twin-land oil ring, whose slots join the space between its lands with that behind it.
    pub lands: usize,
    /// Rails that this entry stands for: 1, or 2 for a three-piece oil ring whose rails are modelled by one that carries
    /// half the tangential force.
    pub rails: usize,
    /// Whether the ring can move in its groove at all.
    pub has_clearance: bool,
    /// Axial force of an expander on a rail, towards the head positive, over the radial force of the tension of that rail; 0 without one.
    pub expander_slope: f64,
}

impl RingGeometry {
    /// Whether there is gas behind the ring that has a pressure of its own.
    #[must_use]
    pub fn has_room(&self) -> bool {
        matches!(self.back, BackVolume::Geometric | BackVolume::Fixed(_)) && self.vent != Vent::Open
    }

    /// Whether the upper flank is the one that it seals: that of an upper rail.
    #[must_use]
    pub fn seals_above(&self) -> bool {
        self.back == BackVolume::OpenBelow
    }

    /// Film thickness at which the ring touches the groove root \[m\], for a local liner radius.
    #[inline]
    #[must_use]
    pub fn h_max(&self, liner_radius: f64) -> f64 {
        liner_radius - self.root_radius - self.width
    }
}

/// The space above a ring, or the crankcase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandGeometry {
    /// Gas volume \[m³\]; not used for the first (combustion chamber) and the last (crankcase).
    pub volume: f64,
    /// Gas temperature \[K\].
    pub temperature: f64,
    /// Way of its gas to the crankcase; not used for the first and the last.
    pub vent: Vent,
}

/// A ring pack.
#[derive(Debug, Clone, PartialEq)]
pub struct PackGeometry {
    /// Liner radius without distortion \[m\].
    pub bore_radius: f64,
    /// Rings, crown first.
    pub rings: Vec<RingGeometry>,
    /// `rings.len() + 1` spaces: above ring 1 (combustion chamber) … below the last ring (crankcase).
    pub lands: Vec<LandGeometry>,
    /// Ratio of specific heats.
    pub gamma: f64,
    /// Specific gas constant \[J/(kg K)\].
    pub gas_constant: f64,
}

/// Where one ring is at an instant, and the geometry that follows from it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RingPlace {
    /// Film thickness at the nearest point \[m\].
    pub h: f64,
    /// Height of the ring above the lower groove flank \[m\], 0 to `clearance` (slightly outside while in contact).
    pub s: f64,
    /// Velocity of the ring relative to the piston \[m/s\], upwards positive.
    pub v: f64,
    /// Axial clearance now \[m\].
    pub clearance: f64,
    /// Lift fraction: `s / clearance` clamped to 0…1, 0 on the lower flank and 1 on the upper; for a discrete motion model 0, ½ or 1.
    pub lift_fraction: f64,
    /// Twist of the section \[rad\], positive when the outer edge rises towards the head. The gap at a flank is then a wedge.
    pub twist: f64,
    /// Its rate \[rad/s\].
    pub twist_rate: f64,
    /// Liner radius here \[m\], distortion included.
    pub liner_radius: f64,
    /// Inner radius of the ring \[m\].
    pub r_inner: f64,
    /// Outer radius of the ring \[m\].
    pub r_outer: f64,
    /// Volume behind the ring \[m³\].
    pub back_volume: f64,
    /// Oil on the flanks.
    pub flank: FlankOil,
}

/// Where oil stands between a ring and the flanks of its groove: on the lower flank, on the upper flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankOil {
    /// Radial width of the strip of oil that bridges each gap \[m\].
    pub wetted: [f64; 2],
    /// Share of each gap that is open to gas, 0 to 1.
    pub open: [f64; 2],
}

impl Default for FlankOil {
    /// No oil that closes a gap.
    fn default() -> Self {
        Self { wetted: [0.0; 2], open: [1.0; 2] }
    }
}

impl RingPlace {
    /// Flank annulus `π (r_outer² - r_inner²)` \[m²\].
    #[inline]
    #[must_use]
    pub fn flank_area(&self) -> f64 {
        std::f64::consts::PI * (self.r_outer * self.r_outer - self.r_inner * self.r_inner)
    }
}

/// The section of a ring between the pressures around it: what the laws of its gas forces read.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct RingSection<'a> {
    /// The ring and its groove.
    pub geometry: &'a RingGeometry,
    /// Where it is.
    pub place: &'a RingPlace,
    /// Radius of the nominal bore \[m\].
    pub bore_radius: f64,
    /// Absolute pressure of the land above the ring \[Pa\].
    pub p_above: f64,
    /// Absolute pressure of the land below the ring \[Pa\].
    pub p_below: f64,
    /// Absolute pressure behind the ring \[Pa\].
    pub p_back: f64,
    /// Absolute pressure below which its film cavitates \[Pa\].
    pub p_cav: f64,
}

impl<'a> RingSection<'a> {
    /// A ring in a bore, under no pressure.
    #[must_use]
    pub const fn new(geometry: &'a RingGeometry, place: &'a RingPlace, bore_radius: f64) -> Self {
        Self { geometry, place, bore_radius, p_above: 0.0, p_below: 0.0, p_back: 0.0, p_cav: 0.0 }
    }

    /// The same ring between absolute pressures \[Pa\]: above it, below it, behind it, and that below which its film cavitates.
    #[must_use]
    pub const fn under(mut self, above: f64, below: f64, back: f64, cavitation: f64) -> Self {
        (self.p_above, self.p_below, self.p_back, self.p_cav) = (above, below, back, cavitation);
        self
    }

    /// Outer circumference `2 π r_outer` \[m\].
    #[must_use]
    pub fn outer_circumference(&self) -> f64 {
        2.0 * std::f64::consts::PI * self.place.r_outer
    }

    /// Load of the gas behind the ring above `p_cav`, on its inner cylinder and per outer circumference \[N/m\].
    #[must_use]
    pub fn gas_on_back(&self) -> f64 {
        self.geometry.height * (self.p_back - self.p_cav) * (self.place.r_inner / self.place.r_outer)
    }

    /// Load of the lands above `p_cav` on the parts of the face beside the running face, per circumference \[N/m\].
    #[must_use]
    pub fn gas_beside_face(&self) -> f64 {
        let g = self.geometry;
        let rest = g.height - g.lands as f64 * g.face.length();
        if g.lands == 2 {
            rest * (self.p_back - self.p_cav)
        } else {
            0.5 * rest * (self.p_above + self.p_below - 2.0 * self.p_cav)
        }
    }
}
