//! Random cases of proptest that are equal in every run.

use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Configuration of proptest for this number of cases.
pub(crate) fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    }
}
