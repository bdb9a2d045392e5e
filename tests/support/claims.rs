//! The figures that README and the page on accuracy publish, with the bars that tests assert: `docs/claims.json`.

use std::collections::HashMap;
use std::io::Write;
use std::sync::LazyLock;

use serde_json::Value;

static BARS: LazyLock<HashMap<String, f64>> = LazyLock::new(|| {
    let rows: Vec<Value> =
        serde_json::from_str(include_str!("../../docs/claims.json")).expect("JSON");
    let bar = |row: &Value| Some((row["name"].as_str()?.to_owned(), row["bar"].as_f64()?));
    rows.iter().filter_map(bar).collect()
});

/// Asserts that an error is below the bar of its claim. With `NACRE_CLAIMS=FILE` the error is appended to the file.
#[track_caller]
pub(crate) fn claim(name: &str, error: f64) {
    if let Some(path) = std::env::var_os("NACRE_CLAIMS") {
        let mut file = std::fs::OpenOptions::new();
        let file = file.create(true).append(true).open(path);
        file.and_then(|mut file| writeln!(file, "{name} {:e}", error.abs()))
            .expect("a file that can be written");
    }
    let bar = BARS.get(name);
    let bar = bar.unwrap_or_else(|| panic!("docs/claims.json has no claim {name}"));
    assert!(error.abs() <= *bar, "{name}: {error:.2e}, the bar is {bar:e}");
}
