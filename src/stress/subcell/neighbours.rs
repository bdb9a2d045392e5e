//! Neighbourhoods of cells on the grid, and distances from the edge of the contact.

/// Cells of the grid within `reach` rows and columns of a cell, itself included.
pub(super) fn around(
    [nx, ny]: [usize; 2],
    [i, j]: [usize; 2],
    reach: usize,
) -> impl Iterator<Item = [usize; 2]> {
    let rows = i.saturating_sub(reach)..(i + reach + 1).min(nx);
    rows.flat_map(move |i| (j.saturating_sub(reach)..(j + reach + 1).min(ny)).map(move |j| [i, j]))
}

/// Whether a cell is at the border of the grid; a row of line contact is endless and has none.
pub(super) fn is_at_border([nx, ny]: [usize; 2], [i, j]: [usize; 2]) -> bool {
    let ends = |at: usize, count: usize| at == 0 || at + 1 == count;
    ends(j, ny) || nx > 1 && ends(i, nx)
}

/// Distance in cells of each cell from the nearest without pressure, a diagonal step counting as one;
/// at most `limit`. Beyond the grid there is no pressure; a row of line contact is endless.
pub(super) fn edge_distances(pressure: &[f64], [nx, ny]: [usize; 2], limit: u8) -> Vec<u8> {
    let mut distances: Vec<u8> = pressure.iter().map(|p| u8::from(*p > 0.0)).collect();
    for level in 1..limit {
        let before = distances.clone();
        let inside = |i: isize, j: isize| {
            let row = nx == 1 || (0..nx as isize).contains(&i);
            let column = (0..ny as isize).contains(&j);
            let i = if nx == 1 { 0 } else { i };
            row && column && before[i as usize * ny + j as usize] >= level
        };
        for (cell, distance) in distances.iter_mut().enumerate() {
            if *distance == level {
                let (i, j) = ((cell / ny) as isize, (cell % ny) as isize);
                let all = (-1..=1).all(|a| (-1..=1).all(|b| inside(i + a, j + b)));
                *distance += u8::from(all);
            }
        }
    }
    distances
}

/// Sums of a field over rectangles of cells, from its sums over all rectangles that begin at the first
/// cell.
pub(super) struct RectangleSums {
    shape: [usize; 2],
    sums: Vec<f64>,
}

impl RectangleSums {
    pub(super) fn new(values: &[f64], shape @ [nx, ny]: [usize; 2]) -> Self {
        let width = ny + 1;
        let mut sums = vec![0.0; (nx + 1) * width];
        for i in 0..nx {
            let mut row = 0.0;
            for j in 0..ny {
                row += values[i * ny + j];
                sums[(i + 1) * width + j + 1] = sums[i * width + j + 1] + row;
            }
        }
        Self { shape, sums }
    }

    /// Sum over the cells of [`around`].
    pub(super) fn around(&self, [i, j]: [usize; 2], reach: usize) -> f64 {
        let [nx, ny] = self.shape;
        let at = |i: usize, j: usize| self.sums[i * (ny + 1) + j];
        let (top, left) = (i.saturating_sub(reach), j.saturating_sub(reach));
        let (bottom, right) = ((i + reach + 1).min(nx), (j + reach + 1).min(ny));
        at(bottom, right) - at(top, right) - at(bottom, left) + at(top, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_rectangles_are_those_of_their_cells() {
        let shape @ [nx, ny] = [5, 7];
        let values: Vec<f64> = (0..nx * ny).map(|k| (k * k % 11) as f64).collect();
        let sums = RectangleSums::new(&values, shape);
        for cell in around(shape, [0, 0], 7) {
            for reach in [0, 1, 3] {
                let direct: f64 = around(shape, cell, reach)
                    .map(|[i, j]| values[i * ny + j])
                    .sum();
                // Small whole numbers are summed exactly.
                assert!((sums.around(cell, reach) - direct).abs() < f64::EPSILON);
            }
        }
    }

    /// A contact of 5 × 6 cells, which the grid's border cuts; in line contact, of 6 cells.
    #[test]
    fn distances_are_counted_from_the_edge_and_the_border() {
        let (nx, ny) = (5, 8);
        let pressure: Vec<f64> = (0..nx * ny)
            .map(|k| f64::from(u8::from((1..7).contains(&(k % ny)))))
            .collect();
        let distances = edge_distances(&pressure, [nx, ny], 4);
        assert_eq!(distances[..ny], [0, 1, 1, 1, 1, 1, 1, 0]);
        assert_eq!(distances[2 * ny..3 * ny], [0, 1, 2, 3, 3, 2, 1, 0]);
        let line = edge_distances(&pressure[..ny], [1, ny], 3);
        assert_eq!(line, [0, 1, 2, 3, 3, 2, 1, 0]);
        assert!(is_at_border([1, ny], [0, 0]) && !is_at_border([1, ny], [0, 3]));
    }
}
