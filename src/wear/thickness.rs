//! The elastic contact of a body whose top layer is worn, to first order in the depth.
//!
//! What is taken off the surface carries the pressure p and the surface's strains e_ij along itself, both of which are the same
//! on its two faces. To first order in the depth w its energy is missing, and so is what it gives to the displacement: with
//! the strains under pressure, e = E p ([`crate::compliance::strain`]),
//!
//! ```text
//! u = K₀ p − { S w p + (λ/M) [w e_kk + Eᵀ(w p δ_ij)] − Eᵀ(w Q_ijkl e_kl) }
//! S = 1/M    M = λ + 2G    Q_ijkl e_kl = Q [(1−ν) e_ij + ν e_kk δ_ij]    Q = E/(1−ν²)
//! ```
//!
//! of the layer's material. Derived for nacre. A wave of pressure k strains the surface by e k_i k_j/k², so that for a wave of
//! depth that makes a wave k′ of displacement out of it, at the angle θ, the braces are
//!
//! ```text
//! F(k′, k) = S + (λ/M)(e′ + e) − Q (cos²θ + ν sin²θ) e e′         F(k, k) = ∂c11/∂h
//! ```
//!
//! symmetric, as the matrices E are. In cells, a part c of S is that of the pressure which they resolve. The pressure on the slope of the worn surface is left out, as it is with all shapes.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use ndarray::{Array2, Zip};

use crate::compliance::convolution::Beside;
use crate::compliance::strain::{StrainWindow, SurfaceStrain};
use crate::contact::{Contact, bounds, enclosing};
use crate::error::{Error, Result, refuse_if};
use crate::model::grid::{Window, each_cell, full_window};
use crate::model::material::Elastic;
use crate::numerics::parallel::Threads;

/// The top layers of both bodies, as far as they have any.
#[derive(Debug)]
pub(super) struct TopLayers(Vec<TopLayer>);

/// The top layer of a body.
#[derive(Debug)]
struct TopLayer {
    /// 0 of the body, 1 of the counterbody.
    member: usize,
    material: Elastic,
    thickness: f64,
    strain: Arc<SurfaceStrain>,
}

impl TopLayers {
    /// The top layers of those bodies of a plan that wear.
    ///
    /// # Errors
    /// A response, whose layers are not known; a layered body with free ends; a grid that repeats along one direction alone;
    /// and too little memory.
    pub(super) fn plan(plan: &Contact, wears: [bool; 2]) -> Result<Self> {
        let both = [Some(plan.body()), plan.setup().counterbody.as_ref()];
        let mut layers = Vec::new();
        for (member, body) in both.into_iter().enumerate() {
            let Some(body) = body.filter(|_| wears[member]) else { continue };
            let body = body.half_space().ok_or(Error::Inconsistent(
                "thickness must be \"frozen\" for a response: its layers are not known",
            ))?;
            let Some(layer) = body.layers().first() else { continue };
            let [along_x, along_y] = plan.grid().is_periodic();
            refuse_if(
                along_x != along_y,
                "thickness must be \"frozen\" on a grid that is periodic along one direction alone",
            )?;
            refuse_if(
                body.ends().iter().any(Option::is_some),
                "thickness must be \"frozen\" for layered bodies with free ends: what their ends do to the strains of the \
                 surface is not known",
            )?;
            layers.push(TopLayer {
                member,
                material: layer.material(),
                thickness: layer.thickness(),
                strain: Arc::new(SurfaceStrain::plan(
                    body,
                    plan.grid(),
                    plan.convolution().own_threads(),
                )?),
            });
        }
        Ok(Self(layers))
    }

    /// What these depths change of the contact; nothing where no layer is worn. A layer that is through is missing as far as
    /// it went.
    pub(super) fn thinned(
        &self,
        depth: &[Array2<f64>; 2],
        threads: &Threads,
    ) -> Vec<Arc<dyn Beside>> {
        let mut operators: Vec<Arc<dyn Beside>> = Vec::new();
        for layer in &self.0 {
            let depth = depth[layer.member].mapv(|depth| depth.min(layer.thickness));
            let whole = full_window(depth.dim().into());
            let Some(worn_window) = bounds(&whole, |i, j| depth[[i, j]] > 0.0) else { continue };
            let area = Thinned { depth: Arc::new(depth), worn_window, layer: layer.into() };
            operators.push(Arc::new(area.on(whole, threads)));
        }
        operators
    }

    /// Difference of two depths, relative to the thickness of the layer: the root of its mean square over the worn cells. The
    /// few that the contact has just reached hardly count, as in the error of a step.
    pub(super) fn apart(&self, one: &[Array2<f64>; 2], other: &[Array2<f64>; 2]) -> f64 {
        let mut most = 0.0_f64;
        for TopLayer { member, thickness, .. } in &self.0 {
            let (mut squares, mut cells) = (0.0, 0.0);
            Zip::from(&one[*member]).and(&other[*member]).for_each(|a, b| {
                if a.max(*b) > 0.0 {
                    squares += ((a.min(*thickness) - b.min(*thickness)) / thickness).powi(2);
                    cells += 1.0;
                }
            });
            most = most.max(f64::sqrt(squares / f64::max(cells, 1.0)));
        }
        most
    }
}

/// What the operator has of a layer.
#[derive(Debug, Clone)]
struct Constants {
    /// S, less what counts for the resolved pressure.
    own_cell: f64,
    /// c: what counts for the resolved pressure.
    resolved_share: f64,
    /// λ/M
    ratio: f64,
    /// Q
    modulus: f64,
    poisson: f64,
    strain: Arc<SurfaceStrain>,
}

impl From<&TopLayer> for Constants {
    fn from(layer: &TopLayer) -> Self {
        let (g, nu) = (layer.material.shear(), layer.material.poisson());
        // In a line contact, strains have one direction.
        let resolved =
            if layer.strain.is_line() { 0.0 } else { (1.0 - 2.0 * nu).powi(2) / (4.0 * g) };
        Self {
            own_cell: (1.0 - 2.0 * nu) / (2.0 * g * (1.0 - nu)) - resolved,
            resolved_share: resolved,
            ratio: nu / (1.0 - nu),
            modulus: layer.material.plane_strain_modulus(),
            poisson: nu,
            strain: Arc::clone(&layer.strain),
        }
    }
}

/// Strains are xx, xy and yy, or yy alone.
impl Constants {
    /// e_kk
    fn trace(strains: &[f64]) -> f64 {
        match strains {
            [xx, _, yy] => xx + yy,
            _ => strains.iter().sum(),
        }
    }

    /// (λ/M) p δ_ij − Q_ijkl e_kl of each strain.
    fn tensor(&self, pressure: f64, strains: &[f64]) -> [f64; 3] {
        let (q, nu, even) = (self.modulus, self.poisson, self.ratio * pressure);
        match *strains {
            [xx, xy, yy] => {
                [even - q * (xx + nu * yy), -q * (1.0 - nu) * xy, even - q * (yy + nu * xx)]
            }
            _ => [even - q * strains.iter().sum::<f64>(), 0.0, 0.0],
        }
    }
}

/// The worn cells of a layer.
#[derive(Debug, Clone)]
struct Thinned {
    /// w on the whole grid.
    depth: Arc<Array2<f64>>,
    /// Window outside which it is 0.
    worn_window: Window,
    layer: Constants,
}

impl Thinned {
    /// The operator for pressures and displacements in a window of the grid.
    fn on(self, window: Window, threads: &Threads) -> Thinning {
        let domain = match self.layer.strain.repeats() {
            true => full_window(self.depth.dim().into()),
            false => enclosing(&window, &self.worn_window),
        };
        let strains = self.layer.strain.window([domain[0].len(), domain[1].len()], threads);
        let depth = each_cell(&domain).map(|(i, j)| self.depth[[i, j]]).collect();
        Thinning { thinned: self, window, domain, depth, strains, fields: Mutex::default() }
    }
}

/// −{…} of the head of this file.
#[derive(Debug)]
struct Thinning {
    thinned: Thinned,
    /// Cells of pressure and displacement in the grid.
    window: Window,
    /// Those and the worn ones: between them, strains are computed.
    domain: Window,
    /// w there.
    depth: Vec<f64>,
    strains: Arc<StrainWindow>,
    fields: Mutex<Fields>,
}

/// Fields on the domain.
#[derive(Debug, Default)]
struct Fields {
    pressure: Vec<f64>,
    /// L p
    resolved: Vec<f64>,
    tensor: Vec<f64>,
    sums: Vec<f64>,
}

impl Beside for Thinning {
    fn add(
        &self,
        pressure: &[f64],
        occupied: Range<usize>,
        displacement: &mut [f64],
        threads: &Threads,
    ) {
        let (layer, depth) = (&self.thinned.layer, &self.depth);
        let columns = self.window[1].len();
        let wide = self.domain[1].len();
        let cells = self.domain[0].len() * wide;
        let count = self.strains.strains();
        // Where rows of the window are in the domain.
        let first = self.window[1].start - self.domain[1].start;
        let row = |i: usize| {
            let start = (self.window[0].start - self.domain[0].start + i) * wide + first;
            start..start + columns
        };
        let mut fields = self.fields.lock().unwrap_or_else(PoisonError::into_inner);
        let Fields { pressure: p, resolved, tensor, sums } = &mut *fields;
        p.clear();
        p.resize(cells, 0.0);
        tensor.resize(count * cells, 0.0);
        sums.resize(cells, 0.0);
        for i in occupied {
            p[row(i)].copy_from_slice(&pressure[i * columns..][..columns]);
        }
        self.strains.strain(p, tensor, threads);
        resolved.clear();
        if layer.resolved_share > 0.0 {
            resolved.extend_from_slice(p);
            self.strains.resolve(resolved);
            let cells = resolved.iter_mut().zip(depth);
            cells.for_each(|(p, w)| *p *= layer.resolved_share * w);
            self.strains.resolve(resolved);
        }
        // From here on p is what the cell's own strains and pressure give.
        for (at, w) in depth.iter().enumerate() {
            let mut strains = [0.0; 3];
            (0..count).for_each(|k| strains[k] = tensor[k * cells + at]);
            let strains = &strains[..count];
            let made = layer.tensor(p[at], strains);
            (0..count).for_each(|k| tensor[k * cells + at] = w * made[k]);
            p[at] = w * (layer.own_cell * p[at] + layer.ratio * Constants::trace(strains));
        }
        p.iter_mut().zip(&*resolved).for_each(|(own, resolved)| *own += resolved);
        self.strains.adjoint(tensor, sums, threads);
        for (i, displacement) in displacement.chunks_exact_mut(columns).enumerate() {
            let own = p[row(i)].iter().zip(&sums[row(i)]);
            displacement.iter_mut().zip(own).for_each(|(u, (own, sum))| *u -= own + sum);
        }
    }

    fn on_window(&self, window: &Window, threads: &Threads) -> Arc<dyn Beside> {
        let within = [0, 1].map(|k| {
            let start = self.window[k].start;
            start + window[k].start..start + window[k].end
        });
        Arc::new(self.thinned.clone().on(within, threads))
    }

    /// Displacement of `cell` from a unit pressure on `loaded` that wear adds, with the strains e of the surface under unit
    /// pressures: −{ (λ/M) (w_cell + w_loaded) e_kk + (S − c) w_cell δ + Σ w_i (e_cell : Q e_loaded + c r_cell r_loaded) }, the sum
    /// over all worn cells i, whose resolved shares of a pressure are r.
    fn entry(&self, cell: [usize; 2], loaded: [usize; 2]) -> f64 {
        let Thinned { depth, worn_window, layer } = &self.thinned;
        let [cell, loaded] =
            [cell, loaded].map(|cell| [0, 1].map(|k| self.window[k].start + cell[k]));
        let strain = |from: [usize; 2], to: [usize; 2]| {
            layer.strain.entry([0, 1].map(|k| to[k] as isize - from[k] as isize))
        };
        let direct = Constants::trace(&strain(loaded, cell));
        let mut sum = layer.ratio * (depth[cell] + depth[loaded]) * direct;
        if cell == loaded {
            sum += layer.own_cell * depth[cell];
        }
        for (i, j) in each_cell(worn_window).filter(|(i, j)| depth[[*i, *j]] > 0.0) {
            let stress_of_load = layer.tensor(0.0, &strain(loaded, [i, j]));
            let product = match *strain([i, j], cell) {
                [xx, xy, yy] => {
                    xx * stress_of_load[0] + 2.0 * xy * stress_of_load[1] + yy * stress_of_load[2]
                }
                // A line contact has one strain.
                ref along => along.iter().sum::<f64>() * stress_of_load[0],
            };
            let shares = [cell, loaded].map(|cell| {
                layer
                    .strain
                    .resolved([cell[0] as isize - i as isize, cell[1] as isize - j as isize])
            });
            let resolved = layer.resolved_share * shares[0] * shares[1];
            sum += depth[[i, j]] * (product + resolved);
        }
        -sum
    }

    fn work(&self) -> f64 {
        2.0 * self.strains.work()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use ndarray::{Array2, Axis, Slice};

    use super::*;
    use crate::compliance::response::surface_compliance;
    use crate::contact::block;
    use crate::model::body::{HalfSpace, Interface, Layer, Substrate};
    use crate::model::grid::Grid;

    const SIDE: usize = 96;

    /// What cells do not resolve of waves (m, n) of the square, 1 − L: 1e-7 of waves of 4, 1e-12 of those of 1.
    fn unresolved(waves: &[[i32; 2]]) -> f64 {
        let numbers = waves.iter().flatten();
        numbers.map(|k| (f64::from(*k) * 0.5 * TAU / SIDE as f64).sin().powi(8)).sum()
    }

    fn threads() -> Result<Threads> {
        Threads::new(Some(1))
    }

    fn layer(young: f64, poisson: f64, thickness: f64) -> Result<Layer> {
        Layer::new(Elastic::new(young, poisson)?, thickness)
    }

    /// A square of side 2π that repeats: waves have whole numbers.
    fn square() -> Result<Grid> {
        Grid::new([SIDE; 2], [TAU; 2])?.periodic([true; 2])
    }

    fn operator(body: &HalfSpace, grid: &Grid, depth: Array2<f64>) -> Result<Arc<dyn Beside>> {
        let layer = TopLayer {
            member: 0,
            material: body.surface_material(),
            thickness: body.layers()[0].thickness(),
            strain: Arc::new(SurfaceStrain::plan(body, grid, &threads()?)?),
        };
        let other = Array2::zeros(grid.shape());
        let mut all = TopLayers(vec![layer]).thinned(&[depth, other], &threads()?);
        Ok(all.remove(0))
    }

    fn applied(operator: &dyn Beside, pressure: &Array2<f64>) -> Result<Array2<f64>> {
        let (nx, ny) = pressure.dim();
        let mut displacement = vec![0.0; nx * ny];
        let values: Vec<f64> = pressure.iter().copied().collect();
        operator.add(&values, 0..nx, &mut displacement, &threads()?);
        Ok(Array2::from_shape_vec((nx, ny), displacement).expect("as many values"))
    }

    /// cos(k·x) on the square.
    fn wave(k: [i32; 2]) -> Array2<f64> {
        Array2::from_shape_fn((SIDE, SIDE), |(i, j)| {
            let [x, y] = [i, j].map(|n| TAU * n as f64 / SIDE as f64);
            (f64::from(k[0]) * x + f64::from(k[1]) * y).cos()
        })
    }

    /// Coefficient of cos(k·x), of k ≠ 0.
    fn coefficient(field: &Array2<f64>, k: [i32; 2]) -> f64 {
        (field * &wave(k)).sum() * 2.0 / (SIDE * SIDE) as f64
    }

    fn bodies() -> Result<[HalfSpace; 3]> {
        Ok([
            HalfSpace::new(Elastic::new(1.0, 0.4)?, [layer(3.0, 0.3, 0.5)?])?,
            HalfSpace::new(Substrate::Rigid, [layer(3.0, 0.3, 0.5)?])?,
            HalfSpace::new(
                Elastic::new(1.0, 0.2)?,
                [
                    layer(0.5, 0.45, 0.3)?.with_interface(Interface::Frictionless),
                    layer(4.0, 0.25, 0.7)?,
                ],
            )?,
        ])
    }

    /// Even wear is the derivative with respect to the thickness, on elastic and rigid bases and on one on which the layer
    /// slips. Quotients of fourth order err by 1e-9.
    #[test]
    fn even_wear_is_the_derivative_by_the_thickness() -> Result<()> {
        let depth = 1e-2;
        for body in bodies()? {
            let operator = operator(&body, &square()?, Array2::from_elem((SIDE, SIDE), depth))?;
            let thickness = body.layers()[0].thickness();
            for k in [[0, 1], [1, 0], [2, 3], [-3, 1], [4, 0]] {
                let made = coefficient(&applied(&*operator, &wave(k))?, k) / -depth;
                let alpha = f64::from(k[0]).hypot(f64::from(k[1]));
                let c11 = |change: f64| {
                    let top = Layer::new(body.layers()[0].material(), thickness + change)?
                        .with_interface(body.layers()[0].interface());
                    let rest = body.layers()[1..].iter().cloned();
                    let other = HalfSpace::new(body.substrate(), std::iter::once(top).chain(rest))?;
                    Ok::<_, crate::Error>(surface_compliance(&other, alpha)?.c11)
                };
                // Of fourth order.
                let step = 2e-3 * thickness;
                let quotient =
                    |step: f64| Ok::<_, crate::Error>((c11(step)? - c11(-step)?) / (2.0 * step));
                let due = (4.0 * quotient(step)? - quotient(2.0 * step)?) / 3.0;
                let scale = c11(0.0)?.max(due.abs());
                let rest = 1e-9 + unresolved(&[k]);
                assert!((made - due).abs() < rest * scale, "{k:?}: {made} {due}");
            }
        }
        Ok(())
    }

    /// Plane-strain finite elements, whose meshes err by 8e-6, on the last, short wave by 1e-4: what a load cos kx makes of
    /// cos k'x where the thickness varies as cos.
    #[test]
    fn uneven_wear_agrees_with_finite_elements() -> Result<()> {
        let one = HalfSpace::new(Substrate::Rigid, [layer(3.0, 0.3, 0.5)?])?;
        let two =
            HalfSpace::new(Substrate::Rigid, [layer(3.0, 0.3, 0.5)?, layer(1.0, 0.25, 0.7)?])?;
        for (body, load, thickness, to, due) in [
            (&one, 0, 1, 1, 0.2513688),
            (&one, 2, 3, 5, 0.0987959),
            (&two, 1, 1, 2, -0.0133527),
            (&two, 3, 1, 4, -0.1269828),
        ] {
            for turned in [false, true] {
                let along = |n: i32| if turned { [n, 0] } else { [0, n] };
                let depth = (1.0 - wave(along(thickness))) * 0.1;
                let operator = operator(body, &square()?, depth)?;
                let made = coefficient(&applied(&*operator, &wave(along(load)))?, along(to)) / 0.1;
                assert!((made / due - 1.0).abs() < 1.1e-4, "{load} {thickness}: {made} {due}");
            }
        }
        Ok(())
    }

    /// Oblique waves are those of the closed form, which is one of the angle between them.
    #[test]
    fn oblique_waves_have_the_closed_form() -> Result<()> {
        for body in bodies()? {
            let material = body.layers()[0].material();
            let nu = material.poisson();
            let strain = |k: [i32; 2]| {
                let alpha = f64::from(k[0]).hypot(f64::from(k[1]));
                Ok::<_, crate::Error>((-alpha * surface_compliance(&body, alpha)?.c12, alpha))
            };
            for (k, worn) in
                [([1, 2], [2, 0]), ([3, -1], [1, 4]), ([0, 2], [3, 0]), ([2, 1], [-4, 2])]
            {
                let operator = operator(&body, &square()?, (1.0 - wave(worn)) * 0.1)?;
                let to = [0, 1].map(|n| k[n] + worn[n]);
                let made = coefficient(&applied(&*operator, &wave(k))?, to) / 0.1;
                let ((e, a), (f, b)) = (strain(k)?, strain(to)?);
                let cos = f64::from(k[0] * to[0] + k[1] * to[1]) / (a * b);
                let own = (1.0 - 2.0 * nu) / (2.0 * material.shear() * (1.0 - nu));
                let turned = cos * cos + nu * (1.0 - cos * cos);
                let modulus = material.plane_strain_modulus();
                let due = 0.5 * (own + nu / (1.0 - nu) * (e + f) - modulus * turned * e * f);
                let rest = 1e-12 + unresolved(&[k, to]);
                assert!((made - due).abs() < rest * own, "{k:?} {worn:?}: {made} {due}");
            }
        }
        Ok(())
    }

    /// As matrices, operators are symmetric to rounding on every window, of worn cells inside and outside it; those on windows
    /// are parts of the whole, and entries are those of the matrix.
    #[test]
    fn operators_are_symmetric_matrices() -> Result<()> {
        let body = &bodies()?[0];
        for grid in [
            Grid::new([9, 12], [1.8, 2.0])?,
            Grid::line(14, 2.0)?,
            Grid::new([8, 12], [1.6, 2.0])?.periodic([true; 2])?,
        ] {
            let [nx, ny] = grid.shape();
            let field = |seed: usize| {
                Array2::from_shape_fn((nx, ny), |(i, j)| {
                    ((7 * i + 3 * j + (i + seed) * j * j) % 11) as f64 - 4.0
                })
            };
            let mut depth = field(5).mapv(|d| 0.05 * d.max(0.0));
            depth.slice_axis_mut(Axis(1), Slice::from(..3)).fill(0.0);
            let whole = operator(body, &grid, depth)?;
            let rows = if nx == 1 { 0..1 } else { 2..6 };
            for window in [full_window([nx, ny]), [rows, 1..7]] {
                let part = whole.on_window(&window, &threads()?);
                let [p, q] = [1, 2].map(|seed| block(&field(seed), &window).to_owned());
                let [u, v] = [applied(&*part, &p)?, applied(&*part, &q)?];
                let [one, other] = [(&u * &q).sum(), (&v * &p).sum()];
                assert!((one - other).abs() < 1e-12 * (one.abs() + u.mapv(f64::abs).sum()));
                let mut padded = Array2::zeros((nx, ny));
                for ((i, j), p) in p.indexed_iter() {
                    padded[[window[0].start + i, window[1].start + j]] = *p;
                }
                let all = applied(&*whole, &padded)?;
                let size = u.fold(0.0_f64, |most, u| most.max(u.abs()));
                for ((i, j), u) in u.indexed_iter() {
                    let same = all[[window[0].start + i, window[1].start + j]];
                    assert!((u - same).abs() < 1e-12 * size, "{u} {same}");
                    let entries = p.indexed_iter();
                    let sum: f64 = entries.map(|((k, l), p)| part.entry([i, j], [k, l]) * p).sum();
                    assert!((u - sum).abs() < 1e-11 * size, "{u} {sum}");
                }
            }
        }
        Ok(())
    }

    /// Strains under cells are those of waves: on a rigid base, from which they end some thicknesses away. Cells average their
    /// pressure, by sin(kd/2)/(kd/2) along each side, but where the strain is that of the cell's own pressure. Strains of
    /// single directions err by that and by images of a homogeneous half-space beyond the grid.
    #[test]
    fn strains_under_cells_are_those_of_waves() -> Result<()> {
        let body = &bodies()?[1];
        let material = body.layers()[0].material();
        // Of waves that are far shorter than the layer is thick.
        let local = -(1.0 - 2.0 * material.poisson()) / (2.0 * material.shear());
        let mean = |k: f64, d: f64| if k > 0.0 { (0.5 * k * d).sin() / (0.5 * k * d) } else { 1.0 };
        let line = SurfaceStrain::plan(body, &Grid::line(400, 8.0)?, &threads()?)?;
        let plane = SurfaceStrain::plan(body, &Grid::new([90, 75], [6.3, 6.0])?, &threads()?)?;
        let [dx, dy] = [0.07, 0.08];
        for k in [0.7, 2.0, 5.0] {
            let strain = -k * surface_compliance(body, k)?.c12;
            let sum: f64 = (0..400)
                .map(|j| {
                    let twice = if j == 0 { 1.0 } else { 2.0 };
                    twice * line.entry([0, j])[0] * (k * 0.02 * j as f64).cos()
                })
                .sum();
            let due = local + (strain - local) * mean(k, 0.02);
            assert!((sum - due).abs() < 1e-6 * local.abs(), "{k}: {sum} {due}");
            for [m, n] in [[k, 0.0], [0.6 * k, 0.8 * k]] {
                let mut sums = [0.0; 3];
                for (i, j) in each_cell(&[0..90, 0..75]) {
                    let [x, y] = [m * dx * i as f64, n * dy * j as f64];
                    let twice = [i, j].map(|n| if n == 0 { 1.0 } else { 2.0 });
                    let [xx, xy, yy] = plane.entry([i as isize, j as isize])[..] else {
                        unreachable!("three strains")
                    };
                    let even = twice[0] * twice[1] * x.cos() * y.cos();
                    sums[0] += xx * even;
                    sums[1] -= 4.0 * xy * x.sin() * y.sin();
                    sums[2] += yy * even;
                }
                let due = local + (strain - local) * mean(m, dx) * mean(n, dy);
                let trace = sums[0] + sums[2];
                assert!((trace - due).abs() < 1e-5 * local.abs(), "{m} {n}: {trace} {due}");
                let (c, s) = (m / k, n / k);
                let rough = (0.05 * (k * dy).powi(2) + 1e-3) * strain.abs().max(local.abs());
                for (sum, direction) in sums.into_iter().zip([c * c, c * s, s * s]) {
                    let due = strain * direction;
                    assert!((sum - due).abs() < rough, "{m} {n}: {sum} {due}");
                }
            }
        }
        Ok(())
    }
}
