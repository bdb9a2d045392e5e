//! Comparison of errors with the messages that are expected.

use nacre::Result;

/// Message of an error.
pub(crate) fn message<T>(result: Result<T>) -> String {
    result.map_or_else(|error| error.to_string(), |_| "no error".into())
}

/// Asserts that each result is an error with the message beside it.
macro_rules! refused {
    ($($result:expr => $message:expr;)+) => {
        $(assert_eq!(crate::messages::message($result), $message);)+
    };
}
