//! Passes over the elements of arrays, four at a time: element by element they would take twice as
//! long. Sums are made in a fixed order.

pub(super) use wide::f64x4 as Lanes;

const LANES: usize = 4;

/// Zero in all lanes.
pub(super) const ZERO: Lanes = Lanes::ZERO;

/// One in all lanes.
pub(super) const ONE: Lanes = Lanes::ONE;

/// The same number in all lanes.
pub(super) fn all(value: f64) -> Lanes {
    Lanes::splat(value)
}

/// `value` where `p` is above 0, and 0 elsewhere, whatever `value` is there.
pub(super) fn where_positive(p: Lanes, value: Lanes) -> Lanes {
    p.simd_gt(ZERO) & value
}

/// `value` where `member` is not 0, and 0 elsewhere, whatever `value` is there.
pub(super) fn where_member(member: Lanes, value: Lanes) -> Lanes {
    member.simd_ne(ZERO) & value
}

/// Σ `term` over the elements of `inputs`, which are equally long.
pub(super) fn sum<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([Lanes; M]) -> [Lanes; N],
) -> [f64; N] {
    let lanes = fold(inputs, |_, sum, value| sum + value, term);
    lanes.map(total)
}

/// The largest of `term` and 0 over the elements of `inputs`, which are equally long.
pub(super) fn largest<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([Lanes; M]) -> [Lanes; N],
) -> [f64; N] {
    // Not max, which looks for NaN: a field with NaN shows in the sums.
    let lanes = fold(inputs, |_, a, b| a.fast_max(b), term);
    lanes.map(top)
}

/// Σ of the last `term`, and the largest of the others and 0.
pub(super) fn largest_and_sum<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([Lanes; M]) -> [Lanes; N],
) -> [f64; N] {
    let join = |k, a: Lanes, b| if k + 1 < N { a.fast_max(b) } else { a + b };
    let lanes = fold(inputs, join, term);
    std::array::from_fn(|k| {
        if k + 1 < N {
            top(lanes[k])
        } else {
            total(lanes[k])
        }
    })
}

/// `join` is told which of the terms it joins.
fn fold<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    join: impl Fn(usize, Lanes, Lanes) -> Lanes,
    term: impl Fn([Lanes; M]) -> [Lanes; N],
) -> [Lanes; N] {
    let mut joined = [ZERO; N];
    let chunks = inputs.map(|input| input.as_chunks::<LANES>().0);
    let count = chunks.iter().map(|chunks| chunks.len()).min();
    for k in 0..count.unwrap_or(0) {
        let values = term(chunks.map(|chunks| Lanes::new(chunks[k])));
        for (k, value) in values.into_iter().enumerate() {
            joined[k] = join(k, joined[k], value);
        }
    }
    let rest = inputs.map(|input| input.as_chunks::<LANES>().1);
    let keep = first(rest.iter().map(|rest| rest.len()).min().unwrap_or(0));
    let values = term(rest.map(padded));
    for (k, value) in values.into_iter().enumerate() {
        joined[k] = join(k, joined[k], keep & value);
    }
    joined
}

/// Replaces the elements of `outputs` by the first of what `step` makes of those of `inputs` and of
/// their own, and sums the second. All are equally long.
pub(super) fn update<const M: usize, const N: usize, const S: usize>(
    inputs: [&[f64]; M],
    mut outputs: [&mut [f64]; N],
    step: impl Fn([Lanes; M], [Lanes; N]) -> ([Lanes; N], [Lanes; S]),
) -> [f64; S] {
    let mut sums = [ZERO; S];
    let from = inputs.map(|input| input.as_chunks::<LANES>().0);
    let mut to = outputs
        .each_mut()
        .map(|output| output.as_chunks_mut::<LANES>().0);
    let ends = from.iter().map(|chunks| chunks.len());
    let count = ends.chain(to.iter().map(|chunks| chunks.len())).min();
    for k in 0..count.unwrap_or(0) {
        let old = to.each_ref().map(|chunks| Lanes::new(chunks[k]));
        let (new, values) = step(from.map(|chunks| Lanes::new(chunks[k])), old);
        for (chunks, new) in to.iter_mut().zip(new) {
            chunks[k] = new.to_array();
        }
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += value;
        }
    }
    let from = inputs.map(|input| input.as_chunks::<LANES>().1);
    let mut to = outputs
        .each_mut()
        .map(|output| output.as_chunks_mut::<LANES>().1);
    let ends = from.iter().map(|rest| rest.len());
    let rest = ends.chain(to.iter().map(|rest| rest.len())).min();
    let old = to.each_ref().map(|rest| padded(rest));
    let (new, values) = step(from.map(padded), old);
    for (rest, new) in to.iter_mut().zip(new) {
        let length = rest.len();
        rest.copy_from_slice(&new.to_array()[..length]);
    }
    let keep = first(rest.unwrap_or(0));
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += keep & value;
    }
    sums.map(total)
}

/// Fewer elements than lanes.
fn padded(rest: &[f64]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes[..rest.len()].copy_from_slice(rest);
    Lanes::new(lanes)
}

/// Keeps so many lanes, and makes the others 0.
fn first(count: usize) -> Lanes {
    let number = Lanes::new([0.0, 1.0, 2.0, 3.0]);
    number.simd_lt(all(count as f64))
}

/// The sum of the lanes, in an order that all machines share.
fn total(lanes: Lanes) -> f64 {
    let [a, b, c, d] = lanes.to_array();
    (a + c) + (b + d)
}

/// The largest of the lanes and 0.
fn top(lanes: Lanes) -> f64 {
    lanes.to_array().into_iter().fold(0.0, f64::max)
}

/// Σ a b
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let [dot] = sum([a, b], |[a, b]| [a * b]);
    dot
}

#[cfg(test)]
mod tests {
    use super::{ONE, all, dot, largest, largest_and_sum, sum, update};

    #[test]
    fn sums_and_largest_of_any_length() {
        for n in 0..40 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let b: Vec<f64> = a.iter().map(|a| 2.0 - a).collect();
            // Integers: every order gives the same sum.
            let expected: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert_eq!(dot(&a, &b).to_bits(), (expected + 0.0).to_bits());
            let [first, second] = sum([&a], |[a]| [a, a * a]);
            assert_eq!(
                first.to_bits(),
                a.iter().fold(0.0, |s: f64, a| s + a).to_bits()
            );
            assert_eq!(
                second.to_bits(),
                a.iter().fold(0.0, |s: f64, a| s + a * a).to_bits()
            );
            let [top] = largest([&a, &b], |[a, b]| [a + all(3.0) * b]);
            let expected = a
                .iter()
                .zip(&b)
                .fold(0.0, |t: f64, (a, b)| t.max(a + 3.0 * b));
            assert_eq!(top.to_bits(), expected.to_bits());
            let both = largest_and_sum([&a, &b], |[a, b]| [a + all(3.0) * b, a * b]);
            assert_eq!(both.map(f64::to_bits), [top, dot(&a, &b)].map(f64::to_bits));
        }
    }

    #[test]
    fn updates_of_any_length() {
        for n in 0..40 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let (mut b, mut c) = (a.clone(), a.clone());
            let sums = update([&a], [&mut b, &mut c], |[a], [b, c]| {
                ([a - all(3.0) * b, c + ONE], [c, a * b])
            });
            for (k, a) in a.iter().enumerate() {
                assert_eq!((b[k] + 2.0 * a).abs().to_bits(), 0);
                assert_eq!((c[k] - a - 1.0).abs().to_bits(), 0);
            }
            assert_eq!(sums[1].to_bits(), dot(&a, &a).to_bits());
            let [first] = sum([&a], |[a]| [a]);
            assert_eq!(sums[0].to_bits(), first.to_bits());
        }
    }
}
