//! Elements of arrays, four at a time: element by element, a pass would take twice as long. Sums are made
//! in a fixed order.

pub(crate) use wide::f64x4 as Lanes;

const LANES: usize = 4;

/// Zero in all lanes.
pub(crate) const ZERO: Lanes = Lanes::ZERO;

/// One in all lanes.
pub(crate) const ONE: Lanes = Lanes::ONE;

/// `value` in all lanes.
pub(crate) fn all(value: f64) -> Lanes {
    Lanes::splat(value)
}

/// `value` where `p` is above 0, and 0 elsewhere, even where `value` is not a number.
pub(crate) fn where_positive(p: Lanes, value: Lanes) -> Lanes {
    p.simd_gt(ZERO) & value
}

/// Σ `term` over the elements of `inputs`, which are equally long.
pub(crate) fn sum<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([Lanes; M]) -> [Lanes; N],
) -> [f64; N] {
    update(inputs, [], |values, []| ([], term(values)))
}

/// Calls `step` with the elements of `inputs` and of `outputs`, which are equally long. It returns the new
/// elements of `outputs`, and terms that are summed.
pub(crate) fn update<const M: usize, const N: usize, const S: usize>(
    inputs: [&[f64]; M],
    outputs: [&mut [f64]; N],
    step: impl Fn([Lanes; M], [Lanes; N]) -> ([Lanes; N], [Lanes; S]),
) -> [f64; S] {
    let ([], sums) = update_with_largest(inputs, outputs, |from, old| {
        let (new, values) = step(from, old);
        (new, [], values)
    });
    sums
}

/// [`update`] where `step` also returns, before the terms, values of which the largest is found; it is at
/// least 0.
pub(crate) fn update_with_largest<
    const M: usize,
    const N: usize,
    const L: usize,
    const S: usize,
>(
    inputs: [&[f64]; M],
    mut outputs: [&mut [f64]; N],
    step: impl Fn([Lanes; M], [Lanes; N]) -> ([Lanes; N], [Lanes; L], [Lanes; S]),
) -> ([f64; L], [f64; S]) {
    let (mut largest, mut sums) = ([ZERO; L], [ZERO; S]);
    let from = inputs.map(|input| input.as_chunks::<LANES>().0);
    let mut to = outputs.each_mut().map(|output| output.as_chunks_mut::<LANES>().0);
    let ends = from.iter().map(|chunks| chunks.len());
    let count = ends.chain(to.iter().map(|chunks| chunks.len())).min();
    for k in 0..count.unwrap_or(0) {
        let old = to.each_ref().map(|chunks| Lanes::new(chunks[k]));
        let (new, tops, values) = step(from.map(|chunks| Lanes::new(chunks[k])), old);
        for (chunks, new) in to.iter_mut().zip(new) {
            chunks[k] = new.to_array();
        }
        // `max` would look for NaN, which a field with NaN shows in its sums anyway.
        for (largest, value) in largest.iter_mut().zip(tops) {
            *largest = largest.fast_max(value);
        }
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += value;
        }
    }
    let from = inputs.map(|input| input.as_chunks::<LANES>().1);
    let mut to = outputs.each_mut().map(|output| output.as_chunks_mut::<LANES>().1);
    let ends = from.iter().map(|rest| rest.len());
    let rest = ends.chain(to.iter().map(|rest| rest.len())).min();
    let old = to.each_ref().map(|rest| padded(rest));
    let (new, tops, values) = step(from.map(padded), old);
    for (rest, new) in to.iter_mut().zip(new) {
        let length = rest.len();
        rest.copy_from_slice(&new.to_array()[..length]);
    }
    let keep = first(rest.unwrap_or(0));
    for (largest, value) in largest.iter_mut().zip(tops) {
        *largest = largest.fast_max(keep & value);
    }
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += keep & value;
    }
    (largest.map(top), sums.map(total))
}

/// The last elements, fewer than lanes; 0 in the lanes that are left.
fn padded(rest: &[f64]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes[..rest.len()].copy_from_slice(rest);
    Lanes::new(lanes)
}

/// A mask of the first `count` lanes.
fn first(count: usize) -> Lanes {
    let number = Lanes::new([0.0, 1.0, 2.0, 3.0]);
    number.simd_lt(all(count as f64))
}

/// The sum of the lanes, in an order that all machines share.
fn total(lanes: Lanes) -> f64 {
    let [a, b, c, d] = lanes.to_array();
    (a + c) + (b + d)
}

/// The largest lane, or 0 where all are negative.
fn top(lanes: Lanes) -> f64 {
    lanes.to_array().into_iter().fold(0.0, f64::max)
}

/// The sum Σ a b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let [dot] = sum([a, b], |[a, b]| [a * b]);
    dot
}

#[cfg(test)]
mod tests {
    use super::{ONE, all, dot, sum, update, update_with_largest};

    #[test]
    fn sums_and_largest_of_any_length() {
        for n in 0..40 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let b: Vec<f64> = a.iter().map(|a| 2.0 - a).collect();
            // Integers: every order gives the same sum.
            let expected: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert_eq!(dot(&a, &b).to_bits(), (expected + 0.0).to_bits());
            let [first, second] = sum([&a], |[a]| [a, a * a]);
            assert_eq!(first.to_bits(), a.iter().fold(0.0, |s: f64, a| s + a).to_bits());
            assert_eq!(second.to_bits(), a.iter().fold(0.0, |s: f64, a| s + a * a).to_bits());
            let ([top], [product]) =
                update_with_largest([&a, &b], [], |[a, b], []| ([], [a + all(3.0) * b], [a * b]));
            let expected = a.iter().zip(&b).fold(0.0, |t: f64, (a, b)| t.max(a + 3.0 * b));
            assert_eq!(top.to_bits(), expected.to_bits());
            assert_eq!(product.to_bits(), dot(&a, &b).to_bits());
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
