//! How a cell is cut into rectangles, to be seen from the centre of another or from its own.

/// A rectangle in a cell: its centre, from that of the cell, and half sides, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

impl Piece {
    /// All of the cell.
    pub(super) const WHOLE: Self = Self {
        centre: [0.0; 2],
        half: [0.5; 2],
    };

    /// Part of the cell that it covers.
    pub(super) fn area(&self) -> f64 {
        4.0 * self.half[0] * self.half[1]
    }

    /// Mean of the squared distance from the cell's centre along one axis.
    pub(super) fn mean_square(&self, axis: usize) -> f64 {
        self.centre[axis].powi(2) + self.half[axis].powi(2) / 3.0
    }
}

/// The cuts that are used, the finer the nearer.
#[derive(Debug)]
pub(super) struct Cuts {
    /// That of a target's own cell: 5 × 5, of which the inner 3 × 3 are cut by three in each
    /// direction, and again, and again, towards the centre. That of the cells next to it: 5 × 5.
    /// That of cells farther off: 3 × 3.
    pub(super) all: [Vec<Piece>; 3],
    /// 1/12 over the second moments of the pieces' centres, along x and y.
    pub(super) norms: [[f64; 2]; 3],
}

impl Cuts {
    /// Of cells, or of strips along x.
    pub(super) fn new(line: bool) -> Self {
        let mut own = Vec::new();
        grade(pieces(Piece::WHOLE, 5, line), 0.2, 3, line, &mut own);
        let all = [
            own,
            pieces(Piece::WHOLE, 5, line),
            pieces(Piece::WHOLE, 3, line),
        ];
        let norms = all.each_ref().map(|pieces| {
            [0, 1].map(|axis| {
                let second = |piece: &Piece| piece.area() * piece.centre[axis].powi(2);
                let sum: f64 = pieces.iter().map(second).sum();
                if sum > 0.0 { 1.0 / (12.0 * sum) } else { 0.0 }
            })
        });
        Self { all, norms }
    }

    /// Which one a target sees that is so many cells off, at a depth in cells: what is left out of
    /// pieces of side s falls off as e^{−2πz/s}.
    pub(super) fn seen_from(&self, offset: [isize; 2], depth: f64) -> usize {
        let near = match offset.map(isize::unsigned_abs) {
            [0, 0] => 0,
            [0 | 1, 0 | 1] => 1,
            _ => 2,
        };
        near.max(Self::finest(depth))
    }

    /// The first cut that is used at a depth.
    pub(super) fn finest(depth: f64) -> usize {
        if depth < 0.4 {
            0
        } else if depth < 0.8 {
            1
        } else {
            2
        }
    }
}

/// `count` × `count` equal pieces of one.
pub(super) fn pieces(whole: Piece, count: usize, line: bool) -> Vec<Piece> {
    let place = |k: usize| (2 * k + 1) as f64 / count as f64 - 1.0;
    let rows = if line { 1 } else { count };
    let mut pieces = Vec::with_capacity(rows * count);
    for a in 0..rows {
        for b in 0..count {
            let Piece {
                centre: [u, v],
                half: [hu, hv],
            } = whole;
            let across = place(b) * hv;
            let (along, hu) = if line {
                (0.0, hu)
            } else {
                (place(a) * hu, hu / count as f64)
            };
            pieces.push(Piece {
                centre: [u + along, v + across],
                half: [hu, hv / count as f64],
            });
        }
    }
    pieces
}

/// Cuts those of `pieces`, of side `side`, that touch the middle one, `levels` times.
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
    let finer = middle
        .into_iter()
        .flat_map(|piece| pieces(piece, 3, line))
        .collect();
    grade(finer, side / 3.0, levels - 1, line, graded);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_make_up_the_cell() {
        for line in [false, true] {
            let cuts = Cuts::new(line);
            for pieces in &cuts.all {
                let area: f64 = pieces.iter().map(Piece::area).sum();
                assert!((area - 1.0).abs() < 1e-14);
                for axis in 0..2 {
                    let second = |piece: &Piece| piece.area() * piece.mean_square(axis);
                    let inertia: f64 = pieces.iter().map(second).sum();
                    assert!((inertia - 1.0 / 12.0).abs() < 1e-14);
                }
            }
            // 5 × 5 less 9, four times 81 less 9, and the last 81; in one dimension 5, 9, 9, 9.
            let count = if line {
                2 + 6 + 6 + 9
            } else {
                16 + 72 + 72 + 81
            };
            assert_eq!(cuts.all[0].len(), count);
        }
    }
}
