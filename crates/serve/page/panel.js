// Settings panel: shows the status and sends changed settings as edits.

import { element } from "./notices.js";
import { steering } from "./camera.js";
import { showLights } from "./lights.js";
import { showModels } from "./models.js";

const byId = (id) => document.getElementById(id);
const SIZES = [[320, 180], [640, 360], [960, 540], [1280, 720], [1920, 1080], [640, 480], [1024, 768]];
const STAGES = { loading: "loading", moving: "moving", refining: "refining", finished: "finished" };

const count = (value) => {
  const [unit, divisor] = value >= 1e9 ? [" G", 1e9] : value >= 1e6 ? [" M", 1e6] : value >= 1e4 ? [" k", 1e3] : ["", 1];
  return divisor === 1 ? `${Math.round(value)}` : `${(value / divisor).toPrecision(3)}${unit}`;
};

/// Sets the value of a control, unless it is being edited.
function show(id, value) {
  const control = byId(id);
  if (document.activeElement === control && control.matches("input[type=number], input[type=range]:active")) return;
  if (control.value !== `${value}`) control.value = value;
}

function fill(id, names) {
  const control = byId(id);
  const key = names.join("\n");
  if (control.dataset.names === key) return;
  control.dataset.names = key;
  control.replaceChildren(...names.map((name) => element("option", { value: name }, `${name}`.replaceAll("_", " ") || "choose")));
}

/// Connects the controls to `edit(edit)`; `fit()` returns the size of the canvas in pixels.
export function watchPanel(catalog, edit, fit) {
  const setting = (name, read) => (event) => {
    const value = read(event.target.value);
    if (event.target.checkValidity() && !Number.isNaN(value)) edit({ setting: { [name]: value } });
  };
  fill("channel", catalog.channels);
  byId("channel").onchange = ({ target }) => edit({ show: target.value });
  for (const [id, names, name] of [["tone", catalog.tones, "tone"], ["integrator", catalog.integrators, "integrator"], ["sampler", catalog.samplers, "sampler"], ["scheduler", catalog.schedulers, "scheduler"]]) {
    fill(id, names);
    byId(id).onchange = setting(name, String);
  }
  for (const [id, name] of [["samples", "samples"], ["max-depth", "max_depth"], ["threads", "threads"]]) {
    byId(id).onchange = setting(name, Number);
  }
  byId("samples").max = catalog.most.samples;
  byId("exposure").oninput = setting("exposure", Number);
  byId("exposure").ondblclick = () => edit({ setting: { exposure: 0 } });
  byId("camera").onchange = ({ target }) => edit({ camera: target.value });
  byId("bookmark").onsubmit = (event) => {
    event.preventDefault();
    const name = byId("bookmark-name").value.trim();
    if (!name) return byId("bookmark-name").focus();
    edit({ bookmark: name });
    byId("bookmark-name").value = "";
  };
  watchSize(catalog, edit, fit);
  byId("speed").oninput = ({ target }) => setSpeed(10 ** Number(target.value));
  for (const radio of document.getElementsByName("mode")) radio.onchange = () => (steering.mode = radio.value);
  byId("frame-all").onclick = () => edit({ frame: null });
  byId("reset").onclick = () => edit("reset");
  byId("reload").onclick = () => edit("reload");
  byId("whole").onclick = () => edit({ region: null });
  byId("denoise").onclick = ({ currentTarget }) => edit({ setting: { denoise: currentTarget.ariaPressed !== "true" } });
}

function watchSize(catalog, edit, fit) {
  const options = SIZES.map(([width, height]) => [`${width} ${height}`, `${width} × ${height}`]);
  const choices = [["now", "now"], ["fit", "this screen"], ["half", "this screen, half"], ...options, ["own", "other …"]];
  byId("size").replaceChildren(...choices.map(([value, text]) => element("option", { value }, text)));
  byId("size").onchange = ({ target }) => {
    const own = target.value === "own";
    byId("own-size").hidden = !own;
    if (own) return byId("width").focus();
    const [width, height] = fit();
    const sizes = { fit: [width, height], half: [Math.ceil(width / 2), Math.ceil(height / 2)] };
    const size = sizes[target.value] ?? target.value.split(" ").map(Number);
    target.value = "now";
    if (size.length === 2) edit({ setting: { size } });
  };
  for (const id of ["width", "height"]) byId(id).max = catalog.most.edge;
  byId("own-size").onsubmit = (event) => {
    event.preventDefault();
    edit({ setting: { size: [Number(byId("width").value), Number(byId("height").value)] } });
    byId("own-size").hidden = true;
    byId("size").value = "now";
  };
}

/// Sets the speed of the keys.
export function setSpeed(speed) {
  steering.speed = Math.min(Math.max(speed, 1e-3), 1e3);
  byId("speed").value = Math.log10(steering.speed);
  byId("speed-text").textContent = `${Number(steering.speed.toPrecision(2))}×`;
}

/// Sets the effect of a drag: `fly` or `orbit`.
export function setMode(mode) {
  steering.mode = mode;
  for (const radio of document.getElementsByName("mode")) radio.checked = radio.value === mode;
}

/// Shows the status.
export function showStatus(status, title, edit) {
  byId("scene-title").textContent = title;
  document.title = `${title} · juggler`;
  byId("stage-chip").dataset.stage = status.stage;
  const share = status.samples_wanted ? Math.min(1, status.samples / status.samples_wanted) : 0;
  const percent = share > 0 && share < 1 ? ` ${Math.floor(share * 100)} %` : "";
  byId("stage-text").textContent = STAGES[status.stage] + (status.stage === "refining" ? percent : "");
  byId("progress").value = share;
  byId("progress").classList.toggle("done", status.stage === "finished");
  showFigures(status);
  for (const id of ["channel", "tone", "integrator", "sampler", "scheduler", "threads", "exposure"]) show(id, status[id]);
  byId("exposure-text").textContent = `${status.exposure > 0 ? "+" : ""}${Number(status.exposure.toFixed(2))}`;
  byId("denoise").ariaPressed = `${status.denoise}`;
  show("samples", status.samples_wanted);
  byId("depth-row").hidden = status.max_depth === null;
  [byId("max-depth").min, byId("max-depth").max] = status.depth_range;
  show("max-depth", status.max_depth ?? "");
  byId("size").options[0].textContent = `${status.size[0]} × ${status.size[1]}`;
  for (const [axis, id] of ["width", "height"].entries()) if (byId("own-size").hidden) byId(id).value = status.size[axis];
  fill("camera", ["", ...status.cameras]);
  byId("whole").hidden = !status.region;
  byId("hash").hidden = !status.hash;
  byId("hash").textContent = status.hash ? `film hash ${status.hash}` : "";
  showLights(status.light_groups, edit);
  showModels(status.models, edit);
  showTime(status);
}

function showFigures(status) {
  const figure = (name, text) => (byId(`figure-${name}`).textContent = text);
  figure("samples", status.samples < 10 && status.samples % 1 ? status.samples.toFixed(1) : count(status.samples));
  figure("noise", status.noise === null ? "–" : `${(status.noise * 100).toPrecision(2)} %`);
  byId("clamped").hidden = status.clamped === null;
  figure("clamped", `${((status.clamped ?? 0) * 100).toFixed(1)} %`);
  figure("fps", status.frames_per_second > 0 ? status.frames_per_second.toFixed(status.frames_per_second < 10 ? 1 : 0) : "–");
  figure("rays", status.rays_per_second > 0 ? count(status.rays_per_second) : "–");
  const coarse = status.coarseness > 1 ? `, 1/${status.coarseness}` : "";
  figure("size", `${status.size[0]} × ${status.size[1]}${coarse}${status.denoised ? ", denoised" : ""}`);
}

function showTime(status) {
  byId("timeline").hidden = !(status.frames > 1);
  if (!(status.frames > 1)) return;
  byId("time").max = status.frames - 0.01;
  show("time", status.frame);
  const frame = status.frame % 1 ? status.frame.toFixed(2) : status.frame;
  byId("time-text").textContent = `${frame} / ${status.frames - 1}`;
  byId("play").textContent = status.playing ? "❚❚" : "▶";
  byId("play").ariaLabel = status.playing ? "Stop" : "Play";
}

/// Shows the time from the last input to the frame that includes it.
export function showLatency(milliseconds) {
  byId("figure-latency").textContent = `${Math.round(milliseconds)} ms`;
}
