/// `x` above `floor + blend`, `floor` below `floor - blend`, a parabola with continuous slope between: never below `floor`.
#[inline]
pub(super) fn held_above(x: f64, floor: f64, blend: f64) -> f64 {
    let over = x - floor;
    if over >= blend {
        x
    } else if over <= -blend {
        floor
    } else {
        floor + (over + blend) * (over + blend) / (4.0 * blend)
    }
}
