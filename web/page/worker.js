// One of the workers: a whole renderer of its own that renders its share of the picture, in slices short enough to hear what
// the page says between them.

import init, { Painter } from "./juggler.js";

/** Milliseconds of a slice. */
const SLICE = 12;
/** Milliseconds after which tiles are sent for the second time, and longest: what the page shows costs time too. */
const FIRST_SHOW = 40;
const LAST_SHOW = 400;

let painter = null;
/** Number of the page's last wish; what is rendered belongs to it. */
let number = 0;
let refining = false;
/** Whether nothing of the scene has been shown yet. */
let fresh = true;

/** Tiles that wait to be sent, when they are, and how long the next ones will wait. */
let [held, due, interval] = [[], 0, FIRST_SHOW];

const again = new MessageChannel();
again.port1.onmessage = refine;

function send(message, patches) {
  if (!patches) return postMessage({ ...message, number });
  const [places, light] = [patches.places(), patches.light()];
  patches.free();
  postMessage({ ...message, number, places, light }, [places.buffer, light.buffer]);
}

function start() {
  [due, interval] = [0, FIRST_SHOW];
  if (!refining) again.port2.postMessage(0);
  refining = true;
}

function refine() {
  if (!refining) return;
  try {
    hold(painter.refine(SLICE));
    refining = !painter.isFinished();
    if (!refining || performance.now() >= due) show();
    if (refining) again.port2.postMessage(0);
  } catch (error) {
    fail(error);
  }
}

function hold(patches) {
  if (!patches) return;
  held.push({ places: patches.places(), light: patches.light() });
  patches.free();
}

/** Sends the tiles that wait. */
function show() {
  if (held.length > 0) postMessage({ type: "tiles", number, parts: held }, held.flatMap(({ places, light }) => [places.buffer, light.buffer]));
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
  async start({ module, index, of }) {
    await init({ module_or_path: module });
    painter = new Painter(index, of);
    send({ type: "ready" });
  },

  /** Another scene: a built-in one by name, or one of the files that come along. */
  open({ name, files }) {
    [refining, fresh] = [false, true];
    for (const { name, bytes } of files) painter.addFile(name, new Uint8Array(bytes));
    painter.open(name);
    send({ type: "opened", status: JSON.parse(painter.status()) });
  },

  /** Edits, and the size of the coarse frame that is to show them at once. */
  edit({ edits, coarse }) {
    const kept = painter.edit(JSON.stringify(edits)) && !fresh;
    fresh = false;
    const changed = { type: "edited", kept, error: painter.problem(), status: JSON.parse(painter.status()) };
    const began = performance.now();
    const patches = kept ? null : painter.coarse(coarse[0], coarse[1]);
    send({ ...changed, took: performance.now() - began }, patches);
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
