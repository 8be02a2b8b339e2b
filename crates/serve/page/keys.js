// Every key and gesture in one table: the page acts by it, the help shows it. The same as in the native window, but for
// Tab, which here goes from one control to the next.

const hold = (keys, axis, sign, says) => ({ keys, motion: [axis, sign], says });
const press = (keys, command, says) => ({ keys, command, says });

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
      press(["f"], "frameAll", "everything into view"),
      press(["v"], "nextCamera", "next camera of the scene"),
      press(["b"], "bookmark", "keep this camera"),
    ],
  },
  {
    name: "Picture",
    gestures: [["R drag", "refine only this part"]],
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
    keys: [press([" "], "play", "play, stop"), press([","], "frameBefore", "frame before, after"), press(["."], "frameAfter", "frame before, after")],
  },
  {
    name: "Page",
    gestures: [],
    keys: [
      press(["h"], "panel", "show or hide the settings"),
      press(["g"], "scenes", "choose a scene"),
      press(["?", "F1"], "help", "these keys"),
      press(["Home"], "reset", "undo all changes"),
      press(["Escape"], "close", "close what lies over the picture"),
    ],
  },
];

const ROWS = new Map(GROUPS.flatMap((group) => group.keys.flatMap((row) => row.keys.map((key) => [key, row]))));
const NAMES = { ArrowUp: "↑", ArrowDown: "↓", ArrowLeft: "←", ArrowRight: "→", PageUp: "Page ↑", PageDown: "Page ↓", " ": "Space", Escape: "Esc", "Control s": "Ctrl S" };

/// `on` has `commands` by name, `hold(motions, fast, seconds)` for each frame of the screen, and `isBlocked()`.
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

  /// The first step is taken at once, the others with the frames of the screen.
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

/// Whether a key belongs to the control that has the focus.
function isTyping(target, key) {
  if (!(target instanceof HTMLElement)) return false;
  if (target.matches("input[type=range], input[type=radio], summary, pre")) return key.startsWith("Arrow") || key.startsWith("Page") || key === " " || key === "Home";
  if (target.matches("button, a")) return key === " " || key === "Enter";
  return target.matches("input, select, textarea");
}

/// The table as the help shows it: rows with the same words are one.
export function helpOf(group) {
  const rows = new Map();
  for (const { keys, says } of group.keys) rows.set(says, [...(rows.get(says) ?? []), ...keys]);
  const caps = (keys) => keys.map((key) => NAMES[key] ?? (key.length === 1 ? key.toUpperCase() : key));
  return { gestures: group.gestures, keys: [...rows].map(([says, keys]) => [caps(keys), says]) };
}
