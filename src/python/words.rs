//! Words of Python and the values that they stand for, both ways.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::compliance::influence::Method;
use crate::contact::{Algorithm, Solver, Termination, Warning};
use crate::model::body::Interface;
use crate::stress::{Member, Side};

/// A value that Python names by a word.
pub(super) trait Word: Copy + 'static {
    /// Name of the argument that takes the word.
    const ARGUMENT: &'static str;
    /// Every value, in the order in which messages list the words.
    const VALUES: &'static [Self];

    /// Word for the value.
    fn word(self) -> &'static str;

    /// Value for a word.
    fn from_word(word: &str) -> PyResult<Self> {
        let found = Self::VALUES.iter().find(|value| value.word() == word);
        found.copied().ok_or_else(|| {
            let words: Vec<_> = Self::VALUES.iter().map(|value| value.word()).collect();
            unknown(Self::ARGUMENT, &words, word)
        })
    }
}

/// `ValueError` for a word that is none of `words`.
fn unknown(argument: &str, words: &[&str], got: &str) -> PyErr {
    let quoted: Vec<_> = words.iter().map(|word| format!("{word:?}")).collect();
    let listed = match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => quoted.concat(),
    };
    PyValueError::new_err(format!("{argument} must be {listed}, got {got:?}"))
}

impl Word for Interface {
    const ARGUMENT: &'static str = "interface";
    const VALUES: &'static [Self] = &[Self::Bonded, Self::Frictionless];

    fn word(self) -> &'static str {
        match self {
            Self::Bonded => "bonded",
            Self::Frictionless => "frictionless",
        }
    }
}

impl Word for Algorithm {
    const ARGUMENT: &'static str = "algorithm";
    const VALUES: &'static [Self] = &[Self::Cascade, Self::PolonskyKeer];

    fn word(self) -> &'static str {
        match self {
            Self::Cascade => "cascade",
            Self::PolonskyKeer => "polonsky-keer",
        }
    }
}

impl Word for Termination {
    const ARGUMENT: &'static str = "termination";
    const VALUES: &'static [Self] =
        &[Self::Running, Self::Converged, Self::IterationLimit, Self::Stopped];

    fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Converged => "converged",
            Self::IterationLimit => "iteration limit",
            Self::Stopped => "stopped",
        }
    }
}

impl Word for Solver {
    const ARGUMENT: &'static str = "solver";
    const VALUES: &'static [Self] = &[Self::Preconditioned, Self::ActiveSet, Self::PolonskyKeer];

    fn word(self) -> &'static str {
        match self {
            Self::Preconditioned => "preconditioned",
            Self::ActiveSet => "active-set",
            Self::PolonskyKeer => "polonsky-keer",
        }
    }
}

impl Word for Side {
    const ARGUMENT: &'static str = "side";
    const VALUES: &'static [Self] = &[Self::Above, Self::Below];

    fn word(self) -> &'static str {
        match self {
            Self::Above => "above",
            Self::Below => "below",
        }
    }
}

impl Word for Member {
    const ARGUMENT: &'static str = "body";
    const VALUES: &'static [Self] = &[Self::Body, Self::Counterbody];

    fn word(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Counterbody => "counterbody",
        }
    }
}

/// Refinement of the spectral mesh where none is given.
pub(super) const REFINEMENT: usize = 4;

/// Method with that name and that refinement.
pub(super) fn method(word: &str, refinement: usize) -> PyResult<Method> {
    Ok(match word {
        "exact" => Method::Exact,
        "plain" => Method::Plain { refinement },
        "difference" => Method::Difference { refinement },
        "image" => Method::Image { refinement },
        "spectral" => Method::Spectral,
        other => {
            let words = ["exact", "plain", "difference", "image", "spectral"];
            return Err(unknown("method", &words, other));
        }
    })
}

/// Kind, axis and figure of a warning; 0 where it has none.
pub(super) fn warning_words(warning: &Warning) -> (&'static str, usize, f64) {
    let (axis, figure) = match *warning {
        Warning::GridEdge | Warning::SharpEdge | Warning::FreeEnd | Warning::CoatedEnd => (0, 0.0),
        Warning::SharpEnd { axis } | Warning::MapRim { axis } => (axis, 0.0),
        Warning::Coarse { axis, cells } => (axis, cells as f64),
        Warning::CoarseSpots { axis, cells } => (axis, cells),
        Warning::LargeContact { axis, ratio } => (axis, ratio),
        Warning::OutsideGrid { depth } => (0, depth),
        Warning::PeakError { error } => (0, error),
        Warning::LargeMotion { size } => (0, size),
    };
    (warning.kind(), axis, figure)
}

/// Warning of that kind, with its axis and figure.
pub(super) fn warning(kind: &str, axis: usize, figure: f64) -> PyResult<Warning> {
    let (cells, ratio) = (figure as usize, figure);
    let warnings = [
        Warning::GridEdge,
        Warning::SharpEnd { axis },
        Warning::FreeEnd,
        Warning::CoatedEnd,
        Warning::SharpEdge,
        Warning::MapRim { axis },
        Warning::Coarse { axis, cells },
        Warning::CoarseSpots { axis, cells: figure },
        Warning::LargeContact { axis, ratio },
        Warning::OutsideGrid { depth: figure },
        Warning::PeakError { error: figure },
        Warning::LargeMotion { size: figure },
    ];
    let found = warnings.iter().find(|warning| warning.kind() == kind);
    found.copied().ok_or_else(|| {
        let kinds = warnings.map(|warning| warning.kind());
        unknown("kind of a warning", &kinds, kind)
    })
}
