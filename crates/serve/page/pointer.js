// Mouse, pen and touch input on the image. One pointer drags or taps, two fingers move and pinch.
// Events within one animation frame are sent as one edit.

import * as camera from "./camera.js";

const TAP_POINTS = 6, TAP_MILLISECONDS = 400, DOUBLE_MILLISECONDS = 350, DOUBLE_POINTS = 24;

/// `on` has `edit(edit)`, `status()`, `tap([x, y])`, `doubleTap([x, y])`, `region(from, to, done)`,
/// `hover([x, y])` and `choosesRegion()`.
export function watchPointer(canvas, picture, on) {
  const pointers = new Map();
  let gesture = null, moved = [0, 0], factor = 1, waiting = false, lastTap = null;

  const flush = () => {
    waiting = false;
    const status = on.status();
    const [[x, y], pinch] = [moved, factor];
    [moved, factor] = [[0, 0], 1];
    if (!status) return;
    if (pinch !== 1) on.edit(camera.closer(pinch));
    if (x === 0 && y === 0) return;
    if (gesture?.pivot) on.edit({ pivot: gesture.pivot });
    if (gesture) gesture.pivot = null;
    const edit = gesture?.pans ? camera.pan : camera.drag;
    on.edit(edit(x, y, picture.scale, status));
  };
  const later = () => {
    if (!waiting) requestAnimationFrame(flush);
    waiting = true;
  };
  const middle = () => {
    const all = [...pointers.values()];
    return [0, 1].map((axis) => all.reduce((sum, point) => sum + point[axis], 0) / all.length);
  };
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    const point = [event.clientX, event.clientY];
    if (pointers.size > 0 && waiting) flush();
    pointers.set(event.pointerId, point);
    const fingers = pointers.size;
    const chooses = fingers === 1 && on.choosesRegion();
    const pans = fingers > 1 || event.shiftKey || event.button === 1 || event.button === 2;
    // An orbit starts with a pivot at the pointer, which has no effect while a point is chosen.
    const pivot = camera.steering.mode === "orbit" && !pans ? picture.at(...point) : null;
    gesture = { start: point, at: performance.now(), pans, chooses, pivot, traveled: gesture && fingers > 1 ? Infinity : 0, middle: middle(), spread: spread() };
    canvas.classList.toggle("dragging", !chooses);
    event.preventDefault();
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    const point = [event.clientX, event.clientY];
    if (!before || !gesture) return on.hover(point);
    pointers.set(event.pointerId, point);
    const now = middle(), step = now.map((value, axis) => value - gesture.middle[axis]);
    gesture.traveled += Math.hypot(...step);
    gesture.middle = now;
    if (gesture.chooses) return on.region(gesture.start, point, false);
    if (gesture.traveled < TAP_POINTS && pointers.size === 1) return;
    moved = moved.map((value, axis) => value + step[axis]);
    if (pointers.size === 2) {
      const wide = spread();
      if (gesture.spread > 0 && wide > 0) factor *= wide / gesture.spread;
      gesture.spread = wide;
    }
    later();
  });

  const end = (event) => {
    if (!pointers.delete(event.pointerId) || !gesture) return;
    const point = [event.clientX, event.clientY];
    if (waiting) flush();
    if (pointers.size > 0) {
      gesture = { ...gesture, pans: true, traveled: Infinity, middle: middle(), spread: spread() };
      return;
    }
    const { chooses, start, traveled, at, pans } = gesture;
    gesture = null;
    canvas.classList.remove("dragging");
    if (event.type === "pointercancel") return;
    if (chooses) return on.region(start, point, true);
    const tapped = traveled < TAP_POINTS && !pans && performance.now() - at < TAP_MILLISECONDS;
    if (tapped) tap(point);
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);

  const tap = (point) => {
    const now = performance.now();
    const twice = lastTap && now - lastTap.at < DOUBLE_MILLISECONDS && Math.hypot(point[0] - lastTap.point[0], point[1] - lastTap.point[1]) < DOUBLE_POINTS;
    lastTap = twice ? null : { at: now, point };
    if (twice) on.doubleTap(point);
    else on.tap(point);
  };

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    factor *= camera.wheelFactor(event);
    later();
  }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
}
