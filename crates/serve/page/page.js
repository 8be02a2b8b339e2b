// Main module: passes the server's messages to image and panel, and gestures and keys to the
// server.

import { held, steering } from "./camera.js";
import { Connection } from "./connection.js";
import { chosen, watchDrops } from "./files.js";
import { Keys } from "./keys.js";
import * as notices from "./notices.js";
import { setMode, setSpeed, showLatency, showStatus, watchPanel } from "./panel.js";
import { Picture } from "./picture.js";
import { watchPointer } from "./pointer.js";
import { fillScenes, openScenes } from "./scenes.js";
import { upload } from "./upload.js";

const byId = (id) => document.getElementById(id);
const canvas = byId("picture");
const picture = new Picture(canvas, byId("region"));
const PROBE_MILLISECONDS = 60, PENDING_MILLISECONDS = 300, SPEED_STEP = 1.5, EXPOSURE_STEP = 0.25, KEPT_MILLISECONDS = 60000;

let status = null, catalog = null, wheel = { steering: true, free: false, watching: 1 };
let pending = null;
const probing = { mode: "off", at: null, waiting: false, last: 0 };
let choosingRegion = false;

// Remove the token from the URL; the server has stored it in a cookie.
if (new URLSearchParams(location.search).has("token")) history.replaceState(null, "", "/");

// Whether this page is connected and steers; otherwise the user learns why not.
function canEdit() {
  if (connection.isOpen && !wheel.steering && !wheel.free) {
    notices.toast("Another page controls the session: take control first");
    return false;
  }
  return connection.isOpen;
}

// Opens the scene, model or mesh among dropped or chosen files.
async function openFiles(files) {
  if (files.length === 0 || !canEdit()) return;
  try {
    notices.toast("uploading the files");
    connection.send({ dropped: await upload(files, catalog?.most.upload) });
  } catch (error) {
    notices.toast(error.message);
  }
}

// Sends an edit to the server if this page steers.
function edit(change) {
  if (!change || !canEdit()) return;
  pending ??= { at: performance.now(), revision: status?.revision ?? 0 };
  connection.send({ edit: change });
}

const connection = new Connection({
  open() {
    notices.connectionLost(null);
    [status, pending, probing.waiting] = [null, null, false];
  },
  lost(pause, why) {
    byId("stage-chip").dataset.stage = "lost";
    byId("stage-text").textContent = "offline";
    notices.connectionLost(pause, why);
  },
  message(message) {
    const [kind, value] = Object.entries(message)[0];
    ({ status: gotStatus, wheel: gotWheel, probe: gotProbe, refused: notices.toast })[kind]?.(value);
  },
  frame(bitmap, facts) {
    picture.show(bitmap, facts.size);
    if (pending && facts.revision > pending.revision) {
      facts.latency = performance.now() - pending.at;
      showLatency(facts.latency);
      pending = null;
    }
    canvas.dataset.revision = facts.revision;
    canvas.dataset.number = facts.number;
    canvas.dataset.kind = facts.kind;
    canvas.dataset.latency = facts.latency ?? canvas.dataset.latency ?? "";
  },
});

function gotStatus(news) {
  stopLatency(news);
  status = news;
  if (catalog) showStatus(status, titleOf(status.scene), edit);
  notices.sceneError(status.error);
  if (!choosingRegion) picture.frame(status.region);
  if (probing.mode !== "off") askProbe();
}

// Stops the latency measurement of an edit that produces no new frame.
function stopLatency(news) {
  const waited = pending;
  if (!waited || news.stage !== "finished" || news.revision <= waited.revision) return;
  setTimeout(() => (pending = pending === waited ? null : pending), PENDING_MILLISECONDS);
}

function titleOf(name) {
  const own = catalog?.file?.name === name ? catalog.file : catalog?.scenes.find((scene) => scene.name === name);
  return own?.title || name || "juggler";
}

function gotWheel(news) {
  wheel = news;
  notices.wheel(news);
}

function gotProbe(facts) {
  probing.waiting = false;
  if (probing.mode !== "off") notices.probe(facts);
}

function askProbe() {
  const now = performance.now();
  if (!probing.at || probing.waiting || now - probing.last < PROBE_MILLISECONDS) return;
  [probing.waiting, probing.last] = [true, now];
  connection.send({ probe: probing.at.map(Math.floor) });
}

function setProbing(mode) {
  probing.mode = mode;
  byId("probe-button").ariaPressed = `${mode !== "off"}`;
  if (mode === "off") notices.probe(null);
  else askProbe();
}

function setRegionChoice(on) {
  choosingRegion = on;
  canvas.classList.toggle("choosing", on);
  byId("region-button").ariaPressed = `${on}`;
}

function probeAt(point) {
  const place = picture.at(...point);
  if (!place) return;
  probing.at = place;
  askProbe();
}

watchPointer(canvas, picture, {
  edit,
  status: () => status,
  choosesRegion: () => keys.region || choosingRegion,
  hover(point) {
    if (probing.mode === "follow") probeAt(point);
  },
  tap(point) {
    if (probing.mode !== "off") return probeAt(point);
    const place = picture.at(...point);
    if (!place) return;
    notices.mark(...point);
    edit({ focus: place });
  },
  doubleTap(point) {
    edit({ frame: picture.at(...point) });
  },
  region(from, to, done) {
    const rect = picture.between(from, to);
    picture.frame(rect);
    if (!done) return (choosingRegion = true);
    setRegionChoice(false);
    edit({ region: rect.width > 1 && rect.height > 1 ? rect : null });
  },
});

const commands = {
  faster: () => setSpeed(steering.speed * SPEED_STEP),
  slower: () => setSpeed(steering.speed / SPEED_STEP),
  mode: () => setMode(steering.mode === "fly" ? "orbit" : "fly"),
  frameAll: () => edit({ frame: null }),
  nextCamera() {
    if (!status?.cameras.length) return;
    const next = (status.cameras.indexOf(byId("camera").value) + 1) % status.cameras.length;
    byId("camera").value = status.cameras[next];
    edit({ camera: status.cameras[next] });
  },
  bookmark() {
    togglePanel(true);
    byId("bookmark-name").focus();
  },
  whole: () => edit({ region: null }),
  denoise: () => edit({ setting: { denoise: !status?.denoise } }),
  probe: () => setProbing({ off: "follow", follow: "pin", pin: "off" }[probing.mode]),
  brighter: () => edit({ setting: { exposure: (status?.exposure ?? 0) + EXPOSURE_STEP } }),
  darker: () => edit({ setting: { exposure: (status?.exposure ?? 0) - EXPOSURE_STEP } }),
  save: () => byId("save-png").click(),
  play: () => status?.frames > 1 && edit({ play: !status.playing }),
  frameBefore: () => stepFrame(-1),
  frameAfter: () => stepFrame(1),
  panel: () => togglePanel(),
  scenes: () => openScenes(status?.scene),
  help: () => byId("help").showModal(),
  reset: () => edit("reset"),
  close() {
    if (choosingRegion) setRegionChoice(false);
    else if (probing.mode !== "off") setProbing("off");
    else byId("error").classList.add("folded");
  },
};
for (let index = 0; index < 8; index += 1) commands[`channel${index}`] = () => catalog && edit({ show: catalog.channels[index] });

function stepFrame(step) {
  if (!(status?.frames > 1)) return;
  edit({ at: (Math.round(status.frame) + step + status.frames) % status.frames });
}

const keys = new Keys({
  commands,
  hold: (motions, fast, seconds) => status && held(motions, fast, seconds, status.flight_speed).forEach(edit),
  isBlocked: () => document.querySelector("dialog[open]") !== null,
});

// Downloads the current image.
async function save(address) {
  notices.toast("Saving the picture");
  const answer = await fetch(address).catch(() => null);
  if (!answer?.ok) return notices.toast(`Not saved: ${answer ? (await answer.text()).trim() : "the server does not answer"}`);
  const [, name] = /filename="([^"]+)"/.exec(answer.headers.get("content-disposition")) ?? [null, "picture"];
  const file = URL.createObjectURL(await answer.blob());
  notices.element("a", { href: file, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(file), KEPT_MILLISECONDS);
  notices.toast(`Saved ${name}`);
}

function togglePanel(open = document.body.classList.contains("panel-closed")) {
  document.body.classList.toggle("panel-closed", !open);
  for (const id of ["toggle-panel", "sheet-handle"]) byId(id).ariaExpanded = `${open}`;
}

byId("toggle-panel").onclick = () => togglePanel();
byId("sheet-handle").onclick = () => togglePanel();
for (const id of ["save-png", "save-exr"]) {
  byId(id).onclick = (event) => {
    event.preventDefault();
    save(event.currentTarget.href);
  };
}
byId("open-help").onclick = commands.help;
byId("open-scenes").onclick = commands.scenes;
byId("take-wheel").onclick = () => connection.send({ steer: true });
byId("connection").onclick = () => connection.retry();
byId("fold-error").onclick = () => byId("error").classList.toggle("folded");
byId("probe-button").onclick = () => setProbing(probing.mode === "off" ? "follow" : "off");
byId("region-button").onclick = () => setRegionChoice(!choosingRegion);
byId("play").onclick = commands.play;
byId("time").oninput = ({ target }) => edit({ at: Number(target.value) });
for (const dialog of document.querySelectorAll("dialog")) {
  dialog.addEventListener("click", ({ target }) => {
    if (target === dialog || target.closest("[data-close]")) dialog.close();
  });
}
watchDrops(openFiles);
byId("files").onchange = ({ target }) => {
  byId("scenes").close();
  openFiles(chosen(target.files));
  target.value = "";
};
if (matchMedia("(max-width: 720px)").matches) togglePanel(false);
setMode(steering.mode);
notices.fillHelp();

async function readCatalog() {
  const answer = await fetch("/catalogue.json");
  if (!answer.ok) return;
  catalog = await answer.json();
  const fit = () => [canvas.width, canvas.height];
  watchPanel(catalog, edit, fit);
  fillScenes(catalog, (name) => edit({ scene: name }));
  if (status) showStatus(status, titleOf(status.scene), edit);
}
readCatalog();
