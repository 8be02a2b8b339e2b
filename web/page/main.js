// The page: starts the workers, sends requests to them and shows the results.

import init, { scenes } from "./juggler.js";
import { listen } from "./controls.js";
import { chosen, scene, watchDrops } from "./files.js";
import { Pool } from "./pool.js";
import { View } from "./view.js";

const $ = (id) => document.getElementById(id);
const cores = Math.max(1, navigator.hardwareConcurrency ?? 2);

let view = null;
let pool = null;
let status = null;
/** The open scene: its name, dropped files, and the edits since then, which workers that start
 * later repeat. */
let source = { name: new URLSearchParams(location.search).get("scene") ?? "juggler", files: [], log: [] };
/** The scene that is being opened; if it has errors, the open scene stays. */
let next = null;
let began = 0;
let playing = null;

function fail(text) {
  $("error").textContent = text;
  $("error").hidden = !text;
}

function edit(...edits) {
  (next ?? source).log.push(...edits);
  $("hash").textContent = "";
  began = performance.now();
  pool.edit(...edits);
}

function open(name, files) {
  play(false);
  fail("");
  next = { name, files, log: [] };
  began = performance.now();
  $("hash").textContent = "";
  if (pool.lost) begin();
  else pool.open(next);
}

const news = {
  opened(now) {
    [source, next] = [next ?? source, null];
    view.open(now.outline);
    tell(now);
    const known = [...$("scene").options].some((option) => option.value === source.name && source.files.length === 0);
    if (!known && !$("scene").querySelector("[data-own]")) {
      $("scene").append(Object.assign(new Option(), { value: "", disabled: true }));
      $("scene").lastChild.dataset.own = "";
    }
    const own = $("scene").querySelector("[data-own]");
    if (!known) own.textContent = source.name;
    $("scene").selectedIndex = known ? [...$("scene").options].findIndex((option) => option.value === source.name) : own.index;
    document.title = `${now.title || source.name} – Juggler`;
    $("description").textContent = now.description ?? "";
  },

  frame({ status: now, error, kept, coarse, rects }) {
    fail(error ?? "");
    if (now.outline.size.join() !== view.size.join()) view.open(now.outline);
    view.resume(now.outline);
    if (!kept) view.coarse(coarse, rects);
    tell(now);
    const milliseconds = performance.now() - began;
    $("speed").textContent = `${coarse.join(" × ")} in ${milliseconds.toFixed(0)} ms`;
    progress();
  },

  tiles(message) {
    view.tiles(message);
    progress();
  },

  failed(text) {
    next = null;
    fail(text);
    if (status) progress();
  },
};

/** Updates the fields of the panel from the status, except the field that has the focus. */
function tell(now) {
  status = now;
  const set = (id, value) => document.activeElement !== $(id) && ($(id).value = value);
  $("size").textContent = now.outline.size.join(" × ");
  $("camera").replaceChildren(...now.cameras.map((name) => new Option(name)));
  $("camera").parentElement.hidden = now.cameras.length < 2;
  set("camera", now.camera);
  set("wanted", now.outline.samples);
  set("exposure", now.exposure);
  $("stops").textContent = `${now.exposure > 0 ? "+" : ""}${now.exposure}`;
  $("time").hidden = now.frames < 2;
  $("at").max = Math.max(0, now.frames - 1);
  set("at", now.frame);
  $("frame").textContent = Number(now.frame.toFixed(2));
}

function progress() {
  const samples = view.compositor.samples();
  const wanted = status.outline.samples;
  $("samples").textContent = `${samples < 10 ? samples.toFixed(1) : samples.toFixed(0)} of ${wanted}`;
  $("bar").style.width = `${Math.min(100, (100 * samples) / wanted)}%`;
  if ($("hash").textContent) return;
  $("seconds").textContent = `${((performance.now() - began) / 1000).toFixed(2)} s`;
  if (view.compositor.isFinished()) $("hash").textContent = view.compositor.hash();
}

function save() {
  const blob = new Blob([view.compositor.png()], { type: "image/png" });
  const name = source.name.split("/").at(-1).replace(/\.(json|gltf|glb|obj|ply|stl)$/i, "");
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: `${name}.png` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

/** Plays in real time: frames that would be late are skipped. */
function play(on) {
  cancelAnimationFrame(playing);
  playing = null;
  $("play").textContent = on ? "⏸" : "▶";
  if (!on || !(status?.frames > 1)) return;
  const [start, first] = [performance.now(), status.frame];
  const next = (now) => {
    playing = requestAnimationFrame(next);
    if (pool.busy) return;
    edit({ at: Math.floor(first + ((now - start) / 1000) * status.frame_rate) % status.frames });
  };
  playing = requestAnimationFrame(next);
}

function panel() {
  $("toggle").onclick = () => {
    const bare = document.body.classList.toggle("bare");
    $("toggle").setAttribute("aria-expanded", String(!bare));
  };
  $("scene").onchange = () => open($("scene").value, []);
  $("open").onclick = () => $("files").click();
  $("files").onchange = () => take(chosen($("files").files));
  $("save").onclick = save;
  $("reset").onclick = () => edit("reset");
  $("camera").onchange = () => edit({ camera: $("camera").value });
  $("wanted").onchange = () => edit({ setting: { samples: Math.max(1, Number($("wanted").value)) } });
  $("exposure").oninput = () => edit({ setting: { exposure: Number($("exposure").value) } });
  $("at").oninput = () => edit({ at: Number($("at").value) });
  $("play").onclick = () => play(playing === null);
  $("workers").max = Math.max(cores, 2);
  $("workers").value = Math.min(cores, 8);
  $("workers").onchange = begin;
  addEventListener("keydown", (event) => {
    if (event.key === "s" && (event.ctrlKey || event.metaKey)) save();
    else if (event.key === "Tab" && event.target === $("picture")) $("toggle").click();
    else if (event.key === "Home" && event.target === $("picture")) edit("reset");
    else if (event.key === " " && event.target === $("picture")) play(playing === null);
    else return;
    event.preventDefault();
  });
}

async function take(files) {
  try {
    const { name, files: all } = await scene(files);
    open(name, all);
  } catch (error) {
    fail(error.message);
  }
}

let module = null;

/** Starts the requested number of workers; they open the current scene and repeat all edits. */
function begin() {
  pool?.close();
  const count = Number($("workers").value);
  $("count").textContent = count;
  $("hash").textContent = "";
  began = performance.now();
  pool = new Pool(module, count, (what, ...rest) => news[what](...rest));
  pool.open(next ?? source);
}

async function start() {
  const bytes = await (await fetch(new URL("juggler_bg.wasm", import.meta.url))).arrayBuffer();
  module = await WebAssembly.compile(bytes);
  const { memory } = await init({ module_or_path: module });
  view = new View($("picture"), memory);
  for (const { name, title } of JSON.parse(scenes())) $("scene").append(Object.assign(new Option(name), { title }));
  const hands = {
    edit,
    flightSpeed: () => status?.flight_speed ?? 1,
    orbits: () => document.querySelector("[name=drag]:checked").value === "orbit",
    pixel: (x, y) => view.pixel(x, y),
  };
  listen($("picture"), hands);
  panel();
  watchDrops(take);
  begin();
}

start().catch((error) => fail(`The page cannot start: ${error.message ?? error}`));
