// WebSocket to the server: sends objects, decodes frames to bitmaps, and reconnects when it is
// lost.

const HEADER_BYTES = 36;
const KINDS = ["image/jpeg", "image/jpeg", "image/png"];
const FIRST_PAUSE = 500, LONGEST_PAUSE = 15000, GROWTH = 1.7;
const SIGN_OF_LIFE = 20000;

/// `on` has `open()`, `lost(milliseconds until the next attempt, reason)`, `message(object)` and
/// `frame(bitmap, facts)`.
export class Connection {
  constructor(on) {
    this.on = on;
    this.pause = FIRST_PAUSE;
    this.unseen = null;
    addEventListener("online", () => this.retry());
    document.addEventListener("visibilitychange", () => this.shown());
    setInterval(() => this.send({ here: true }), SIGN_OF_LIFE);
    this.open();
  }

  get isOpen() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  send(message) {
    if (this.isOpen) this.socket.send(JSON.stringify(message));
  }

  /// Reconnects now.
  retry() {
    if (!this.timer) return;
    clearTimeout(this.timer);
    this.open();
  }

  open() {
    this.timer = null;
    const socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    let order = Promise.resolve();
    socket.onopen = () => {
      this.pause = FIRST_PAUSE;
      this.on.open();
    };
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") this.on.message(JSON.parse(data));
      else order = order.then(() => this.frame(socket, data)).catch(() => {});
    };
    socket.onclose = () => this.lost(socket);
  }

  async lost(socket) {
    if (socket !== this.socket) return;
    const pause = this.pause * (0.85 + 0.3 * Math.random());
    this.pause = Math.min(this.pause * GROWTH, LONGEST_PAUSE);
    this.timer = setTimeout(() => this.open(), pause);
    this.on.lost(pause, "");
    // Report the reason of a server that refuses the connection.
    const answer = await fetch("/catalogue.json").catch(() => null);
    if (answer && !answer.ok && this.timer) this.on.lost(pause, (await answer.text()).trim());
  }

  async frame(socket, data) {
    const head = new DataView(data, 0, HEADER_BYTES);
    const facts = {
      serial: head.getUint32(0, true),
      kind: head.getUint32(4, true),
      number: Number(head.getBigUint64(8, true)),
      revision: Number(head.getBigUint64(16, true)),
      size: [head.getUint32(24, true), head.getUint32(28, true)],
      samples: head.getFloat32(32, true),
    };
    const file = new Blob([new Uint8Array(data, HEADER_BYTES)], { type: KINDS[facts.kind] });
    const bitmap = await createImageBitmap(file);
    if (socket !== this.socket) return bitmap.close();
    this.on.frame(bitmap, facts);
    this.unseen = facts.serial;
    this.shown();
  }

  /// Acknowledges the displayed frame. A hidden page does not, and so receives no more frames.
  shown() {
    if (this.unseen === null || document.hidden) return;
    this.send({ ack: this.unseen });
    this.unseen = null;
  }
}
