// Image on the canvas: fitted to its area, with interpolated pixels; and conversions between points
// and pixels.

export class Picture {
  constructor(canvas, region) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.region = region;
    this.size = [0, 0];
    this.box = { left: 0, top: 0, width: 1, height: 1 };
    this.rect = null;
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(bitmap, size) {
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.size = size;
    this.draw();
  }

  draw() {
    const { canvas, context, bitmap } = this;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((edge) => Math.max(1, Math.round(edge * ratio)));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    context.fillStyle = "#0b0d11";
    context.fillRect(0, 0, width, height);
    if (!bitmap) return;
    const scale = Math.min(width / this.size[0], height / this.size[1]);
    const [w, h] = this.size.map((edge) => Math.round(edge * scale));
    const [x, y] = [Math.round((width - w) / 2), Math.round((height - h) / 2)];
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = "high";
    context.drawImage(bitmap, x, y, w, h);
    this.box = { left: x / ratio, top: y / ratio, width: w / ratio, height: h / ratio };
    this.drawRegion();
  }

  /// Image pixels per point of the screen.
  get scale() {
    return this.size[0] / this.box.width || 1;
  }

  /// Returns the film position under a point, in pixels; `null` outside of the image.
  at(x, y) {
    const place = this.near(x, y);
    const inside = place.every((value, axis) => value >= 0 && value < this.size[axis]);
    return inside ? place : null;
  }

  near(x, y) {
    const { left, top } = this.canvas.getBoundingClientRect();
    return [(x - left - this.box.left) * this.scale, (y - top - this.box.top) * this.scale];
  }

  /// Returns the image region between two points of the screen.
  between([x0, y0], [x1, y1]) {
    const clamp = (value, axis) => Math.min(Math.max(value, 0), this.size[axis]);
    const [a, b] = [this.near(Math.min(x0, x1), Math.min(y0, y1)), this.near(Math.max(x0, x1), Math.max(y0, y1))];
    const [x, y] = a.map((value, axis) => Math.floor(clamp(value, axis)));
    const [right, bottom] = b.map((value, axis) => Math.ceil(clamp(value, axis)));
    return { x, y, width: right - x, height: bottom - y };
  }

  /// Outlines a region of the image; `null` removes the outline.
  frame(rect) {
    this.rect = rect;
    this.drawRegion();
  }

  drawRegion() {
    this.region.hidden = !this.rect;
    if (!this.rect) return;
    const { left, top } = this.box;
    const points = (pixels) => `${pixels / this.scale}px`;
    this.region.style.left = `${left + this.rect.x / this.scale}px`;
    this.region.style.top = `${top + this.rect.y / this.scale}px`;
    this.region.style.width = points(this.rect.width);
    this.region.style.height = points(this.rect.height);
  }
}
