// Input on the canvas: mouse, touch, wheel and keys become edits of the camera.

/** Rotation by a drag across the whole image, in degrees. */
const TURN = 120;
/** Angular speed of rotation keys, in degrees per second. */
const DEGREES = 60;
/** Logarithm of the zoom factor per second of zoom keys. */
const ZOOM = 1;
/** Maximum movement of the pointer during a click, in CSS pixels. */
const STILL = 4;

const MOVES = {
  KeyW: { forward: 1 }, ArrowUp: { forward: 1 }, KeyS: { forward: -1 }, ArrowDown: { forward: -1 },
  KeyA: { right: -1 }, ArrowLeft: { right: -1 }, KeyD: { right: 1 }, ArrowRight: { right: 1 },
  KeyE: { up: 1 }, PageUp: { up: 1 }, KeyQ: { up: -1 }, PageDown: { up: -1 },
  KeyJ: { yaw_degrees: -1 }, KeyL: { yaw_degrees: 1 }, KeyI: { pitch_degrees: 1 }, KeyK: { pitch_degrees: -1 },
  KeyU: { roll_degrees: -1 }, KeyO: { roll_degrees: 1 }, KeyX: { zoom: 1 }, KeyC: { zoom: -1 },
};

/** Listens for input. `hands.edit(edit)` receives the edits; `hands.flightSpeed()`, in scene units
 * per second, `hands.orbits()` and `hands.pixel(x, y)` describe the scene and the view. */
export function listen(canvas, hands) {
  drags(canvas, hands);
  wheel(canvas, hands);
  keys(hands);
}

function closer(hands, orbits, factor) {
  hands.edit(orbits ? { orbit: { closer: factor } } : { zoom: factor });
}

function drags(canvas, hands) {
  const fingers = new Map();
  let moved = 0;
  const apart = () => {
    const [a, b] = fingers.values();
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse" && event.button > 2) return;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus();
    if (fingers.size === 0) moved = 0;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = fingers.size === 2 ? apart() : 0;
    const [x, y] = [event.clientX - finger.x, event.clientY - finger.y];
    [finger.x, finger.y] = [event.clientX, event.clientY];
    moved += Math.hypot(x, y);
    if (moved < STILL) return;
    if (fingers.size === 2) return closer(hands, hands.orbits(), apart() / Math.max(before, 1));
    const turn = TURN / Math.min(canvas.clientWidth, canvas.clientHeight);
    const [yaw_degrees, pitch_degrees] = [x * turn, y * turn];
    const orbits = hands.orbits() !== (event.shiftKey || event.buttons === 2);
    hands.edit(orbits ? { orbit: { yaw_degrees, pitch_degrees } } : { fly: { yaw_degrees: -yaw_degrees, pitch_degrees } });
  });
  const end = (event) => fingers.delete(event.pointerId);
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("click", (event) => {
    if (moved < STILL && event.detail === 1) hands.edit({ focus: hands.pixel(event.clientX, event.clientY) });
  });
  canvas.addEventListener("dblclick", (event) => hands.edit({ frame: hands.pixel(event.clientX, event.clientY) }));
}

function wheel(canvas, hands) {
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 50 : event.deltaY;
    closer(hands, hands.orbits(), 1.05 ** Math.min(10, Math.max(-10, -lines)));
  }, { passive: false });
}

/** Whether a key event belongs to a field of the panel. */
function elsewhere(event) {
  return event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
}

/** Sum of the movements of all held keys; `by` gives the step of each kind of movement. */
function total(held, by) {
  const sum = {};
  for (const [axis, sign] of [...held].flatMap((code) => Object.entries(MOVES[code]))) {
    const amount = axis === "zoom" ? by.zoom : axis.endsWith("_degrees") ? by.turn : by.step;
    sum[axis] = (sum[axis] ?? 0) + sign * amount;
  }
  return sum;
}

function keys(hands) {
  const held = new Set();
  let running = false;
  let before = null;
  let fast = false;
  // Held keys move the camera in proportion to the elapsed time, once per animation frame.
  const fly = (now) => {
    running = held.size > 0;
    if (!running) {
      before = null;
      return;
    }
    const seconds = before === null ? 1 / 60 : Math.min(0.1, Math.max(0.001, (now - before) / 1000));
    before = now;
    const step = hands.flightSpeed() * seconds * (fast ? 4 : 1);
    const { zoom = 0, ...sum } = total(held, { step, turn: DEGREES * seconds, zoom: ZOOM * seconds });
    if (Object.keys(sum).length > 0) hands.edit({ fly: sum });
    if (zoom !== 0) hands.edit({ zoom: Math.exp(zoom) });
    requestAnimationFrame(fly);
  };
  addEventListener("keydown", (event) => {
    fast = event.shiftKey;
    if (elsewhere(event)) return;
    if (!MOVES[event.code]) return;
    event.preventDefault();
    held.add(event.code);
    // Move at once, so that the shortest key press has an effect.
    if (!running) fly(performance.now());
  });
  addEventListener("keyup", (event) => {
    fast = event.shiftKey;
    held.delete(event.code);
  });
  addEventListener("blur", () => held.clear());
}
