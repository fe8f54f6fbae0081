//! Profiles and the settings that they apply to.
use crate::error::{array_text, blob_error, check_version, checked, Error, Result};
use lensprof_sys as sys;
use std::ffi::c_char;
use std::ptr::null_mut;

/// Camera, lens and setting. Empty texts and `None` are unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    pub camera_maker: String,
    pub camera_model: String,
    pub lens: String,
    pub crop_factor: Option<f64>,
    pub focal_mm: Option<f64>,
    /// The f-number.
    pub aperture: Option<f64>,
    /// Focus distance; may be infinite.
    pub distance_m: Option<f64>,
    pub processing: sys::Processing,
}

impl Default for Key {
    fn default() -> Key {
        Key::from_raw(&sys::ProfileKey::default())
    }
}

impl Key {
    fn from_raw(raw: &sys::ProfileKey) -> Key {
        let known = |value: f64| (value != sys::UNKNOWN).then_some(value);
        Key {
            camera_maker: array_text(&raw.camera_maker),
            camera_model: array_text(&raw.camera_model),
            lens: array_text(&raw.lens),
            crop_factor: known(raw.crop_factor),
            focal_mm: known(raw.focal_mm),
            aperture: known(raw.aperture),
            distance_m: known(raw.distance_m),
            processing: sys::Processing::from_raw(raw.processing.into()).unwrap_or(sys::Processing::Jpeg),
        }
    }

    pub(crate) fn to_raw(&self) -> Result<sys::ProfileKey> {
        let mut raw = sys::ProfileKey::default();
        put_text(&mut raw.camera_maker, &self.camera_maker)?;
        put_text(&mut raw.camera_model, &self.camera_model)?;
        put_text(&mut raw.lens, &self.lens)?;
        raw.crop_factor = self.crop_factor.unwrap_or(sys::UNKNOWN);
        raw.focal_mm = self.focal_mm.unwrap_or(sys::UNKNOWN);
        raw.aperture = self.aperture.unwrap_or(sys::UNKNOWN);
        raw.distance_m = self.distance_m.unwrap_or(sys::UNKNOWN);
        raw.processing = self.processing as u32;
        Ok(raw)
    }
}

fn put_text(to: &mut [c_char], text: &str) -> Result<()> {
    if text.len() >= to.len() || text.contains('\0') {
        return Err(Error::argument(&format!(
            "{text:?}: has a zero, or more than {} bytes; shorten it",
            to.len() - 1
        )));
    }
    for (to, &from) in to.iter_mut().zip(text.as_bytes()) {
        *to = from as c_char;
    }
    Ok(())
}

/// Response and falloff of one camera, lens and setting: 50 kB on the heap.
#[derive(Clone, Default)]
pub struct Profile(pub(crate) Box<sys::Profile>);

impl Profile {
    /// The profile of a blob.
    pub fn unpack(blob: &[u8]) -> Result<Profile> {
        check_version()?;
        let mut profile = Profile::default();
        let status = unsafe { sys::lensprof_profile_unpack(blob.as_ptr().cast(), blob.len(), &mut *profile.0) };
        checked(status, String::new).map_err(|error| blob_error(error, blob.len()))?;
        Ok(profile)
    }

    /// The profile as a blob, without covariance.
    pub fn pack(&self) -> Result<Vec<u8>> {
        let invalid = || "this profile: has values out of range; make it again".to_owned();
        let mut bytes = 0;
        checked(
            unsafe { sys::lensprof_profile_pack(&*self.0, 0, null_mut(), 0, &mut bytes) },
            invalid,
        )?;
        let mut blob = vec![0; bytes];
        let data = blob.as_mut_ptr().cast();
        checked(
            unsafe { sys::lensprof_profile_pack(&*self.0, 0, data, bytes, &mut bytes) },
            invalid,
        )?;
        Ok(blob)
    }

    pub fn key(&self) -> Key {
        Key::from_raw(&self.0.key)
    }

    /// Relative illuminance of green in the corner, or of all channels, and its standard error if known.
    pub fn corner_falloff(&self) -> (f64, Option<f64>) {
        let mut sigma = 0.0;
        let falloff = unsafe { sys::lensprof_profile_radial_falloff(&*self.0, 1, 1.0, &mut sigma) };
        (falloff, (sigma != sys::UNKNOWN).then_some(sigma))
    }

    pub(crate) fn set_options(&self, options: &mut sys::ApplyOptions) -> Result<()> {
        let status = unsafe { sys::lensprof_apply_options_set_profile(options, &*self.0) };
        checked(status, || "this profile: cannot be applied".to_owned())
    }
}
