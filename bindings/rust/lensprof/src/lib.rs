//! Corrects pictures by profiles of lenses: blobs, plans for tiles of pixels, and the profile database.
//!
//! ```no_run
//! use lensprof::{Key, Layout, Plan, Store, Tile};
//! let store = Store::open("lenses.db")?;
//! let key = Key { lens: "Acme 50mm f/1.8".into(), focal_mm: Some(50.0), aperture: Some(2.8), ..Key::default() };
//! let found = store.lookup(&key)?;
//! let mut pixels = vec![0u8; 640 * 480 * 3];
//! let plan = Plan::<u8>::new(&found.profile, Layout::Rgb, 640, 480)?;
//! plan.apply(&mut pixels, Tile { x: 0, y: 0, width: 640, height: 480 })?;
//! # Ok::<(), lensprof::Error>(())
//! ```
mod error;
mod plan;
mod profile;
mod store;

pub use error::{Error, Result};
pub use lensprof_sys::{Layout, Processing, Status};
pub use plan::{Plan, Sample, Tile};
pub use profile::{Key, Profile};
pub use store::{Found, Store};

/// Version of the library, e.g. "0.3.0". Calls refuse a library of another minor version than this crate's.
pub fn version() -> String {
    error::text(unsafe { lensprof_sys::lensprof_version() })
}
