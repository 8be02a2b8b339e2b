// The worker pool. Every message goes to all workers, so all of them have the same scene and
// camera.

import { RenderRate } from "./juggler.js";

/** Time budget of a coarse frame, in seconds. */
const BUDGET = 0.03;

export class Pool {
  /** Calls `news` with ("opened", status), ("frame", answer), ("tiles", message) or ("failed",
   * text). */
  constructor(module, count, news) {
    this.news = news;
    this.number = 0;
    this.rate = new RenderRate();
    /** Size of the image, once it is known. */
    this.size = null;
    this.waiting = [];
    this.busy = null;
    /** Whether a worker has failed for good, so that the pool must be replaced. */
    this.lost = false;
    this.workers = Array.from({ length: count }, (_, index) => {
      const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
      worker.onmessage = ({ data }) => this.heard(index, data);
      worker.onerror = (event) => this.news("failed", event.message ?? "a worker has failed");
      worker.postMessage({ type: "start", module, index, count });
      return worker;
    });
  }

  close() {
    this.workers.forEach((worker) => worker.terminate());
    this.rate.free();
    this.news = () => {};
  }

  tell(message) {
    this.number += 1;
    this.busy = { ...message, number: this.number, answers: [], tiles: [], late: [] };
    this.workers.forEach((worker) => worker.postMessage({ ...message, number: this.number }));
  }

  /** Opens a scene and applies the edits of its `log`. */
  open({ name, files, log }) {
    this.waiting = [...log];
    this.tell({ type: "open", name, files });
  }

  /** Queues edits. While a frame is being rendered, they are collected, so that no worker falls
   * behind. */
  edit(...edits) {
    this.waiting.push(...edits);
    if (!this.busy && this.size) this.flush();
  }

  flush() {
    const edits = this.waiting;
    this.waiting = [];
    const step = this.rate.coarseness(...this.size, BUDGET);
    this.tell({ type: "edit", edits, coarse: this.size.map((edge) => Math.ceil(edge / step)) });
  }

  heard(index, message) {
    // Keep tiles that were sent before an edit: they are valid if the edit leaves the samples
    // unchanged.
    if (message.type === "tiles" && this.busy && message.number === this.number - 1) this.busy.late.push(message);
    if (message.number !== this.number || message.type === "ready") return;
    if (message.type === "tiles") {
      // Hold tiles back until the coarse frame is complete, which would overwrite them.
      if (this.busy) this.busy.tiles.push(message);
      else this.news("tiles", message);
      return;
    }
    if (message.type === "failed") {
      this.busy = null;
      this.lost ||= message.lost;
      this.news("failed", message.text);
      return;
    }
    if (!this.busy) return;
    this.busy.answers[index] = message;
    if (this.busy.answers.filter(Boolean).length === this.workers.length) this.answered();
  }

  answered() {
    const { type, answers, tiles, late, coarse } = this.busy;
    const { status, error, kept } = answers[0];
    this.busy = null;
    this.size = status.outline.size;
    if (type === "open") {
      this.news("opened", status);
      this.flush();
      return;
    }
    const slowest = Math.max(...answers.map(({ took }) => took));
    if (!kept) this.rate.measure(coarse[0] * coarse[1], slowest / 1000);
    this.news("frame", { status, error, kept, coarse, rects: answers });
    (kept ? [...late, ...tiles] : tiles).forEach((message) => this.news("tiles", message));
    if (this.waiting.length > 0) this.flush();
  }
}
