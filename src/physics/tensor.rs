//! Vectors and 3x3 matrices over any scalar. A matrix is its three columns.

use super::scalar::Scalar;

/// Components in space.
pub type Vec3<S> = [S; 3];
/// Columns of a 3x3 matrix.
pub type Mat3<S> = [Vec3<S>; 3];

#[inline(always)]
pub fn vec3<S: Scalar>(v: [f64; 3]) -> Vec3<S> {
    // Not by `map`, whose call vectors would pass through memory.
    [S::from_f64(v[0]), S::from_f64(v[1]), S::from_f64(v[2])]
}

#[inline(always)]
pub fn add<S: Scalar>(a: Vec3<S>, b: Vec3<S>) -> Vec3<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub fn sub<S: Scalar>(a: Vec3<S>, b: Vec3<S>) -> Vec3<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub fn neg<S: Scalar>(a: Vec3<S>) -> Vec3<S> {
    [-a[0], -a[1], -a[2]]
}

#[inline(always)]
pub fn scale<S: Scalar>(a: Vec3<S>, s: S) -> Vec3<S> {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// a s + b
#[inline(always)]
pub fn axpy<S: Scalar>(a: Vec3<S>, s: S, b: Vec3<S>) -> Vec3<S> {
    [a[0].mul_add(s, b[0]), a[1].mul_add(s, b[1]), a[2].mul_add(s, b[2])]
}

#[inline(always)]
pub fn dot<S: Scalar>(a: Vec3<S>, b: Vec3<S>) -> S {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub fn cross<S: Scalar>(a: Vec3<S>, b: Vec3<S>) -> Vec3<S> {
    [a[1].mul_sub(b[2], a[2] * b[1]), a[2].mul_sub(b[0], a[0] * b[2]), a[0].mul_sub(b[1], a[1] * b[0])]
}

/// Cofactor matrix: columns a_eta x a_zeta, a_zeta x a_xi, a_xi x a_eta, so that cof(A)_d . A_e = det A delta_de.
#[inline(always)]
pub fn cofactor<S: Scalar>(a: &Mat3<S>) -> Mat3<S> {
    [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])]
}

#[inline(always)]
pub fn det<S: Scalar>(a: &Mat3<S>) -> S {
    dot(a[0], cross(a[1], a[2]))
}

/// a_0 x + a_1 y + a_2 z
#[inline(always)]
pub fn combined<S: Scalar>(a: &Mat3<S>, x: S, y: S, z: S) -> Vec3<S> {
    axpy(a[0], x, axpy(a[1], y, scale(a[2], z)))
}

/// A symmetric 3x3 matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Sym3<S> {
    pub xx: S,
    pub yy: S,
    pub zz: S,
    pub xy: S,
    pub xz: S,
    pub yz: S,
}

impl<S: Scalar> Sym3<S> {
    #[inline(always)]
    pub fn zero() -> Self {
        let o = S::zero();
        Sym3 { xx: o, yy: o, zz: o, xy: o, xz: o, yz: o }
    }

    /// self + c other
    #[inline(always)]
    pub fn plus(&self, c: S, other: &Sym3<S>) -> Self {
        Sym3 {
            xx: c.mul_add(other.xx, self.xx),
            yy: c.mul_add(other.yy, self.yy),
            zz: c.mul_add(other.zz, self.zz),
            xy: c.mul_add(other.xy, self.xy),
            xz: c.mul_add(other.xz, self.xz),
            yz: c.mul_add(other.yz, self.yz),
        }
    }

    /// Columns.
    #[inline(always)]
    pub fn columns(&self) -> Mat3<S> {
        [[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]]
    }

    pub fn map<T>(&self, f: impl Fn(S) -> T) -> Sym3<T> {
        Sym3 {
            xx: f(self.xx),
            yy: f(self.yy),
            zz: f(self.zz),
            xy: f(self.xy),
            xz: f(self.xz),
            yz: f(self.yz),
        }
    }

    pub fn to_array(self) -> [S; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz]
    }
}

/// Gram matrix A^T A.
#[inline(always)]
pub fn gram<S: Scalar>(a: &Mat3<S>) -> Sym3<S> {
    Sym3 {
        xx: dot(a[0], a[0]),
        yy: dot(a[1], a[1]),
        zz: dot(a[2], a[2]),
        xy: dot(a[0], a[1]),
        xz: dot(a[0], a[2]),
        yz: dot(a[1], a[2]),
    }
}

/// A symmetric matrix M that measures lengths in element coordinates, with as many zeros as its kind is known to have.
pub trait Metric<S: Scalar>: Copy {
    /// Whether M has entries xy, xz and yz that are not zero.
    const XY: bool;
    const XZ: bool;
    const YZ: bool;
    /// M : G
    fn contracted(&self, g: &Sym3<S>) -> S;
    /// M G M
    fn around(&self, g: &Sym3<S>) -> Sym3<S>;
    /// c M
    fn scaled(&self, c: S) -> Sym3<S>;
}

impl<S: Scalar> Metric<S> for Sym3<S> {
    const XY: bool = true;
    const XZ: bool = true;
    const YZ: bool = true;

    #[inline(always)]
    fn contracted(&self, g: &Sym3<S>) -> S {
        let off = dot([self.xy, self.xz, self.yz], [g.xy, g.xz, g.yz]);
        self.xx.mul_add(g.xx, self.yy.mul_add(g.yy, self.zz.mul_add(g.zz, off + off)))
    }

    #[inline(always)]
    fn around(&self, g: &Sym3<S>) -> Sym3<S> {
        let (m, g) = (self.columns(), g.columns());
        // Columns of G M.
        let [x, y, z] = [
            combined(&g, m[0][0], m[0][1], m[0][2]),
            combined(&g, m[1][0], m[1][1], m[1][2]),
            combined(&g, m[2][0], m[2][1], m[2][2]),
        ];
        Sym3 {
            xx: dot(m[0], x),
            yy: dot(m[1], y),
            zz: dot(m[2], z),
            xy: dot(m[0], y),
            xz: dot(m[0], z),
            yz: dot(m[1], z),
        }
    }

    #[inline(always)]
    fn scaled(&self, c: S) -> Sym3<S> {
        Sym3 {
            xx: c * self.xx,
            yy: c * self.yy,
            zz: c * self.zz,
            xy: c * self.xy,
            xz: c * self.xz,
            yz: c * self.yz,
        }
    }
}

/// M that couples eta with neither xi nor zeta: xy and yz are not read.
#[derive(Debug, Clone, Copy)]
pub struct InPlane<S>(pub Sym3<S>);

impl<S: Scalar> Metric<S> for InPlane<S> {
    const XY: bool = false;
    const XZ: bool = true;
    const YZ: bool = false;

    #[inline(always)]
    fn contracted(&self, g: &Sym3<S>) -> S {
        let m = &self.0;
        m.xx.mul_add(g.xx, m.yy.mul_add(g.yy, m.zz.mul_add(g.zz, m.xz * (g.xz + g.xz))))
    }

    #[inline(always)]
    fn around(&self, g: &Sym3<S>) -> Sym3<S> {
        let m = &self.0;
        // G M where it is needed: its columns xi and zeta.
        let (xx, xz) = (g.xx.mul_add(m.xx, g.xz * m.xz), g.xx.mul_add(m.xz, g.xz * m.zz));
        let (zx, zz) = (g.xz.mul_add(m.xx, g.zz * m.xz), g.xz.mul_add(m.xz, g.zz * m.zz));
        let (yx, yz) = (g.xy.mul_add(m.xx, g.yz * m.xz), g.xy.mul_add(m.xz, g.yz * m.zz));
        Sym3 {
            xx: m.xx.mul_add(xx, m.xz * zx),
            yy: m.yy * m.yy * g.yy,
            zz: m.xz.mul_add(xz, m.zz * zz),
            xy: m.yy * yx,
            xz: m.xx.mul_add(xz, m.xz * zz),
            yz: m.yy * yz,
        }
    }

    #[inline(always)]
    fn scaled(&self, c: S) -> Sym3<S> {
        let (m, o) = (&self.0, S::zero());
        Sym3 { xx: c * m.xx, yy: c * m.yy, zz: c * m.zz, xy: o, xz: c * m.xz, yz: o }
    }
}

/// The identity.
#[derive(Debug, Clone, Copy)]
pub struct Identity;

impl<S: Scalar> Metric<S> for Identity {
    const XY: bool = false;
    const XZ: bool = false;
    const YZ: bool = false;

    #[inline(always)]
    fn contracted(&self, g: &Sym3<S>) -> S {
        g.xx + g.yy + g.zz
    }

    #[inline(always)]
    fn around(&self, g: &Sym3<S>) -> Sym3<S> {
        *g
    }

    #[inline(always)]
    fn scaled(&self, c: S) -> Sym3<S> {
        let o = S::zero();
        Sym3 { xx: c, yy: c, zz: c, xy: o, xz: o, yz: o }
    }
}
