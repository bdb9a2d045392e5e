//! Errors by what they say.

use nacre::Result;

/// What the error says.
pub(crate) fn message<T>(result: Result<T>) -> String {
    match result {
        Ok(_) => "no error".into(),
        Err(error) => error.to_string(),
    }
}

/// Each with the message that it must give.
pub(crate) fn check<T>(cases: impl IntoIterator<Item = (Result<T>, &'static str)>) {
    for (result, expected) in cases {
        assert_eq!(message(result), expected);
    }
}
