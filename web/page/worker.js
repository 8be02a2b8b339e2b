// One of the workers: a whole renderer of its own that renders its share of the picture, in slices short enough to hear what
// the page says between them.

import init, { WorkerRenderer } from "./juggler.js";

/** Milliseconds of a slice. */
const SLICE = 12;
/** Milliseconds after which tiles are sent for the second time, and longest: what the page shows costs time too. */
const FIRST_SHOW = 40;
const LAST_SHOW = 400;

let renderer = null;
/** Number of the page's last wish; what is rendered belongs to it. */
let number = 0;
let refining = false;
/** Whether nothing of the scene has been shown yet. */
let fresh = true;

/** Tiles that wait to be sent, when they are, and how long the next ones will wait. */
let [held, due, interval] = [[], 0, FIRST_SHOW];

const again = new MessageChannel();
again.port1.onmessage = refine;

function send(message, rects) {
  if (!rects) return postMessage({ ...message, number });
  const [bounds, radiance] = [rects.bounds(), rects.radiance()];
  rects.free();
  postMessage({ ...message, number, bounds, radiance }, [bounds.buffer, radiance.buffer]);
}

function start() {
  [due, interval] = [0, FIRST_SHOW];
  if (!refining) again.port2.postMessage(0);
  refining = true;
}

function refine() {
  if (!refining) return;
  try {
    hold(renderer.refine(SLICE));
    refining = !renderer.isFinished();
    if (!refining || performance.now() >= due) show();
    if (refining) again.port2.postMessage(0);
  } catch (error) {
    fail(error);
  }
}

function hold(rects) {
  if (!rects) return;
  held.push({ bounds: rects.bounds(), radiance: rects.radiance() });
  rects.free();
}

/** Sends the tiles that wait. */
function show() {
  if (held.length > 0) postMessage({ type: "tiles", number, parts: held }, held.flatMap(({ bounds, radiance }) => [bounds.buffer, radiance.buffer]));
  held = [];
  due = performance.now() + interval;
  interval = Math.min(interval * 1.5, LAST_SHOW);
}

/** What the renderer itself says is a text. Anything else is the end of it: its memory may be in any state. */
function fail(error) {
  refining = false;
  const lost = typeof error !== "string";
  const text = lost ? `A worker has stopped: ${error}. It may have run out of memory, of which a page has 4 GiB.` : error;
  send({ type: "failed", text, lost });
}

const answers = {
  async start({ module, index, count }) {
    await init({ module_or_path: module });
    renderer = new WorkerRenderer(index, count);
    send({ type: "ready" });
  },

  /** Another scene: a built-in one by name, or one of the files that come along. */
  open({ name, files }) {
    [refining, fresh] = [false, true];
    for (const { name, bytes } of files) renderer.addFile(name, new Uint8Array(bytes));
    renderer.open(name);
    send({ type: "opened", status: JSON.parse(renderer.status()) });
  },

  /** Edits, and the size of the coarse frame that is to show them at once. */
  edit({ edits, coarse }) {
    const kept = renderer.edit(JSON.stringify(edits)) && !fresh;
    fresh = false;
    const changed = { type: "edited", kept, error: renderer.problem(), status: JSON.parse(renderer.status()) };
    const began = performance.now();
    const rects = kept ? null : renderer.coarse(coarse[0], coarse[1]);
    send({ ...changed, took: performance.now() - began }, rects);
    start();
  },
};

/** Messages in their order, though the first takes its time. */
let turn = Promise.resolve();

async function answer(message) {
  // Tiles from before may count after it too.
  show();
  number = message.number ?? number;
  try {
    await answers[message.type](message);
  } catch (error) {
    fail(error);
  }
}

onmessage = ({ data }) => {
  turn = turn.then(() => answer(data));
};
