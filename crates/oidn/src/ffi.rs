//! Bindings of `oidn.h` (version 2), and the only `unsafe` code of this crate.
#![allow(unsafe_code, reason = "a foreign library")]

use crate::Error;
use crate::image::FilterImage;
pub(crate) use libloading::Library;
use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr::{NonNull, null};

type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`.
const CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
const FLOAT3: c_int = 3;

/// Opens a library and runs its initializers.
pub(crate) fn open(path: &Path) -> Result<Library, String> {
    // SAFETY: the user names a library and wants it to run; the initializers of Open Image Denoise
    // have no preconditions.
    unsafe { Library::new(path) }.map_err(|error| error.to_string())
}

/// Functions of an open library, together with the library.
#[derive(Debug)]
pub(crate) struct Api {
    new_device: unsafe extern "C" fn(c_int) -> Handle,
    commit_device: unsafe extern "C" fn(Handle),
    release_device: unsafe extern "C" fn(Handle),
    device_int: unsafe extern "C" fn(Handle, *const c_char) -> c_int,
    device_error: unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int,
    new_filter: unsafe extern "C" fn(Handle, *const c_char) -> Handle,
    release_filter: unsafe extern "C" fn(Handle),
    set_image: SetImage,
    set_bool: unsafe extern "C" fn(Handle, *const c_char, bool),
    commit_filter: unsafe extern "C" fn(Handle),
    execute_filter: unsafe extern "C" fn(Handle),
    _library: Library,
}

/// `oidnSetSharedFilterImage`: filter, name, pixels, format, width, height, byte offset, bytes per
/// pixel and bytes per row (0: packed).
type SetImage = unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);

impl Api {
    /// Looks up all functions of `library`; the error names the one that is missing.
    pub fn new(library: Library) -> Result<Self, String> {
        // SAFETY: each field has the type that `oidn.h` of version 2 gives the function of that
        // name; enums are `int` there. A library of another version with these names takes the same
        // arguments: `oidnGetDeviceInt` and `oidnSetFilterBool` exist from version 2 on, and later
        // versions keep them.
        unsafe {
            Ok(Self {
                new_device: symbol(&library, "oidnNewDevice")?,
                commit_device: symbol(&library, "oidnCommitDevice")?,
                release_device: symbol(&library, "oidnReleaseDevice")?,
                device_int: symbol(&library, "oidnGetDeviceInt")?,
                device_error: symbol(&library, "oidnGetDeviceError")?,
                new_filter: symbol(&library, "oidnNewFilter")?,
                release_filter: symbol(&library, "oidnReleaseFilter")?,
                set_image: symbol(&library, "oidnSetSharedFilterImage")?,
                set_bool: symbol(&library, "oidnSetFilterBool")?,
                commit_filter: symbol(&library, "oidnCommitFilter")?,
                execute_filter: symbol(&library, "oidnExecuteFilter")?,
                _library: library,
            })
        }
    }

    /// Creates a CPU device. Devices of other types would need their own memory.
    pub fn device(&self) -> Result<Device<'_>, Error> {
        // SAFETY: the argument is one of the header's device types.
        let handle = unsafe { (self.new_device)(CPU) };
        let Some(handle) = NonNull::new(handle) else {
            return Err(Error::Failed("it has no device for this processor".to_owned()));
        };
        let device = Device { api: self, handle };
        // SAFETY: the device is alive until it is dropped.
        unsafe { (self.commit_device)(handle.as_ptr()) };
        device.take_error().map(|()| device)
    }
}

/// Looks up a function by name and copies its pointer.
///
/// # Safety
///
/// `T` must be the function's type, and the library must outlive all calls of it.
unsafe fn symbol<T: Copy>(library: &Library, name: &str) -> Result<T, String> {
    // SAFETY: the caller's promise; `Api` holds the library as long as its functions.
    unsafe { library.get::<T>(name.as_bytes()) }.map(|found| *found).map_err(|_| format!("it has no {name}"))
}

/// Device, released when dropped.
pub(crate) struct Device<'a> {
    api: &'a Api,
    handle: NonNull<c_void>,
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the device was created by this library and is released once; its filters are
        // gone, because they borrow it.
        unsafe { (self.api.release_device)(self.handle.as_ptr()) }
    }
}

impl Device<'_> {
    /// Version: 10,000 × major + 100 × minor + patch; 0 if the library does not report it.
    pub fn version(&self) -> c_uint {
        // SAFETY: the device is alive, and the name is zero-terminated.
        let version = unsafe { (self.api.device_int)(self.handle.as_ptr(), c"version".as_ptr()) };
        c_uint::try_from(version).unwrap_or_default()
    }

    /// Returns the first error since the last call.
    fn take_error(&self) -> Result<(), Error> {
        let mut message: *const c_char = null();
        // SAFETY: the device is alive, and `message` is a valid pointer.
        let code = unsafe { (self.api.device_error)(self.handle.as_ptr(), &raw mut message) };
        if code == 0 {
            return Ok(());
        }
        if message.is_null() {
            return Err(Error::Failed(format!("error {code}")));
        }
        // SAFETY: the header promises a zero-terminated text that lives until the next call on this
        // thread.
        let text = unsafe { CStr::from_ptr(message) };
        Err(Error::Failed(text.to_string_lossy().into_owned()))
    }

    /// Denoises HDR `images` of path tracing with the `RT` filter. All images must have the given
    /// size.
    pub fn filter(&self, images: &[FilterImage], width: usize, height: usize) -> Result<Vec<f32>, Error> {
        let Some(first) = images.first().filter(|_| images.iter().all(|i| (i.width, i.height) == (width, height)))
        else {
            return Err(Error::Failed("the pictures differ in size".to_owned()));
        };
        let mut output = vec![0.0_f32; first.numbers.len()];
        // SAFETY: the device is alive, and the name is zero-terminated.
        let handle = unsafe { (self.api.new_filter)(self.handle.as_ptr(), c"RT".as_ptr()) };
        let Some(handle) = NonNull::new(handle) else {
            return self.take_error().and(Err(Error::Failed("it has no filter for path traced pictures".to_owned())));
        };
        let filter = Filter { device: self, handle };
        for image in images {
            filter.set_image(&image.name, image.numbers.as_ptr().cast_mut(), [width, height]);
        }
        filter.set_image(c"output", output.as_mut_ptr(), [width, height]);
        // SAFETY: the filter is alive. Each image set above holds as many numbers as its size
        // demands (`FilterImage::new`, and all have one size), tightly packed. All of them outlive
        // the filter, and only `output` is written, which nothing else borrows meanwhile.
        unsafe {
            (self.api.set_bool)(handle.as_ptr(), c"hdr".as_ptr(), true);
            (self.api.commit_filter)(handle.as_ptr());
            (self.api.execute_filter)(handle.as_ptr());
        }
        drop(filter);
        self.take_error().map(|()| output)
    }
}

/// Filter, released when dropped.
struct Filter<'a> {
    device: &'a Device<'a>,
    handle: NonNull<c_void>,
}

impl Filter<'_> {
    /// Sets an image of the filter, which execution reads or writes at `numbers`.
    fn set_image(&self, name: &CStr, numbers: *mut f32, [width, height]: [usize; 2]) {
        // SAFETY: the filter is alive, and the name is zero-terminated; only `execute_filter`
        // accesses the pixels.
        unsafe {
            let (handle, pixels) = (self.handle.as_ptr(), numbers.cast::<c_void>());
            (self.device.api.set_image)(handle, name.as_ptr(), pixels, FLOAT3, width, height, 0, 0, 0);
        }
    }
}

impl Drop for Filter<'_> {
    fn drop(&mut self) {
        // SAFETY: the filter was created by this library and is released once.
        unsafe { (self.device.api.release_filter)(self.handle.as_ptr()) }
    }
}
