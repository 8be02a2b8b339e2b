// See test.sh.

import { strict as assert } from "node:assert";
import { writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import { join } from "node:path";
import { model } from "../browser/drop.mjs";
import { Browser, Program, difference, median, pause, serve } from "./harness.mjs";

const [program, chromium, pictures] = process.argv.slice(2);
const site = await serve(join(import.meta.dirname, "../../web/dist"));
const juggler = new Program(program);
const browser = await Browser.start(chromium, pictures);
const began = performance.now();
const say = (text) => console.log(`${((performance.now() - began) / 1000).toFixed(1).padStart(6)} s  ${text}`);

/** Files of a scene with an include and a mesh. */
const FILES = {
  "pyramid.json": `{
    "version": 1,
    "include": "colors.json",
    "camera": {"perspective": {"eye": [3, 2, 4], "look_at": [0, 0.5, 0], "vertical_fov_degrees": 40}},
    "lights": [{"point": {"position": [4, 6, 5], "intensity": 60}}, {"ambient": {"intensity": 0.2}}],
    "objects": [
      {"shape": {"mesh": {"file": "models/pyramid.obj"}}, "material": "gold"},
      {"shape": {"plane": {}}, "material": "ground"}
    ],
    "render": {"size": [320, 240], "samples": 8}
  }`,
  "colors.json": `{"version": 1, "materials": {"gold": {"phong": {"diffuse": [0.9, 0.6, 0.1]}}, "ground": {"phong": {"diffuse": 0.5}}}}`,
  "pyramid.obj": "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.6 0\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n",
};

async function sameAsTheProgram(name, ...samples) {
  await browser.open(`${site.url}?scene=${name}`);
  if (samples.length > 0) await browser.samples(samples[0]);
  const { hash } = juggler.render(name, ...samples.flatMap((count) => ["--samples", String(count)]));
  assert.equal(await browser.hash(), hash, name);
  await browser.screenshot(name);
  say(`${name}: ${hash.slice(0, 16)}…, the hash of the program, after ${await browser.text("#seconds")}`);
}

async function saves() {
  const [download] = await Promise.all([browser.page.waitForEvent("download"), browser.page.click("#save")]);
  const saved = join(juggler.folder, "saved.png");
  await download.saveAs(saved);
  const { status, stdout, stderr } = juggler.run("compare", saved, juggler.picture);
  assert.equal(status, 0, `the saved pixels are the program's: ${stdout}${stderr}`);
  assert.equal(download.suggestedFilename(), "chess.png");
  say("saved: a PNG file with the pixels of the program's");
}

async function flies() {
  const { page } = browser;
  const hash = await browser.hash();
  const before = await browser.fields();
  const moved = async (what, act) => {
    const start = await browser.fields();
    await act();
    await pause(600);
    const change = difference(start, await browser.fields());
    assert(change > 1, `${what} changes the picture: ${change}`);
    return change;
  };
  await page.locator("#picture").focus();
  for (const key of ["w", "ArrowLeft", "j", "l", "u", "x"]) {
    await moved(key, () => page.keyboard.press(key, { delay: 400 }));
  }
  const { x, y, width, height } = await page.locator("#picture").boundingBox();
  const [across, down] = [x + width * 0.6, y + height * 0.5];
  for (const kind of ["orbit", "look"]) {
    await page.check(`[name=drag][value=${kind}]`);
    await moved(kind, async () => {
      await page.mouse.move(across, down);
      await page.mouse.down();
      for (let i = 1; i <= 10; i++) await page.mouse.move(across + 12 * i, down + 4 * i);
      await page.mouse.up();
    });
    await moved(`${kind} and wheel`, () => page.mouse.wheel(0, -200));
  }
  await browser.hash();
  await browser.screenshot("flown");
  await page.locator("#picture").focus();
  await page.keyboard.press("Home");
  await browser.hash();
  await browser.samples(4);
  assert.equal(await browser.hash(), hash, "back where it began");
  assert.deepEqual(await browser.fields(), before);
  say("keys, drags and the wheel move the camera; a reset leads back to the same bits");
}

async function answersSoon() {
  const { page } = browser;
  await page.locator("#picture").focus();
  const times = [];
  for (let i = 0; i < 15; i++) {
    times.push(await page.evaluate(async (code) => {
      const canvas = document.getElementById("picture");
      const speed = document.getElementById("speed");
      speed.textContent = "";
      const shown = new Promise((done) => {
        new MutationObserver((_, observer) => {
          if (speed.textContent === "") return;
          observer.disconnect();
          requestAnimationFrame(done);
        }).observe(speed, { childList: true });
      });
      const start = performance.now();
      canvas.dispatchEvent(new KeyboardEvent("keydown", { code, bubbles: true }));
      canvas.dispatchEvent(new KeyboardEvent("keyup", { code, bubbles: true }));
      await shown;
      return performance.now() - start;
    }, i % 2 ? "KeyA" : "KeyD"));
    await pause(150);
  }
  say(`a key is seen after ${median(times).toFixed(0)} ms, at worst ${Math.max(...times).toFixed(0)}`);
  return median(times);
}

async function takesFiles() {
  const { page } = browser;
  await browser.drop(FILES);
  for (const [name, text] of Object.entries(FILES)) writeFileSync(join(juggler.folder, name), text);
  await page.waitForFunction(() => document.getElementById("size").textContent === "320 × 240");
  // The browser drops folders from names; on disk, the scene must name the place of the mesh.
  const text = FILES["pyramid.json"].replace("models/", "");
  writeFileSync(join(juggler.folder, "pyramid.json"), text);
  const { hash } = juggler.render(join(juggler.folder, "pyramid.json"));
  assert.equal(await browser.hash(), hash, "a scene with a mesh and an include");
  await browser.screenshot("dropped");
  say("dropped files: a scene with a mesh and an include has the hash of the program");
}

/** Drops a model as one file, and as several: both have the hash of the program. */
async function takesModels() {
  const { glb, gltf } = model("robot");
  for (const [kind, files] of Object.entries({ glb, gltf })) {
    for (const [name, content] of Object.entries(files)) writeFileSync(join(juggler.folder, name), content);
    await browser.drop(files);
    await browser.page.waitForFunction(() => document.getElementById("size").textContent !== "320 × 240");
    await browser.samples(1);
    const { hash } = juggler.render(join(juggler.folder, `robot.${kind}`), "--samples", "1");
    assert.equal(await browser.hash(), hash, `robot.${kind}`);
    await browser.screenshot(`dropped-${kind}`);
    say(`robot.${kind}: ${hash.slice(0, 16)}…, the hash of the program`);
    await browser.drop(FILES);
    await browser.page.waitForFunction(() => document.getElementById("size").textContent === "320 × 240");
    await browser.hash();
  }
}

async function saysWhatIsWrong() {
  const { page } = browser;
  const wrong = `{"version": 1, "objects": [{"shape": {"sphere": {"radios": 2}}}, {"shape": {"mesh": {"file": "none.obj"}}}]}`;
  writeFileSync(join(juggler.folder, "wrong.json"), wrong);
  const before = await browser.fields();
  await browser.drop({ "wrong.json": wrong });
  await page.waitForSelector("#error:not([hidden])");
  const said = (await browser.text("#error")).trim();
  const check = juggler.run("check", join(juggler.folder, "wrong.json"));
  const expected = (check.stdout + check.stderr).replaceAll(join(juggler.folder, "/"), "");
  assert(said.includes("radius") && expected.includes(said), `${said}\n--- but the program:\n${expected}`);
  assert.deepEqual(await browser.fields(), before, "the last good picture stays");
  await browser.screenshot("mistakes");
  await browser.drop({ "readme.txt": "no scene" });
  await page.waitForFunction(() => document.getElementById("error").textContent.includes("no scene among"));
  await page.selectOption("#scene", "red-cube");
  await page.waitForSelector("#error", { state: "hidden" });
  await browser.hash();
  say("errors: the messages of juggler check over the last good picture");
}

async function fitsAPhone() {
  await browser.open(`${site.url}?scene=scalablitz-pool`, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  await browser.hash();
  await browser.screenshot("phone");
  await browser.page.tap("#toggle");
  await browser.screenshot("phone-bare");
  const { width } = await browser.page.locator("#picture").boundingBox();
  assert(width <= 390 && !(await browser.page.locator("#panel").isVisible()));
  say("a phone: the panel below, or away");
}

/** Returns the speedup of two workers over one: the ratio of the medians of alternating renders. */
async function twoAreFaster() {
  const scene = "cornell-cube";
  await browser.open(`${site.url}?scene=${scene}`);
  await browser.samples(12);
  await browser.hash();
  const times = { 1: [], 2: [] };
  let gain = 0;
  for (let round = 1; round <= 7; round++) {
    for (const count of [1, 2]) {
      await browser.workers(count);
      times[count].push(await browser.seconds());
    }
    gain = median(times[1]) / median(times[2]);
    if (round >= 3 && gain >= 1.6) break;
  }
  say(`${scene}: one worker ${times[1].join(", ")} s, two ${times[2].join(", ")} s: ${gain.toFixed(2)} times as fast`);
  return gain;
}

await sameAsTheProgram("chess", 4);
await saves();
await flies();
await sameAsTheProgram("juggler", 1);
await sameAsTheProgram("scalablitz-pool");
const latency = await answersSoon();
await takesFiles();
await takesModels();
await saysWhatIsWrong();
await fitsAPhone();
const gain = availableParallelism() > 1 ? await twoAreFaster() : Infinity;
assert.deepEqual(browser.faults, [], "nothing went wrong in the page");
await browser.browser.close();
site.close();
assert(latency < 100, `a key takes ${latency} ms`);
assert(gain >= 1.6, `two workers are ${gain} times as fast as one`);
say(`all is well; screenshots in ${pictures}`);
