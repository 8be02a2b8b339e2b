// Conversion of key presses and drags to edits, with the same constants as in the native window.

const DEGREES_PER_SECOND = 60, ZOOM_PER_SECOND = 1, FAST = 4;
const ORBIT_DEGREES = 0.35, PARALLEL_DEGREES = 0.15, WHEEL_POINTS = 400;
const LONGEST_STEP = 0.1;
const DEFAULT_FIELD = 40, DEFAULT_HEIGHT = 4;
const RADIANS = Math.PI / 180;

/// Effect of a drag, on the camera (`fly`) or the scene (`orbit`), and speed of the keys.
export const steering = { mode: "fly", speed: 1 };

/// Returns the extent of a pixel at the image center: in degrees, and in scene units at the point
/// of interest.
export function lens(status) {
  const [kind, camera] = Object.entries(status.camera ?? {})[0] ?? ["perspective", {}];
  const [width, height] = status.size;
  if (kind === "orthographic") {
    const tall = camera.height ?? (camera.width ? (camera.width * height) / width : DEFAULT_HEIGHT);
    return { degrees: 0, units: tall / height };
  }
  const half = halfHeight(camera, height / width);
  const eye = camera.eye ?? [0, 0, 0];
  const distance = Math.hypot(...eye.map((value, axis) => value - status.interest[axis]));
  const units = (2 * half * Math.max(distance, status.extent * 1e-3)) / height;
  return { degrees: Math.atan((2 * half) / height) / RADIANS, units };
}

/// Returns half the film height at distance 1.
function halfHeight(camera, shape) {
  if (camera.horizontal_fov_degrees) return Math.tan((camera.horizontal_fov_degrees * RADIANS) / 2) * shape;
  if (camera.screen) return ((camera.screen.width / 2) * shape) / camera.screen.distance;
  if (camera.view_plane) return camera.view_plane.height / 2 / camera.view_plane.distance;
  return Math.tan(((camera.vertical_fov_degrees ?? DEFAULT_FIELD) * RADIANS) / 2);
}

/// Returns the edits of keys that were held for some seconds; `flightSpeed` is in scene units per
/// second.
export function held(motions, fast, seconds, flightSpeed) {
  const time = Math.min(seconds, LONGEST_STEP) * (fast ? FAST : 1);
  const step = flightSpeed * steering.speed * time;
  const fly = {};
  let zoom = 0;
  for (const [axis, sign] of motions) {
    if (axis === "zoom") zoom += sign * ZOOM_PER_SECOND * time;
    else fly[axis] = (fly[axis] ?? 0) + sign * (axis.endsWith("_degrees") ? DEGREES_PER_SECOND * time : step);
  }
  const flown = Object.values(fly).some((value) => value !== 0) ? [{ fly }] : [];
  return zoom === 0 ? flown : [...flown, { zoom: Math.exp(zoom) }];
}

/// Returns the edit of a drag over some points: in fly mode, the content under the pointer follows
/// it.
export function drag(x, y, scale, status) {
  if (steering.mode === "orbit") return { orbit: { yaw_degrees: x * ORBIT_DEGREES, pitch_degrees: y * ORBIT_DEGREES } };
  const degrees = lens(status).degrees * scale || PARALLEL_DEGREES;
  return { fly: { yaw_degrees: -x * degrees, pitch_degrees: y * degrees } };
}

/// Returns the edit of a sideways drag: the point of interest follows the pointer.
export function pan(x, y, scale, status) {
  const units = lens(status).units * scale;
  return { fly: { right: -x * units, up: y * units } };
}

/// Returns the edit of a zoom with the wheel or two fingers, by a factor.
export function closer(factor) {
  const bounded = Math.min(Math.max(factor, 0.1), 10);
  return steering.mode === "orbit" ? { orbit: { closer: bounded } } : { zoom: bounded };
}

/// Returns the zoom factor of a wheel event; below 1 for scrolling down.
export function wheelFactor(event) {
  const points = event.deltaY * [1, 20, 400][event.deltaMode];
  return Math.exp(-points / (event.ctrlKey ? WHEEL_POINTS / 4 : WHEEL_POINTS));
}
