//! What programs may rely on of Rust's interface: values that threads share.

use nacre::friction::FrictionSolution;
use nacre::indent::Indent;
use nacre::{Body, Case, Contact, Convolution, HeightMap, Options, Report, Setup, Solution};
use nacre::{Stress, StressPlan};

const fn is_shared<T: Send + Sync>() {}

/// Plans and solutions go to other threads, and threads share them: this compiles.
const _: () = {
    is_shared::<Contact>();
    is_shared::<Convolution>();
    is_shared::<StressPlan>();
    is_shared::<Indent>();
    is_shared::<Solution>();
    is_shared::<FrictionSolution>();
    is_shared::<Stress>();
    is_shared::<Report>();
    is_shared::<Body>();
    is_shared::<HeightMap>();
    is_shared::<Case<'_>>();
    is_shared::<(Setup, Options)>();
};
