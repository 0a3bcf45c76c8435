// SPDX-License-Identifier: GPL-3.0-or-later
// The pure parts of the pages of tactograph live (modules beside this file), without a browser. Argument: a JSON file with
// the answer `about` to /spectrogram/N, the files of its `cells` and `known`, and `places`: [m, 1/m]; it prints what the
// page says of the cell at each place.
import {readFileSync} from 'node:fs';
import assert from 'node:assert';
import {Axis, Cells, cellWords, exportQuery, frequencyMarks, marks, paint, powers} from './cells.js';
import {compareWords, fullScale, gainsOf, largestLevel} from './compare.js';
import {arrange, countWords, recordingWords, withPrefix} from './library.js';
import {effectiveWords, positionOf, queryOf, valueAt, valueWords} from './shape.js';

// The list: search, order, and those that can't be read at its end.
const row = (name, length_m, rms, changed_s, surface) => ({name, length_m, rms, changed_s, unit: 'N', surface});
const rows = [row('oak10', 0.03, 0.2, 3, 'wood'), row('oak2', 0.05, 0.1, 1, 'wood'), {name: 'a-broken', reason: 'no sidecar'}, row('Cork', 0.04, 0.3, 2, '')];
const names = (search, order) => arrange(rows, search, order).map(({name}) => name);
assert.deepEqual(names('', 'name'), ['Cork', 'oak2', 'oak10', 'a-broken']);
assert.deepEqual(names('', 'length'), ['oak2', 'Cork', 'oak10', 'a-broken']);
assert.deepEqual(names('', 'strength'), ['Cork', 'oak10', 'oak2', 'a-broken']);
assert.deepEqual(names('', 'newest'), ['oak10', 'Cork', 'oak2', 'a-broken']);
assert.deepEqual(names(' WOOD 10 ', 'name'), ['oak10']);
assert.deepEqual(names('broken', 'length'), ['a-broken']);
assert.deepEqual(names('.*', 'name'), []);  // text, no pattern
assert.match(countWords(rows.slice(0, 1), rows), /^1 of 4 .*1 can't/);
assert.deepEqual([withPrefix(0.0123, 'N'), withPrefix(1.5e-6, 'm'), withPrefix(0, 'N'), withPrefix(0.3, 'm/s'), withPrefix(2, '1')],
                 ['12.3 mN', '1.50 µm', '0.00 N', '0.300 m/s', '2.00']);

assert.match(recordingWords({duration_s: 2, sample_rate_hz: 2000, channels: ['a', 'b'], strokes: 1, missing_frames: 3, surface: ''}), /^2\.00 s, 2 kHz, a, b, 1 stroke, 3 frames missing$/);

// Sliders: positions and back, what is off or as it is does not enter the query.
const stretch = {query: 'stretch', times: 1, low: 0.5, high: 2, start: 1, logarithmic: true};
const low = {query: 'low_per_m', times: 1e-3, low: 0.05, high: 20, start: 0.05, logarithmic: true, off: 0.05};
assert.deepEqual([0, 100, 200].map((position) => valueAt(stretch, position)), [0.5, 1, 2]);
assert.equal(positionOf(stretch, 1), 100);
assert.deepEqual([valueAt({low: 0, high: 200, digits: 0}, 7), valueAt({low: -24, high: 0}, 150)], [7, -6]);
assert.equal(queryOf([stretch, low], [1, 0.05], true), '');
assert.equal(queryOf([stretch, low], [1.3, 0.5], true), 'stretch=1.3&low_per_m=500&keep_slope=1');
assert.equal(queryOf([stretch, low], [1, 0.5], true), 'low_per_m=500');
assert.match(effectiveWords({factor: 1.3, period_m: 3e-3, low_per_m: 500, high_per_m: 5000, removed_share: 0}), /^stretch 1\.3, period 3 mm before, band from 0\.5 \/mm \(2 mm\), to 5 \/mm \(0\.2 mm\)$/);
// A spatial frequency is also a period.
assert.deepEqual([0.05, 0.3, 4].map((value) => valueWords({...low, period: true}, value)), ['off', '0.3 /mm (3.33 mm)', '4 /mm (0.25 mm)']);
assert.equal(valueWords({unit: ''}, 3), '3');

// A and B: the same RMS of displacement, and no tray beyond its limit.
const side = (gain_m_per_n, rms, tray_peak_m) => ({figures: {name: 'x', gain_m_per_n, rms, tray_peak_m, displacement_limit_m: 100e-6}});
const sides = {A: side(4e-4, 0.01, 20e-6), B: side(-3e-4, 0.05, 60e-6)};
assert.deepEqual(gainsOf(sides, false), {A: 4e-4, B: -3e-4});
const equal = gainsOf(sides, true);
assert.equal(equal.A, 4e-4);
assert.ok(equal.B < 0 && Math.abs(equal.B * 0.05 / (4e-4 * 0.01) + 1) < 1e-12);  // the sign stays
assert.equal(largestLevel(sides, gainsOf(sides, false), 4), 1.66);                // 100 / 60
assert.equal(largestLevel(sides, equal, 4), 4);                                   // B: 60 um x 0.8 / 3
assert.equal(largestLevel({A: sides.A, B: null}, equal, 10), 5);
assert.ok(Math.abs(fullScale(sides, gainsOf(sides, false)) - 60e-6) < 1e-15 && Math.abs(fullScale(sides, equal) - 20e-6) < 1e-15);
assert.equal(fullScale({A: side(1, 1, 0), B: null}, {A: 1}), 100e-6);             // a texture without force
assert.equal(gainsOf({A: side(1, 0, 1), B: sides.B}, true).B, -3e-4);
assert.match(compareWords(sides, equal, true), /0\.400 mm\/N.*-0\.080 mm\/N, 0\.267 times its default \(-11\.5 dB\)/);
assert.match(compareWords({A: side(1, 0, 1), B: sides.B}, {A: 1, B: -3e-4}, true), /no equal RMS/);

// Axes: places and back, zoom about a place, marks.
const close = (a, b) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(b)), `${a} is not ${b}`);
for (const axis of [new Axis(10, 15000, true), new Axis(0, 0.035), new Axis(-2, 3)])
  for (const place of [0, 0.3, 1]) close(axis.place(axis.value(place)), place);
close(new Axis(10, 1000, true).value(0.5), 100);
const limits = new Axis(0, 10), part = new Axis(4, 8).zoomed(0.5, 0.25, limits);
assert.deepEqual([part.low, part.high, part.value(0.25)], [4.5, 6.5, 5]);
assert.deepEqual({...new Axis(4, 8).zoomed(8, 0.5, limits)}, {...new Axis(0, 10)});
const along = new Axis(4, 8).showing(9, limits);
assert.deepEqual([along.low, along.high], [5, 9]);
assert.deepEqual(marks(new Axis(0, 1), 5), [0, 0.2, 0.4, 0.6, 0.8, 1]);
assert.deepEqual(marks(new Axis(-0.25, 0.3), 5), [-0.2, 0, 0.2]);
assert.deepEqual(marks(new Axis(0.07, 15, true), 6), [0.1, 0.2, 0.5, 1, 2, 5, 10]);
assert.deepEqual(marks(new Axis(2.1, 2.9, true), 4), [2.2, 2.4, 2.6, 2.8]);
for (const logarithmic of [true, false])
  for (const unit of ['1/mm', 'mm', 'Hz'])
    for (const [place, text] of frequencyMarks(new Axis(logarithmic ? 70 : 0, 15000, logarithmic), 8, unit, 0.05)) {
      const per_m = {'1/mm': 1e3 * text, mm: 1e3 / text, Hz: text / 0.05}[unit];
      assert.ok(place >= 0 && place <= 1);
      close(new Axis(logarithmic ? 70 : 0, 15000, logarithmic).place(per_m), place);
    }

// Cells: 3 windows of 4 frequencies.
const about = {first_position_m: 0.01, hop_m: 0.001, rows: 3, bins: 4, frequency_step_per_m: 100, level_decade_db: 10, level_factor: 10, cell_unit: 'N2 mm',
               level_unit: '1 N^2 mm', start_m: 0.005, end_m: 0.017, lowest_per_m: 70};
const few = new Cells(about, Float32Array.from({length: 12}, (_, i) => 10 ** (i - 6)), Float32Array.from([100, 200, 100, 200, 100, 300]));
assert.deepEqual(few.at(0.01049, 149), {row: 0, bin: 1});
assert.deepEqual(few.at(9, -9), {row: 2, bin: 0});
close(few.level_db({row: 1, bin: 2}), 10);
assert.deepEqual([few.knows({row: 0, bin: 3}), few.knows({row: 2, bin: 3}), few.knows({row: 0, bin: 0})], [false, true, false]);
assert.match(cellWords(few, {row: 0, bin: 3}, 0.05), /position 10 mm; frequency 0\.3 \/mm \(period 3\.333 mm; 15 Hz at 50 mm\/s\); .*outside the valid band/);
assert.doesNotMatch(cellWords(few, {row: 2, bin: 0}, 0.05), /period|Infinity/);

assert.deepEqual(['N2 mm', '1 N^2 mm', 'm', '(m/s)2'].map(powers), ['N² mm', '1 N² mm', 'm', '(m/s)²']);

// Pixels: the whole, larger than the cells and smaller; what is outside; every cell is in some pixel.
const colours = Uint32Array.from({length: 256}, (_, i) => i + 1), levels = {low_db: -60, high_db: 60};  // 10 dB are 21.3 colours
const painted = (x, y, width, height) => {
  const pixels = new Uint32Array(width * height);
  paint(few, x, y, levels, colours, width, height, pixels);
  return Array.from({length: height}, (_, j) => Array.from(pixels.subarray(j * width, (j + 1) * width)));
};
const shade = (cell) => colours[Math.min(255, Math.floor((10 * (cell - 5) + 60) * 256 / 120))];
const x = new Axis(0.0095, 0.0125), y = new Axis(-50, 350);  // exactly the cells
assert.deepEqual(painted(x, y, 3, 4), [3, 2, 1, 0].map((bin) => [0, 4, 8].map((first) => shade(first + bin))));
assert.deepEqual(painted(x, y, 1, 1), [[256]]);  // the largest
assert.deepEqual(painted(x, y, 6, 4)[3], [0, 0, 4, 4, 8, 8].map(shade));
assert.deepEqual(painted(new Axis(0.0075, 0.0105), y, 3, 1), [[0, 0, shade(3)]]);
assert.deepEqual(painted(x, new Axis(1000, 2000), 2, 1), [[0, 0]]);

// Exports: nothing of a view that is whole.
const query = (...view) => exportQuery(few, ...view);
const all = [new Axis(0.005, 0.017), new Axis(70, 300, true)], some = [new Axis(0.01, 0.017), new Axis(150, 250, true)];
assert.equal(query(...all, {selection: true, formants: false, range_db: 60}), 'range_db=60');
assert.equal(query(...some, {selection: false, formants: true, range_db: 40}), 'range_db=40&formants=1');
assert.equal(query(...some, {selection: true, formants: false, range_db: 60}), 'from_m=0.01&low_per_m=150&high_per_m=250&range_db=60');

if (process.argv[2] !== undefined) {
  const given = JSON.parse(readFileSync(process.argv[2], 'utf8'));
  const floats = (file) => new Float32Array(new Uint8Array(readFileSync(file)).buffer);
  const spectrogram = new Cells(given.about, floats(given.cells), floats(given.known));
  console.log(JSON.stringify(given.places.map(([position_m, per_m]) => cellWords(spectrogram, spectrogram.at(position_m, per_m), 0.05))));
}
