// A worker: a complete renderer that renders its share of the image, in time slices that are short
// enough to receive messages of the page in between.

import init, { WorkerRenderer } from "./juggler.js";

/** Length of a time slice, in milliseconds. */
const SLICE = 12;
/** First and longest interval between messages with tiles, in milliseconds: showing tiles costs the
 * page time, too. */
const FIRST_SHOW = 40;
const LAST_SHOW = 400;

let renderer = null;
/** Number of the page's latest request, to which the results belong. */
let number = 0;
let refining = false;
/** Whether nothing of the scene is visible yet. */
let fresh = true;

/** Tiles to be sent, the time when they are due, and the next interval. */
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

/** Sends the collected tiles. */
function show() {
  if (held.length > 0) postMessage({ type: "tiles", number, parts: held }, held.flatMap(({ bounds, radiance }) => [bounds.buffer, radiance.buffer]));
  held = [];
  due = performance.now() + interval;
  interval = Math.min(interval * 1.5, LAST_SHOW);
}

/** Reports an error. Errors of the renderer are strings; after any other error its memory is in an
 * unknown state and the worker is lost. */
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

  /** Opens a scene: a built-in one by name, or one of the files in the message. */
  open({ name, files }) {
    [refining, fresh] = [false, true];
    for (const { name, bytes } of files) renderer.addFile(name, new Uint8Array(bytes));
    renderer.open(name);
    send({ type: "opened", status: JSON.parse(renderer.status()) });
  },

  /** Applies edits and renders a coarse frame of the given size. */
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

/** Chain of promises that answers messages in order, although the first one takes long. */
let turn = Promise.resolve();

async function answer(message) {
  // Send earlier tiles first: they may stay valid.
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
