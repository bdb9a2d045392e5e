//! Influence coefficients without aliasing: the radial kernel, integrated over the cell.
//!
//! With κ and η of [`RadialKernel`], K = (A1 + κ)/r:
//!
//! - far from the cell, Gauss quadrature of K over it;
//! - near a long thin cell, Gauss quadrature across it, and along it with x = y sinh u beside the
//!   cell, x = e^v ahead of it,
//!
//! ```text
//! ∫ K(√(x²+y²)) dx = ∫ (A1 + κ)(y cosh u) du = ∫ K(√(x²+y²)) x dv
//! ```
//!
//! - on the cell and next to it, A1 times Love's closed form, plus the sum over the four corners of
//!
//! ```text
//! F(x, y) = x ∫₀^{asinh(y/x)} η(x cosh u) du + y ∫₀^{asinh(x/y)} η(y cosh u) du
//! ```
//!
//! which holds for any radial kernel. The integrands in u are smooth however thin a layer is.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::potential::Rectangle;
use super::radial::RadialKernel;
use crate::error::{Result, positive};
use crate::kernel::quadrature::{Rule, Rules};
use crate::parallel::Threads;
use crate::response::{Body, Response};

/// Displacement around one uniformly loaded cell: influence coefficients without aliasing, at any
/// offset.
///
/// ```
/// use nacre::{Elastic, HalfSpace, Layer, influence::CellInfluence};
/// let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(4.0, 0.3)?);
/// let body = HalfSpace::new(soft, [Layer::new(hard, 8.0)?])?;
/// let cell = CellInfluence::plan(&body, [1.0, 1.0], 200.0)?;
/// // Reference value by Hankel quadrature.
/// assert!((cell.at([0.0, 0.0]) / 0.282_429_656_405_885_74 - 1.0).abs() < 1e-11);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct CellInfluence {
    /// α c11 of the surface material.
    short: f64,
    rectangle: Rectangle,
    /// Half sides, the longer one first.
    half: [f64; 2],
    /// Whether the longer side lies along y.
    swapped: bool,
    rules: Rules,
    /// For the substitutions x = y sinh u and x = e^v.
    panel: Rule,
    /// Where the body is not homogeneous.
    tables: Option<Tables>,
    error: f64,
}

/// Tables of the radial kernels, over the squared distance.
#[derive(Debug)]
pub(super) struct Tables {
    /// K.
    kernel: Table,
    /// η.
    pub(super) mean: Table,
}

impl CellInfluence {
    /// Plans the displacement of `body` around a cell of sides `spacing` \[m\], for offsets up to
    /// `reach` \[m\]; beyond it falls as 1/r.
    ///
    /// # Errors
    /// Unless the lengths are finite and above 0.
    pub fn plan(body: impl Into<Body>, spacing: [f64; 2], reach: f64) -> Result<Self> {
        Self::plan_on(
            &*body.into(),
            spacing,
            NEAREST_RIM,
            reach,
            &Threads::new(None)?,
        )
    }

    /// The same for offsets of which no corner of the cell is nearer than `nearest` shorter sides:
    /// half a side, for whole cells.
    pub(super) fn plan_on(
        body: &dyn Response,
        spacing @ [dx, dy]: [f64; 2],
        nearest: f64,
        reach: f64,
        threads: &Threads,
    ) -> Result<Self> {
        positive("spacing", dx)?;
        positive("spacing", dy)?;
        positive("reach", reach)?;
        let limits = body.asymptotes();
        // Nodes of the quadratures lie inside the cells.
        let range = [nearest * dx.min(dy), 1.01 * (reach + dx.hypot(dy))];
        let kernel = RadialKernel::new(body, range[0], range[1]);
        let scale = limits.short.max(limits.long);
        let tables = kernel.map(|kernel| threads.run(|| Tables::new(&kernel, range)));
        let (tables, missed) = tables.unzip();
        Ok(Self {
            short: limits.short,
            rectangle: Rectangle::new(spacing),
            half: [0.5 * dx.max(dy), 0.5 * dx.min(dy)],
            swapped: dy > dx,
            rules: Rules::new(),
            panel: Rule::gauss_legendre(10),
            tables,
            error: (missed.unwrap_or(0.0) + QUADRATURE * scale) / (2.0 * PI),
        })
    }

    /// Estimated error \[1/Pa\] of C r/(dx dy), r the offset or half the shorter side: the form in
    /// which the coefficients of a homogeneous body are all about the same, 1/(πE*).
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Displacement \[m\] per unit pressure on the cell, at `offset` \[m\] from its centre.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let love = || self.short * self.rectangle.potential(x, y, 0.0);
        let integral = match &self.tables {
            Some(tables) => self.integral(x.abs(), y.abs(), tables, love),
            None => love(),
        };
        integral / (2.0 * PI)
    }

    /// ∬ K over the cell, seen from (x, y) relative to its centre.
    fn integral(&self, x: f64, y: f64, tables: &Tables, love: impl Fn() -> f64) -> f64 {
        let [a, b] = self.half;
        let (x, y) = if self.swapped { (y, x) } else { (x, y) };
        let distance = SECTOR * (x - a).max(0.0).hypot((y - b).max(0.0));
        let Some(across) = self.rules.at(distance / b) else {
            let corner = |x: f64, y: f64| self.corner(x, y, &tables.mean);
            return love() + corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b)
                + corner(x - a, y - b);
        };
        match self.rules.at(distance / a) {
            Some(along) => across.around(y, b, |y| {
                along.around(x, a, |x| tables.kernel(x * x + y * y))
            }),
            None => across.around(y, b, |y| self.strip(x - a, x + a, y, tables)),
        }
    }

    /// ∫ K(√(x²+y²)) dx from x1 to x2 > |x1|.
    fn strip(&self, x1: f64, x2: f64, y: f64, tables: &Tables) -> f64 {
        if x1 > 0.0 {
            return self.panel.over_panels(x1.ln(), x2.ln(), |v| {
                let x = v.exp();
                x * tables.kernel(x * x + y * y)
            });
        }
        let y = y.abs();
        self.panel
            .over_panels((x1 / y).asinh(), (x2 / y).asinh(), |u| {
                let r = y * u.cosh();
                r * tables.kernel(r * r)
            })
    }

    /// Integral of η's kernel over the rectangle from the origin to (x, y); odd in x and in y.
    fn corner(&self, x: f64, y: f64, mean: &Table) -> f64 {
        let (u, v) = (x.abs(), y.abs());
        let wedge = |near: f64, far: f64| {
            if near <= f64::MIN_POSITIVE {
                return 0.0;
            }
            near * self.panel.over_panels(0.0, (far / near).asinh(), |u| {
                let r = near * u.cosh();
                mean.at(r * r)
            })
        };
        x.signum() * y.signum() * (wedge(u, v) + wedge(v, u))
    }
}

/// Error of the quadratures over the cell, relative; `tests/influence_exact.rs` shows that the
/// estimate which it is part of bounds the true error.
const QUADRATURE: f64 = 1e-12;

/// The kernel is analytic in a sector only, not in the half-plane as 1/r is: to the rules it is
/// nearer than its origin is.
const SECTOR: f64 = 0.7;

/// How near to the rim of the cell the public tables go, in shorter sides.
const NEAREST_RIM: f64 = 1e-6;

/// The same for offsets of whole cells: corners lie half a side from the axes.
pub(super) const WHOLE_CELLS: f64 = 0.49;

impl Tables {
    /// K at the squared distance s; as 1/r beyond the table.
    fn kernel(&self, s: f64) -> f64 {
        let end = self.kernel.range[1];
        if s > end {
            self.kernel.at(end) * (end / s).sqrt()
        } else {
            self.kernel.at(s)
        }
    }

    /// Tables for distances in `range`, and the error of their values.
    pub(super) fn new(kernel: &RadialKernel, range: [f64; 2]) -> (Self, f64) {
        let at = |r: f64| {
            let (kappa, eta) = kernel.at(r);
            [(kernel.short + kappa) / r, eta]
        };
        let [table, mean] = Table::pair(range, at);
        // Interpolation, seen between the nodes.
        let missed = (0..64).map(|k| {
            let r = range[0] * (range[1] / range[0]).powf((f64::from(k) + 0.5) / 64.0);
            let [k, eta] = at(r);
            ((table.at(r * r) - k) * r)
                .abs()
                .max((mean.at(r * r) - eta).abs())
        });
        let error = kernel.error + missed.fold(0.0, f64::max);
        (
            Self {
                kernel: table,
                mean,
            },
            error,
        )
    }
}

/// Points of a piece of a [`Table`].
const NODES: usize = 8;

/// Leading bits of the mantissa that number the pieces within an octave.
const BITS: u32 = 3;

/// A function of s > 0 that is smooth in ln s: polynomials of degree 7 over eighths of octaves,
/// found by the leading bits of s.
#[derive(Debug)]
pub(super) struct Table {
    /// Of s.
    range: [f64; 2],
    first: usize,
    /// Powers of the position in the piece, from −1 to 1.
    pieces: Vec<[f64; NODES]>,
}

impl Table {
    /// Both functions `f(r)`, as tables over s = r², for r in `range`.
    fn pair(range: [f64; 2], f: impl Fn(f64) -> [f64; 2] + Sync) -> [Self; 2] {
        let piece = |s: f64| (s.to_bits() >> (52 - BITS)) as usize;
        let (first, last) = (piece(range[0] * range[0]), piece(range[1] * range[1]));
        let nodes: [f64; NODES] =
            std::array::from_fn(|k| (PI * (k as f64 + 0.5) / NODES as f64).cos());
        let powers = powers_of_lagrange(&nodes);
        let both: Vec<[[f64; NODES]; 2]> = (first..=last)
            .into_par_iter()
            .map(|piece| {
                let bits = (piece as u64) << (52 - BITS);
                let (start, end) = (
                    f64::from_bits(bits),
                    f64::from_bits(bits + (1 << (52 - BITS))),
                );
                let mut polynomials = [[0.0; NODES]; 2];
                for (node, lagrange) in nodes.iter().zip(&powers) {
                    let s = start + 0.5 * (1.0 + node) * (end - start);
                    for (polynomial, value) in polynomials.iter_mut().zip(f(s.sqrt())) {
                        for (c, l) in polynomial.iter_mut().zip(lagrange) {
                            *c += value * l;
                        }
                    }
                }
                polynomials
            })
            .collect();
        [0, 1].map(|k| Self {
            range: range.map(|r| r * r),
            first,
            pieces: both.iter().map(|pair| pair[k]).collect(),
        })
    }

    /// The function at s, or at the nearer end of the table.
    pub(super) fn at(&self, s: f64) -> f64 {
        let bits = s.clamp(self.range[0], self.range[1]).to_bits();
        let polynomial = &self.pieces[(bits >> (52 - BITS)) as usize - self.first];
        // The bits that are left are the position in the piece, from 1 to 2 under this exponent.
        let left = (bits << BITS) & ((1 << 52) - 1);
        let position = 2.0 * f64::from_bits(1.0_f64.to_bits() | left) - 3.0;
        polynomial
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * position + c)
    }
}

/// Coefficients by powers of the Lagrange polynomials of `nodes`.
pub(crate) fn powers_of_lagrange<const NODES: usize>(
    nodes: &[f64; NODES],
) -> [[f64; NODES]; NODES] {
    std::array::from_fn(|k| {
        let mut polynomial = [0.0; NODES];
        polynomial[0] = 1.0;
        for (degree, (_, node)) in nodes
            .iter()
            .enumerate()
            .filter(|(j, _)| *j != k)
            .enumerate()
        {
            let norm = 1.0 / (nodes[k] - node);
            for power in (0..=degree + 1).rev() {
                let below = if power > 0 {
                    polynomial[power - 1]
                } else {
                    0.0
                };
                polynomial[power] = (below - node * polynomial[power]) * norm;
            }
        }
        polynomial
    })
}
