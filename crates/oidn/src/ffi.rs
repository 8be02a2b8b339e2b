//! The functions of `oidn.h` (version 2) that are called, and the only `unsafe` of this crate.
#![allow(unsafe_code, reason = "a foreign library")]

use crate::Error;
use crate::image::Image;
pub(crate) use libloading::Library;
use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr::{NonNull, null};

type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`.
const CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
const FLOAT3: c_int = 3;

/// Opens a library and runs its initialisers.
pub(crate) fn open(path: &Path) -> Result<Library, String> {
    // SAFETY: the user names a library and means it to be run; the initialisers of Open Image Denoise ask for nothing.
    unsafe { Library::new(path) }.map_err(|error| error.to_string())
}

/// The functions, and the library that they live in.
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

/// `oidnSetSharedFilterImage`: filter, name, pixels, format, width, height, offset, bytes to the next pixel and row (0: closely).
type SetImage = unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);

impl Api {
    /// Finds all functions, or says which one is missing.
    pub fn new(library: Library) -> Result<Self, String> {
        // SAFETY: each field has the type that `oidn.h` of version 2 gives the function of that name; enums are `int` there. A library
        // of another version with these names takes the same arguments: `oidnGetDeviceInt` and `oidnSetFilterBool`
        // exist from version 2 on, and later versions keep them.
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

    /// A device on the processor: other devices would need their memory to be asked for.
    pub fn device(&self) -> Result<Device<'_>, Error> {
        // SAFETY: the argument is one of the header's device types.
        let handle = unsafe { (self.new_device)(CPU) };
        let Some(handle) = NonNull::new(handle) else {
            return Err(Error::Failed("it has no device for this processor".to_owned()));
        };
        let device = Device { api: self, handle };
        // SAFETY: the device is alive until it is dropped.
        unsafe { (self.commit_device)(handle.as_ptr()) };
        device.check().map(|()| device)
    }
}

/// A function by name, copied out of the library.
///
/// # Safety
///
/// `T` must be the function's type, and the library must outlive all calls of it.
unsafe fn symbol<T: Copy>(library: &Library, name: &str) -> Result<T, String> {
    // SAFETY: the caller's promise; `Api` holds the library as long as its functions.
    unsafe { library.get::<T>(name.as_bytes()) }.map(|found| *found).map_err(|_| format!("it has no {name}"))
}

/// A device, given back when dropped.
pub(crate) struct Device<'a> {
    api: &'a Api,
    handle: NonNull<c_void>,
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the device was made by this library and is released once; its filters are gone, for they borrow it.
        unsafe { (self.api.release_device)(self.handle.as_ptr()) }
    }
}

impl Device<'_> {
    /// 10,000 × major + 100 × minor + patch; 0 when the library does not say.
    pub fn version(&self) -> c_uint {
        // SAFETY: the device is alive, the name ends with a zero.
        let version = unsafe { (self.api.device_int)(self.handle.as_ptr(), c"version".as_ptr()) };
        c_uint::try_from(version).unwrap_or_default()
    }

    /// What went wrong since this was last asked.
    fn check(&self) -> Result<(), Error> {
        let mut message: *const c_char = null();
        // SAFETY: the device is alive, the pointer to the message is ours.
        let code = unsafe { (self.api.device_error)(self.handle.as_ptr(), &raw mut message) };
        if code == 0 {
            return Ok(());
        }
        if message.is_null() {
            return Err(Error::Failed(format!("error {code}")));
        }
        // SAFETY: the header promises a text that ends with a zero and lives until the next call on this thread.
        let text = unsafe { CStr::from_ptr(message) };
        Err(Error::Failed(text.to_string_lossy().into_owned()))
    }

    /// Runs the filter for path traced pictures of high range on `images`.
    pub fn filter(&self, images: &[Image], width: usize, height: usize) -> Result<Vec<f32>, Error> {
        let Some(length) = images.first().filter(|_| images.iter().all(|i| (i.width, i.height) == (width, height)))
        else {
            return Err(Error::Failed("pictures of several sizes".to_owned()));
        };
        let mut output = vec![0.0_f32; length.numbers.len()];
        // SAFETY: the device is alive, the name ends with a zero.
        let handle = unsafe { (self.api.new_filter)(self.handle.as_ptr(), c"RT".as_ptr()) };
        let Some(handle) = NonNull::new(handle) else {
            return self.check().and(Err(Error::Failed("it has no filter for path traced pictures".to_owned())));
        };
        let filter = Filter { device: self, handle };
        for image in images {
            filter.set(&image.name, image.numbers.as_ptr().cast_mut(), [width, height]);
        }
        filter.set(c"output", output.as_mut_ptr(), [width, height]);
        // SAFETY: the filter is alive; each picture given to it above has as many numbers as it was told (`Image::new`, and all are
        // of one size), closely packed; all of them outlive the filter, and only `output` is written, which nobody else
        // borrows meanwhile.
        unsafe {
            (self.api.set_bool)(handle.as_ptr(), c"hdr".as_ptr(), true);
            (self.api.commit_filter)(handle.as_ptr());
            (self.api.execute_filter)(handle.as_ptr());
        }
        drop(filter);
        self.check().map(|()| output)
    }
}

/// A filter, given back when dropped.
struct Filter<'a> {
    device: &'a Device<'a>,
    handle: NonNull<c_void>,
}

impl Filter<'_> {
    /// Tells the filter where a picture is; it reads or writes there when it is executed.
    fn set(&self, name: &CStr, numbers: *mut f32, [width, height]: [usize; 2]) {
        // SAFETY: the filter is alive, the name ends with a zero; pixels are touched only by `execute_filter`.
        unsafe {
            let (handle, pixels) = (self.handle.as_ptr(), numbers.cast::<c_void>());
            (self.device.api.set_image)(handle, name.as_ptr(), pixels, FLOAT3, width, height, 0, 0, 0);
        }
    }
}

impl Drop for Filter<'_> {
    fn drop(&mut self) {
        // SAFETY: the filter was made by this library and is released once.
        unsafe { (self.device.api.release_filter)(self.handle.as_ptr()) }
    }
}
