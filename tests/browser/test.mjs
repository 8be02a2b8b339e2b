// See test.sh.

import { strict as assert } from "node:assert";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { dropFiles, model } from "./drop.mjs";
import { Tab, difference, median, pause, startBrowser, startServer, until } from "./harness.mjs";

const [program, executable, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "juggler-browser-"));
const file = join(folder, "ball.json");
const scene = (color) => `{
  "version": 1,
  "title": "Ball",
  "render": {"size": [640, 480], "samples": 4},
  "cameras": {
    "main": {"perspective": {"eye": [0, 1, 6], "look_at": [0, 1, 0]}},
    "top": {"perspective": {"eye": [0, 6, 1], "look_at": [0, 0, 0]}}
  },
  "background": [0.2, 0.3, 0.5],
  "materials": {"ball": {"phong": {"diffuse": ${color}, "specular": 0.5, "shininess": 60}}, "floor": {"phong": {"diffuse": 0.6, "reflection": 0.2}}},
  "lights": [{"point": {"position": [4, 6, 4], "intensity": 60}}],
  "objects": [
    {"shape": "plane", "material": "floor"},
    {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}], "material": "ball"}
  ]
}`;
writeFileSync(file, scene("[0.8, 0.1, 0.1]"));

const start = performance.now();
const say = (text) => console.log(`${((performance.now() - start) / 1000).toFixed(1).padStart(6)} s  ${text}`);
const words = (port) => [file, "--size", "640x480", "--addr", `127.0.0.1:${port}`, "--threads", "2"];
let server = await startServer(program, words(0));
const browser = await startBrowser(executable);
const desktop = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true });
const tabs = [];

async function open(context, url = server.url) {
  const tab = await Tab.open(context, url, pictures);
  tabs.push(tab);
  return tab;
}

/// Returns the mean difference of the picture before and after an action.
async function change(tab, act) {
  await tab.finished();
  const [before, { revision }] = [await tab.fields(), await tab.shown()];
  await act();
  await tab.frame((shown) => shown.revision > revision);
  await tab.reported("the change", (status) => status.revision > revision);
  await tab.finished();
  return difference(before, await tab.fields());
}

async function firstPicture() {
  const began = performance.now();
  assert(/\?token=[0-9a-f]{32}$/.test(server.url), server.url);
  const origin = new URL(server.url).origin;
  const stranger = await browser.newContext();
  const refused = await (await stranger.newPage()).goto(origin);
  assert.equal(refused.status(), 403, "without the token");
  await stranger.close();
  const tab = await open(desktop);
  assert.equal(tab.page.url(), `${origin}/`, "the token is not left where a glance reads it");
  say(`first picture after ${Math.round(performance.now() - began)} ms`);
  await tab.finished();
  const fields = await tab.fields();
  assert(new Set(fields).size > 30, "the picture is blank");
  assert.equal(await tab.page.title(), "ball.json · juggler");
  await tab.screenshot("1-first");
  const unnamed = await tab.page.evaluate(() => [...document.querySelectorAll("button, input, select, a")]
    .filter((control) => !(control.ariaLabel || control.labels?.length || control.textContent.trim() || control.placeholder))
    .map((control) => control.outerHTML));
  assert.deepEqual(unnamed, [], "controls without a name");
  const hidden = await tab.page.evaluate(() => {
    const { scrollHeight, clientHeight } = document.getElementById("panel-body");
    return scrollHeight - clientHeight;
  });
  assert(hidden <= 0, `a window of 1280 by 800 hides ${hidden} points of the settings`);
  return tab;
}

async function dragAndKeys(tab) {
  const { mouse, keyboard } = tab.page;
  const drag = async (from, to) => {
    await mouse.move(...from);
    await mouse.down();
    await mouse.move(...to, { steps: 8 });
    await mouse.up();
  };
  const dragged = await change(tab, () => drag([500, 400], [640, 430]));
  assert(dragged > 1, `a drag changed ${dragged}`);
  const eye = () => Object.values(tab.status.camera)[0].eye;
  const before = eye();
  const flightSpeed = tab.status.flight_speed;
  const flown = await change(tab, async () => {
    await keyboard.down("w");
    await pause(300);
    await keyboard.up("w");
  });
  const distance = Math.hypot(...eye().map((value, axis) => value - before[axis]));
  assert(flown > 0.2 && distance > 0.01 * tab.status.extent, `W changed ${flown}, moved ${distance}`);
  const step = tab.sent.map(String).map((text) => /"forward":([0-9.e-]+)/.exec(text)).find(Boolean);
  const speed = Number(step[1]) * 60;
  assert(Math.abs(speed / flightSpeed - 1) < 1e-3, `the first step of W is one of ${speed} per second, not ${flightSpeed}`);
  assert((await change(tab, () => mouse.wheel(0, -300))) > 0.2, "the wheel");
  assert((await change(tab, () => keyboard.press("x", { delay: 200 }))) > 0.2, "X zooms");
  await keyboard.press("m");
  assert((await change(tab, () => drag([500, 400], [600, 380]))) > 0.2, "orbit");
  const orbits = tab.sent.map(String).filter((text) => /orbit|pivot/.test(text));
  assert(/pivot/.test(orbits[0]) && orbits.filter((text) => text.includes("pivot")).length === 1, `a drag begins with its pivot: ${orbits}`);
  await keyboard.press("m");
  await change(tab, () => mouse.dblclick(490, 400));
  assert((await change(tab, () => keyboard.press("Home"))) > 0.2, "undone");
  assert((await change(tab, () => keyboard.press("3"))) > 5, "normals");
  await tab.screenshot("2-normals");
  await change(tab, () => keyboard.press("1"));
}

async function latency(tab) {
  const times = [];
  for (let index = 0; index < 15; index += 1) {
    await tab.finished();
    const { revision } = await tab.shown();
    await tab.page.keyboard.press(index % 2 ? "a" : "d");
    times.push((await tab.frame((shown) => shown.revision > revision)).latency);
  }
  const [middle, worst] = [median(times), Math.max(...times)];
  say(`from a key to the picture: median ${middle.toFixed(0)} ms, worst ${worst.toFixed(0)} ms`);
  assert(middle < 100, "a key takes too long to be seen");
  await change(tab, () => tab.page.keyboard.press("Home"));
}

async function tools(tab) {
  const { keyboard, mouse } = tab.page;
  await keyboard.press("p");
  await mouse.move(490, 420);
  await until("the probe", async () => (await tab.visible("#probe")) && /sphere/.test(await tab.page.locator("#probe").innerText()));
  await tab.screenshot("3-probe");
  await keyboard.press("Escape");
  await keyboard.down("r");
  await mouse.move(380, 300);
  await mouse.down();
  await mouse.move(560, 480, { steps: 4 });
  await mouse.up();
  await keyboard.up("r");
  await tab.reported("a region", (status) => status.region);
  await tab.screenshot("4-region");
  await keyboard.press("t");
  await tab.reported("no region", (status) => !status.region);
  const brighter = await change(tab, () => tab.page.locator("#exposure").fill("1"));
  assert(brighter > 2, "exposure");
  await change(tab, () => tab.page.locator("#exposure").fill("0"));
  await change(tab, () => tab.page.locator("#camera").selectOption("top"));
  await change(tab, () => tab.page.locator("#camera").selectOption("main"));
  await tab.page.locator("#samples").fill("8");
  await keyboard.press("Enter");
  await tab.reported("samples", (status) => status.samples_wanted === 8 && status.stage === "finished");
  await tab.page.locator("#size").selectOption("320 180");
  await tab.reported("a smaller picture", (status) => status.size[0] === 320);
  await tab.page.locator("#denoise").click();
  await tab.reported("a denoised picture", (status) => status.denoised && status.stage === "finished");
  assert.equal(await tab.page.locator("#denoise").getAttribute("aria-pressed"), "true");
  await tab.screenshot("14-denoised");
  await tab.page.locator("#picture").focus();
  await keyboard.press("n");
  await tab.reported("the noisy picture again", (status) => !status.denoise && !status.denoised && status.stage === "finished");
  await tab.page.locator("#size").selectOption("640 480");
  await tab.reported("the old size", (status) => status.size[0] === 640 && status.stage === "finished");
  await tab.page.locator("#picture").focus();
  await keyboard.press("?");
  await until("the help", () => tab.visible("#help"));
  await tab.screenshot("5-help");
  await keyboard.press("Escape");
}

async function save(tab) {
  await tab.finished();
  const [download] = await Promise.all([tab.page.waitForEvent("download"), tab.page.locator("#save-png").click()]);
  assert.equal(download.suggestedFilename(), "ball.png");
  await until("the file is named", async () => (await tab.page.locator("#toast").innerText()) === "Saved ball.png" && tab.visible("#toast"));
  await tab.screenshot("15-saved");
  const path = join(pictures, "saved.png");
  await download.saveAs(path);
  assert.equal(readFileSync(path).readUInt32BE(16), 640, "its width");
  const rendered = join(folder, "rendered.png");
  execFileSync(program, ["render", file, "--samples", "8", "-o", rendered, "--quiet"]);
  const verdict = spawnSync(program, ["compare", path, rendered], { encoding: "utf8" });
  assert.equal(verdict.status, 0, `the saved picture is another one: ${verdict.stdout}${verdict.stderr}`);
}

async function scenes(tab) {
  await tab.page.keyboard.press("g");
  await until("thumbnails", () => tab.page.evaluate(() => [...document.querySelectorAll(".card img")].filter((image) => image.naturalWidth > 0).length >= 6));
  await tab.screenshot("6-scenes");
  await tab.page.locator("#scene-search").fill("three mirror balls above");
  await tab.page.locator(".card:visible").first().click();
  await tab.reported("the other scene", (status) => status.scene === "juggler" && status.frames === 30);
  await until("its picture", async () => (await tab.shown()).revision >= tab.status.revision);
  const still = await tab.fields();
  await tab.page.locator("#picture").focus();
  await tab.page.keyboard.press(" ");
  await tab.reported("it plays", (status) => status.playing && status.frame > 0);
  await pause(700);
  await tab.page.keyboard.press(" ");
  await tab.reported("it stops", (status) => !status.playing);
  assert(difference(still, await tab.fields()) > 0.2, "nothing moved");
  await tab.page.locator("#time").fill("7");
  await tab.reported("frame 7", (status) => status.frame === 7);
  await tab.frame(({ revision }) => revision === tab.status.revision);
  await pause(1500);
  await tab.screenshot("7-juggler");
  await tab.page.keyboard.press("g");
  await tab.page.locator("#scene-search").fill("started with");
  await tab.page.locator(".card:visible").first().click();
  await tab.reported("the file again", (status) => status.frames <= 1);
}

async function liveEdits(tab) {
  let began = 0;
  const edited = await change(tab, () => {
    began = performance.now();
    writeFileSync(file, scene("[0.1, 0.6, 0.2]"));
  });
  assert(edited > 0.5, "the edit does not show");
  const { number } = await tab.shown();
  began = performance.now();
  writeFileSync(file, scene("[0.1, 0.2, 0.7]"));
  await tab.frame((shown) => shown.number > number);
  say(`a saved edit is seen after ${Math.round(performance.now() - began)} ms`);
  const good = await tab.finished().then(() => tab.fields());
  writeFileSync(file, scene("[0.1, 0.2, 0.7]").replace('"radius"', '"raduis"'));
  await until("the mistake", () => tab.visible("#error"));
  const shown = await tab.page.locator("#error-text").innerText();
  const { stderr } = spawnSync(program, ["check", file], { encoding: "utf8" });
  assert.equal(shown.trim(), stderr.trim());
  assert(difference(good, await tab.fields()) < 1, "the last good picture is gone");
  await tab.screenshot("8-error");
  writeFileSync(file, scene("[0.8, 0.1, 0.1]"));
  await until("it is good again", async () => !(await tab.visible("#error")));
  await tab.finished();
}

async function reconnect(tab) {
  const { port } = server;
  tab.serverIsAway = true;
  assert.equal(await server.stop("SIGINT"), 130);
  await until("the message about the lost connection", () => tab.visible("#connection"));
  const last = tab.status;
  await pause(1200);
  await tab.screenshot("9-lost");
  assert(/trying again/.test(await tab.page.locator("#connection").innerText()));
  server = await startServer(program, words(port));
  await until("the message about the new token", async () => /new token/.test(await tab.page.locator("#connection").innerText()));
  assert.equal(await server.stop("SIGINT"), 130);
  // Start a server without a token: the page reconnects by itself.
  server = await startServer(program, [...words(port), "--no-token"]);
  assert.equal(server.url, `http://127.0.0.1:${port}/`);
  await until("the connection", async () => !(await tab.visible("#connection")));
  // The new server numbers its pictures from the start, so wait for one of them.
  await until("a picture of the new server", async () => tab.status !== last && (await tab.shown()).revision === tab.status.revision);
  tab.serverIsAway = false;
  await change(tab, () => tab.page.keyboard.press("d"));
}

async function wheel(tab) {
  const other = await open(desktop);
  await until("it watches", () => other.visible("#watching"));
  const { revision } = await other.shown();
  await other.page.keyboard.press("d");
  await until("a message that the page only watches", () => other.visible("#toast"));
  await other.screenshot("10-watching");
  assert.equal((await other.shown()).revision, revision);
  await other.page.locator("#take-wheel").click();
  await until("the first one watches", async () => (await tab.visible("#watching")) && !(await other.visible("#watching")));
  await change(other, () => other.page.keyboard.press("d"));
  await tab.frame((shown) => shown.revision > revision);
  await other.page.close();
  await until("the only page steers without asking", async () => tab.wheel.steering && !(await tab.visible("#watching")));
  await tab.page.bringToFront();
  await change(tab, () => tab.page.keyboard.press("a"));
}

/// Drops models on the page and chooses what they show.
async function dropped(tab) {
  const { glb, gltf } = model("robot");
  const show = async (files, name) => {
    await dropFiles(tab.page, files);
    await tab.reported(`${name} is open`, (status) => status.scene === name && status.stage !== "loading");
    await tab.page.fill("#samples", "2");
    await tab.page.keyboard.press("Enter");
    // A field that has the focus keeps its value when another scene opens.
    await tab.page.locator("#picture").focus();
    await tab.reported("two samples", (status) => status.samples_wanted === 2);
    await tab.finished();
    return tab.fields();
  };
  const whole = await show(glb, "robot.glb");
  assert(new Set(whole).size > 30, "the picture is blank");
  await tab.screenshot("16-dropped-glb");
  const parts = await show(gltf, "robot.gltf");
  assert(difference(whole, parts) < 0.5, "the same model from several files");
  await tab.screenshot("17-dropped-gltf");
  const variant = tab.page.locator("#model-rows select[name=variant]");
  const last = (await variant.locator("option").count()) - 1;
  assert((await change(tab, () => variant.selectOption({ index: last }))) > 0.5, "another variant");
  await tab.screenshot("19-variant");
  const clip = tab.page.locator("#model-rows select[name=clip]");
  assert((await change(tab, () => clip.selectOption({ index: 0 }))) > 0.05, "the rest pose");
  assert.equal(tab.status.models[0].clip, null);
  await dropFiles(tab.page, { "readme.txt": "no scene" });
  await until("a reason", async () => /no scene among the files/.test(await tab.page.textContent("#toast")));
  await dropFiles(tab.page, { "broken.glb": Buffer.from("glTF") });
  await until("an error", () => tab.visible("#error"));
  await tab.screenshot("18-dropped-broken");
  await change(tab, () => tab.page.evaluate(() => {
    document.getElementById("open-scenes").click();
    document.querySelector(".card").click();
  }));
}

async function phone(tab) {
  await tab.page.close();
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  const small = await open(context);
  await small.finished();
  await small.screenshot("11-phone");
  const devtools = await context.newCDPSession(small.page);
  const touch = (type, ...points) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const looked = await change(small, async () => {
    await touch("touchStart", [200, 400]);
    for (let step = 1; step <= 6; step += 1) await touch("touchMove", [200 + 12 * step, 400]);
    await touch("touchEnd");
  });
  assert(looked > 0.2, `a finger changed ${looked}`);
  const before = small.sent.length;
  const pinched = await change(small, async () => {
    await touch("touchStart", [150, 400], [240, 400]);
    for (let step = 1; step <= 6; step += 1) await touch("touchMove", [150 - 8 * step, 400], [240 + 8 * step, 400]);
    await touch("touchEnd");
  });
  assert(pinched > 0.2 && small.sent.slice(before).some((text) => `${text}`.includes("zoom")), `two fingers changed ${pinched}`);
  await small.page.locator("#sheet-handle").tap();
  await until("the sheet", () => small.visible("#panel-body"));
  await small.screenshot("12-phone-sheet");
  const wide = await small.page.evaluate(() => document.documentElement.scrollWidth);
  assert(wide <= 390, "it is wider than the screen");
  await small.page.locator("#sheet-handle").tap();
  await small.page.locator("#open-scenes").tap();
  await pause(800);
  await small.screenshot("13-phone-scenes");
  await context.close();
}

try {
  const tab = await firstPicture();
  for (const step of [dragAndKeys, latency, tools, save, scenes, liveEdits, reconnect, wheel, dropped, phone]) {
    await step(tab);
    say(step.name);
  }
  for (const { faults } of tabs) assert.deepEqual(faults, [], "faults in a page");
  assert.equal(await server.stop("SIGTERM"), 143);
  assert(!/panicked/.test(server.log), server.log);
  say(`all is well; screenshots are in ${pictures}`);
  rmSync(folder, { recursive: true });
} catch (error) {
  for (const [index, tab] of tabs.entries()) if (!tab.page.isClosed()) await tab.screenshot(`failed-${index}`).catch(() => {});
  console.error(error, tabs.map(({ faults, status }) => ({ faults, status })), server.log, `screenshots are in ${pictures}`);
  process.exitCode = 1;
} finally {
  await browser.close();
  await server.stop("SIGKILL");
}
