//! Comparison of errors with the messages that are expected.

use nacre::Result;

/// Message of an error.
pub(crate) fn message<T>(result: Result<T>) -> String {
    match result {
        Ok(_) => "no error".into(),
        Err(error) => error.to_string(),
    }
}

/// Asserts that each result is an error with the message beside it.
pub(crate) fn check<T>(cases: impl IntoIterator<Item = (Result<T>, &'static str)>) {
    for (result, expected) in cases {
        assert_eq!(message(result), expected);
    }
}
