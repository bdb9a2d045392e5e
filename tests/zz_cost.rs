use nacre::gradient::*;
use nacre::*;
use std::time::Instant;
#[test]
fn cost() -> Result<()> {
    for part in [0.33, 0.83] {
        let coat = Layer::new(Elastic::new(4.0, 0.3)?, 0.5)?;
        let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?;
        let ball = Paraboloid::new(50.0, 50.0)?;
        // half-width 1 from load by trial
        let mut best = f64::MAX;
        let mut solve = f64::MAX;
        let mut keep = None;
        for _ in 0..5 {
            let t = Instant::now();
            let contact = Contact::plan(
                &body,
                Grid::new([256, 256], [2.0 / part, 2.0 / part])?,
                Setup::default(),
            )?;
            let t1 = Instant::now();
            let s = contact.solve(&ball, &Motion::load(0.053), &Options::default())?;
            best = best.min(t.elapsed().as_secs_f64());
            solve = solve.min(t1.elapsed().as_secs_f64());
            keep = Some(s);
        }
        let s = keep.unwrap();
        println!(
            "part {part}: extent {:?} plan+solve {:.1} ms solve {:.1} ms",
            s.contact_extent()[0],
            1e3 * best,
            1e3 * solve
        );
        let outs = [
            Output::LocatedPeak,
            Output::Approach,
            Output::PressureNorm(8.0),
            Output::ParticipationArea,
            Output::Displacement([0.0, 0.0]),
            Output::Pressure([0.1, 0.1]),
        ];
        for n in [1usize, 6] {
            let mut b = f64::MAX;
            let mut pl = f64::MAX;
            let mut none = f64::MAX;
            for _ in 0..5 {
                let t = Instant::now();
                let plan = Linearisation::plan(&s, Some(&ball), &LinearOptions::default())?;
                pl = pl.min(t.elapsed().as_secs_f64());
                plan.gradients(&outs[..n], None)?;
                b = b.min(t.elapsed().as_secs_f64());
                let t = Instant::now();
                plan.gradients(&outs[..n], Some(&[]))?;
                none = none.min(t.elapsed().as_secs_f64());
            }
            println!(
                "  {n} outputs: {:.1} ms = {:.2} of plan+solve; plan {:.1}, adjoints {:.1}",
                1e3 * b,
                b / best,
                1e3 * pl,
                1e3 * none
            );
        }
    }
    Ok(())
}
