//! Wear: waves, the limit of fretting, steps and their control, layers that get thinner and are worn through.

#[macro_use]
#[path = "support/root.rs"]
#[expect(dead_code, reason = "no binary uses all of it")]
mod support;

mod wear {
    mod fretting;
    mod histories;
    mod thickness;
    mod waves;
}
