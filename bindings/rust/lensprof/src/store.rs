//! The profile database.
use crate::error::{array_text, check, check_version, Error, Result};
use crate::plan::no_error;
use crate::profile::{Key, Profile};
use lensprof_sys as sys;
use std::ffi::CString;
use std::path::Path;
use std::ptr::{null, null_mut};

/// An open profile database, which is only read. One thread at a time uses it; dropping it closes it.
pub struct Store(*mut sys::Store);

// SAFETY: a handle belongs to one thread at a time, whichever it is.
unsafe impl Send for Store {}

/// The answer of a lookup.
pub struct Found {
    pub profile: Profile,
    /// Whether the answer is a stored profile, unchanged.
    pub exact: bool,
    /// Stored profiles used for the falloff.
    pub profiles: u32,
    /// Standard error of the falloff in the corner, if known.
    pub sigma: Option<f64>,
    /// Warnings, as whole sentences.
    pub reason: String,
}

impl Store {
    /// Opens a database that exists.
    pub fn open(path: impl AsRef<Path>) -> Result<Store> {
        check_version()?;
        let path = path.as_ref();
        let name = CString::new(path.as_os_str().as_encoded_bytes())
            .map_err(|_| Error::argument(&format!("{path:?}: has a zero; no file has such a name")))?;
        let (mut store, mut error) = (null_mut(), no_error());
        let mode = sys::StoreMode::Read as u32;
        check(
            unsafe { sys::lensprof_store_open(name.as_ptr(), mode, &mut store, &mut error) },
            &error,
        )?;
        Ok(Store(store))
    }

    /// The profile for a setting: a stored one, or composed of the lens's falloffs at other settings and the camera's
    /// response. `Status::ErrorNotFound`, with the reason, if nothing is near enough.
    pub fn lookup(&self, key: &Key) -> Result<Found> {
        let (key, mut profile, mut error) = (key.to_raw()?, Profile::default(), no_error());
        let mut how = Box::<sys::Lookup>::default();
        let status =
            unsafe { sys::lensprof_store_lookup_in(&self.0, 1, &key, null(), &mut *profile.0, &mut *how, &mut error) };
        check(status, &error)?;
        Ok(Found {
            profile,
            exact: how.exact != 0,
            profiles: how.rows,
            sigma: (how.sigma != sys::UNKNOWN).then_some(how.sigma),
            reason: array_text(&how.reason),
        })
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        unsafe { sys::lensprof_store_close(self.0) }
    }
}
