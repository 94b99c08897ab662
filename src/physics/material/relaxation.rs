//! Stress relaxation: a Prony series on the isochoric part of any law, at finite strain (Simo 1987; Simo & Hughes, Computational
//! Inelasticity, ch. 10).
//!
//! The law is that of slow deformation. With its isochoric stress in element coordinates, Sd = DEV\[2 dW/dC\] and
//! DEV\[.\] = (.) - 1/3 (C : .) C^-1, a term k of relative modulus r_k and time tau_k holds the stress h_k,
//!
//! ```text
//! dh_k/dt = dSd/dt - h_k / tau_k,     S = J^-2/3 DEV[Sd + sum_k r_k h_k]
//! ```
//!
//! Element coordinates turn with the body, so a rotation costs nothing and changes nothing.
//!
//! What is kept of a term is the stress that has relaxed, a_k = Sd - h_k, half a step after the positions that it was computed
//! from: the middle of the time over which the force at those positions acts. From there to the next positions Sd has half of its
//! change before it:
//!
//! ```text
//! h(n) = e^(-dt(n-1/2) / 2 tau) (Sd(n) - a(n-1/2)),     a(n+1/2) = Sd(n) - e^(-dt(n+1/2) / 2 tau) h(n)
//! ```
//!
//! which is the midpoint rule h(n+1) = e^(-dt / tau) h(n) + e^(-dt / 2 tau) (Sd(n+1) - Sd(n)), exact for a stress that jumps,
//! second order in dt / tau otherwise, with six numbers a term in place of twelve.

use crate::scalar::Scalar;
use crate::tensor::{Mat3, Metric, Sym3, combined, dot, gram};

/// A term of a Prony series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// Its shear modulus over that of the law, r = g / (1 - sum g) with g the share of the instantaneous modulus.
    pub ratio: f64,
    /// Relaxation time tau [s].
    pub time: f64,
}

/// A Prony series.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Relaxation {
    pub terms: Vec<Term>,
}

/// Whether a step gives the terms their time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// As long as the step says.
    Timed,
    /// Everything has relaxed: the law alone.
    Relaxed,
}

impl Relaxation {
    /// Instantaneous shear modulus over that of the law.
    pub fn instantaneous(&self) -> f64 {
        1.0 + self.terms.iter().map(|term| term.ratio).sum::<f64>()
    }

    /// The terms in a step of `after` [s] that follows one of `before` [s]; `shear_modulus`: the law's [Pa].
    pub fn fading(&self, shear_modulus: f64, before: f64, after: f64, pace: Pace) -> Vec<Fading> {
        let of_term = |&Term { ratio, time }: &Term| match pace {
            Pace::Timed => Fading {
                ratio,
                held: (-0.5 * before / time).exp(),
                kept: (-0.5 * after / time).exp(),
                loss: ratio / (2.0 * shear_modulus * time),
                stiffness: ratio * shear_modulus,
            },
            Pace::Relaxed => Fading { ratio: 0.0, held: 0.0, kept: 0.0, loss: 0.0, stiffness: 0.0 },
        };
        self.terms.iter().map(of_term).collect()
    }
}

/// A term within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fading {
    /// [`Term::ratio`]; 0 where everything has relaxed.
    pub ratio: f64,
    /// What is left of its stress after half of the step before the positions, and after half of the step that follows.
    pub held: f64,
    pub kept: f64,
    /// r / (2 G tau): power lost over the square of h [1/(Pa s)].
    pub loss: f64,
    /// r G [Pa].
    pub stiffness: f64,
}

/// What the points of an element, or of the lanes' elements, remember.
pub trait Memory<S> {
    fn terms(&self) -> &[Fading];
    /// Time from the positions before to these [s].
    fn before(&self) -> f64;
    /// Whether what has relaxed is to be kept: a step that is taken, not one that is tried.
    fn keeps(&self) -> bool;
    /// Stress that has relaxed at a point, by term [Pa].
    fn relaxed(&self, point: usize, term: usize) -> Sym3<S>;
    fn keep(&mut self, point: usize, term: usize, relaxed: Sym3<S>);
}

/// Of elements that remember nothing.
#[derive(Debug, Clone, Copy)]
pub struct Forgetful;

impl<S: Scalar> Memory<S> for Forgetful {
    #[inline(always)]
    fn terms(&self) -> &[Fading] {
        &[]
    }

    #[inline(always)]
    fn before(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn keeps(&self) -> bool {
        false
    }

    #[inline(always)]
    fn relaxed(&self, _point: usize, _term: usize) -> Sym3<S> {
        Sym3::zero()
    }

    #[inline(always)]
    fn keep(&mut self, _point: usize, _term: usize, _relaxed: Sym3<S>) {}
}

/// A deformed point, as relaxation sees it.
#[derive(Clone, Copy)]
pub struct Deformed<S> {
    /// A^T A.
    pub gram: Sym3<S>,
    /// cof A and det A.
    pub cof: Mat3<S>,
    pub det: S,
    /// det F.
    pub j: S,
    /// 2 W1 M + 2 W2 (I1 M - M G M), and WJ.
    pub isochoric: Sym3<S>,
    pub wj: S,
    /// Change of A^T A / 2 since the positions before.
    pub change: Sym3<S>,
}

/// What relaxation adds at a point, per reference volume.
#[derive(Clone, Copy)]
pub struct Overstress<S> {
    /// Second Piola stress in element coordinates but for what goes with cof A [Pa].
    pub stress: Sym3<S>,
    /// What goes with cof A, times det A / det J [Pa].
    pub pressure: S,
    /// Work of the overstress since the positions before [J/m3].
    pub work: S,
    /// Power that the terms lose [W/m3], not negative: |s|^2 / (2 eta) of a dashpot of viscosity eta = r G tau that carries the
    /// stress s = r h, in the metric of the deformed shape.
    pub loss: S,
}

/// Half the change of A^T A from the positions before to these, from the columns of A and their mean rates over the time between.
#[inline(always)]
pub fn change<S: Scalar>(a: &Mat3<S>, rate: &Mat3<S>, dt: f64) -> Sym3<S> {
    let (dt, half) = (S::from_f64(dt), S::from_f64(0.5));
    let entry = |i: usize, j: usize| {
        let square = dot(rate[i], rate[j]);
        dt * half * (dot(a[i], rate[j]) + dot(a[j], rate[i]) - dt * square)
    };
    Sym3 {
        xx: entry(0, 0),
        yy: entry(1, 1),
        zz: entry(2, 2),
        xy: entry(0, 1),
        xz: entry(0, 2),
        yz: entry(1, 2),
    }
}

/// What the terms add at a point; they go on by a step, where that is kept.
#[inline(always)]
pub fn overstress<S: Scalar, R: Memory<S>>(memory: &mut R, point: usize, at: &Deformed<S>) -> Overstress<S> {
    let (zero, one) = (S::zero(), S::one());
    let third = S::from_f64(1.0 / 3.0);
    let r = at.j.recip_cbrt();
    let inverse = gram(&at.cof).scaled(one / (at.det * at.det));
    // WJ J G^-1 makes a deviator of it.
    let elastic = at.isochoric.plus(at.wj * at.j, &inverse).scaled(at.j * r);
    let (mut sum, mut middle) = (Sym3::zero(), Sym3::zero());
    let (mut loss, mut stiffness) = (zero, zero);
    for k in 0..memory.terms().len() {
        let term = memory.terms()[k];
        let middle_of_step = elastic.plus(-one, &memory.relaxed(point, k));
        let h = middle_of_step.scaled(S::from_f64(term.held));
        if memory.keeps() {
            memory.keep(point, k, elastic.plus(S::from_f64(-term.kept), &h));
        }
        sum = sum.plus(S::from_f64(term.ratio), &h);
        middle = middle.plus(S::from_f64(term.ratio), &middle_of_step);
        loss += S::from_f64(term.loss) * deviator_squared(&h, &at.gram);
        stiffness += S::from_f64(term.stiffness);
    }
    let scale = r * r;
    let stress = sum.scaled(scale);
    let pressure = -third * at.gram.contracted(&stress);
    // Half a step back Sd was less by r G G^-1 E G^-1, to first order.
    let isochoric =
        middle.contracted(&at.change) - third * at.gram.contracted(&middle) * inverse.contracted(&at.change);
    let work = scale * (isochoric - stiffness * deviator_squared(&at.change, &inverse));
    Overstress { stress, pressure, work, loss }
}

/// tr (A B A B) - 1/3 (tr A B)^2 of symmetric A and a metric B.
#[inline(always)]
fn deviator_squared<S: Scalar>(a: &Sym3<S>, b: &Sym3<S>) -> S {
    let (a, b) = (a.columns(), b.columns());
    let m = [
        combined(&a, b[0][0], b[0][1], b[0][2]),
        combined(&a, b[1][0], b[1][1], b[1][2]),
        combined(&a, b[2][0], b[2][1], b[2][2]),
    ];
    let trace = m[0][0] + m[1][1] + m[2][2];
    let off = m[0][1] * m[1][0] + m[0][2] * m[2][0] + m[1][2] * m[2][1];
    let square = dot([m[0][0], m[1][1], m[2][2]], [m[0][0], m[1][1], m[2][2]]) + off + off;
    trace.neg_mul_add(trace * S::from_f64(1.0 / 3.0), square)
}
