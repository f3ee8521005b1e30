use gudgeon_core::kinds::{Kinematics, PistonMotion};

/// The piston as its crank-end gas space sees it: up is towards the crank.
#[derive(Debug, Clone)]
pub struct CrankEnd {
    /// Motion towards the head.
    pub head: Box<dyn Kinematics>,
}

impl Kinematics for CrankEnd {
    fn motion(&self, theta: f64) -> PistonMotion {
        let m = self.head.motion(theta);
        PistonMotion { y: -m.y, v: -m.v, a: -m.a, rod_angle: m.rod_angle }
    }
    fn height(&self, theta: f64) -> f64 {
        -self.head.height(theta)
    }
    fn velocity(&self, theta: f64) -> f64 {
        -self.head.velocity(theta)
    }
    fn height_and_velocity(&self, theta: f64) -> (f64, f64) {
        let (y, v) = self.head.height_and_velocity(theta);
        (-y, -v)
    }
    fn y_tdc(&self) -> f64 {
        self.head.stroke() - self.head.y_tdc()
    }
    fn stroke(&self) -> f64 {
        self.head.stroke()
    }
    fn omega(&self) -> f64 {
        self.head.omega()
    }
}
