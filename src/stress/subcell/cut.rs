//! Cells cut into rectangles, whose stresses are summed: the nearer the target, the finer the cut.

/// A rectangle in a cell, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// Distance from the cell's centre.
    pub(super) centre: [f64; 2],
    /// Half sides.
    pub(super) half: [f64; 2],
}

impl Piece {
    /// The whole cell.
    pub(super) const CELL: Self = Self { centre: [0.0; 2], half: [0.5; 2] };

    /// Area over the cell's.
    pub(super) fn area(&self) -> f64 {
        4.0 * self.half[0] * self.half[1]
    }

    /// Mean over the piece of the squared distance from the cell's centre along one axis.
    pub(super) fn mean_square(&self, axis: usize) -> f64 {
        self.centre[axis].powi(2) + self.half[axis].powi(2) / 3.0
    }
}

/// A cell cut into pieces.
#[derive(Debug)]
pub(super) struct Cut {
    pub(super) pieces: Vec<Piece>,
    /// Along x and y, 1/12 over the second moment of the pieces' centres: 1 for infinitely many pieces,
    /// 0 along an axis that is not cut.
    pub(super) norms: [f64; 2],
    /// Points along a side of a piece at which a pressure is sampled for the piece's mean.
    pub(super) points: usize,
}

impl Cut {
    fn new(pieces: Vec<Piece>, points: usize) -> Self {
        let norms = [0, 1].map(|axis| {
            let second = |piece: &Piece| piece.area() * piece.centre[axis].powi(2);
            let sum: f64 = pieces.iter().map(second).sum();
            if sum > 0.0 { 1.0 / (12.0 * sum) } else { 0.0 }
        });
        Self { pieces, norms, points }
    }
}

/// How many cuts there are.
pub(super) const CUTS: usize = 3;

/// Cuts of a cell, seen from its own centre, from the cells next to it, and from those farther off.
#[derive(Debug)]
pub(super) struct Cuts([Cut; CUTS]);

impl Cuts {
    /// Side of the smallest pieces, in cells.
    pub(super) const SMALLEST: f64 = 1.0 / 135.0;

    /// Cuts of cells, or of strips along x if `line`. A cell's own cut is 5 × 5, and its inner 3 × 3
    /// are cut by three in each direction, three times over towards the centre. The cut seen from the
    /// cells next to it is 5 × 5, the one seen from farther off 3 × 3.
    pub(super) fn new(line: bool) -> Self {
        let mut own = Vec::new();
        grade(pieces(Piece::CELL, 5, line), 0.2, 3, line, &mut own);
        Self([
            Cut::new(own, 1),
            Cut::new(pieces(Piece::CELL, 5, line), 2),
            Cut::new(pieces(Piece::CELL, 3, line), 2),
        ])
    }

    /// The cut of this number.
    pub(super) fn get(&self, number: usize) -> &Cut {
        &self.0[number]
    }

    /// Number of the cut for a target `offset` cells away, at a depth in cells.
    pub(super) fn seen_from(&self, offset: [isize; 2], depth: f64) -> usize {
        let near = match offset.map(isize::unsigned_abs) {
            [0, 0] => 0,
            [0 | 1, 0 | 1] => 1,
            _ => 2,
        };
        near.max(Self::finest_at(depth))
    }

    /// Number of the finest cut that is used at a depth in cells: what pieces of side s leave out falls
    /// off as e^{−2πz/s}.
    pub(super) fn finest_at(depth: f64) -> usize {
        if depth < 0.4 {
            0
        } else if depth < 0.8 {
            1
        } else {
            2
        }
    }
}

/// `count` × `count` equal pieces of one; of a strip, `count` across.
pub(super) fn pieces(whole: Piece, count: usize, line: bool) -> Vec<Piece> {
    let place = |k: usize| (2 * k + 1) as f64 / count as f64 - 1.0;
    let rows = if line { 1 } else { count };
    let mut pieces = Vec::with_capacity(rows * count);
    for a in 0..rows {
        for b in 0..count {
            let Piece { centre: [u, v], half: [hu, hv] } = whole;
            let across = place(b) * hv;
            let (along, hu) = if line { (0.0, hu) } else { (place(a) * hu, hu / count as f64) };
            pieces.push(Piece { centre: [u + along, v + across], half: [hu, hv / count as f64] });
        }
    }
    pieces
}

/// Cuts the middle one of the `coarse` pieces, of side `side`, and those that touch it, `levels` times.
fn grade(coarse: Vec<Piece>, side: f64, levels: usize, line: bool, graded: &mut Vec<Piece>) {
    if levels == 0 {
        graded.extend(coarse);
        return;
    }
    let inner = |piece: &Piece| {
        let near = |u: f64| u.abs() < 1.5 * side;
        (line || near(piece.centre[0])) && near(piece.centre[1])
    };
    let (middle, outer): (Vec<Piece>, Vec<Piece>) = coarse.into_iter().partition(inner);
    graded.extend(outer);
    let finer = middle.into_iter().flat_map(|piece| pieces(piece, 3, line)).collect();
    grade(finer, side / 3.0, levels - 1, line, graded);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_make_up_the_cell() {
        for line in [false, true] {
            let cuts = Cuts::new(line);
            for cut in &cuts.0 {
                let area: f64 = cut.pieces.iter().map(Piece::area).sum();
                assert!((area - 1.0).abs() < 1e-14);
                for axis in 0..2 {
                    let second = |piece: &Piece| piece.area() * piece.mean_square(axis);
                    let inertia: f64 = cut.pieces.iter().map(second).sum();
                    assert!((inertia - 1.0 / 12.0).abs() < 1e-14);
                }
            }
            // 5 × 5 less 9, four times 81 less 9, and the last 81; in one dimension 5, 9, 9, 9.
            let count = if line { 2 + 6 + 6 + 9 } else { 16 + 72 + 72 + 81 };
            assert_eq!(cuts.0[0].pieces.len(), count);
            let sides = cuts.0[0].pieces.iter().map(|piece| 2.0 * piece.half[1]);
            let smallest = sides.fold(1.0, f64::min);
            assert!((smallest / Cuts::SMALLEST - 1.0).abs() < 1e-14);
        }
    }
}
