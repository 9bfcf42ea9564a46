//! The curve of Maw, Barber and Fawcett (1976): an elastic sphere strikes a plane obliquely.

/// Sphere and plane: all that the curve depends on.
#[derive(Clone, Copy, Debug)]
pub struct Impact {
    /// Poisson's ratio [-].
    pub poisson_ratio: f64,
    /// Coefficient of friction [-].
    pub friction: f64,
    /// Largest approach of the centre to the floor over the radius; nothing for Maw's curve itself [-].
    pub dent: f64,
}

/// Springs from the contact's centre to its largest radius.
const SPRINGS: usize = 400;
/// Steps in the time of contact.
const STEPS: f64 = 8000.0;

impl Impact {
    /// Tangential velocity of the contact point after the impact for one before it, both over the normal speed.
    ///
    /// Hertz's contact with partial slip is that of a row of independent springs at `x` which a parabola `x^2/R` dents
    /// by `d` (Jaeger 1995; Lyashenko and Popov 2015, Sci. Rep. 5, 8479, get the curve of Maw et al. with it):
    ///
    /// ```text
    /// dF_n = E* w dx,  w = d - x^2/R >= 0;   dF_t = G* s dx,  ds/dt = u until G* |s| = mu E* w;   G*/E* = 2(1 - nu)/(2
    /// - nu) m d''= -F_n,   m v' = -F_t,   (2/5) m R^2 omega' = F_t (R - d),   u = v - omega (R - d)
    /// ```
    /// Exact for the half-space where normal and tangential compliance do not couple. The contact lies `R - d` below
    /// the centre: with a dent of nothing `(2/7) m u' = -F_t`, which is Maw's curve. What comes out is `v - omega R`,
    /// the sphere being round again. Units of R = E* = m = 1.
    pub fn after(&self, before: f64) -> f64 {
        let Impact { poisson_ratio: nu, friction, dent: deepest } = *self;
        let stiffness = 2.0 * (1.0 - nu) / (2.0 - nu);
        // Any dent gives the same curve.
        let dent = 0.01_f64;
        let speed = (16.0 / 15.0 * dent.powf(2.5)).sqrt();
        let (dt, dx) = (2.9432 * dent / speed / STEPS, dent.sqrt() / SPRINGS as f64);
        let (mut d, mut approach, mut v, mut spin) = (0.0, speed, before * speed, 0.0);
        let mut springs = [0.0_f64; SPRINGS];
        loop {
            // Half of the way before the kick and half after it: reversible where nothing slips.
            d += 0.5 * dt * approach;
            if d < 0.0 {
                return (v - spin) / speed;
            }
            let arm = 1.0 - d / dent * deepest;
            let u = v - spin * arm;
            let (mut push, mut pull) = (0.0, 0.0);
            for (i, s) in springs.iter_mut().enumerate() {
                let w = (d - ((i as f64 + 0.5) * dx).powi(2)).max(0.0);
                let bound = friction * w / stiffness;
                *s = (*s + u * dt).clamp(-bound, bound);
                push += 2.0 * w * dx;
                pull += 2.0 * stiffness * *s * dx;
            }
            approach -= dt * push;
            v -= dt * pull;
            spin += 2.5 * dt * pull * arm;
            d += 0.5 * dt * approach;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gross slip takes 7 mu v_n, from psi = 4 chi - 1 on and not below (Maw, Barber and Fawcett 1976).
    #[test]
    fn slip_throughout_begins_where_it_should() {
        for poisson_ratio in [0.3, 0.4, 0.5] {
            let impact = Impact { poisson_ratio, friction: 0.3, dent: 0.0 };
            let share = (1.0 - poisson_ratio) / (2.0 - poisson_ratio);
            let off = |psi: f64| {
                let before = psi * impact.friction / (2.0 * share);
                impact.after(before) - (before - 7.0 * impact.friction)
            };
            let limit = 4.0 * 3.5 * share - 1.0;
            assert!(off(limit + 0.1).abs() < 2e-3, "{}", off(limit + 0.1));
            assert!(off(limit - 1.0).abs() > 2e-2, "{}", off(limit - 1.0));
        }
    }

    #[test]
    fn what_sticks_comes_back_and_what_does_not_rub_goes_on() {
        let impact = Impact { poisson_ratio: 0.4, friction: 0.3, dent: 0.0 };
        assert!(impact.after(0.6) < -0.1);
        let smooth = Impact { friction: 0.0, ..impact };
        assert!((smooth.after(0.6) - 0.6).abs() < 1e-12);
    }

    /// Gross slip pulls with mu F_n at R - d, whose mean over the impulse of Hertz's impact, int d F_n dt/int F_n dt,
    /// is found here by quadrature over the dent: dt = dd/sqrt(1 - d^2.5), F_n = d^1.5.
    #[test]
    fn a_dent_shortens_the_arm_of_friction() {
        let impact = Impact { poisson_ratio: 0.4, friction: 0.3, dent: 0.04 };
        let n = 100_000;
        let [mut impulse, mut moment] = [0.0, 0.0];
        for i in 0..n {
            // d = 1 - s^2 takes the pole at the largest dent away.
            let s = (f64::from(i) + 0.5) / f64::from(n);
            let d = 1.0 - s * s;
            let share = d.powf(1.5) * 2.0 * s / (1.0 - d.powf(2.5)).sqrt();
            impulse += share;
            moment += share * d;
        }
        let arm = 1.0 - 0.04 * moment / impulse;
        // v changes by 2 mu, omega R by 5 mu times the arm.
        let expected = 2.7 - 0.6 - 1.5 * arm;
        assert!((impact.after(2.7) - expected).abs() < 1e-3, "{} {expected}", impact.after(2.7));
    }
}
