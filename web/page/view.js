// The canvas: coarse frames stretched over it, and the picture's tiles as they come.

import { Board, Patches } from "./juggler.js";

export class View {
  constructor(canvas, memory) {
    this.canvas = canvas;
    this.memory = memory;
    this.context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
    this.small = document.createElement("canvas");
    this.board = null;
  }

  /** For another picture; what is shown stays until the first frame. */
  open(outline) {
    this.board?.free();
    this.board = new Board(JSON.stringify(outline));
    this.size = outline.size;
  }

  /** Pixels of the module's memory as the browser draws them. */
  image(at, width, height) {
    return new ImageData(new Uint8ClampedArray(this.memory.buffer, at, 4 * width * height), width, height);
  }

  /** Width and height follow the first pixels, so that the old picture stays until then. */
  fit() {
    const [width, height] = this.size;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
    }
  }

  coarse([width, height], patches) {
    this.board.begin(width, height);
    for (const { places, light } of patches) this.board.putCoarse(new Patches(places, light));
    this.fit();
    [this.small.width, this.small.height] = [width, height];
    this.small.getContext("2d").putImageData(this.image(this.board.coarseRgba(), width, height), 0, 0);
    this.context.imageSmoothingEnabled = true;
    this.context.drawImage(this.small, 0, 0, ...this.size);
  }

  tiles({ parts }) {
    for (const { places, light } of parts) {
      this.board.put(new Patches(places, light));
      this.paint(places, 5);
    }
  }

  /** Tile by tile, as what lies between them may still be of the coarse frame. */
  paint(places, stride) {
    this.fit();
    const image = this.image(this.board.rgba(), ...this.size);
    for (let i = 0; i < places.length; i += stride) {
      this.context.putImageData(image, 0, 0, places[i], places[i + 1], places[i + 2], places[i + 3]);
    }
  }

  /** Another tone, more samples: the light so far stays. */
  resume(outline) {
    this.board.resume(JSON.stringify(outline));
    this.paint(this.board.tiles(), 4);
  }

  /** The picture's pixel under a place of the window. */
  pixel(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return [((x - box.left) / box.width) * this.size[0], ((y - box.top) / box.height) * this.size[1]];
  }
}
