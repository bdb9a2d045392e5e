//! Where a load point may lie: the convex hull of the cells that can touch.

use ndarray::ArrayRef2;

/// First and last cell of finite gap in each row, as scaled coordinates.
pub(crate) fn outline(gap: &ArrayRef2<f64>, [x, y]: &[Vec<f64>; 2]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for (row, &x) in gap.rows().into_iter().zip(x) {
        let touches = |h: &f64| h.is_finite();
        let (Some(first), Some(last)) =
            (row.iter().position(touches), row.iter().rposition(touches))
        else {
            continue;
        };
        points.push([x, y[first]]);
        if last > first {
            points.push([x, y[last]]);
        }
    }
    points
}

/// The interval's inside as s · v > c, from both ends.
pub(crate) fn interval(values: impl Iterator<Item = f64>) -> [(f64, f64); 2] {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
        (a.min(v), b.max(v))
    });
    [(1.0, low), (-1.0, -high)]
}

/// The inside of the convex hull as n · v > c for each edge; none where the hull has no inside.
/// Points come in order of x, then y. Andrew, Inf. Process. Lett. 9 (1979) 216.
pub(crate) fn hull_half_planes(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                if turn(a, b, point) > 1e-14 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain
    };
    let lower = chain(&mut points.iter().copied());
    let upper = chain(&mut points.iter().rev().copied());
    if lower.len() + upper.len() < 5 {
        return Vec::new();
    }
    lower
        .windows(2)
        .chain(upper.windows(2))
        .map(|edge| {
            // Counter-clockwise: the inside is to the left.
            let [a, b] = [edge[0], edge[1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let n = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
            [n[0], n[1], n[0] * a[0] + n[1] * a[1]]
        })
        .collect()
}
