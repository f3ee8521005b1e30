//! A periodic motion by orders.

/// One order of a periodic motion; phasors `a` stand for `Re(a e^{i order θ})`, θ the angle of the reference shaft.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OrderResponse {
    /// The order.
    pub order: f64,
    /// Angles of the inertias \[rad\], real and imaginary part.
    pub angle: Vec<[f64; 2]>,
    /// Torques in the links \[N m\].
    pub torque: Vec<[f64; 2]>,
    /// Power that the link turns into heat \[W\].
    pub heat: Vec<f64>,
    /// Torques that excite the inertias \[N m\].
    pub excitation: Vec<[f64; 2]>,
}

/// All orders of a periodic motion, ascending: quantities of an [`OrderResponse`], in rows that hold one inertia or link in all orders.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OrderResponses {
    order: Vec<f64>,
    angle: Phasors,
    torque: Phasors,
    heat: Vec<f64>,
    excitation: Phasors,
}

/// Rows of complex numbers, one after the other: real parts and imaginary parts.
type Phasors = [Vec<f64>; 2];

/// Real and imaginary parts of an inertia or a link in all orders.
pub type PhasorRow<'a> = [&'a [f64]; 2];

impl OrderResponses {
    /// Makes room for some orders of a line with so many inertias and links. What it held before is lost.
    pub fn reset(&mut self, order: impl ExactSizeIterator<Item = f64>, nodes: usize, links: usize) {
        let count = order.len();
        self.order.clear();
        self.order.extend(order);
        for (phasors, rows) in
            [(&mut self.angle, nodes), (&mut self.torque, links), (&mut self.excitation, nodes)]
        {
            phasors.iter_mut().for_each(|part| part.resize(rows * count, 0.0));
        }
        self.heat.resize(links * count, 0.0);
    }

    /// Number of orders.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The orders.
    #[must_use]
    pub fn orders(&self) -> &[f64] {
        &self.order
    }

    /// Angles of an inertia \[rad\].
    #[must_use]
    #[inline]
    pub fn angle(&self, node: usize) -> PhasorRow<'_> {
        row(&self.angle, node, self.len())
    }

    /// Torques in a link \[N m\].
    #[must_use]
    #[inline]
    pub fn torque(&self, link: usize) -> PhasorRow<'_> {
        row(&self.torque, link, self.len())
    }

    /// Power that a link turns into heat \[W\].
    #[must_use]
    #[inline]
    pub fn heat(&self, link: usize) -> &[f64] {
        &self.heat[link * self.len()..][..self.len()]
    }

    /// Torques that excite an inertia \[N m\].
    #[must_use]
    #[inline]
    pub fn excitation(&self, node: usize) -> PhasorRow<'_> {
        row(&self.excitation, node, self.len())
    }

    /// As [`OrderResponses::angle`], to be written.
    #[inline]
    pub fn angle_mut(&mut self, node: usize) -> [&mut [f64]; 2] {
        row_mut(&mut self.angle, node, self.order.len())
    }

    /// As [`OrderResponses::torque`], to be written.
    #[inline]
    pub fn torque_mut(&mut self, link: usize) -> [&mut [f64]; 2] {
        row_mut(&mut self.torque, link, self.order.len())
    }

    /// As [`OrderResponses::heat`], to be written.
    #[inline]
    pub fn heat_mut(&mut self, link: usize) -> &mut [f64] {
        let count = self.order.len();
        &mut self.heat[link * count..][..count]
    }

    /// As [`OrderResponses::excitation`], to be written.
    #[inline]
    pub fn excitation_mut(&mut self, node: usize) -> [&mut [f64]; 2] {
        row_mut(&mut self.excitation, node, self.order.len())
    }

    /// All angles and torques, as real numbers.
    #[must_use]
    pub fn values(&self) -> [&[f64]; 4] {
        let ([a, b], [c, d]) = (&self.angle, &self.torque);
        [a, b, c, d]
    }

    /// One order.
    #[must_use]
    pub fn get(&self, k: usize) -> OrderResponse {
        let of = |[re, im]: &Phasors| {
            re.iter().zip(im).skip(k).step_by(self.len()).map(|(re, im)| [*re, *im]).collect()
        };
        OrderResponse {
            order: self.order[k],
            angle: of(&self.angle),
            torque: of(&self.torque),
            heat: self.heat.iter().skip(k).step_by(self.len()).copied().collect(),
            excitation: of(&self.excitation),
        }
    }

    /// One order after the other.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = OrderResponse> + '_ {
        (0..self.len()).map(|k| self.get(k))
    }
}

/// Of orders of one line, ascending.
impl From<&[OrderResponse]> for OrderResponses {
    fn from(all: &[OrderResponse]) -> Self {
        let mut own = Self::default();
        let (nodes, links) = all.first().map_or((0, 0), |o| (o.angle.len(), o.torque.len()));
        own.reset(all.iter().map(|o| o.order), nodes, links);
        for (k, o) in all.iter().enumerate() {
            put(&mut own.angle, k, &o.angle, all.len());
            put(&mut own.torque, k, &o.torque, all.len());
            put(&mut own.excitation, k, &o.excitation, all.len());
            own.heat.iter_mut().skip(k).step_by(all.len()).zip(&o.heat).for_each(|(own, heat)| *own = *heat);
        }
        own
    }
}

/// Writes the numbers of one order.
fn put([re, im]: &mut Phasors, k: usize, z: &[[f64; 2]], count: usize) {
    let rows = re.iter_mut().zip(im).skip(k).step_by(count);
    rows.zip(z).for_each(|((re, im), z)| [*re, *im] = *z);
}

#[inline]
fn row([re, im]: &Phasors, row: usize, count: usize) -> PhasorRow<'_> {
    [&re[row * count..][..count], &im[row * count..][..count]]
}

#[inline]
fn row_mut([re, im]: &mut Phasors, row: usize, count: usize) -> [&mut [f64]; 2] {
    [&mut re[row * count..][..count], &mut im[row * count..][..count]]
}
