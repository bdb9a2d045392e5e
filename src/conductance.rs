//! Conductance: heat or current through the cells in contact of a solved contact, and the film on them.
//!
//! Steady conduction into a layered half-space has a scalar response like that of its elasticity: the potential T̂ of the surface
//! (temperature \[K\] or voltage \[V\]) per flux density q̂ into the body of the same wavenumber α is Z, with
//!
//! ```text
//! Z = 1/(k α)                                  a half-space of conductivity k
//! Z ← Z + r                                    an interface of resistance r per area
//! Z ← Z_j (Z + Z_j t)/(Z_j + Z t)              a layer: Z_j = 1/(k_j α), t = tanh α h_j
//! ```
//!
//! from the substrate up. Between bodies that are each at one potential far away, the contact area C is at one potential,
//!
//! ```text
//! (Z₁ + Z₂ + ρ) q = 1  on C,   q = 0 elsewhere,   R = 1/∬ q dA
//! ```
//!
//! with the resistance ρ per area of the film between them. It is the tangent of a contact whose cells stay, with conduction in place
//! of elasticity and the film in place of springs. For homogeneous bodies it is Barber's theorem, R = E*/(2k) dδ/dW with
//! 1/k = 1/k₁ + 1/k₂: Barber, Proc. R. Soc. A 459 (2003) 53, doi:10.1098/rspa.2002.1038.
//!
//! # The error
//!
//! Cells that the edge of the contact cuts count as a whole or not at all, which makes an error of the area A ([`contact`](crate::contact)).
//! R falls as 1/√A where the bodies spread the flux, and as 1/A under a film or a coating that conducts poorly. Stated is the error of
//! a film, R δA/A. Of 330 coated discs anywhere on their grids, whose resistances are known to 1e-12, none is off by more.
//! In line contact, where R counts from a datum, it is δA/A times −dR/d ln b ≈ Z(2/b) 2/πb + ρ/2b, half-width b.

use std::f64::consts::PI;

use ndarray::Array2;

use crate::compliance::response::{Asymptotes, Body, Response, refuse_free};
use crate::contact::{Compliance, Solution, outline_error};
use crate::error::{Error, Result, not_negative, positive, refuse_if};
use crate::numerics::linear_cg::Watch;

/// Conduction into a body: conductivities of its layers and its substrate.
#[derive(Debug, Clone, PartialEq)]
pub struct Conductor {
    /// Layers from the surface down.
    layers: Vec<ConductingLayer>,
    /// 1/k of the substrate; 0 of a perfect conductor.
    base: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct ConductingLayer {
    thickness: f64,
    /// 1/k.
    resistivity: f64,
    /// Resistance per area of the interface below.
    interface: f64,
}

impl Conductor {
    /// A body of this conductivity \[W/(m K)\] or \[S/m\]; infinite for a body at one potential throughout.
    ///
    /// # Errors
    /// A conductivity that is not above 0.
    pub fn homogeneous(conductivity: f64) -> Result<Self> {
        Ok(Self { layers: Vec::new(), base: resistivity(conductivity)? })
    }

    /// The layers of `body` and its substrate, with conductivities from the surface down; one stands for all.
    ///
    /// # Errors
    /// A plate with a free base, a conductivity that is not above 0, an infinite one of a layer, and another number of them than of
    /// layers with the substrate.
    pub fn of(body: Option<&Body>, conductivities: &[f64]) -> Result<Self> {
        if let Some(body) = body {
            refuse_free(&**body, "bodies that conduct")?;
        }
        let layers = body.and_then(|body| body.half_space()).map_or(&[][..], |body| body.layers());
        let (count, all) = (layers.len() + 1, conductivities);
        if let [f64::INFINITY] = all {
            return Self::homogeneous(f64::INFINITY);
        }
        let all = if let [one] = all { vec![*one; count] } else { all.to_vec() };
        if all.len() != count {
            return Err(Error::Parameter {
                name: "conductivity",
                requirement: "as many as layers, and one for the substrate",
                value: all.len() as f64,
            });
        }
        let body = Self::homogeneous(all[layers.len()])?;
        let of_layers = all.iter().zip(layers).rev();
        of_layers
            .into_iter()
            .try_fold(body, |body, (k, layer)| body.below_layer(*k, layer.thickness(), 0.0))
    }

    /// This body under one more layer, with the resistance per area \[m² K/W\] or \[Ω m²\] of the interface between them.
    ///
    /// # Errors
    /// A conductivity or thickness that is not above 0 and finite, a resistance that is negative or not finite.
    pub fn below_layer(
        mut self,
        conductivity: f64,
        thickness: f64,
        interface: f64,
    ) -> Result<Self> {
        let layer = ConductingLayer {
            thickness: positive("thickness", thickness)?,
            resistivity: 1.0 / positive("conductivity", conductivity)?,
            interface: not_negative("interface", interface)?,
        };
        self.layers.insert(0, layer);
        Ok(self)
    }

    /// Whether the body is at one potential throughout.
    fn is_perfect(&self) -> bool {
        self.layers.is_empty() && self.base <= 0.0
    }
}

fn resistivity(conductivity: f64) -> Result<f64> {
    if conductivity == f64::INFINITY {
        return Ok(0.0);
    }
    Ok(1.0 / positive("conductivity", conductivity)?)
}

impl Response for Conductor {
    /// α Z.
    fn normal(&self, wavenumber: f64) -> f64 {
        self.layers.iter().rev().fold(self.base, |below, layer| {
            let below = below + wavenumber * layer.interface;
            let (own, t) = (layer.resistivity, (wavenumber * layer.thickness).tanh());
            own * (below + own * t) / (own + below * t)
        })
    }

    /// Long waves see the substrate and, to the next order, what layers add to it.
    fn asymptotes(&self) -> Asymptotes {
        let of_layer = |layer: &ConductingLayer| {
            let instead = self.base * self.base / layer.resistivity;
            layer.interface + layer.thickness * (layer.resistivity - instead)
        };
        Asymptotes {
            long: self.base,
            constant: self.layers.iter().map(of_layer).sum(),
            short: self.layers.first().map_or(self.base, |layer| layer.resistivity),
        }
    }

    /// A layer that conducts well spreads the flux over its thickness times the ratio of conductivities.
    fn lengths(&self) -> Option<[f64; 2]> {
        let top = self.layers.first()?.thickness;
        let total: f64 = self.layers.iter().map(|layer| layer.thickness).sum();
        let all = || self.layers.iter().map(|layer| layer.resistivity);
        let least = all().fold(if self.base > 0.0 { self.base } else { f64::INFINITY }, f64::min);
        let most = all().fold(self.base, f64::max);
        let interfaces =
            self.layers.iter().map(|layer| layer.interface / least).fold(0.0, f64::max);
        Some([top, (total * most / least).max(interfaces)])
    }
}

/// Conduction through a contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Conductance {
    /// Resistance between the bodies far from the contact \[K/W\] or \[Ω\]; per length of a line contact, from the datum of
    /// [`Grid::line`](crate::Grid::line), and times the area of a period of a contact that repeats.
    pub resistance: f64,
    /// Estimated error of the resistance.
    pub uncertainty: f64,
    /// Share of each cell of the flux, (nx, ny).
    pub flux: Array2<f64>,
}

impl Solution {
    /// Resistance of the contact to heat or current between its bodies, with a `film` of this resistance per area \[m² K/W\] or
    /// \[Ω m²\] on the cells in contact. `watch` is asked before each iteration whether to continue.
    ///
    /// # Errors
    /// No contact, a contact with free ends or one that repeats along one axis only, bodies and a film without any resistance, and
    /// those of [`Solution::stiffness`].
    ///
    /// ```
    /// use nacre::conductance::Conductor;
    /// use nacre::{Contact, Elastic, FlatPunch, Grid, Motion, Options, Setup};
    /// // A disc of radius a on a half-space: R = 1/(4 k a).
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [2.5, 2.5])?, Setup::default())?;
    /// let solution = contact.solve(&FlatPunch::new(1.0)?, &Motion::load(1.0), &Options::default())?;
    /// let (body, punch) = (Conductor::homogeneous(2.0)?, Conductor::homogeneous(f64::INFINITY)?);
    /// let conduction = solution.conductance([body, punch], None, None)?;
    /// assert!((conduction.resistance * 4.0 * 2.0 - 1.0).abs() < 0.02);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn conductance(
        &self,
        bodies: [Conductor; 2],
        film: Option<Compliance>,
        watch: Option<&mut Watch>,
    ) -> Result<Conductance> {
        let grid = self.grid();
        let [along_x, along_y] = grid.is_periodic();
        refuse_if(
            self.report.free_ends().is_some(),
            "conductance of bodies with free ends is not known: solve without ends",
        )?;
        refuse_if(
            along_x != along_y,
            "conductance needs a grid that repeats along both axes or along none",
        )?;
        let cells = self.pressure.iter().filter(|p| **p > 0.0).count() as f64;
        refuse_if(cells <= 0.0, "conductance needs a contact, and no cell is in contact")?;
        let mut conductors = bodies.into_iter().filter(|body| !body.is_perfect());
        let Some(body) = conductors.next() else {
            return Err(Error::Inconsistent(
                "conductance needs a body with a finite conductivity: both are perfect conductors",
            ));
        };
        let other = conductors.next();
        let films = film.as_ref().map(|film| film.on(grid)).transpose()?;
        let wave = |alpha: f64| {
            [Some(&body), other.as_ref()]
                .into_iter()
                .flatten()
                .map(|body| body.normal(alpha))
                .sum::<f64>()
        };
        // −dR/d ln A.
        let rate = grid.is_line().then(|| {
            let area = cells * grid.cell_area();
            let touches = self.pressure.iter().map(|p| f64::from(u8::from(*p > 0.0)));
            let film = films.map_or(0.0, |films| {
                touches.zip(&films).map(|(touches, film)| touches * film).sum::<f64>() / cells
            });
            wave(4.0 / area) / PI + film / area
        });
        let (conductance, mut flux) =
            self.unit_flux(body.into(), other.map(Body::from), film, watch)?;
        flux /= flux.sum();
        let period = if along_x { grid.size().into_iter().product() } else { 1.0 };
        let resistance = period / conductance;
        let share = outline_error(&self.pressure, grid) / cells;
        let uncertainty = share * rate.unwrap_or(resistance);
        Ok(Conductance { resistance, uncertainty, flux })
    }
}
