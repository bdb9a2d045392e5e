//! Graded coatings: layers thin enough to stand for properties that vary with depth. The method was
//! derived here.

use crate::compliance::response::frequency_response;
use crate::error::{Error, Result, positive, require};
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::material::Elastic;
use crate::numerics::rounding;

/// Largest number of layers of a graded coating, at which the search for a number ends. Chosen by trial.
const MAX_LAYERS: usize = 4096;

/// Wavenumbers, times the thickness, at which the response is compared: wavelengths from 600 times the
/// coating's thickness to a fifth of it.
const WAVENUMBERS: [f64; 9] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 8.0, 16.0, 32.0];

/// Layers, from the surface down, of a coating whose `material` depends on depth.
///
/// First the material is searched: it is evaluated at two thousand depths, and wherever two neighbours
/// differ, the interval is bisected. Jumps are located to rounding and steep parts are set apart, so that
/// the coating becomes sections without either. Each section is then cut into equal layers, each of the
/// material at its middle. Their number is doubled until the frequency response on `substrate`, at
/// wavelengths down to a fifth of the `thickness`, is within the relative `tolerance` of its limit. The
/// error falls with the second power of the layers' thickness. It is estimated from the last two
/// doublings, which must both meet the tolerance, and from the mean material that the search found in each
/// layer, which must not change the response by more.
///
/// No number of samples shows what lies between them: a feature that is thinner than a thousandth of the
/// `thickness` may be missed. `breakpoints` \[m\] are depths, in any order, where the caller knows of a
/// jump or of a thin feature. A section begins at each, and its neighbourhood is searched down to a
/// trillionth of the thickness.
///
/// # Errors
/// Unless `thickness` is finite and above 0, 0 < `tolerance` < 1 and the breakpoints lie inside the
/// coating; an error of `material`; where the material varies at every scale, so that its jumps cannot be
/// counted; where 4096 layers do not meet the tolerance.
///
/// ```
/// use nacre::{Elastic, HalfSpace, graded_layers};
/// let steel = Elastic::new(210e9, 0.3)?;
/// // From 420 GPa at the surface to the substrate's modulus.
/// let layers = graded_layers(steel, 10e-6, 1e-3, &[], |z| Elastic::new(420e9 - 21e15 * z, 0.3))?;
/// assert!(layers.len() < 200);
/// let body = HalfSpace::new(steel, layers)?;
/// assert!(body.interfaces().last().is_some_and(|depth| (depth / 10e-6 - 1.0).abs() < 1e-12));
///
/// // A soft adhesive of 20 nm, which only the caller can know of.
/// let glued = |z: f64| Elastic::new(if (z - 5e-6).abs() < 10e-9 { 1e9 } else { 210e9 }, 0.3);
/// let layers = graded_layers(steel, 10e-6, 1e-3, &[5e-6], glued)?;
/// assert_eq!(layers.len(), 3);
/// # Ok::<(), nacre::Error>(())
/// ```
pub fn graded_layers(
    substrate: impl Into<Substrate>,
    thickness: f64,
    tolerance: f64,
    breakpoints: &[f64],
    mut material: impl FnMut(f64) -> Result<Elastic>,
) -> Result<Vec<Layer>> {
    positive("thickness", thickness)?;
    require("tolerance", tolerance, tolerance > 0.0 && tolerance < 1.0, "above 0 and below 1")?;
    for &z in breakpoints {
        let inside = z > 0.0 && z < thickness;
        require("breakpoints", z, inside, "above 0 and below the thickness")?;
    }
    let substrate = substrate.into();
    let samples = Samples::of(thickness, tolerance, breakpoints, &mut material)?;
    let respond = |layers: &[Layer]| -> Result<Vec<f64>> {
        let body = HalfSpace::new(substrate, layers.iter().cloned())?;
        let response = WAVENUMBERS.iter().map(|x| frequency_response(&body, x / thickness));
        response.collect()
    };
    let mut before: Option<Vec<f64>> = None;
    let mut agreed = false;
    let mut count = 2;
    while count <= MAX_LAYERS {
        let layers = cut(&samples, count, &mut material)?;
        if layers.len() > MAX_LAYERS {
            break;
        }
        let response = respond(&layers)?;
        // Second order: the error is a third of the last change.
        let enough =
            before.as_ref().is_some_and(|before| change(&response, before) / 3.0 <= tolerance);
        if enough && agreed {
            let mean = samples.mean_layers(&layers)?;
            if change(&respond(&mean)?, &response) <= tolerance {
                return merged(layers);
            }
        }
        agreed = enough;
        before = Some(response);
        count *= 2;
    }
    Err(Error::Parameter {
        name: "tolerance",
        requirement: "large enough to be met by 4096 layers",
        value: tolerance,
    })
}

/// Largest relative change of a response.
fn change(new: &[f64], old: &[f64]) -> f64 {
    let changes = new.iter().zip(old).map(|(new, old)| (new / old - 1.0).abs());
    changes.fold(0.0, f64::max)
}

/// Layers of the material at their middle, `count` in each section that is not uniform.
fn cut(
    samples: &Samples,
    count: usize,
    material: &mut impl FnMut(f64) -> Result<Elastic>,
) -> Result<Vec<Layer>> {
    let mut layers = Vec::new();
    for section in samples.sections() {
        let count = if section.uniform { 1 } else { count };
        let each = (section.to - section.from) / count as f64;
        for k in 0..count {
            let middle = section.from + (k as f64 + 0.5) * each;
            layers.push(Layer::new(material(middle)?, each)?);
        }
    }
    Ok(layers)
}

/// Layers without those that have the material of the layer above.
fn merged(layers: Vec<Layer>) -> Result<Vec<Layer>> {
    let mut kept: Vec<Layer> = Vec::new();
    for layer in layers {
        match kept.last_mut() {
            Some(last) if last.material() == layer.material() => {
                *last = Layer::new(layer.material(), last.thickness() + layer.thickness())?;
            }
            _ => kept.push(layer),
        }
    }
    Ok(kept)
}

/// Samples over the thickness. They are stratified: neighbours are at most 1.62/`SAMPLES` apart, so that
/// every feature thicker than a thousandth of the coating has one.
const SAMPLES: f64 = 2048.0;

/// Smallest number of stratified samples of a part between two breakpoints; chosen by trial.
const LEAST: f64 = 32.0;

/// Samples that approach each end of a part, at distances that halve: down to 2⁻⁴⁰ = 1e-12 of it.
const HALVINGS: i32 = 40;

/// Fraction of the golden section. Its multiples fill an interval evenly, and no period of the material is
/// a multiple of it.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Width of a bracket, relative to the thickness, at which a jump is located; a few hundred roundings.
const LOCATED: f64 = 1e-13;

/// Difference of neighbours above which an interval is bisected also where the material is smooth.
const RESOLVED: f64 = 0.05;

/// Largest part of a difference that one half of an interval has where the material is smooth. A straight
/// course has 0.5, a jump 1.
const SMOOTH_HALF: f64 = 0.75;

/// Change of ln E over the thickness, or of ν, above which a part is steep and becomes a section of its
/// own; chosen by trial.
const STEEP: f64 = 50.0;

/// Largest number of steep parts that are set apart. Of a coating with more, such as a fine sinus, none is.
const STEEP_PARTS: usize = 64;

/// Largest number of samples, beyond which the search ends.
const MOST: usize = 200_000;

/// A part of the coating without jumps.
#[derive(Debug, Clone, Copy)]
pub(super) struct CoatingPart {
    pub(super) from: f64,
    pub(super) to: f64,
    /// Whether all samples in it have the same material.
    pub(super) uniform: bool,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    z: f64,
    material: Elastic,
}

impl Sample {
    /// Difference of two materials: of ln E, or of Poisson's ratio, whichever is larger.
    fn difference(&self, other: &Self) -> f64 {
        let young = (self.material.young() / other.material.young()).ln().abs();
        let poisson = (self.material.poisson() - other.material.poisson()).abs();
        young.max(poisson)
    }
}

/// What the search found: samples by increasing depth, and the sections between jumps.
pub(super) struct Samples {
    samples: Vec<Sample>,
    sections: Vec<CoatingPart>,
    /// Depths of jumps, and breakpoints, where there may be one.
    jumps: Vec<f64>,
}

impl Samples {
    /// Searches a coating. Differences up to `tolerance` are not followed.
    pub(super) fn of(
        thickness: f64,
        tolerance: f64,
        breakpoints: &[f64],
        material: &mut impl FnMut(f64) -> Result<Elastic>,
    ) -> Result<Self> {
        let mut ends = [&[0.0, thickness], breakpoints].concat();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let mut at = |z: f64| material(z).map(|material| Sample { z, material });
        let mut samples = Vec::new();
        let mut jumps = Vec::new();
        for part in ends.windows(2) {
            let depths = depths(part[0], part[1], thickness);
            let points = depths.into_iter().map(&mut at);
            let points = points.collect::<Result<Vec<_>>>()?;
            // Intervals that are left, the next one last.
            let mut left: Vec<_> = points.windows(2).rev().map(|pair| [pair[0], pair[1]]).collect();
            samples.extend(points.first());
            while let Some([one, two]) = left.pop() {
                if samples.len() > MOST {
                    return Err(Error::Inconsistent(
                        "young and poisson must not vary at every scale: the search for jumps found \
                         no end; give a smoother function, or one layer for each part",
                    ));
                }
                let difference = one.difference(&two);
                let middle = 0.5 * (one.z + two.z);
                if difference <= tolerance || middle <= one.z || middle >= two.z {
                    samples.push(two);
                    continue;
                }
                if two.z - one.z <= LOCATED * thickness {
                    jumps.push(middle);
                    samples.push(two);
                    continue;
                }
                let middle = at(middle)?;
                let halves = [one.difference(&middle), middle.difference(&two)];
                let smooth = halves[0].max(halves[1]) <= SMOOTH_HALF * difference;
                if smooth && difference <= RESOLVED {
                    samples.extend([middle, two]);
                } else {
                    left.extend([[middle, two], [one, middle]]);
                }
            }
        }
        ends.extend(&jumps);
        // The caller's breakpoints may be jumps, too.
        jumps.extend(breakpoints);
        jumps.sort_by(f64::total_cmp);
        ends.extend(steep_ends(&samples, &jumps, thickness, tolerance));
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|b, a| *b - *a <= LOCATED * thickness);
        // The last end must be the thickness to the bit.
        if let Some(last) = ends.last_mut() {
            *last = thickness;
        }
        let sections = ends.windows(2).map(|ends| section(ends[0], ends[1], &samples));
        let sections = sections.collect();
        Ok(Self { samples, sections, jumps })
    }

    pub(super) fn sections(&self) -> &[CoatingPart] {
        &self.sections
    }

    /// These layers with the mean of the samples, which are joined by straight lines, in place of their
    /// material. A layer with fewer than four samples keeps its own.
    pub(super) fn mean_layers(&self, layers: &[Layer]) -> Result<Vec<Layer>> {
        let mut top = 0.0;
        let mean = layers.iter().map(|layer| {
            let (from, to) = (top, top + layer.thickness());
            top = to;
            let first = self.samples.partition_point(|sample| sample.z < from);
            let end = self.samples.partition_point(|sample| sample.z <= to);
            if end < first + 4 {
                return Ok(layer.clone());
            }
            let (mut young, mut poisson, mut width) = (0.0, 0.0, 0.0);
            let reach = first.saturating_sub(1)..(end + 1).min(self.samples.len());
            for pair in self.samples[reach].windows(2) {
                let [one, two] = [pair[0], pair[1]];
                let (a, b) = (one.z.max(from), two.z.min(to));
                let each = b - a;
                // The straight line between the samples, at the middle of what lies in the layer; next to a
                // jump, the sample on this side of it.
                let t = match between_any(&self.jumps, one.z, two.z) {
                    true => f64::from(one.z < from),
                    false => (0.5 * (a + b) - one.z) / (two.z - one.z),
                };
                let mean = |first: f64, second: f64| first + t * (second - first);
                young += each * mean(one.material.young(), two.material.young());
                poisson += each * mean(one.material.poisson(), two.material.poisson());
                width += each;
            }
            // The mean lies between the extremes but for rounding.
            let poisson = (poisson / width).min(0.5);
            Layer::new(Elastic::new(young / width, poisson)?, layer.thickness())
        });
        mean.collect()
    }
}

/// Samples between two depths.
fn between(samples: &[Sample], from: f64, to: f64) -> &[Sample] {
    let first = samples.partition_point(|sample| sample.z < from);
    let end = samples.partition_point(|sample| sample.z <= to);
    &samples[first..end]
}

/// Depths of the samples of a part, increasing, strictly inside.
fn depths(from: f64, to: f64, thickness: f64) -> Vec<f64> {
    let width = to - from;
    let count = rounding::ceil(SAMPLES * width / thickness).max(LEAST);
    let even = (0..count as usize).map(|k| {
        let k = k as f64;
        from + width * (k + ((k + 1.0) * GOLDEN).fract()) / count
    });
    let near = (1..=HALVINGS).flat_map(|k| {
        let by = width * 0.5_f64.powi(k);
        [from + by, to - by]
    });
    let mut depths: Vec<f64> = even.chain(near).collect();
    depths.retain(|z| *z > from && *z < to);
    depths.sort_by(f64::total_cmp);
    depths.dedup();
    depths
}

/// Ends of the parts in which the material changes steeply, without jumps; none where there are too many.
fn steep_ends(samples: &[Sample], jumps: &[f64], thickness: f64, tolerance: f64) -> Vec<f64> {
    let mut ends = Vec::new();
    let mut inside = false;
    for pair in samples.windows(2) {
        let width = pair[1].z - pair[0].z;
        let jump = between_any(jumps, pair[0].z, pair[1].z);
        let difference = pair[0].difference(&pair[1]);
        // A difference below the tolerance may be rounding.
        let steep = !jump && difference > tolerance && difference * thickness > STEEP * width;
        if steep != inside {
            ends.push(pair[0].z);
            inside = steep;
        }
    }
    if ends.len() > 2 * STEEP_PARTS {
        ends.clear();
    }
    ends
}

fn between_any(jumps: &[f64], from: f64, to: f64) -> bool {
    let next = jumps.partition_point(|z| *z <= from);
    jumps.get(next).is_some_and(|z| *z < to)
}

fn section(from: f64, to: f64, samples: &[Sample]) -> CoatingPart {
    let inside = between(samples, from, to);
    let uniform =
        inside.first().is_some_and(|first| inside.iter().all(|s| s.material == first.material));
    CoatingPart { from, to, uniform }
}
