use gudgeon_core::kinds::{Edge, Film2dGrid};
use gudgeon_numerics::elementary;

/// What [`Panel::grid`] takes for `crowding`: at either end the spacing vanishes somewhere as the intervals become many.
pub const CROWDING: std::ops::RangeInclusive<f64> = -0.5..=0.5;

/// One side of a skirt: part of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// Radius \[m\].
    pub radius: f64,
    /// Height from the upper to the lower edge \[m\].
    pub length: f64,
    /// Angle to the left and to the right of the middle \[rad\].
    pub half_angle: f64,
}

impl Panel {
    /// Length of the arc \[m\].
    #[must_use]
    pub fn width(&self) -> f64 {
        2.0 * self.half_angle * self.radius
    }

    /// Area of the surface \[m²\].
    #[must_use]
    pub fn area(&self) -> f64 {
        self.width() * self.length
    }

    /// `nx` × `ny` intervals over the whole side: `x` from the upper edge down, `y` along the arc from the middle, oil at given pressure on
    /// all edges. Along the height nodes lie closer at its middle by the part `crowding`, or closer at its ends where that is negative ([`CROWDING`]):
    /// `x = L/2 (1 + t (1 - g + g t²))`, `t` equally spaced from -1 to 1.
    #[must_use]
    pub fn grid(&self, nx: usize, ny: usize, crowding: f64) -> Film2dGrid {
        let (length, width, g) = (self.length, self.width(), crowding);
        let mut grid = Film2dGrid::uniform(nx + 1, ny + 1, length, width);
        for x in &mut grid.x {
            let t = 2.0 * *x / length - 1.0;
            *x = 0.5 * length * (1.0 + t * (1.0 - g + g * t * t));
        }
        // Nodes left and right of the middle mirror each other to the last bit.
        for j in 0..=ny {
            let right = 0.5 * width * (2.0 * j.max(ny - j) as f64 / ny as f64 - 1.0);
            grid.y[j] = if 2 * j < ny { -right } else { right };
        }
        grid
    }

    /// The half of `grid` up to its middle line of nodes, a plane of symmetry, when it has one and at least four intervals along the arc.
    #[must_use]
    pub fn half(grid: &Film2dGrid) -> Option<Film2dGrid> {
        let ny = grid.y.len();
        (ny % 2 == 1 && ny >= 5).then(|| {
            let mut half = grid.clone();
            half.y.truncate(ny / 2 + 1);
            half.edges[3] = Edge::Wall;
            half
        })
    }

    /// Gap at height `x` below the upper edge and angle `angle` from the middle \[m\], for a skirt whose upper and lower edge are displaced
    /// towards this side of the liner by `top` and `bottom`: `c - (top (1 - x/L) + bottom x/L) cos φ`.
    #[must_use]
    pub fn gap(&self, clearance: f64, top: f64, bottom: f64, x: f64, angle: f64) -> f64 {
        clearance - between(top, bottom, x / self.length) * elementary::cos(angle)
    }
}

/// The value at the part `s` of the way from `top` to `bottom`.
pub(crate) fn between(top: f64, bottom: f64, s: f64) -> f64 {
    top + (bottom - top) * s
}
