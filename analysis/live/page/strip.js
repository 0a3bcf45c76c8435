// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures: the texture's map with the finger on it, and the trace of the tray.

// Points of the colour maps, dark to light: viridis (van der Walt, Smith), cividis (Nunez et al. 2018), grey.
const COLOURS = {
  viridis: [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]],
  cividis: [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [165, 156, 116], [195, 179, 105], [254, 232, 56]],
  grey: [[20, 20, 20], [235, 235, 235]],
};

function colourAt(points, part) {
  const at = Math.max(0, Math.min(1, part)) * (points.length - 1), i = Math.min(points.length - 2, Math.floor(at));
  return points[i].map((c, k) => Math.round(c + (at - i) * (points[i + 1][k] - c)));
}

/** 256 colours of a map, dark to light, each as a pixel of ImageData. */
export function palette(name) {
  const bytes = new Uint8ClampedArray(4 * 256);
  for (let i = 0; i < 256; ++i) bytes.set([...colourAt(COLOURS[name], i / 255), 255], 4 * i);
  return new Uint32Array(bytes.buffer);
}

// A canvas with as many pixels as the screen has there; `fresh` if its size has changed.
export function sized(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  const fresh = canvas.width !== width || canvas.height !== height;
  if (fresh) [canvas.width, canvas.height] = [width, height];
  return {ink: canvas.getContext('2d'), width, height, ratio, fresh};
}

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const LOCAL_M = 0.5e-3;  // on each side: the colour is the range of the force within it

/** The view is {from_m, to_m}, of a texture {start_m, length_m, map}: least and greatest force of each column. */
export function drawMap(canvas, texture, view, colours) {
  const {ink, width, height} = sized(canvas);
  ink.clearRect(0, 0, width, height);
  if (texture === null) return;
  const {map, length_m, start_m} = texture, columns = map.length / 2, middle = height / 2;
  const columnAt = (x) => (view.from_m + x / width * (view.to_m - view.from_m) - start_m) / length_m * columns;
  const most = map.reduce((peak, value) => Math.max(peak, Math.abs(value)), 0) || 1;
  const ranges = localRanges(map, Math.max(1, Math.round(LOCAL_M / length_m * columns)));
  const widest = Math.max(...ranges) || 1;
  for (let x = 0; x < width; ++x) {
    // From the last column before this pixel on, so that neighbours meet.
    const first = Math.max(0, Math.floor(columnAt(x)) - 1), end = Math.min(columns, Math.max(first + 1, Math.ceil(columnAt(x + 1))));
    if (columnAt(x + 0.5) < 0 || columnAt(x + 0.5) >= columns) continue;
    const colour = colourAt(COLOURS[colours], ranges[end - 1] / widest), part = map.subarray(2 * first, 2 * end);
    ink.fillStyle = `rgb(${colour.join()})`;
    ink.fillRect(x, 0, 1, height);
    ink.fillStyle = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2] > 110 ? '#000' : '#fff';
    const top = middle - Math.max(...part) / most * middle * 0.9, bottom = middle - Math.min(...part) / most * middle * 0.9;
    ink.fillRect(x, top, 1, Math.max(1, bottom - top));
  }
}

// The range of the force around each column.
function localRanges(map, reach) {
  return Float32Array.from({length: map.length / 2}, (_, i) => {
    const part = map.subarray(2 * Math.max(0, i - reach), 2 * (i + reach + 1));
    return Math.max(...part) - Math.min(...part);
  });
}

/** The finger: a line where it touches, dashed where it is lifted; its end is a filled or an empty triangle. */
export function drawFinger(canvas, view, place_m, touches) {
  const {ink, width, height, ratio} = sized(canvas);
  ink.clearRect(0, 0, width, height);
  if (place_m === null) return;
  const x = (place_m - view.from_m) / (view.to_m - view.from_m) * width, size = 9 * ratio;
  for (const [colour, thickness] of [['#000', 6 * ratio], ['#fff', 3 * ratio]]) {
    ink.strokeStyle = ink.fillStyle = colour;
    ink.lineWidth = thickness;
    ink.setLineDash(touches ? [] : [8 * ratio, 8 * ratio]);
    ink.beginPath();
    ink.moveTo(x, size);
    ink.lineTo(x, height);
    ink.stroke();
    ink.setLineDash([]);
    ink.beginPath();
    ink.moveTo(x - size, 1);
    ink.lineTo(x + size, 1);
    ink.lineTo(x, 2 * size);
    ink.closePath();
    if (touches) ink.fill();
    ink.stroke();
  }
}

const TRACE_CELLS = 1000;  // of 2 ms

export class Trace {
  constructor(canvas, cells = TRACE_CELLS) {
    this.canvas = canvas;
    this.count = cells;
    this.clear(1);
  }
  /** `full_m` is at the upper edge. */
  clear(full_m) {
    this.full_m = full_m;
    this.cells = new Float32Array(2 * this.count);
    this.at = 0;
  }
  add(cells) {
    for (let i = 0; i < cells.length; i += 2) {
      this.cells[2 * this.at] = cells[i];
      this.cells[2 * this.at + 1] = cells[i + 1];
      this.at = (this.at + 1) % this.count;
    }
  }
  /** The largest magnitude of the last `shown` cells. */
  peak(shown = this.count) {
    let most = 0;
    for (let i = this.count - shown; i < this.count; ++i)
      for (const k of [0, 1]) most = Math.max(most, Math.abs(this.cells[2 * ((this.at + i) % this.count) + k]) || 0);
    return most;
  }
  /** The last `shown` cells. Those that are NaN are left out. */
  draw(shown = this.count) {
    const {ink, width, height, ratio} = sized(this.canvas);
    ink.clearRect(0, 0, width, height);
    const middle = height / 2, scale = middle * 0.95 / this.full_m;
    ink.fillStyle = css('--line');
    ink.fillRect(0, middle, width, 1);
    ink.fillStyle = css('--trace');
    for (let x = 0; x < width; ++x) {
      // From the last cell before this pixel on, so that neighbours meet.
      const first = Math.max(0, Math.floor(x / width * shown) - 1), end = Math.max(first + 1, Math.floor((x + 1) / width * shown));
      let least = Infinity, most = -Infinity;
      for (let i = first; i < end; ++i) {
        const cell = 2 * ((this.at + this.count - shown + i) % this.count);
        least = Math.min(least, this.cells[cell]);
        most = Math.max(most, this.cells[cell + 1]);
      }
      ink.fillRect(x, middle - most * scale, 1, Math.max(ratio, (most - least) * scale));
    }
  }
}
