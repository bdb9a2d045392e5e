//! Sums in a fixed order, eight at a time: one after the other they would take longer than what they
//! add up.

const LANES: usize = 8;

/// Σ `term` over the elements of `inputs`, which are equally long.
pub(super) fn sum<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([f64; M]) -> [f64; N],
) -> [f64; N] {
    fold(inputs, [0.0; N], |sum, value| sum + value, term)
}

/// The largest of `term` and 0 over the elements of `inputs`, which are equally long.
pub(super) fn largest<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    term: impl Fn([f64; M]) -> [f64; N],
) -> [f64; N] {
    // Not f64::max, which looks for NaN: there are none.
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    fold(inputs, [0.0; N], larger, term)
}

fn fold<const M: usize, const N: usize>(
    inputs: [&[f64]; M],
    start: [f64; N],
    join: impl Fn(f64, f64) -> f64,
    term: impl Fn([f64; M]) -> [f64; N],
) -> [f64; N] {
    let mut lanes = start.map(|start| [start; LANES]);
    let parts = inputs.map(|input| input.as_chunks::<LANES>());
    let count = parts.iter().map(|(chunks, _)| chunks.len()).min();
    for chunk in 0..count.unwrap_or(0) {
        let block = parts.map(|(chunks, _)| chunks[chunk]);
        for lane in 0..LANES {
            let values = term(block.map(|block| block[lane]));
            for (lanes, value) in lanes.iter_mut().zip(values) {
                lanes[lane] = join(lanes[lane], value);
            }
        }
    }
    let rest = parts.iter().map(|(_, rest)| rest.len()).min();
    for lane in 0..rest.unwrap_or(0) {
        let values = term(parts.map(|(_, rest)| rest[lane]));
        for (lanes, value) in lanes.iter_mut().zip(values) {
            lanes[lane] = join(lanes[lane], value);
        }
    }
    lanes.map(|lanes| joined(lanes, &join))
}

fn joined(l: [f64; LANES], join: impl Fn(f64, f64) -> f64) -> f64 {
    let even = join(join(l[0], l[4]), join(l[2], l[6]));
    join(even, join(join(l[1], l[5]), join(l[3], l[7])))
}

/// Replaces the elements of `outputs` by the first of what `step` makes of those of `inputs` and of
/// their own, and sums the second. All are equally long.
pub(super) fn update<const M: usize, const N: usize, const S: usize>(
    inputs: [&[f64]; M],
    mut outputs: [&mut [f64]; N],
    step: impl Fn([f64; M], [f64; N]) -> ([f64; N], [f64; S]),
) -> [f64; S] {
    let mut lanes = [[0.0; LANES]; S];
    let from = inputs.map(|input| input.as_chunks::<LANES>().0);
    let mut to = outputs
        .each_mut()
        .map(|output| output.as_chunks_mut::<LANES>().0);
    let ends = from.iter().map(|chunks| chunks.len());
    let count = ends.chain(to.iter().map(|chunks| chunks.len())).min();
    for chunk in 0..count.unwrap_or(0) {
        let read = from.map(|chunks| chunks[chunk]);
        let mut block = to.each_ref().map(|chunks| chunks[chunk]);
        for lane in 0..LANES {
            let (new, values) = step(
                read.map(|read| read[lane]),
                block.each_ref().map(|block| block[lane]),
            );
            for (block, new) in block.iter_mut().zip(new) {
                block[lane] = new;
            }
            for (lanes, value) in lanes.iter_mut().zip(values) {
                lanes[lane] += value;
            }
        }
        for (chunks, block) in to.iter_mut().zip(block) {
            chunks[chunk] = block;
        }
    }
    let from = inputs.map(|input| input.as_chunks::<LANES>().1);
    let mut to = outputs
        .each_mut()
        .map(|output| output.as_chunks_mut::<LANES>().1);
    let ends = from.iter().map(|rest| rest.len());
    let rest = ends.chain(to.iter().map(|rest| rest.len())).min();
    for lane in 0..rest.unwrap_or(0) {
        let old = to.each_ref().map(|rest| rest[lane]);
        let (new, values) = step(from.map(|rest| rest[lane]), old);
        for (rest, new) in to.iter_mut().zip(new) {
            rest[lane] = new;
        }
        for (lanes, value) in lanes.iter_mut().zip(values) {
            lanes[lane] += value;
        }
    }
    lanes.map(|lanes| joined(lanes, |a, b| a + b))
}

/// Σ a b
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let [dot] = sum([a, b], |[a, b]| [a * b]);
    dot
}

#[cfg(test)]
mod tests {
    use super::{dot, largest, sum, update};

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
            let [top] = largest([&a, &b], |[a, b]| [a + 3.0 * b]);
            let expected = a
                .iter()
                .zip(&b)
                .fold(0.0, |t: f64, (a, b)| t.max(a + 3.0 * b));
            assert_eq!(top.to_bits(), expected.to_bits());
        }
    }

    #[test]
    fn updates_of_any_length() {
        for n in 0..40 {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let (mut b, mut c) = (a.clone(), a.clone());
            let sums = update([&a], [&mut b, &mut c], |[a], [b, c]| {
                ([a - 3.0 * b, c + 1.0], [c, a * b])
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
