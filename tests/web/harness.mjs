// A file server, the program to compare with, a browser, and the operations that tests need.

import { spawnSync } from "node:child_process";
import { strict as assert } from "node:assert";
import { createServer } from "node:http";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { chromium } from "playwright-core";
import { dropFiles } from "../browser/drop.mjs";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
/** Timeout of every operation, in milliseconds. */
const PATIENCE = 180_000;

/** Serves a folder, with no header except the type. */
export async function serve(folder) {
  const server = createServer(({ url }, answer) => {
    const path = normalize(decodeURIComponent(new URL(url, "http://x").pathname)).replace(/\/$/, "/index.html");
    try {
      const bytes = readFileSync(join(folder, path));
      answer.writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      answer.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

/** The program `juggler`, with a folder for its files. */
export class Program {
  constructor(path) {
    this.path = path;
    this.folder = mkdtempSync(join(tmpdir(), "juggler-web-"));
    this.picture = join(this.folder, "picture.png");
  }

  run(...words) {
    return spawnSync(this.path, words, { encoding: "utf8", env: { ...process.env, NO_COLOR: "1" } });
  }

  /** Renders a picture and returns the statistics of its film. */
  render(scene, ...words) {
    const stats = join(this.folder, "stats.json");
    const { status, stderr } = this.run("render", scene, "-o", this.picture, "--stats", stats, ...words);
    assert.equal(status, 0, stderr);
    return JSON.parse(readFileSync(stats)).film;
  }
}

/** A browser with one page and the errors in it. */
export class Browser {
  static async start(executablePath, pictures) {
    const args = ["--no-sandbox", "--disable-dev-shm-usage", "--force-color-profile=srgb"];
    const self = new Browser();
    self.browser = await chromium.launch({ executablePath, args });
    Object.assign(self, { pictures, faults: [] });
    return self;
  }

  async open(url, options = {}) {
    await this.context?.close();
    this.context = await this.browser.newContext({ viewport: { width: 1200, height: 760 }, acceptDownloads: true, ...options });
    this.page = await this.context.newPage();
    this.page.setDefaultTimeout(PATIENCE);
    this.page.on("pageerror", (error) => this.faults.push(String(error)));
    this.page.on("console", (message) => message.type() === "error" && this.faults.push(message.text()));
    await this.page.goto(url);
    await this.page.waitForFunction(() => document.getElementById("size").textContent.length > 0);
  }

  text(selector) {
    return this.page.locator(selector).textContent();
  }

  /** Waits for the finished picture and returns its hash. */
  async hash() {
    await this.page.waitForFunction(() => document.getElementById("hash").textContent.length === 64, null, { timeout: PATIENCE });
    return this.text("#hash");
  }

  async seconds() {
    await this.hash();
    return Number.parseFloat(await this.text("#seconds"));
  }

  async samples(count) {
    await this.page.fill("#wanted", String(count));
    await this.page.press("#wanted", "Enter");
    await this.page.locator("#picture").focus();
    await this.page.waitForFunction((count) => document.getElementById("samples").textContent.endsWith(` of ${count}`), count);
  }

  async workers(count) {
    await this.page.evaluate((count) => {
      const slider = document.getElementById("workers");
      slider.value = count;
      slider.dispatchEvent(new Event("change"));
    }, count);
  }

  /** Drops files on the page; `files` maps names to texts or buffers. */
  drop(files) {
    return dropFiles(this.page, files);
  }

  /** Returns the picture scaled to 16 by 16 pixels, as numbers from 0 to 255. */
  fields() {
    return this.page.evaluate(() => {
      const small = new OffscreenCanvas(16, 16).getContext("2d");
      small.drawImage(document.getElementById("picture"), 0, 0, 16, 16);
      return [...small.getImageData(0, 0, 16, 16).data];
    });
  }

  screenshot(name) {
    return this.page.screenshot({ path: join(this.pictures, `${name}.png`) });
  }
}

/** Returns the mean difference of two pictures, 0 to 255. */
export function difference(one, other) {
  return one.reduce((sum, value, index) => sum + Math.abs(value - other[index]), 0) / one.length;
}

export const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
export const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
