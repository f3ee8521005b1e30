//! Flanks and face of a ring as narrow channels, whatever the law of a channel.

use std::f64::consts::{PI, TAU};

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{BackVolume, PackGeometry, RingGeometry, Vent};

use crate::channel::channel_conductance;
use crate::passage::Passage;
use crate::ring_passages::{Openings, RingPassages};
use crate::spaces::lifted;

/// One passage but for its height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Channel {
    perimeter: f64,
    /// Conductance for a height of 1 m.
    conductance: f64,
    /// Flow at a Reynolds number of one.
    unit_flow: f64,
}

impl Channel {
    /// Conductance \[kg/(s Pa²)\] at a height \[m\].
    pub fn conductance(&self, height: f64) -> f64 {
        self.conductance * height * height * height
    }

    /// Cross section \[m²\] at a height \[m\].
    pub fn area(&self, height: f64) -> f64 {
        self.perimeter * height
    }

    /// Flow \[kg/s\] at which the Reynolds number of twice the height is one.
    pub const fn unit_flow(&self) -> f64 {
        self.unit_flow
    }

    /// The channel behind its mouth.
    pub fn limited(&self, height: f64) -> Passage {
        Passage::LimitedChannel { conductance: self.conductance(height), area: self.area(height) }
    }
}

/// The channels of one ring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RingChannels {
    upper: Channel,
    lower: Channel,
    face: Channel,
}

impl RingChannels {
    /// The passages of a ring: `flank` and `face` make them from a channel and its height \[m\] above zero; the end gap is an orifice.
    pub fn passages(
        &self,
        ring: &RingGeometry,
        o: &Openings,
        face_oil: f64,
        flank: impl Fn(&Channel, f64) -> Passage,
        face: impl Fn(&Channel, f64) -> Passage,
    ) -> RingPassages<Passage> {
        let open = |height: f64, passage: &dyn Fn(f64) -> Passage| {
            if height > 0.0 { passage(height) } else { Passage::Closed }
        };
        let (upper, lower) = if ring.back == BackVolume::Sealed {
            (Passage::Closed, Passage::Closed)
        } else {
            (
                open(o.upper.laminar() + o.leak[1], &|h| flank(&self.upper, h)),
                open(o.lower.laminar() + o.leak[0], &|h| flank(&self.lower, h)),
            )
        };
        RingPassages {
            upper,
            lower,
            gap: Passage::Orifice { area: o.gap },
            face: open(ring.leak_face + lifted(o.h, face_oil), &|h| face(&self.face, h)),
        }
    }
}

/// The channels of all rings of a pack, with the gas at the mean temperature of the spaces at both ends and the `viscosity` \[Pa s\] that it has there.
///
/// # Errors
/// A ring without radial thickness or length of its face.
pub(crate) fn ring_channels(
    pack: &PackGeometry,
    viscosity: impl Fn(f64) -> f64,
) -> Result<Vec<RingChannels>, BuildError> {
    let channel = |perimeter: f64, length: f64, t_a: f64, t_b: f64| {
        let t = 0.5 * (t_a + t_b);
        let mu = viscosity(t);
        Channel {
            perimeter,
            conductance: channel_conductance(perimeter, 1.0, length, mu, pack.gas_constant * t),
            unit_flow: 0.5 * perimeter * mu,
        }
    };
    let mut per_ring = Vec::with_capacity(pack.rings.len());
    for (i, ring) in pack.rings.iter().enumerate() {
        for (length, what) in [(ring.width, "radial thickness"), (ring.face.length(), "face length")] {
            if !(length > 0.0 && length.is_finite()) {
                return Err(BuildError::new(format!("ring {} has the {what} {length:e} m", i + 1)));
            }
        }
        let Some([above, below]) = pack.lands.get(i..i + 2).and_then(|s| <&[_; 2]>::try_from(s).ok()) else {
            break; // The network reports the missing land.
        };
        let behind = match (ring.back, ring.vent) {
            (BackVolume::OpenAbove, _) => above.temperature,
            (BackVolume::OpenBelow | BackVolume::Sealed, _) => below.temperature,
            (_, Vent::Open) => pack.lands.last().unwrap_or(below).temperature,
            _ => ring.back_temperature,
        };
        let (upper, lower) = (TAU * ring.piston_radius_above, TAU * ring.piston_radius_below);
        per_ring.push(RingChannels {
            upper: channel(upper, ring.width, above.temperature, behind),
            lower: channel(lower, ring.width, behind, below.temperature),
            face: channel(
                2.0 * PI * pack.bore_radius,
                ring.face.length(),
                above.temperature,
                below.temperature,
            ),
        });
    }
    Ok(per_ring)
}
