//! Plans: a profile prepared for the pixels of one frame.
use crate::error::{blob_error, check, check_version, checked, Result};
use crate::profile::Profile;
use lensprof_sys as sys;
use std::marker::PhantomData;
use std::mem::size_of;
use std::ptr::null;

/// A type of samples.
pub trait Sample: Copy + sealed::Sealed {
    #[doc(hidden)]
    const TYPE: sys::SampleType;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
    impl Sealed for f32 {}
}

impl Sample for u8 {
    const TYPE: sys::SampleType = sys::SampleType::U8;
}
impl Sample for u16 {
    const TYPE: sys::SampleType = sys::SampleType::U16;
}
impl Sample for f32 {
    const TYPE: sys::SampleType = sys::SampleType::F32;
}

/// A part of a frame, px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// Corrects falloff in the pixels of frames of one size. Immutable: several threads may use it on different tiles.
pub struct Plan<S: Sample> {
    _memory: Vec<u64>, // holds what `plan` points to
    plan: *const sys::Plan,
    layout: sys::Layout,
    sample: PhantomData<S>,
}

// SAFETY: the library only reads a plan after its init.
unsafe impl<S: Sample> Send for Plan<S> {}
unsafe impl<S: Sample> Sync for Plan<S> {}

impl<S: Sample> Plan<S> {
    /// A plan of a profile for frames of width x height px.
    pub fn new(profile: &Profile, layout: sys::Layout, width: u32, height: u32) -> Result<Plan<S>> {
        let mut options = options::<S>(layout, width, height);
        profile.set_options(&mut options)?;
        Plan::prepare(&options, layout)
    }

    /// The same of a blob, which is read in place.
    pub fn of_blob(blob: &[u8], layout: sys::Layout, width: u32, height: u32) -> Result<Plan<S>> {
        let mut options = options::<S>(layout, width, height);
        options.blob = blob.as_ptr().cast();
        options.blob_bytes = blob.len();
        Plan::prepare(&options, layout).map_err(|error| blob_error(error, blob.len()))
    }

    fn prepare(options: &sys::ApplyOptions, layout: sys::Layout) -> Result<Plan<S>> {
        check_version()?;
        let bytes = unsafe { sys::lensprof_plan_bytes(options) };
        let mut memory = vec![0u64; bytes.div_ceil(size_of::<u64>())];
        let (mut plan, mut error) = (null(), no_error());
        let size = memory.len() * size_of::<u64>();
        let status =
            unsafe { sys::lensprof_plan_init(memory.as_mut_ptr().cast(), size, options, &mut plan, &mut error) };
        check(status, &error)?;
        Ok(Plan {
            _memory: memory,
            plan,
            layout,
            sample: PhantomData,
        })
    }

    /// Corrects a tile in place. Its rows follow each other without gaps.
    pub fn apply(&self, pixels: &mut [S], tile: Tile) -> Result<()> {
        let row = tile.width as usize * unsafe { sys::lensprof_layout_samples(self.layout as u32) } as usize;
        let refused = || {
            format!(
                "{} samples for {tile:?}: the tile must fit the frame and the pixels",
                pixels.len()
            )
        };
        if row.checked_mul(tile.height as usize) != Some(pixels.len()) {
            checked(sys::Status::ErrorSize as _, refused)?;
        }
        let target = sys::Target {
            data: pixels.as_mut_ptr().cast(),
            row_bytes: (row * size_of::<S>()) as isize,
            width: tile.width,
            height: tile.height,
            sample: S::TYPE as u32,
            layout: self.layout as u32,
        };
        checked(
            unsafe { sys::lensprof_apply(self.plan, null(), &target, tile.x, tile.y) },
            || format!("{tile:?}: the tile must fit the frame and the pixels"),
        )
    }
}

fn options<S: Sample>(layout: sys::Layout, width: u32, height: u32) -> sys::ApplyOptions {
    sys::ApplyOptions {
        frame_width: width,
        frame_height: height,
        source_sample: S::TYPE as u32,
        target_sample: S::TYPE as u32,
        source_layout: layout as u32,
        ..sys::ApplyOptions::default()
    }
}

pub(crate) fn no_error() -> sys::ErrorText {
    let item = sys::Item {
        kind: 0,
        index: 0,
        text_begin: 0,
        text_bytes: 0,
    };
    sys::ErrorText { text: [0; 256], item }
}
