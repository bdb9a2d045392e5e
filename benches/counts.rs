//! Work of a dozen small problems, one in each call: `counts CASE [prepare]`. `benches/counts.py` runs it under Valgrind,
//! once with `prepare`, which stops before the work that counts, and once without.
//!
//! Prints the convolutions of the work, and nothing where it has no such number. Without a case it lists them. All run on
//! one thread.

use std::ops::ControlFlow;
use std::sync::Arc;

use nacre::friction::{FrictionOptions, Rolling, RollingDirection, Step};
use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::indent::{Indent, IndentParameter, Stack, Tip};
use nacre::stress::Strengths;
use nacre::wear::{Wear, WearSession, WearSteps};
use nacre::{
    BodyParameter, Contact, Cylinder, Elastic, Grid, HalfSpace, HeightMap, Layer, Member, Motion,
    Options, Paraboloid, Result, Setup, Solution, StressOptions, Surface,
};
use ndarray::Array2;

/// Work that is prepared, and returns its convolutions.
type Work = Box<dyn FnOnce() -> Result<Option<f64>>>;

/// A case by its name, and what prepares it.
type Case = (&'static str, fn() -> Result<Work>);

const CASES: [Case; 16] = [
    ("plan/bare", || plan(false)),
    ("plan/coated", || plan(true)),
    ("solve/bare", || solve(ball(false, 128)?)),
    ("solve/coated", || solve(ball(true, 128)?)),
    ("solve/line", || solve(line()?)),
    ("solve/roller_ends", || solve(roller()?)),
    ("solve/rough_periodic", || solve(rough()?)),
    ("stress/bare", || stress(ball(false, 64)?, 0.0)),
    ("stress/coated_friction", || stress(ball(true, 32)?, FRICTION)),
    ("stress/line", || stress(line()?, FRICTION)),
    ("slide/equal", || slide(Some(body(true)?))),
    ("slide/rigid", || slide(None)),
    ("roll/equal", roll),
    ("wear/coated", wear),
    ("gradient/coated", gradient),
    ("indent/coated", indent),
];

/// Lengths are in radii of the bare contact of the ball, of radius [`RADIUS`], under the load [`LOAD`]; E* is 1.
const RADIUS: f64 = 50.0;
const LOAD: f64 = 4.0 / 3.0 / RADIUS;
const FRICTION: f64 = 0.3;

/// A problem that is planned.
struct Planned {
    contact: Contact,
    shape: Box<dyn Surface>,
    motion: Motion,
}

impl Planned {
    fn solve(&self) -> Result<Solution> {
        let solution = self.contact.solve(&*self.shape, &self.motion, &Options::default())?;
        solution.require_converged(1e-8)
    }
}

/// A body of E* = 1, bare or with a layer of four times the modulus and 0.3 thick.
fn body(coated: bool) -> Result<HalfSpace> {
    let layer = Layer::new(Elastic::new(4.0 * 0.91, 0.3)?, 0.3)?;
    HalfSpace::new(Elastic::new(0.91, 0.3)?, coated.then_some(layer))
}

fn one_thread() -> Setup {
    Setup::default().with_threads(1)
}

fn ball(coated: bool, cells: usize) -> Result<Planned> {
    let grid = Grid::new([cells, cells], [3.0, 3.0])?;
    Ok(Planned {
        contact: Contact::plan(&body(coated)?, grid, one_thread())?,
        shape: Box::new(Paraboloid::new(RADIUS, RADIUS)?),
        motion: Motion::load(LOAD),
    })
}

fn line() -> Result<Planned> {
    Ok(Planned {
        contact: Contact::plan(&body(true)?, Grid::line(256, 3.0)?, one_thread())?,
        shape: Box::new(Cylinder::new(RADIUS)?),
        motion: Motion::load(std::f64::consts::PI / 4.0 / RADIUS),
    })
}

/// A straight roller of eight radii with free ends, on a race.
fn roller() -> Result<Planned> {
    let with_ends = body(false)?.with_ends([Some(-4.0), Some(4.0)])?;
    let setup = one_thread().with_counterbody(with_ends);
    Ok(Planned {
        contact: Contact::plan(&body(false)?, Grid::new([96, 48], [8.0, 4.0])?, setup)?,
        shape: Box::new(Cylinder::new(RADIUS)?),
        motion: Motion::load(8.0 * std::f64::consts::PI / 4.0 / RADIUS),
    })
}

/// A period of white noise between −2e-3 and 2e-3, by a linear congruence, under half of the pressure that closes it.
fn rough() -> Result<Planned> {
    const CELLS: usize = 64;
    let mut state = 1_u32;
    let heights = Array2::from_shape_simple_fn((CELLS, CELLS), || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        2e-3 * (f64::from(state >> 8) / f64::from(1_u32 << 23) - 1.0)
    });
    let grid = Grid::new([CELLS, CELLS], [1.0, 1.0])?.periodic([true, true])?;
    let shape = HeightMap::new(heights, [1.0 / CELLS as f64; 2])?.periodic([true, true])?;
    Ok(Planned {
        contact: Contact::plan(&body(true)?, grid, one_thread())?,
        shape: Box::new(shape),
        motion: Motion::load(LOAD),
    })
}

fn plan(coated: bool) -> Result<Work> {
    Ok(Box::new(move || ball(coated, 128).map(|_| None)))
}

fn solve(planned: Planned) -> Result<Work> {
    Ok(Box::new(move || Ok(Some(planned.solve()?.report.convolutions))))
}

fn stress(planned: Planned, friction: f64) -> Result<Work> {
    let solution = planned.solve()?;
    let options = StressOptions::default().with_threads(1).with_friction(friction);
    let options = options.with_direction([0.0, 1.0]);
    Ok(Box::new(move || {
        solution.stress_summary(Member::Body, &Strengths::default(), &options).map(|_| None)
    }))
}

/// A contact of 64² cells for friction and wear, with its ball.
fn pair(counterbody: Option<HalfSpace>) -> Result<(Contact, Paraboloid)> {
    let setup = counterbody.map_or_else(one_thread, |body| one_thread().with_counterbody(body));
    let contact = Contact::plan(&body(true)?, Grid::new([64, 64], [3.6, 3.6])?, setup)?;
    Ok((contact, Paraboloid::new(RADIUS, RADIUS)?))
}

fn to_a_millionth() -> FrictionOptions {
    FrictionOptions::default().with_tolerance(1e-6)
}

fn slide(counterbody: Option<HalfSpace>) -> Result<Work> {
    let (contact, ball) = pair(counterbody)?;
    let press = Step::press(Motion::load(LOAD), FRICTION);
    let push = |share: f64| press.clone().with_force([Some(share * FRICTION * LOAD), None]);
    let steps = [push(0.5), push(0.875), push(-0.25)];
    Ok(Box::new(move || {
        let solutions = contact.slide(&ball, &steps, &to_a_millionth(), None)?;
        let reports = || solutions.iter().map(|solution| &solution.report);
        assert!(reports().all(|report| report.converged()));
        Ok(Some(reports().map(|report| report.convolutions as f64).sum()))
    }))
}

fn roll() -> Result<Work> {
    let (contact, ball) = pair(Some(body(true)?))?;
    let rolling = Rolling::new(Motion::load(LOAD), FRICTION, RollingDirection::PlusX)
        .with_creepage([Some(0.5 * FRICTION * LOAD), None])
        .with_spin(0.5 * FRICTION * LOAD);
    Ok(Box::new(move || {
        let report = contact.roll(&ball, &rolling, &to_a_millionth())?.report;
        assert!(report.converged());
        Ok(Some(report.convolutions as f64))
    }))
}

/// Five steps, until the contact is some tenth wider.
fn wear() -> Result<Work> {
    const STEPS: u32 = 5;
    let (contact, ball) = pair(None)?;
    // Twice the volume of the cap over the contact.
    let distance = 2.0 * std::f64::consts::PI / (4.0 * RADIUS) / LOAD;
    let ends = (1..=STEPS).map(|k| distance * f64::from(k) / f64::from(STEPS)).collect();
    let wear =
        Wear::sliding([vec![1.0, 1.0], vec![0.0]], distance).with_steps(WearSteps::Ends(ends));
    let mut session = WearSession::new(Arc::new(contact), ball, Motion::load(LOAD), wear, false)?;
    Ok(Box::new(move || {
        let mut convolutions = 0.0;
        while let Some(state) = session.advance(&mut |_| ControlFlow::Continue(()))? {
            convolutions += state.solution.report.convolutions;
        }
        Ok(Some(convolutions))
    }))
}

fn gradient() -> Result<Work> {
    let planned = ball(true, 64)?;
    let solution = planned.solve()?;
    Ok(Box::new(move || {
        let outputs = [Output::LocatedPeak, Output::Approach, Output::ParticipationArea];
        let options = LinearOptions::default();
        let linear = Linearisation::plan(&solution, Some(&*planned.shape), &options)?;
        linear.gradients(&outputs, None).map(|_| None)
    }))
}

/// A plan, and a curve of ten points with two derivatives.
fn indent() -> Result<Work> {
    let body = body(true)?.into();
    Ok(Box::new(move || {
        let indent = Indent::new(&Stack::plan(&[body])?, &Tip::paraboloid(RADIUS)?);
        let deepest = indent.at_load(LOAD)?.approach;
        let approaches: Vec<f64> = (1..=10).map(|k| deepest * f64::from(k) / 10.0).collect();
        let parameters = [
            IndentParameter::Body(0, BodyParameter::Young(0)),
            IndentParameter::Body(0, BodyParameter::Thickness(0)),
        ];
        indent.curve(&approaches, &parameters).map(|_| None)
    }))
}

/// The processor and those of its features that transforms look for, as it shows them to this program.
fn processor() -> String {
    let mut words = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    words.extend(
        [
            ("sse4.1", is_x86_feature_detected!("sse4.1")),
            ("avx", is_x86_feature_detected!("avx")),
            ("avx2", is_x86_feature_detected!("avx2")),
            ("fma", is_x86_feature_detected!("fma")),
            ("avx512f", is_x86_feature_detected!("avx512f")),
        ]
        .into_iter()
        .filter_map(|(name, has)| has.then_some(name)),
    );
    words.join(" ")
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (name, only_prepares) = match words[..] {
        ["processor"] => {
            println!("{}", processor());
            return Ok(());
        }
        [name, "prepare"] => (name, true),
        [name] if !name.starts_with("--") => (name, false),
        // Nothing, or what `cargo bench` adds.
        _ => {
            CASES.iter().for_each(|(name, _)| println!("{name}"));
            return Ok(());
        }
    };
    let (_, prepare) = CASES.iter().find(|case| case.0 == name).expect("a case by its name");
    let work = prepare()?;
    if !only_prepares && let Some(convolutions) = work()? {
        println!("{convolutions}");
    }
    Ok(())
}
