//! Vectors and 3x3 matrices over any scalar. A matrix is its three columns.

use super::scalar::Scalar;

/// Components in space.
pub type Vec3<S> = [S; 3];
/// Columns of a 3x3 matrix.
pub type Mat3<S> = [Vec3<S>; 3];

#[inline(always)]
pub fn vec3<S: Scalar>(v: [f64; 3]) -> Vec3<S> {
    v.map(S::from_f64)
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
    /// Columns of A M.
    #[inline(always)]
    pub fn left_multiplied(&self, a: &Mat3<S>) -> Mat3<S> {
        [
            combined(a, self.xx, self.xy, self.xz),
            combined(a, self.xy, self.yy, self.yz),
            combined(a, self.xz, self.yz, self.zz),
        ]
    }

    /// The same where xy and yz are zero.
    #[inline(always)]
    pub fn left_multiplied_in_plane(&self, a: &Mat3<S>) -> Mat3<S> {
        [
            axpy(a[0], self.xx, scale(a[2], self.xz)),
            scale(a[1], self.yy),
            axpy(a[0], self.xz, scale(a[2], self.zz)),
        ]
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
