// A server, a browser, and the operations that tests need.

import { spawn } from "node:child_process";
import { strict as assert } from "node:assert";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { join } from "node:path";
import { chromium } from "playwright-core";

const PATIENCE = 60000;

export const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

/// Starts the program and reads its address.
export async function startServer(program, words) {
  const child = spawn(program, ["serve", ...words], { stdio: ["ignore", "pipe", "pipe"] });
  const server = { child, log: "" };
  child.stderr.on("data", (text) => (server.log += text));
  const [line] = await once(createInterface(child.stdout), "line");
  server.url = line.match(/http:\S+/)[0];
  server.port = Number(new URL(server.url).port);
  server.stop = async (signal = "SIGINT") => {
    if (child.exitCode !== null) return child.exitCode;
    child.kill(signal);
    const [status] = await once(child, "exit");
    return status;
  };
  return server;
}

export async function startBrowser(executablePath) {
  const args = ["--no-sandbox", "--disable-dev-shm-usage", "--force-color-profile=srgb"];
  return chromium.launch({ executablePath, args });
}

/// Waits until a condition is truthy and returns its value.
export async function until(what, condition, patience = PATIENCE) {
  const start = performance.now();
  for (;;) {
    const value = await condition();
    if (value) return value;
    assert(performance.now() - start < patience, `waited in vain: ${what}`);
    await pause(15);
  }
}

/// What a page reports while its server is away or refuses it.
const FAILED_REQUEST = /^(Failed to load resource|WebSocket connection)/;

/// A page with the messages from its server and the errors in it. While `serverIsAway`, failed
/// requests are no errors.
export class Tab {
  constructor(page, pictures) {
    Object.assign(this, { page, pictures, status: null, wheel: null, faults: [], sent: [], serverIsAway: false });
    page.on("pageerror", (error) => this.faults.push(`${error}`));
    page.on("console", (message) => {
      const isExpected = this.serverIsAway && FAILED_REQUEST.test(message.text());
      if (message.type() === "error" && !isExpected) this.faults.push(`${message.text()} (${message.location().url})`);
    });
    page.on("websocket", (socket) => {
      socket.on("framereceived", ({ payload }) => typeof payload === "string" && Object.assign(this, JSON.parse(payload)));
      socket.on("framesent", ({ payload }) => this.sent.push(payload));
    });
  }

  static async open(context, url, pictures) {
    const tab = new Tab(await context.newPage(), pictures);
    await tab.page.goto(url);
    await tab.frame();
    return tab;
  }

  /// Returns the data that the canvas has about its picture.
  shown() {
    return this.page.evaluate(() => {
      const { revision, number, kind, latency } = document.getElementById("picture").dataset;
      return { revision: Number(revision ?? -1), number: Number(number ?? -1), kind: Number(kind ?? -1), latency: Number(latency) };
    });
  }

  frame(fits = ({ number }) => number >= 0) {
    return until("a frame", async () => {
      const shown = await this.shown();
      return fits(shown) && shown;
    });
  }

  /// Waits for a status from the server that fits.
  reported(what, fits, patience) {
    return until(what, () => this.status && fits(this.status) && this.status, patience);
  }

  /// Waits for the finished picture.
  async finished() {
    await this.reported("a finished picture", (status) => status.stage === "finished");
    await this.frame(({ kind }) => kind === 2);
  }

  /// Returns the picture scaled to 16 by 16 pixels, as numbers from 0 to 255.
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

  visible(selector) {
    return this.page.locator(selector).isVisible();
  }
}

/// Returns the mean difference of two pictures, 0 to 255.
export function difference(one, other) {
  return one.reduce((sum, value, index) => sum + Math.abs(value - other[index]), 0) / one.length;
}

export const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
