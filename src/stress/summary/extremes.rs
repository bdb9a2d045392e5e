//! The extremes of the stress on one plane after another.

use std::ops::ControlFlow;

use crate::compliance::response::interior::Place;
use crate::stress::derived::{Peak, Tensor};
use crate::stress::options::StressProgress;
use crate::stress::plan::{PlaneStress, StressPlan};

/// The plane of stress that was evaluated last, and what evaluates the next.
pub(super) struct Planes<'a, 'b> {
    plan: &'a StressPlan,
    friction: [f64; 2],
    residual: &'a [f64],
    evaluator: PlaneStress<'a>,
    /// The six components at the cells.
    fields: [Vec<f64>; 6],
    progress: &'a mut StressProgress<'b>,
    /// Planes evaluated so far.
    done: usize,
    /// Planes that are evaluated at most, but for those below an interface.
    planned: usize,
}

/// The extremes on one plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes {
    von_mises: Peak,
    tension: Peak,
    shear: Peak,
}

impl Extremes {
    /// Each of the extremes, to be refined by itself.
    pub(super) const EACH: [fn(&Self) -> Peak; 3] = [|e| e.von_mises, |e| e.tension, |e| e.shear];
}

/// The largest value found so far, and its cell.
#[derive(Debug, Clone, Copy)]
struct Largest {
    value: f64,
    cell: usize,
}

impl Largest {
    /// Before any value.
    const NONE: Self = Self {
        value: f64::NEG_INFINITY,
        cell: 0,
    };

    fn offer(&mut self, value: f64, cell: usize) {
        if value > self.value {
            *self = Self { value, cell };
        }
    }
}

/// Extremes of the traction on one plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tractions {
    /// Largest σ_zz.
    pub(super) tension: Peak,
    /// Smallest σ_zz.
    pub(super) compression: Peak,
    /// Largest √(σ_xz² + σ_yz²).
    pub(super) shear: Peak,
}

impl<'a, 'b> Planes<'a, 'b> {
    /// Planes of `plan` under a friction and the residual stress of each layer; `progress` is told how
    /// many of those `planned` are done.
    pub(super) fn new(
        plan: &'a StressPlan,
        friction: [f64; 2],
        residual: &'a [f64],
        planned: usize,
        progress: &'a mut StressProgress<'b>,
    ) -> Self {
        let cells = plan.whole.grid.shape().iter().product();
        Self {
            plan,
            friction,
            residual,
            evaluator: PlaneStress::new(plan, friction, false),
            fields: std::array::from_fn(|_| vec![0.0; cells]),
            progress,
            done: 0,
            planned,
        }
    }

    /// Tells `progress` that all is done.
    pub(super) fn finish(&mut self) {
        // A break has nothing left to stop.
        let _ = (self.progress)(1.0);
    }

    /// Evaluates the stress at `place`.
    fn evaluate(&mut self, place: &Place) -> ControlFlow<()> {
        let (done, planned) = (self.done as f64, self.planned as f64);
        let progress = &mut self.progress;
        let mut progress = |part: f64| progress(((done + part) / planned).min(1.0));
        let mut outputs = self.fields.each_mut().map(Vec::as_mut_slice);
        self.evaluator
            .evaluate(place, &mut outputs, &mut progress)?;
        let residual = self.residual[place.layer];
        for field in &mut self.fields[..2] {
            field.iter_mut().for_each(|s| *s += residual);
        }
        self.done += 1;
        ControlFlow::Continue(())
    }

    fn tensor(&self, cell: usize) -> Tensor {
        Tensor::new(self.fields.each_ref().map(|field| field[cell]))
    }

    fn peak(&self, largest: Largest, place: &Place) -> Peak {
        let ny = self.plan.whole.grid.shape()[1];
        let Largest { value, cell } = largest;
        let [i, j] = [cell / ny, cell % ny];
        let window = [i..i + 1, j..j + 1];
        let places = std::slice::from_ref(place);
        let error = self.plan.uncertainties(places, self.friction, &window);
        Peak {
            value,
            position: [
                self.plan.whole.grid.x()[i],
                self.plan.whole.grid.y()[j],
                place.depth,
            ],
            uncertainty: error.map(|errors| errors[0]),
        }
    }

    /// Extremes at `place`.
    pub(super) fn extremes(&mut self, place: &Place) -> ControlFlow<(), Extremes> {
        self.evaluate(place)?;
        let [mut von_mises, mut tension, mut shear] = [Largest::NONE; 3];
        for cell in 0..self.fields[0].len() {
            let tensor = self.tensor(cell);
            let mises = tensor.von_mises();
            von_mises.offer(mises, cell);
            // The largest principal stress is at most the mean plus 2/3 of von Mises' stress, and the
            // largest shear stress at most 1/√3 of it: most cells need no principal stresses.
            if tensor.mean() + 0.67 * mises > tension.value || 0.58 * mises > shear.value {
                let [first, _, last] = tensor.principal();
                tension.offer(first, cell);
                shear.offer(0.5 * (first - last), cell);
            }
        }
        ControlFlow::Continue(Extremes {
            von_mises: self.peak(von_mises, place),
            tension: self.peak(tension, place),
            shear: self.peak(shear, place),
        })
    }

    /// Extremes of the traction at `place`.
    pub(super) fn tractions(&mut self, place: &Place) -> ControlFlow<(), Tractions> {
        self.evaluate(place)?;
        let [mut tension, mut compression, mut shear] = [Largest::NONE; 3];
        for cell in 0..self.fields[0].len() {
            let Tensor { zz, yz, xz, .. } = self.tensor(cell);
            tension.offer(zz, cell);
            compression.offer(-zz, cell);
            shear.offer(xz.hypot(yz), cell);
        }
        compression.value = -compression.value;
        ControlFlow::Continue(Tractions {
            tension: self.peak(tension, place),
            compression: self.peak(compression, place),
            shear: self.peak(shear, place),
        })
    }

    /// Largest jump of the in-plane stress from the plane evaluated last to that at `below`.
    pub(super) fn jump(&mut self, below: &Place) -> ControlFlow<(), Peak> {
        let [above_xx, above_yy, above_xy] = [0, 1, 3].map(|k| self.fields[k].clone());
        self.evaluate(below)?;
        let mut largest = Largest::NONE;
        let above = above_xx.iter().zip(&above_yy).zip(&above_xy).enumerate();
        for (cell, ((above_xx, above_yy), above_xy)) in above {
            let below = self.tensor(cell);
            let (xx, yy, xy) = (
                below.xx - above_xx,
                below.yy - above_yy,
                below.xy - above_xy,
            );
            let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            largest.offer(mean.abs() + half.hypot(xy), cell);
        }
        ControlFlow::Continue(self.peak(largest, below))
    }
}
