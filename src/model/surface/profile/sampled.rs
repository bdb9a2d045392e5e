//! Measured profiles.

use std::sync::Arc;

use super::stations::{Piece, chords, limit, smoothed, spline};
use crate::error::{Error, Result, positive, refuse_if, require};
use crate::model::data::value;

/// Largest number of coordinates at which a search for the contact looks at a profile: within a thousandth of
/// its length a tilt changes little.
const MARKS: usize = 1024;

/// A measured profile: drops at increasing positions (its stations), a smooth curve through them, and +∞ beyond.
///
/// The curve is a cubic spline whose slopes are limited, so that it does not overshoot at steps and edges: Huynh, SIAM J.
/// Numer. Anal. 30 (1993) 57, doi:10.1137/0730004, constraint M3. Where the profile has true edges,
/// [`SampledProfile::with_corners`] breaks the curve; [`SampledProfile::straight`] joins all stations by straight lines.
/// [`SampledProfile::smoothed`] removes noise.
///
/// What lies between the stations is not known. The errors of solutions count it: [`SampledProfile::alternatives`].
///
/// ```
/// use nacre::{SampledProfile, surface::Profile};
/// // A crown of 0.3 m, every 2 mm.
/// let x: Vec<f64> = (-5..=5).map(|k| 2e-3 * f64::from(k)).collect();
/// let drop: Vec<f64> = x.iter().map(|x| x * x / 0.6).collect();
/// let smooth = SampledProfile::new(&x, &drop)?;
/// let straight = smooth.clone().straight();
/// let at = |profile: SampledProfile| Profile::from(profile).drop(1e-3);
/// assert!((at(smooth) / (1e-6 / 0.6) - 1.0).abs() < 1e-12);
/// assert!((at(straight) / (2e-6 / 0.6) - 1.0).abs() < 1e-12);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SampledProfile {
    /// Position and drop of each station.
    samples: Arc<[[f64; 2]]>,
    curve: Curve,
    pieces: Arc<[Piece]>,
}

/// How stations are joined.
#[derive(Debug, Clone, PartialEq)]
struct Curve {
    is_straight: bool,
    is_limited: bool,
    /// Positions of the corners, ascending.
    corners: Vec<f64>,
    /// Wavelength below which waves are taken away.
    smoothing: Option<f64>,
}

impl SampledProfile {
    /// A profile with drops `drop` \[m\] at positions `x` \[m\].
    ///
    /// # Errors
    /// Unless there are at least two positions and as many drops, all are finite, and the positions
    /// increase.
    pub fn new(x: &[f64], drop: &[f64]) -> Result<Self> {
        if x.len() != drop.len() || x.len() < 2 {
            return Err(Error::Shape {
                name: "profile: positions and drops, at least two of each",
                expected: [x.len().max(2); 2],
                found: [x.len(), drop.len()],
            });
        }
        for (index, (x, d)) in x.iter().zip(drop).enumerate() {
            if !(x.is_finite() && d.is_finite()) {
                return Err(Error::NonFinite { name: "profile", index: [index, 0] });
            }
        }
        if let Some(pair) = x.windows(2).find(|pair| pair[1] <= pair[0]) {
            require("profile positions", pair[1], false, "increasing")?;
        }
        let samples: Vec<[f64; 2]> = x.iter().zip(drop).map(|(x, drop)| [*x, *drop]).collect();
        let curve =
            Curve { is_straight: false, is_limited: true, corners: Vec::new(), smoothing: None };
        let profile = Self::through(samples.into(), curve);
        let mut between = x.windows(2).map(|x| x[0] + 0.5 * (x[1] - x[0]));
        refuse_if(
            !between.all(|x| profile.drop(x).is_finite()),
            "profile must have finite slopes: positions are too close, or drops too large",
        )?;
        Ok(profile)
    }

    fn through(samples: Arc<[[f64; 2]]>, curve: Curve) -> Self {
        let pieces = curve.pieces(&samples).into();
        Self { samples, curve, pieces }
    }

    /// This profile with true edges at the stations that are nearest to these positions \[m\]: it is smooth between them.
    ///
    /// # Errors
    /// Unless all are between the first and the last position.
    pub fn with_corners(self, corners: &[f64]) -> Result<Self> {
        let [low, high] = self.ends();
        for corner in corners {
            let holds = *corner > low && *corner < high;
            require("corners", *corner, holds, "between the ends of the profile")?;
        }
        let mut corners = corners.to_vec();
        corners.sort_by(f64::total_cmp);
        Ok(Self::through(self.samples, Curve { corners, ..self.curve }))
    }

    /// This profile with straight lines between the stations, each of which is an edge.
    pub fn straight(self) -> Self {
        Self::through(self.samples, Curve { is_straight: true, ..self.curve })
    }

    /// This profile without noise: without waves that are shorter than a `wavelength` \[m\], of which half is left. The
    /// drops at the stations are those of the regression filter of ISO 16610-31 (second degree, not robust), which leaves
    /// parabolas as they are; on both sides of a corner it is applied by itself.
    ///
    /// # Errors
    /// Unless `wavelength` is finite and above 0.
    pub fn smoothed(self, wavelength: f64) -> Result<Self> {
        let smoothing = Some(positive("smoothing", wavelength)?);
        Ok(Self::through(self.samples, Curve { smoothing, ..self.curve }))
    }

    /// Position and drop of each station \[m\], as they were given.
    pub fn samples(&self) -> impl Iterator<Item = [f64; 2]> {
        self.samples.iter().copied()
    }

    /// Positions of the corners \[m\], as they were given, ascending.
    pub fn corners(&self) -> &[f64] {
        &self.curve.corners
    }

    /// Whether straight lines join the stations.
    pub fn is_straight(&self) -> bool {
        self.curve.is_straight
    }

    /// Wavelength below which waves are taken away \[m\]; `None` where none are.
    pub fn smoothing(&self) -> Option<f64> {
        self.curve.smoothing
    }

    /// Other profiles that the stations may mean: the curves through every second station, the even ones without limits of
    /// slopes and the odd ones with them, and that with half of the smoothing. How far solutions with them differ shows how
    /// much is not known. None where straight lines are said to join the stations.
    pub fn alternatives(&self) -> Vec<Self> {
        if self.curve.is_straight || self.samples.len() < 3 {
            return Vec::new();
        }
        let spans = self.curve.spans(&self.samples);
        let every_second = |offset: usize, is_limited: bool| {
            let kept = spans.iter().flat_map(|[first, last]| {
                let inner = (first + offset..*last).step_by(2);
                [*first].into_iter().chain(inner).chain([*last]).map(|k| self.samples[k])
            });
            let mut fewer: Vec<[f64; 2]> = kept.collect();
            fewer.dedup();
            Self::through(fewer.into(), Curve { is_limited, ..self.curve.clone() })
        };
        let mut others = vec![every_second(0, false), every_second(1, true)];
        if let Some(wavelength) = self.curve.smoothing {
            let smoothing = Some(0.5 * wavelength);
            let curve = Curve { smoothing, ..self.curve.clone() };
            others.push(Self::through(Arc::clone(&self.samples), curve));
        }
        others
    }

    /// Changes of the profile with the drop at one station: the profile with a drop that is larger, and smaller, by a step,
    /// and the step.
    pub(super) fn changed(&self, number: usize) -> Option<([Self; 2], f64)> {
        let drops = || self.samples.iter().map(|[_, drop]| *drop);
        let range =
            drops().fold(f64::NEG_INFINITY, f64::max) - drops().fold(f64::INFINITY, f64::min);
        // The curve is linear in the drops but where slopes are limited.
        let step = if range > 0.0 { 1e-4 * range } else { 1.0 };
        self.samples.get(number)?;
        let by = |step: f64| {
            let mut samples = self.samples.to_vec();
            samples[number][1] += step;
            Self::through(samples.into(), self.curve.clone())
        };
        Some(([by(step), by(-step)], step))
    }

    /// Positions of the stations; of very many, the highest of each of [`MARKS`] groups.
    pub(super) fn marks(&self) -> Vec<f64> {
        let highest = |group: &[[f64; 2]]| {
            let by_drop = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
            group.iter().min_by(by_drop).map(|sample| sample[0])
        };
        let groups = self.samples.chunks(self.samples.len().div_ceil(MARKS));
        groups.filter_map(highest).collect()
    }

    pub(super) fn ends(&self) -> [f64; 2] {
        [self.samples[0][0], self.samples[self.samples.len() - 1][0]]
    }

    pub(super) fn drop(&self, x: f64) -> f64 {
        let [low, high] = self.ends();
        if !(low..=high).contains(&x) {
            return f64::INFINITY;
        }
        self.pieces[self.piece_at(x)].at(x)
    }

    /// Number of the piece at x.
    fn piece_at(&self, x: f64) -> usize {
        let pieces_before = self.pieces.partition_point(|piece| piece.ends[0] <= x);
        pieces_before.clamp(1, self.pieces.len()) - 1
    }

    /// Integral of the drop from a to b \[m²\], between the ends.
    pub(super) fn integral(&self, a: f64, b: f64) -> f64 {
        let pieces = self.pieces[self.piece_at(a)..].iter();
        let pieces = pieces.take_while(|piece| piece.ends[0] < b);
        pieces.map(|piece| piece.integral(piece.ends[0].max(a), piece.ends[1].min(b))).sum()
    }
}

value! {
    SampledProfile by SampledProfileData {
        x: Vec<f64> = of.samples().map(|[x, _]| x).collect();
        drop: Vec<f64> = of.samples().map(|[_, drop]| drop).collect();
        smooth: bool = !of.is_straight();
        #[serde(default, skip_serializing_if = "crate::model::data::is_default")]
        corners: Vec<f64> = of.corners().to_vec();
        smoothing: Option<f64> = of.smoothing();
    }
    of, fields => {
        let mut profile = Self::new(&fields.x, &fields.drop)?.with_corners(&fields.corners)?;
        if !fields.smooth {
            profile = profile.straight();
        }
        match fields.smoothing {
            Some(wavelength) => profile.smoothed(wavelength),
            None => Ok(profile),
        }
    }
}

impl Curve {
    /// First and last number of the stations of each smooth part.
    fn spans(&self, samples: &[[f64; 2]]) -> Vec<[usize; 2]> {
        let last = samples.len() - 1;
        let nearest = |corner: &f64| {
            let above = samples.partition_point(|sample| sample[0] < *corner).clamp(1, last);
            let is_below = *corner - samples[above - 1][0] < samples[above][0] - *corner;
            if is_below { above - 1 } else { above }
        };
        let mut breaks = vec![0];
        breaks.extend(self.corners.iter().map(nearest));
        breaks.push(last);
        breaks.dedup();
        breaks.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The pieces between the stations.
    fn pieces(&self, samples: &[[f64; 2]]) -> Vec<Piece> {
        let spans = self.spans(samples);
        let x: Vec<f64> = samples.iter().map(|[x, _]| *x).collect();
        let mut values: Vec<f64> = samples.iter().map(|[_, drop]| *drop).collect();
        if let Some(wavelength) = self.smoothing {
            let drops = values.clone();
            for [first, last] in &spans {
                let smooth = smoothed(&x[*first..=*last], &drops[*first..=*last], wavelength);
                for (k, value) in (*first..).zip(smooth) {
                    // A corner has the mean of both sides.
                    let is_met = k == *first && k > 0;
                    values[k] = if is_met { 0.5 * (values[k] + value) } else { value };
                }
            }
        }
        let parts = spans.into_iter().flat_map(|[first, last]| {
            let (x, values) = (&x[first..=last], &values[first..=last]);
            if self.is_straight {
                return Piece::between(x, values, chords(x, values).into_iter().map(|s| [s; 2]));
            }
            let mut slopes = spline(x, values);
            if self.is_limited {
                limit(x, values, &mut slopes);
            }
            Piece::between(x, values, slopes.windows(2).map(|slopes| [slopes[0], slopes[1]]))
        });
        parts.collect()
    }
}
