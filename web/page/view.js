// The canvas: shows coarse frames, scaled to its size, and the tiles of the image as they arrive.

import { Compositor, PixelRects } from "./juggler.js";

export class View {
  constructor(canvas, memory) {
    this.canvas = canvas;
    this.memory = memory;
    this.context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
    this.small = document.createElement("canvas");
    this.compositor = null;
  }

  /** Prepares for another image; the old one stays visible until the first frame. */
  open(info) {
    this.compositor?.free();
    this.compositor = new Compositor(JSON.stringify(info));
    this.size = info.size;
  }

  /** ImageData of pixels in the module's memory. */
  image(at, width, height) {
    return new ImageData(new Uint8ClampedArray(this.memory.buffer, at, 4 * width * height), width, height);
  }

  /** Resizes the canvas when the first pixels arrive, so that the old image stays visible until
   * then. */
  fit() {
    const [width, height] = this.size;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
    }
  }

  coarse([width, height], rects) {
    this.compositor.restart(width, height);
    for (const { bounds, radiance } of rects) this.compositor.addCoarseRows(new PixelRects(bounds, radiance));
    this.fit();
    [this.small.width, this.small.height] = [width, height];
    this.small.getContext("2d").putImageData(this.image(this.compositor.coarseRgba(), width, height), 0, 0);
    this.context.imageSmoothingEnabled = true;
    this.context.drawImage(this.small, 0, 0, ...this.size);
  }

  tiles({ parts }) {
    for (const { bounds, radiance } of parts) {
      this.compositor.addTiles(new PixelRects(bounds, radiance));
      this.paint(bounds, 5);
    }
  }

  /** Draws tile by tile, because pixels between tiles may still show the coarse frame. */
  paint(bounds, stride) {
    this.fit();
    const image = this.image(this.compositor.rgba(), ...this.size);
    for (let i = 0; i < bounds.length; i += stride) {
      this.context.putImageData(image, 0, 0, bounds[i], bounds[i + 1], bounds[i + 2], bounds[i + 3]);
    }
  }

  /** Continues with other tone settings or more samples and keeps the radiance so far. */
  resume(info) {
    this.compositor.resume(JSON.stringify(info));
    this.paint(this.compositor.tiles(), 4);
  }

  /** Pixel of the image at a position in the window. */
  pixel(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return [((x - box.left) / box.width) * this.size[0], ((y - box.top) / box.height) * this.size[1]];
  }
}
