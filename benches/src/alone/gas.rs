//! Gas flow past the rings.

use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::kinds::{GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasPartials};

use super::{Alone, alone, seen};

/// Rates and partial derivatives of a pack of three rings whose pressures fall from 60 bar to 1 bar.
pub fn gas_flow(m: &ModelInfo) -> Result<Alone, String> {
    let (pack, places) = gudgeon_gas::plain_pack(3);
    let rings = places.len();
    alone::<dyn GasFlowSpec, _, _>(
        m,
        move |s| s.build(&GasFlowCtx { pack: &pack }),
        move |gas| {
            let inp = GasIn { p_cylinder: 60e5, p_crankcase: 1e5, rings: &places };
            let n = gas.states().len();
            let (mut state, mut rates) = (vec![0.0; n], vec![0.0; n]);
            let mut out = GasOut::new(rings);
            gas.at_pressures(&inp, &[60e5, 20e5, 4e5, 1e5], &mut state);
            gas.rates(black_box(&inp), &state, &mut rates, &mut out)?;
            let mut partials = GasPartials::new(rings, n);
            gas.partials(&inp, &state, &mut partials)?;
            seen((rates, partials))
        },
    )
}
