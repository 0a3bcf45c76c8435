// SPDX-License-Identifier: GPL-3.0-or-later
// A spectrogram in numbers: axes and their marks, the cell at a place, the shades of a view, and what a cell says.

/** An axis from `low` to `high` along 0 to 1. A logarithmic one needs low > 0. */
export class Axis {
  constructor(low, high, logarithmic = false) {
    Object.assign(this, {low, high, logarithmic});
  }
  scale(value) { return this.logarithmic ? Math.log(value) : value; }
  place(value) { return (this.scale(value) - this.scale(this.low)) / (this.scale(this.high) - this.scale(this.low)); }
  value(place) {
    const scaled = this.scale(this.low) + place * (this.scale(this.high) - this.scale(this.low));
    return this.logarithmic ? Math.exp(scaled) : scaled;
  }
  /** `times` as much of the axis, the value at `place` staying there, not beyond `limits` (an axis). */
  zoomed(times, place, limits) {
    return this.within(this.value(place - place * times), this.value(place + (1 - place) * times), limits);
  }
  /** Moved so that it contains a value. */
  showing(value, limits) {
    const place = this.place(value), beyond = Math.min(0, place) + Math.max(0, place - 1);
    return beyond === 0 ? this : this.within(this.value(beyond), this.value(1 + beyond), limits);
  }
  within(low, high, limits) { return new Axis(Math.max(low, limits.low), Math.min(high, limits.high), this.logarithmic); }
}

/** About `most` round values of an axis. */
export function marks(axis, most) {
  const {low, high} = axis;
  if (axis.logarithmic && high / low > 5) {
    const decades = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) decades.push(10 ** power);
    const factors = decades.length * 3 <= 2 * most ? [1, 2, 5] : [1];
    return decades.flatMap((decade) => factors.map((factor) => factor * decade)).filter((value) => value >= low && value <= high);
  }
  const rough = (high - low) / most, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= rough);
  const count = Math.floor(high / step + 1e-9) - Math.ceil(low / step - 1e-9) + 1;
  return Array.from({length: Math.max(0, count)}, (_, i) => Number(((Math.ceil(low / step - 1e-9) + i) * step).toPrecision(12)));
}

const plain = (value, digits) => String(Number(value.toPrecision(digits)));

/** Spatial frequencies in other words; `unit`: '1/mm', 'mm' (the wavelength), 'Hz' (at a speed in m/s). */
export function fromPerMetre(per_m, unit, speed_mps) { return unit === 'mm' ? 1e3 / per_m : unit === 'Hz' ? per_m * speed_mps : 1e-3 * per_m; }
export function toPerMetre(value, unit, speed_mps) { return unit === 'mm' ? 1e3 / value : unit === 'Hz' ? value / speed_mps : 1e3 * value; }

/** Marks of an axis of spatial frequencies (1/m) in a unit: [place, text]. */
export function frequencyMarks(axis, most, unit, speed_mps) {
  const ends = [axis.low, axis.high].map((per_m) => fromPerMetre(Math.max(per_m, 1e-9), unit, speed_mps)).sort((a, b) => a - b);
  // Wavelengths on a linear axis of frequency are as little even as on a logarithmic one.
  const shown = new Axis(ends[0], unit === 'mm' ? Math.min(ends[1], 1e3 * ends[0]) : ends[1], axis.logarithmic || unit === 'mm');
  const taken = [];
  return marks(shown, most).map((value) => [axis.place(toPerMetre(value, unit, speed_mps)), plain(value, 6)])
    .filter(([place]) => place >= 0 && place <= 1 && taken.every((other) => Math.abs(other - place) >= 0.5 / most) && taken.push(place));
}

/** The spectrogram of the page: the server's members, with `cells` (as in NAME.nc, by rows) and `known` (limits of each row, 1/m). */
export class Cells {
  constructor(about, cells, known) {
    Object.assign(this, about, {cells, known});
    this.levels = new Float32Array(cells.length);
    const {level_decade_db: decade, level_factor: factor} = about;
    for (let i = 0; i < cells.length; ++i) this.levels[i] = decade * Math.log10(factor * cells[i]);
  }
  position_m(row) { return this.first_position_m + row * this.hop_m; }
  frequency_per_m(bin) { return bin * this.frequency_step_per_m; }
  get highest_per_m() { return this.frequency_per_m(this.bins - 1); }
  /** The cell nearest to a place: {row, bin}. */
  at(position_m, frequency_per_m) {
    const near = (value, most) => Math.max(0, Math.min(most - 1, Math.round(value)));
    return {row: near((position_m - this.first_position_m) / this.hop_m, this.rows), bin: near(frequency_per_m / this.frequency_step_per_m, this.bins)};
  }
  cell({row, bin}) { return this.cells[row * this.bins + bin]; }
  level_db({row, bin}) { return this.levels[row * this.bins + bin]; }
  /** The colour of each cell, 0 to 255 from low_db to high_db, by frequencies: cell {row, bin} at bin * rows + row. Kept
   * until the range changes, because a zoom needs them for each picture. */
  shades({low_db, high_db}) {
    if (this.shaded?.low_db === low_db && this.shaded.high_db === high_db) return this.shaded.shades;
    const {bins, rows, levels} = this, shades = new Uint8Array(levels.length), scale = 256 / (high_db - low_db);
    for (let row = 0, at = 0; row < rows; ++row)
      for (let bin = 0; bin < bins; ++bin, ++at) shades[bin * rows + row] = Math.max(0, Math.min(255, Math.floor((levels[at] - low_db) * scale)));
    this.shaded = {low_db, high_db, shades};
    return shades;
  }
  /** Whether the recording could know it; null if the texture does not say. */
  knows({row, bin}) {
    if (this.known.length === 0) return null;
    const per_m = this.frequency_per_m(bin);
    return this.known[2 * row] <= per_m && per_m <= this.known[2 * row + 1];
  }
}

/** The first and the end of the cells that each of `count` pixels shows: of `most`, pixel i from edge(i) to edge(i + 1), in
 * cells from the middle of cell 0. A pixel beyond them has none. */
function spans(count, most, edge) {
  const first = new Int32Array(count), end = new Int32Array(count);
  for (let i = 0, before = edge(0); i < count; ++i) {
    const after = edge(i + 1), low = Math.min(before, after), high = Math.max(before, after), middle = Math.round((low + high) / 2);
    before = after;
    first[i] = Math.max(0, Math.round(low));
    end[i] = Math.min(most, Math.round(high));
    if (high - low < 1 || end[i] <= first[i]) [first[i], end[i]] = middle >= 0 && middle < most ? [middle, middle + 1] : [0, 0];
  }
  return {first, end};
}

/** The colours of a view: a pixel shows the largest of its cells. `positions`, `frequencies`: axes; `colours`: 256 pixels (as
 * in ImageData, 32 bits); where there is no cell the pixel is 0. */
export function paint(spectrogram, positions, frequencies, levels, colours, width, height, pixels) {
  const {bins, rows} = spectrogram, shades = spectrogram.shades(levels), line = new Uint8Array(rows);
  const x = spans(width, rows, (i) => (positions.value(i / width) - spectrogram.first_position_m) / spectrogram.hop_m);
  const y = spans(height, bins, (i) => frequencies.value(1 - i / height) / spectrogram.frequency_step_per_m);
  for (let j = 0; j < height; ++j) {
    const begin = j * width;
    if (j > 0 && y.first[j] === y.first[j - 1] && y.end[j] === y.end[j - 1]) {  // the same cells as above
      pixels.copyWithin(begin, begin - width, begin);
      continue;
    }
    if (y.end[j] === 0) {
      pixels.fill(0, begin, begin + width);
      continue;
    }
    line.set(shades.subarray(y.first[j] * rows, (y.first[j] + 1) * rows));
    for (let bin = y.first[j] + 1; bin < y.end[j]; ++bin)
      for (let row = 0, at = bin * rows; row < rows; ++row, ++at) if (shades[at] > line[row]) line[row] = shades[at];
    for (let i = 0; i < width; ++i) {
      let most = line[x.first[i]];
      for (let row = x.first[i] + 1; row < x.end[i]; ++row) if (line[row] > most) most = line[row];
      pixels[begin + i] = x.end[i] === 0 ? 0 : colours[most];
    }
  }
}

/** A unit as people write it: "N² mm" for "N2 mm" (netCDF) and "N^2 mm". */
export const powers = (unit) => unit.replace(/\^?2\b/g, '²');

/** Everything about a cell. A value has the nine digits that identify a float32. */
export function cellWords(spectrogram, cell, speed_mps) {
  const per_m = spectrogram.frequency_per_m(cell.bin), known = spectrogram.knows(cell), level = spectrogram.level_db(cell);
  const wave = per_m > 0 ? ` (period ${plain(1e3 / per_m, 4)} mm; ${plain(per_m * speed_mps, 4)} Hz at ${plain(1e3 * speed_mps, 4)} mm/s)` : '';
  return `position ${plain(1e3 * spectrogram.position_m(cell.row), 7)} mm; frequency ${plain(1e-3 * per_m, 6)} /mm${wave}; ` +
      `${spectrogram.cell(cell).toExponential(8)} ${powers(spectrogram.cell_unit)}, ${Number.isFinite(level) ? level.toFixed(1) : '−∞'} dB re ${powers(spectrogram.level_unit)}` +
      (known === false ? '; outside the valid band: not measured' : '');
}

/** The query of an export: nothing of a view that is whole. */
export function exportQuery(spectrogram, positions, frequencies, {selection, formants, range_db}) {
  const query = new URLSearchParams();
  if (selection) {
    const whole_m = [spectrogram.start_m, spectrogram.end_m], lowest = spectrogram.lowest_per_m;
    if (positions.low > whole_m[0]) query.set('from_m', positions.low);
    if (positions.high < whole_m[1]) query.set('to_m', positions.high);
    // The axis of a picture is logarithmic: it has no zero.
    if (frequencies.low >= spectrogram.frequency_step_per_m && frequencies.low !== lowest) query.set('low_per_m', frequencies.low);
    if (frequencies.high < spectrogram.highest_per_m) query.set('high_per_m', frequencies.high);
  }
  query.set('range_db', range_db);
  if (formants) query.set('formants', 1);
  return query.toString();
}
