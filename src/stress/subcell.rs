//! Pressure within the cells of a solved contact, and the stress that it adds: a method of nacre's own.
//!
//! # Idea
//!
//! A solver knows the pressure as one value per cell. Farther than a cell or two from the surface that
//! is enough. Nearer, stresses show the steps between cells, and the staircase that the solver's
//! contact has in place of a smooth edge. But the pressure of a smooth contact is known better than
//! that: where the surfaces part smoothly it falls as p = √d (c0 + c1 d + …) at the distance d from
//! the edge (Johnson, Contact Mechanics (1985), §5.1, doi:10.1017/CBO9781139171731), so that p² is
//! smooth up to the edge, and a polynomial can be continued from the interior to it.
//!
//! # Formulas
//!
//! In a cell, with u and v the distances from its centre along x and y, in cells,
//!
//! ```text
//! interior      p = p_cell + s_x u + s_y v + ½ k_x (u² − 1/12) + ½ k_y (v² − 1/12)
//! edge          p = √max(q(u, v), 0)       q a polynomial of degree 2 or 3, fitted to p²
//! elsewhere     p = p_cell
//! ```
//!
//! Slopes s and curvatures k are differences of the neighbours' pressures. q is fitted by least squares
//! to p² of cells that are three cells from the edge and farther; for Hertz' contact it is exact. The
//! edge is then shifted, by thousandths of a cell, until the cells around bear the force that the
//! solver's cells do.
//!
//! The load of a cell is split into three parts:
//!
//! 1. its mean, and
//! 2. shares ±m/2 of its first moment m on the two neighbours along each axis: both are uniform over
//!    cells, and go into the convolution that is made anyway;
//! 3. the rest, which has neither force nor moment. Its stresses fall off as the fourth power of the
//!    distance. They are summed over three cells to each side, at depths of up to four cells, from the
//!    stresses of small rectangles under uniform pressure.
//!
//! # Gain
//!
//! Below Hertz' point contact of 128 cells to the half-width, stresses one cell deep are within 7e-4 of
//! the peak pressure, and 4e-3 with uniform cells; a tenth of a cell deep, farther than three cells
//! from the edge, 3.3e-4 instead of 2.4e-3 (`tests/stress/edge.rs`). Where the edge is sharp, the
//! contact rough or too small, the pressure stays uniform, and no more than 1e-4 of the peak is lost.
//!
//! # Files
//!
//! | file | what it makes |
//! |---|---|
//! | `neighbours` | neighbourhoods of cells, distances to the edge |
//! | `fit` | a polynomial through values at cell centres, by least squares |
//! | `edge` | the cells near the edge where a polynomial is certain enough |
//! | `cut` | cells cut into rectangles |
//! | `reconstruction` | the pressure of all cells: uniform part, slopes and curvatures, roots |
//! | `margin` | images around the cells of a grid that repeats |
//! | `near` | the sum of the third part over the cells around |
//! | `scale` | whether cells resolve the law of the pressure at an edge |
//! | `uncertainty` | the error that the size of the cells leaves, at a depth |
//! | `within` | the stresses of rectangles in a given body, and the whole for a plan |

mod cut;
mod edge;
mod fit;
mod margin;
mod near;
mod neighbours;
mod reconstruction;
mod scale;
mod uncertainty;
mod within;

pub(super) use near::{NearTable, STRESSES};
pub(super) use scale::Pair;
pub(super) use within::SubcellStress;
