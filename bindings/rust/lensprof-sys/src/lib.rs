//! The C interface of lensprof, generated from its public headers, which have the documentation.
//!
//! Structures are named without `lensprof_`, in Rust's manner; functions have their names in C. Inline functions of the
//! headers are not exported: `Default` of a structure calls its `_init` function.
#[rustfmt::skip]
mod abi;

pub use abi::*;
