//! Embree 4, loaded at run time without linking. All calls to C are in this file.
#![expect(unsafe_code, reason = "Embree is a C library")]

use crate::layout::{Arguments, INVALID, Ray1, Ray8, RayHit1, RayHit8, Valid8};
use juggler_bvh::Quality;
use juggler_math::Ray;
use juggler_raybench::Mesh;
use juggler_raybench::clock::{CpuClock, Elapsed, Stopwatch};
use libloading::Library;
use std::ffi::{CString, OsStr, c_char, c_int, c_void};
use std::ptr::null_mut;
use std::sync::atomic::{AtomicI64, Ordering};

/// `RTCDevice`, `RTCGeometry` or `RTCScene`.
type Handle = *mut c_void;
type Monitor = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// Embree's functions that the benchmark calls.
pub struct Api {
    new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    device_property: unsafe extern "C" fn(Handle, c_int) -> isize,
    device_error: unsafe extern "C" fn(Handle) -> c_int,
    release_device: unsafe extern "C" fn(Handle),
    set_monitor: unsafe extern "C" fn(Handle, Monitor, *mut c_void),
    new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle,
    new_buffer: unsafe extern "C" fn(Handle, c_int, u32, c_int, usize, usize) -> *mut c_void,
    commit_geometry: unsafe extern "C" fn(Handle),
    release_geometry: unsafe extern "C" fn(Handle),
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    set_flags: unsafe extern "C" fn(Handle, c_int),
    set_quality: unsafe extern "C" fn(Handle, c_int),
    attach: unsafe extern "C" fn(Handle, Handle) -> u32,
    commit_scene: unsafe extern "C" fn(Handle),
    release_scene: unsafe extern "C" fn(Handle),
    intersect1: unsafe extern "C" fn(Handle, *mut RayHit1, *const Arguments),
    occluded1: unsafe extern "C" fn(Handle, *mut Ray1, *const Arguments),
    intersect8: unsafe extern "C" fn(*const Valid8, Handle, *mut RayHit8, *const Arguments),
    occluded8: unsafe extern "C" fn(*const Valid8, Handle, *mut Ray8, *const Arguments),
    /// Keeps the functions loaded.
    _library: Library,
}

impl Api {
    /// Loads the library at `path`.
    pub fn open(path: &OsStr) -> Result<Self, String> {
        // SAFETY: the user names a library to be run; Embree's initializers have no preconditions.
        let library = unsafe { Library::new(path) }.map_err(|error| error.to_string())?;
        // SAFETY: each field has the type that `rtcore_device.h`, `rtcore_geometry.h` and
        // `rtcore_scene.h` of Embree 4 declare for the name beside it. Enums are C ints, `size_t`
        // is `usize`, `ssize_t` is `isize`.
        unsafe {
            Ok(Self {
                new_device: function(&library, "rtcNewDevice")?,
                device_property: function(&library, "rtcGetDeviceProperty")?,
                device_error: function(&library, "rtcGetDeviceError")?,
                release_device: function(&library, "rtcReleaseDevice")?,
                set_monitor: function(&library, "rtcSetDeviceMemoryMonitorFunction")?,
                new_geometry: function(&library, "rtcNewGeometry")?,
                new_buffer: function(&library, "rtcSetNewGeometryBuffer")?,
                commit_geometry: function(&library, "rtcCommitGeometry")?,
                release_geometry: function(&library, "rtcReleaseGeometry")?,
                new_scene: function(&library, "rtcNewScene")?,
                set_flags: function(&library, "rtcSetSceneFlags")?,
                set_quality: function(&library, "rtcSetSceneBuildQuality")?,
                attach: function(&library, "rtcAttachGeometry")?,
                commit_scene: function(&library, "rtcCommitScene")?,
                release_scene: function(&library, "rtcReleaseScene")?,
                intersect1: function(&library, "rtcIntersect1")?,
                occluded1: function(&library, "rtcOccluded1")?,
                intersect8: function(&library, "rtcIntersect8")?,
                occluded8: function(&library, "rtcOccluded8")?,
                _library: library,
            })
        }
    }
}

/// Looks up a function by name.
///
/// # Safety
/// `F` must be the type of that function.
unsafe fn function<F: Copy>(library: &Library, name: &str) -> Result<F, String> {
    // SAFETY: guaranteed by the caller; the pointer is copied, and `Api` keeps the library as long
    // as its functions.
    unsafe { library.get::<F>(name.as_bytes()) }.map(|symbol| *symbol).map_err(|error| error.to_string())
}

/// An Embree device with a number of build threads. Only one per process: after a second one,
/// Embree 4.4 keeps a thread busy or builds with another number of threads than requested.
pub struct Device<'a> {
    api: &'a Api,
    device: Handle,
    /// Memory that Embree holds, in bytes. Boxed, since Embree keeps its address.
    bytes: Box<AtomicI64>,
}

/// A mesh in Embree's buffers.
pub struct EmbreeMesh<'d> {
    device: &'d Device<'d>,
    geometry: Handle,
}

/// Memory monitor callback: Embree reports allocations as positive, deallocations as negative
/// numbers.
unsafe extern "C" fn count_bytes(counter: *mut c_void, bytes: isize, _after: bool) -> bool {
    // SAFETY: `counter` is the boxed counter of a `Device`, which outlives Embree's device.
    unsafe { &*counter.cast::<AtomicI64>() }.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

impl<'a> Device<'a> {
    /// Creates a device without meshes.
    pub fn new(api: &'a Api, threads: usize) -> Result<Self, String> {
        let settings = CString::new(format!("threads={threads}")).map_err(|error| error.to_string())?;
        let bytes = Box::new(AtomicI64::new(0));
        // SAFETY: the string ends with a zero and lives through the call; the counter lives as long
        // as the device.
        let device = unsafe {
            let device = (api.new_device)(settings.as_ptr());
            if device.is_null() {
                return Err(format!("Embree made no device: error {}", (api.device_error)(null_mut())));
            }
            (api.set_monitor)(device, count_bytes, std::ptr::from_ref::<AtomicI64>(&bytes).cast_mut().cast());
            device
        };
        Ok(Self { api, device, bytes })
    }

    /// Copies a mesh into Embree's buffers.
    pub fn load(&self, mesh: &Mesh) -> Result<EmbreeMesh<'_>, String> {
        // SAFETY: the device lives.
        let geometry = unsafe { (self.api.new_geometry)(self.device, TRIANGLES) };
        let own = EmbreeMesh { device: self, geometry };
        own.buffer(VERTICES, FLOAT3, mesh.positions.iter().map(|position| position.to_array()))?;
        own.buffer(INDICES, UINT3, mesh.triangles.iter().copied())?;
        // SAFETY: the geometry is this device's, and its buffers are filled.
        unsafe { (self.api.commit_geometry)(geometry) };
        self.checked(own)
    }

    /// Version of the library, such as `4.4.0`.
    pub fn version(&self) -> String {
        // SAFETY: the device lives; 1 to 3 are the parts of the version.
        let part = |part| unsafe { (self.api.device_property)(self.device, part) };
        format!("{}.{}.{}", part(1), part(2), part(3))
    }

    fn checked<T>(&self, value: T) -> Result<T, String> {
        // SAFETY: the device lives.
        match unsafe { (self.api.device_error)(self.device) } {
            0 => Ok(value),
            error => Err(format!("Embree's error {error}")),
        }
    }
}

impl EmbreeMesh<'_> {
    /// Creates a buffer and fills it with triples of 32-bit numbers.
    fn buffer<T: Copy>(
        &self,
        kind: c_int,
        format: c_int,
        items: impl ExactSizeIterator<Item = [T; 3]>,
    ) -> Result<(), String> {
        let count = items.len();
        // SAFETY: the geometry is this device's; the buffer has `count` items of 12 bytes.
        let start = unsafe { (self.device.api.new_buffer)(self.geometry, kind, 0, format, 12, count) }.cast::<[T; 3]>();
        if start.is_null() {
            return Err("Embree has no memory for the mesh".into());
        }
        for (i, item) in items.enumerate().take(count) {
            // SAFETY: `i < count`, and Embree aligns buffers to at least four bytes.
            unsafe { start.add(i).write(item) };
        }
        Ok(())
    }

    /// Builds a scene and returns it with the build time.
    pub fn build(&self, quality: Quality, robust: bool) -> Result<(Scene<'_>, Elapsed), String> {
        let Device { api, device, bytes } = self.device;
        let before = bytes.load(Ordering::Relaxed);
        // SAFETY: device and geometry live; the numbers are members of `RTCSceneFlags` and
        // `RTCBuildQuality`.
        let scene = unsafe {
            let scene = (api.new_scene)(*device);
            (api.set_flags)(scene, if robust { 1 << 2 } else { 0 });
            (api.set_quality)(scene, quality_of(quality));
            (api.attach)(scene, self.geometry);
            scene
        };
        let watch = Stopwatch::start(CpuClock::Process);
        // SAFETY: as above.
        unsafe { (api.commit_scene)(scene) };
        let elapsed = watch.elapsed();
        let scene_bytes = usize::try_from(bytes.load(Ordering::Relaxed) - before).unwrap_or(0);
        self.device.checked((Scene { device: self.device, scene, bytes: scene_bytes }, elapsed))
    }
}

/// `RTC_BUILD_QUALITY_LOW`, `_MEDIUM` or `_HIGH`.
fn quality_of(quality: Quality) -> c_int {
    match quality {
        Quality::Fast => 0,
        Quality::Balanced => 1,
        Quality::Best => 2,
    }
}

/// `RTC_GEOMETRY_TYPE_TRIANGLE`.
const TRIANGLES: c_int = 0;
/// `RTC_BUFFER_TYPE_INDEX` and `RTC_BUFFER_TYPE_VERTEX`.
const INDICES: c_int = 0;
const VERTICES: c_int = 1;
/// `RTC_FORMAT_UINT3` and `RTC_FORMAT_FLOAT3`.
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: created in `new`, released once; meshes and scenes borrow the device, so none is
        // left.
        unsafe { (self.api.release_device)(self.device) };
    }
}

impl Drop for EmbreeMesh<'_> {
    fn drop(&mut self) {
        // SAFETY: created in `load`, released once; scenes retain the geometry.
        unsafe { (self.device.api.release_geometry)(self.geometry) };
    }
}

/// A committed Embree scene.
pub struct Scene<'d> {
    device: &'d Device<'d>,
    scene: Handle,
    /// Size of the tree in bytes, without the mesh.
    pub bytes: usize,
}

// SAFETY: Embree allows any number of threads to trace a committed scene; nothing else is done
// through `&Scene`.
unsafe impl Sync for Scene<'_> {}

/// Hit of a ray: distance and index of the triangle.
pub type Hit = (f32, u32);

impl Scene<'_> {
    /// `rtcIntersect1`.
    #[inline(always)]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut ray = RayHit1::from(ray);
        // SAFETY: the scene is committed; the structure is laid out as Embree's.
        unsafe { (self.device.api.intersect1)(self.scene, &raw mut ray, &ALONE) };
        (ray.hit.geometry != INVALID).then_some((ray.ray.far, ray.hit.primitive))
    }

    /// `rtcOccluded1`.
    #[inline(always)]
    pub fn any(&self, ray: &Ray) -> bool {
        let mut ray = Ray1::from(ray);
        // SAFETY: the scene is committed; the structure is laid out as Embree's.
        unsafe { (self.device.api.occluded1)(self.scene, &raw mut ray, &ALONE) };
        ray.far < 0.0
    }

    /// `rtcIntersect8` for up to eight rays.
    #[inline(always)]
    pub fn closest8(&self, rays: &[Ray], coherent: bool) -> [Option<Hit>; 8] {
        let (packet, valid) = Ray8::of(rays);
        let mut packet = RayHit8::from(packet);
        let arguments = if coherent { &TOGETHER } else { &ALONE };
        // SAFETY: the scene is committed; the structures are laid out and aligned as Embree's.
        unsafe { (self.device.api.intersect8)(&raw const valid, self.scene, &raw mut packet, arguments) };
        let hit = |lane: usize| (packet.ray.far[lane], packet.hit.primitive[lane]);
        std::array::from_fn(|lane| (packet.hit.geometry[lane] != INVALID).then_some(hit(lane)))
    }

    /// `rtcOccluded8` for up to eight rays.
    #[inline(always)]
    pub fn any8(&self, rays: &[Ray], coherent: bool) -> [bool; 8] {
        let (mut packet, valid) = Ray8::of(rays);
        let arguments = if coherent { &TOGETHER } else { &ALONE };
        // SAFETY: the scene is committed; the structures are laid out and aligned as Embree's.
        unsafe { (self.device.api.occluded8)(&raw const valid, self.scene, &raw mut packet, arguments) };
        packet.far.map(|far| far < 0.0)
    }
}

const ALONE: Arguments = Arguments::new(false);
const TOGETHER: Arguments = Arguments::new(true);

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: created in `build`, released once.
        unsafe { (self.device.api.release_scene)(self.scene) };
    }
}
