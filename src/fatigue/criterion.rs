//! Multiaxial fatigue criteria, each an equivalent stress of a history that is compared with a limit.

use super::planes::{Plane, Planes};
use super::{State, check, deviator, from_coordinates, hydrostatic, largest};
use crate::error::{Error, Result, positive};
use crate::numerics::enclosing_ball::smallest_ball;
use crate::stress::Tensor;

/// Names of the criteria.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum CriterionKind {
    /// max over t of τ(t) + a σ_h(t) ≤ b. s* is the centre of the smallest hypersphere around the deviators s, and τ half
    /// the difference of the largest and smallest principal value of s − s*. Dang Van, ASTM STP 1191 (1993) 120,
    /// doi:10.1520/STP24799S.
    DangVan,
    /// R/√2 + a max σ_h ≤ b, with the radius R of that hypersphere. Crossland (1956); the form of code_aster's
    /// POST_FATIGUE, which has half of the largest distance of two states for R: the same in proportional loading, up to
    /// 15 % less else.
    Crossland,
    /// max over all planes of τ_a + k σ_n ≤ f, with the radius τ_a of the smallest circle around the path of the shear
    /// stress on a plane, and the largest normal stress σ_n there. Findley, J. Eng. Ind. 81 (1959) 301.
    Findley,
    /// τ_a + k σ_n ≤ f on the plane of the largest τ_a, with the sign of σ_n, as in Findley's. Matake, Bull. JSME 20
    /// (1977) 257 (not read).
    Matake,
}

/// A fatigue criterion with its constants, from the fatigue limits of two simple tests, both fully reversed:
///
/// ```text
/// r = t/f      Dang Van   a = 3(r − ½)               b = t
///              Crossland  a = 3r − √3                b = t
///              Matake     k = 2r − 1                 f = t
///              Findley    k = (2r−1)/√(1−(2r−1)²)    f = t √(1+k²)
/// ```
///
/// with t of torsion and f of bending. Each follows from the criterion in the two tests (derived here).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criterion {
    kind: CriterionKind,
    bending: f64,
    torsion: f64,
    factor: f64,
    limit: f64,
}

/// The left side of a criterion, for one history.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Equivalent {
    /// The stress that is compared with the limit \[Pa\].
    pub stress: f64,
    /// Index of the state that decides: that of the largest sum, hydrostatic or normal stress.
    pub at: usize,
    /// Normal of the plane, for the criteria of planes.
    pub normal: Option<[f64; 3]>,
    /// For [`CriterionKind::Matake`]: by which part the largest τ_a among other maxima is below the largest one. Where it is
    /// small, the plane may jump from one to the other.
    pub gap: Option<f64>,
}

/// Part by which a ratio of limits may be below its bound: it is computed from two numbers, with rounding.
const ROUNDING: f64 = 1e-12;

impl Criterion {
    /// A criterion from the fully reversed limits of bending and torsion \[Pa\].
    ///
    /// # Errors
    /// A limit that is not finite and above 0; a torsion below the bending/√3 of Crossland's criterion, or half the
    /// bending limit of the others; for Findley's one that is not below the bending limit.
    ///
    /// ```
    /// use nacre::fatigue::{Criterion, CriterionKind};
    /// let dang_van = Criterion::new(CriterionKind::DangVan, 520e6, 330e6)?;
    /// assert!((dang_van.factor() - (3.0 * 330.0 / 520.0 - 1.5)).abs() < 1e-15);
    /// // In the two tests, the stress is at its limit.
    /// let bent = [[0.0, 520e6, 0.0, 0.0, 0.0, 0.0], [0.0, -520e6, 0.0, 0.0, 0.0, 0.0]];
    /// assert!((dang_van.stress(&bent)?.stress / dang_van.limit() - 1.0).abs() < 1e-12);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn new(kind: CriterionKind, bending: f64, torsion: f64) -> Result<Self> {
        positive("bending", bending)?;
        positive("torsion", torsion)?;
        let ratio = torsion / bending;
        let refused =
            |requirement| Err(Error::Parameter { name: "torsion", requirement, value: torsion });
        let least = if kind == CriterionKind::Crossland { 1.0 / 3.0_f64.sqrt() } else { 0.5 };
        if ratio < least * (1.0 - ROUNDING) {
            return refused(match kind {
                CriterionKind::Crossland => "at least bending/√3",
                _ => "at least half of bending",
            });
        }
        let twice = 2.0 * ratio - 1.0;
        if kind == CriterionKind::Findley && ratio >= 1.0 {
            return refused("below bending");
        }
        let factor = match kind {
            CriterionKind::DangVan => 3.0 * (ratio - 0.5),
            CriterionKind::Crossland => 3.0 * ratio - 3.0_f64.sqrt(),
            CriterionKind::Findley => twice / (1.0 - twice * twice).sqrt(),
            CriterionKind::Matake => twice,
        };
        let factor = factor.max(0.0);
        let limit = match kind {
            CriterionKind::Findley => torsion * factor.hypot(1.0),
            _ => torsion,
        };
        Ok(Self { kind, bending, torsion, factor, limit })
    }

    /// Its name.
    pub fn kind(&self) -> CriterionKind {
        self.kind
    }

    /// Fully reversed limits of bending and torsion \[Pa\].
    pub fn limits(&self) -> [f64; 2] {
        [self.bending, self.torsion]
    }

    /// Factor a or k of the hydrostatic or normal stress.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// Limit b or f of the equivalent stress \[Pa\].
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// The equivalent stress of a history.
    ///
    /// # Errors
    /// No state, or one that is not finite.
    pub fn stress(&self, history: &[State]) -> Result<Equivalent> {
        check(history)?;
        Ok(match self.kind {
            CriterionKind::DangVan | CriterionKind::Crossland => self.of_deviators(history),
            CriterionKind::Findley => {
                let planes = Planes::new(history);
                self.on(&planes, planes.findley(self.factor), None)
            }
            CriterionKind::Matake => {
                let planes = Planes::new(history);
                let (plane, gap) = planes.matake();
                self.on(&planes, plane, Some(gap))
            }
        })
    }

    /// The criteria of the smallest hypersphere.
    fn of_deviators(&self, history: &[State]) -> Equivalent {
        let points: Vec<[f64; 5]> = history.iter().map(deviator).collect();
        let ball = smallest_ball(&points);
        let (at, stress) = match self.kind {
            CriterionKind::Crossland => {
                let (at, tension) = largest(history.iter().map(hydrostatic));
                (at, ball.radius / 2.0_f64.sqrt() + self.factor * tension)
            }
            _ => largest(points.iter().zip(history).map(|(point, state)| {
                let away = std::array::from_fn(|axis| point[axis] - ball.centre[axis]);
                let [first, _, last] = Tensor::new(from_coordinates(&away)).principal();
                0.5 * (first - last) + self.factor * hydrostatic(state)
            })),
        };
        Equivalent { stress, at, normal: None, gap: None }
    }

    /// The stress on a plane.
    fn on(&self, planes: &Planes, plane: Plane, gap: Option<f64>) -> Equivalent {
        let stress = plane.shear + self.factor * plane.tension;
        let at = planes.largest_tension(&plane.normal);
        Equivalent { stress, at, normal: Some(plane.normal), gap }
    }
}
