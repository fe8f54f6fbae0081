//! Statuses and texts of the library as `Result`.
use lensprof_sys::{lensprof_status_name, lensprof_version, ErrorText, Status};
use std::ffi::{c_char, c_int, CStr};
use std::fmt;

/// The library refused a call or failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    pub status: Status,
    /// A sentence that names the item and the next step.
    pub text: String,
}

pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn argument(text: &str) -> Error {
        Error {
            status: Status::ErrorArgument,
            text: text.to_owned(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{} ({})",
            self.text,
            text(unsafe { lensprof_status_name(self.status as c_int) })
        )
    }
}

impl std::error::Error for Error {}

/// A text of static storage.
pub(crate) fn text(pointer: *const c_char) -> String {
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// A terminated text in an array.
pub(crate) fn array_text(array: &[c_char]) -> String {
    let bytes: Vec<u8> = array.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The result of a call with the library's text.
pub(crate) fn check(status: c_int, error: &ErrorText) -> Result<()> {
    checked(status, || array_text(&error.text))
}

/// The result of a call that has no text of its own.
pub(crate) fn checked(status: c_int, text: impl FnOnce() -> String) -> Result<()> {
    match Status::from_raw(status.into()) {
        Some(Status::Ok) => Ok(()),
        known => Err(Error {
            status: known.unwrap_or(Status::ErrorInternal),
            text: text(),
        }),
    }
}

/// The error of a call that read a blob of so many bytes.
pub(crate) fn blob_error(error: Error, bytes: usize) -> Error {
    let text = match error.status {
        Status::ErrorLayout => "written by a newer lensprof; update this library",
        Status::ErrorCorrupt => "not a blob, or damaged; export it again",
        _ => return error,
    };
    Error {
        text: format!("profile blob of {bytes} bytes: {text}"),
        ..error
    }
}

/// While the major version is 0, structures may change with the minor one.
pub(crate) fn check_version() -> Result<()> {
    let (library, headers) = (text(unsafe { lensprof_version() }), lensprof_sys::VERSION);
    if library.split('.').take(2).eq(headers.split('.').take(2)) {
        return Ok(());
    }
    let text = format!("the library is lensprof {library}, but this crate is for {headers}; install the two together");
    Err(Error {
        status: Status::ErrorUnsupported,
        text,
    })
}
