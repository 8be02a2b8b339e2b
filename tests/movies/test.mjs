// See test.sh.

import { strict as assert } from "node:assert";
import { spawnSync } from "node:child_process";
import { appendFileSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { basename, join } from "node:path";
import { startBrowser } from "../browser/harness.mjs";

const [program, chromium, folder] = process.argv.slice(2);
const FRAMES = Number(process.env.MOVIE_FRAMES ?? 12);
const SIZE = (process.env.MOVIE_SIZE ?? "160x90").split("x").map(Number);
const FLAGS = ["--size", SIZE.join("x"), "--samples", process.env.MOVIE_SAMPLES ?? "4", "--frames", `0..${FRAMES}`, "--quiet"];
const PACE = 30;
const TYPES = { mp4: "video/mp4", webp: "image/webp", apng: "image/apng", gif: "image/gif" };

const began = performance.now();
const say = (text) => console.log(`${((performance.now() - began) / 1000).toFixed(1).padStart(6)} s  ${text}`);
const file = (name) => join(folder, name);
const picture = (number) => `frame_${String(number).padStart(4, "0")}.png`;

function run(command, ...words) {
  const { status, stdout, stderr } = spawnSync(command, words, { encoding: "utf8" });
  assert.equal(status, 0, `${command} ${words.join(" ")}: ${stderr}`);
  return stdout + stderr;
}

/** Reports a skipped check as check.sh does; in CI that is an error. */
function skip(reason) {
  assert.notEqual(process.env.CI, "true", reason);
  say(`SKIPPED: ${reason}`);
  if (process.env.JUGGLER_SKIPPED) appendFileSync(process.env.JUGGLER_SKIPPED, `${reason}\n`);
}

/** Renders all movies and their frames. */
function render() {
  // Movies are not dithered.
  run(program, "render", "juggler", ...FLAGS, "--dither", "off", "-o", file("frame_####.png"));
  for (const ending of Object.keys(TYPES)) run(program, "render", "juggler", ...FLAGS, "-o", file(`movie.${ending}`));
  const sizes = Object.keys(TYPES).map((ending) => `${ending} ${statSync(file(`movie.${ending}`)).size}`);
  say(`${FRAMES} frames of ${SIZE.join("x")}: bytes of ${sizes.join(", ")}`);
}

/** Reads the movies with ffprobe, and measures their difference from the frames with ffmpeg. */
function checkWithFfmpeg() {
  if (spawnSync("ffprobe", ["-version"]).status !== 0) {
    skip("tests/movies: ffprobe is not installed (apt-get install ffmpeg)");
    return;
  }
  for (const ending of ["mp4", "apng", "gif"]) {
    const words = ["-v", "error", "-count_frames", "-show_streams", "-show_format", "-of", "json", file(`movie.${ending}`)];
    const { streams, format } = JSON.parse(run("ffprobe", ...words));
    const [stream] = streams;
    assert.deepEqual([stream.width, stream.height, Number(stream.nb_read_frames)], [...SIZE, FRAMES], ending);
    if (ending === "mp4") {
      const { codec_name, profile, pix_fmt, color_range, color_space, color_primaries, color_transfer, r_frame_rate } = stream;
      const found = [codec_name, profile, pix_fmt, color_range, color_space, color_primaries, color_transfer, r_frame_rate];
      assert.deepEqual(found, ["av1", "Main", "yuv420p", "tv", "bt709", "bt709", "iec61966-2-1", `${PACE}/1`]);
      assert.equal(Number(format.duration).toFixed(6), (FRAMES / PACE).toFixed(6));
    }
    // Compare frames by number, whatever their times, in the pixel format of the MP4, which halves
    // the resolution of the chroma.
    const plain = "setpts=N/30/TB,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
    const graph = `[0:v]${plain}[a];[1:v]${plain}[b];[a][b]psnr`;
    const report = run("ffmpeg", "-hide_banner", "-i", file(`movie.${ending}`), "-i", file("frame_%04d.png"), "-lavfi", graph, "-f", "null", "-");
    const error = report.match(/y:(\S+) u:(\S+) v:(\S+) average/).slice(1).map(Number);
    // A GIF has 256 colors.
    assert(error.every((decibels) => Number.isNaN(decibels) || decibels > (ending === "gif" ? 25 : 33)), `${ending}: ${error}`);
    say(`ffmpeg: ${ending} of ${FRAMES} frames, PSNR ${error.map((decibels) => (Number.isNaN(decibels) ? "infinite" : decibels.toFixed(1))).join(", ")} dB (brightness, colors)`);
  }
}

/** Opens a page that can read the files. */
async function open(browser) {
  const server = createServer(({ url }, answer) => {
    const name = basename(url);
    if (!/^(movie|frame_\d+)\.\w+$/.test(name)) return answer.writeHead(200, { "content-type": "text/html" }).end("<p>movies");
    const type = TYPES[name.split(".")[1]] ?? "image/png";
    return answer.writeHead(200, { "content-type": type }).end(readFileSync(file(name)));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.evaluate(() => {
    const canvas = new OffscreenCanvas(1, 1);
    /** Returns the levels of an image source. */
    window.levels = (what, width, height) => {
      Object.assign(canvas, { width, height });
      const pen = canvas.getContext("2d", { willReadFrequently: true });
      pen.drawImage(what, 0, 0);
      return pen.getImageData(0, 0, width, height).data;
    };
    window.frame = async (name, width, height) => {
      const bitmap = await createImageBitmap(await (await fetch(name)).blob());
      return window.levels(bitmap, width, height);
    };
    /** Returns the difference of two pictures: the maximum, the mean, and the mean over blocks, in
     * which the error of sharp colors averages out. */
    window.apart = (a, b, width, height) => {
      const [block, sums] = [8, new Map()];
      let [most, sum] = [0, 0];
      for (let i = 0; i < a.length; i++) {
        if (i % 4 === 3) continue;
        const [x, y] = [(i >> 2) % width, Math.floor((i >> 2) / width)];
        const key = `${x >> 3} ${y >> 3} ${i % 4}`;
        sums.set(key, (sums.get(key) ?? 0) + a[i] - b[i]);
        most = Math.max(most, Math.abs(a[i] - b[i]));
        sum += Math.abs(a[i] - b[i]);
      }
      const blocks = [...sums.values()].reduce((all, one) => all + Math.abs(one), 0) / (sums.size * block * block);
      return { most, mean: sum / (width * height * 3), blocks };
    };
  });
  return { page, close: () => server.close() };
}

/** Plays and seeks the MP4. */
async function plays(page) {
  const moments = [0, Math.floor(FRAMES / 2), FRAMES - 1, 1].map((number) => [number, picture(number)]);
  const seen = await page.evaluate(async ({ moments, pace, size: [width, height] }) => {
    const video = document.createElement("video");
    const event = (name) => new Promise((done, failed) => {
      video.addEventListener(name, done, { once: true });
      video.addEventListener("error", () => failed(new Error(video.error.message)), { once: true });
    });
    video.muted = true;
    const loaded = event("loadeddata");
    video.src = URL.createObjectURL(await (await fetch("movie.mp4")).blob());
    await loaded;
    const errors = [];
    for (const [number, name] of moments) {
      const there = event("seeked");
      const shown = new Promise((done) => video.requestVideoFrameCallback((now, data) => done(data.mediaTime)));
      video.currentTime = (number + 0.5) / pace;
      await there;
      const time = await shown;
      const now = window.levels(video, width, height).slice();
      errors.push({ time, ...window.apart(now, await window.frame(name, width, height), width, height) });
    }
    const ended = event("ended");
    video.currentTime = 0;
    await video.play();
    await ended;
    return { duration: video.duration, size: [video.videoWidth, video.videoHeight], errors };
  }, { moments, pace: PACE, size: SIZE });
  assert.deepEqual(seen.size, SIZE);
  assert(Math.abs(seen.duration - FRAMES / PACE) < 1e-3, `${seen.duration} s`);
  seen.errors.forEach(({ time }, i) => assert(Math.abs(time - moments[i][0] / PACE) < 1e-3, `frame ${moments[i][0]}: ${time} s`));
  // The chroma has half the resolution, so neighboring saturated colors differ with any encoder.
  const worst = Math.max(...seen.errors.map(({ blocks }) => blocks));
  assert(worst < 4.5, `colors are off: ${JSON.stringify(seen.errors)}`);
  say(`Chromium plays the mp4: ${seen.duration} s, blocks of ${seen.errors.length} frames off by at most ${worst.toFixed(2)} levels`);
}

/** Decodes an animated picture in the page. */
async function shows(page, ending) {
  const names = Array.from({ length: FRAMES }, (_, number) => picture(number));
  const seen = await page.evaluate(async ({ ending, type, names, size: [width, height] }) => {
    const decoder = new ImageDecoder({ data: (await fetch(`movie.${ending}`)).body, type });
    await decoder.completed;
    const { frameCount, repetitionCount } = decoder.tracks.selectedTrack;
    let [microseconds, errors] = [0, []];
    for (const [frameIndex, name] of names.entries()) {
      const { image } = await decoder.decode({ frameIndex });
      microseconds += image.duration;
      const now = window.levels(image, width, height).slice();
      image.close();
      errors.push(window.apart(now, await window.frame(name, width, height), width, height));
    }
    return { frameCount, repetitionCount, microseconds, errors };
  }, { ending, type: TYPES[ending], names, size: SIZE });
  assert.equal(seen.frameCount, FRAMES);
  assert(seen.repetitionCount === null || seen.repetitionCount === Infinity, `${seen.repetitionCount} times`);
  assert(Math.abs(seen.microseconds / 1e6 - FRAMES / PACE) < 0.006, `${ending}: ${seen.microseconds} µs`);
  const [most, blocks] = ["most", "blocks"].map((key) => Math.max(...seen.errors.map((error) => error[key])));
  if (ending === "gif") assert(blocks < 6, `gif: ${JSON.stringify(seen.errors)}`);
  else assert.equal(most, 0, `${ending}: nothing may be lost`);
  say(`Chromium shows the ${ending}: ${seen.frameCount} frames, ${seen.microseconds / 1e6} s, at most ${most} levels off`);
}

render();
checkWithFfmpeg();
const browser = await startBrowser(chromium);
const { page, close } = await open(browser);
await plays(page);
for (const ending of ["webp", "apng", "gif"]) await shows(page, ending);
await browser.close();
close();
say("all is well");
