// Table of all keys and gestures, used by the input and by the help. Commands that the native
// window has too have the same keys, except that H replaces Tab, which moves the focus here.

const hold = (keys, axis, sign, help) => ({ keys, motion: [axis, sign], help });
const press = (keys, command, help) => ({ keys, command, help });

export const GROUPS = [
  {
    name: "Camera",
    gestures: [
      ["drag, one finger", "look around (fly), turn the scene about the point to orbit (orbit)"],
      ["Shift drag, two fingers", "move sideways and up"],
      ["wheel, pinch", "zoom (fly), come closer (orbit)"],
      ["click, tap", "set the point to orbit, and the focus of a lens"],
      ["double click, double tap", "bring an object into view"],
      ["Shift with keys", "four times as fast"],
    ],
    keys: [
      hold(["w", "ArrowUp"], "forward", 1, "forward"),
      hold(["s", "ArrowDown"], "forward", -1, "back"),
      hold(["a", "ArrowLeft"], "right", -1, "left"),
      hold(["d", "ArrowRight"], "right", 1, "right"),
      hold(["e", "PageUp"], "up", 1, "up"),
      hold(["q", "PageDown"], "up", -1, "down"),
      hold(["j"], "yaw_degrees", -1, "yaw"),
      hold(["l"], "yaw_degrees", 1, "yaw"),
      hold(["i"], "pitch_degrees", 1, "pitch"),
      hold(["k"], "pitch_degrees", -1, "pitch"),
      hold(["u"], "roll_degrees", -1, "roll"),
      hold(["o"], "roll_degrees", 1, "roll"),
      hold(["x"], "zoom", 1, "zoom"),
      hold(["c"], "zoom", -1, "zoom"),
      press(["+", "="], "faster", "faster"),
      press(["-"], "slower", "slower"),
      press(["m"], "mode", "fly or orbit"),
      press(["f"], "frameAll", "bring everything into view"),
      press(["v"], "nextCamera", "next camera of the scene"),
      press(["b"], "bookmark", "bookmark this camera"),
    ],
  },
  {
    name: "Picture",
    gestures: [["R drag", "refine only this region"]],
    keys: [
      press(["t"], "whole", "refine the whole picture"),
      press(["p"], "probe", "probe the pixel: follow, pin, off"),
      press(["n"], "denoise", "denoise, when nothing moves"),
      press(["["], "darker", "exposure"),
      press(["]"], "brighter", "exposure"),
      ...["picture", "albedo", "normals", "depth", "objects", "materials", "samples", "noise"].map((name, index) => press([`${index + 1}`], `channel${index}`, name)),
      press(["Control s"], "save", "save the picture"),
    ],
  },
  {
    name: "Time",
    gestures: [],
    keys: [press([" "], "play", "play or stop"), press([","], "frameBefore", "previous, next frame"), press(["."], "frameAfter", "previous, next frame")],
  },
  {
    name: "Page",
    gestures: [],
    keys: [
      press(["h"], "panel", "show or hide the settings"),
      press(["g"], "scenes", "choose a scene"),
      press(["?", "F1"], "help", "these keys"),
      press(["Home"], "reset", "undo all changes"),
      press(["Escape"], "close", "close dialogs and overlays"),
    ],
  },
];

const ROWS = new Map(GROUPS.flatMap((group) => group.keys.flatMap((row) => row.keys.map((key) => [key, row]))));
const NAMES = { ArrowUp: "↑", ArrowDown: "↓", ArrowLeft: "←", ArrowRight: "→", PageUp: "Page ↑", PageDown: "Page ↓", " ": "Space", Escape: "Esc", "Control s": "Ctrl S" };

/// `on` has `commands` by name, `hold(motions, fast, seconds)` for each animation frame, and
/// `isBlocked()`.
export class Keys {
  constructor(on) {
    this.on = on;
    this.held = new Map();
    this.fast = false;
    this.region = false;
    addEventListener("keydown", (event) => this.down(event));
    addEventListener("keyup", (event) => this.up(event));
    addEventListener("blur", () => this.release());
  }

  down(event) {
    const control = event.ctrlKey || event.metaKey;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.altKey || this.on.isBlocked() || isTyping(event.target, name)) return;
    this.fast = event.shiftKey;
    if (name === "r" && !control) this.region = true;
    const row = ROWS.get(control ? `Control ${name}` : name);
    if (!row) return;
    event.preventDefault();
    if (row.command) {
      if (!event.repeat) this.on.commands[row.command]();
    } else if (!this.held.has(event.code)) {
      this.held.set(event.code, row.motion);
      if (this.held.size === 1) this.begin();
    }
  }

  up(event) {
    this.fast = event.shiftKey;
    if (event.key.toLowerCase() === "r") this.region = false;
    this.held.delete(event.code);
  }

  release() {
    this.held.clear();
    this.region = false;
  }

  /// Performs the first step at once, further ones with each animation frame.
  begin() {
    let last = performance.now();
    const step = (seconds) => this.on.hold([...this.held.values()], this.fast, seconds);
    const next = (now) => {
      if (this.held.size === 0) return;
      const seconds = (now - last) / 1000;
      if (seconds > 0) {
        step(seconds);
        last = now;
      }
      requestAnimationFrame(next);
    };
    step(1 / 60);
    requestAnimationFrame(next);
  }
}

/// Returns whether a key belongs to the focused control.
function isTyping(target, key) {
  if (!(target instanceof HTMLElement)) return false;
  if (target.matches("input[type=range], input[type=radio], summary, pre")) return key.startsWith("Arrow") || key.startsWith("Page") || key === " " || key === "Home";
  if (target.matches("button, a")) return key === " " || key === "Enter";
  return target.matches("input, select, textarea");
}

/// Returns a group for the help; rows with the same text are merged.
export function helpOf(group) {
  const rows = new Map();
  for (const { keys, help } of group.keys) rows.set(help, [...(rows.get(help) ?? []), ...keys]);
  const caps = (keys) => keys.map((key) => NAMES[key] ?? (key.length === 1 ? key.toUpperCase() : key));
  return { gestures: group.gestures, keys: [...rows].map(([help, keys]) => [caps(keys), help]) };
}
