//! Work on many cells: threads, rows, lanes, and the memory that the work needs.
//!
//! Nothing here knows what is computed. Sums are made in an order that does not depend on the number of
//! threads.

mod lanes;
mod memory;
mod pool;
mod rows;
mod threads;

pub(crate) use lanes::{
    Lanes, ONE, ZERO, all, dot, sum, update, update_with_largest, where_positive,
};
pub(crate) use memory::check_memory;
pub(crate) use pool::{Lease, Pool};
pub(crate) use rows::{Row, Rows, Total, Written};
pub(crate) use threads::{LEAF, SetOnDrop, Threads, each_chunk, each_row, join, number};
