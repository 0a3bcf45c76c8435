// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the pure parts of the page of the device (ticks.js, beside this file) without a browser. Argument: a JSON file with
// `streams`: events `ticks` and their period; it prints what the page makes of each. The rest is checked here.
import {readFileSync} from 'node:fs';
import assert from 'node:assert';
import {Cells, contactWords, decodeTicks, gainWords, lateRows, limitWords, placeWords, roundUp, SILENT_MS, Spectrum, Speeds, stateOf} from './ticks.js';

const {streams} = JSON.parse(readFileSync(process.argv[2], 'utf8'));
console.log(JSON.stringify(streams.map(({events, period_s}) => {
  const spectrum = new Spectrum(), cells = new Cells(), rows = [], made = [];
  let step = 0;
  for (const event of events) {
    const ticks = decodeTicks(event, period_s);
    rows.push(...ticks.rows);
    made.push(...cells.take(ticks));
    spectrum.take(ticks);
    step = ticks.step;
  }
  return {rows, cells: made.map((value) => (Number.isNaN(value) ? null : value)), amplitudes: Array.from(spectrum.amplitudes() ?? []), step};
})));

// The state in word and shape, with every way to lose the daemon.
const told = {here: true}, silent_ms = 0;
for (const state of ['idle', 'armed', 'playing', 'fault'])
  assert.deepEqual(stateOf({server: true, daemon: told, state, silent_ms}), {state, words: state});
const lost = [{server: false, daemon: told, state: 'playing', silent_ms}, {server: true, daemon: {here: false}, state: 'playing', silent_ms},
              {server: true, daemon: told, state: 'lost', silent_ms}, {server: true, daemon: told, state: 'playing', silent_ms: SILENT_MS + 1},
              {server: true, daemon: null, state: undefined, silent_ms}];
for (const one of lost) assert.equal(stateOf(one).state, 'lost');
assert.equal(new Set(lost.map((one) => stateOf(one).words)).size, lost.length);
assert.ok(SILENT_MS < 2000);
assert.equal(stateOf({server: true, daemon: told, state: 'idle', silent_ms: 1e6}).state, 'idle');  // in idle the daemon is silent

assert.notEqual(contactWords(512), contactWords(512 | 128));
assert.notEqual(contactWords(0), contactWords(512));
assert.match(limitWords({limits_took_db: -20.04, limits_took_last_second_db: -31}, 8 | 64), /amplitude, energy.*-31\.0 dB.*-20\.0 dB/);
assert.match(limitWords({limits_took: 'unknown: ticks were lost'}, 16), /slew.*ticks were lost/);

assert.equal(lateRows({}), null);
const parts = {late_over_10us_part: 0.5, late_over_50us_part: 0.25, late_over_100us_part: 0.125, late_over_500us_part: 0.0625, late_over_1000us_part: 0.03125};
assert.deepEqual(lateRows(parts).map(([, part]) => part), [0.5, 0.25, 0.125, 0.0625, 0.03125, 0.03125]);

// A steady speed, of the whole span only.
const speeds = new Speeds();
const steadyAfter = (...seen) => { for (const [time_s, speed_mps] of seen) speeds.take(time_s, speed_mps); return speeds.steady(0.5); };
assert.equal(steadyAfter([0, 0.05], [0.3, 0.05]), null);                            // seen for 0.3 s
assert.ok(Math.abs(steadyAfter([0.6, 0.052]) - 0.051) < 1e-12);
assert.equal(steadyAfter([0.7, -0.05]), null);                                      // it turned
assert.ok(Math.abs(steadyAfter([0.9, -0.05], [1.2, -0.05]) - 0.05) < 1e-12);        // the turn is 0.5 s ago
assert.equal(steadyAfter([1.3, 0.07]), null);
assert.equal(steadyAfter([0.1, 0.05]), null);                                       // a new clock
assert.equal(steadyAfter([0.2, undefined]), null);

assert.match(gainWords({forces: false, asked: 0.8, effective: 0.75, gain_m_per_n: 1e-4}), /0\.80.*0\.75.*0\.100 mm\/N/);
assert.doesNotMatch(gainWords({forces: false, asked: undefined, effective: 0.75, gain_m_per_n: 1e-4}), /asked/);
assert.notEqual(gainWords({forces: true}), gainWords({forces: false}));
const onPlane = placeWords({x_m: 0.001, y_m: -0.002, force_x_n: 0.5, force_y_n: 1, force_peak_n: 3}, 0);
assert.match(onPlane, /x 1\.00 mm, y -2\.00 mm.*x 0\.50 N, y 1\.00 N.*3\.00 N/);
assert.doesNotMatch(onPlane, /drive/);
assert.match(placeWords({speed_mps: 0.05, drive_v: 1.5}, 0.012), /12\.00 mm, 50 mm\/s; drive 1\.50 V/);

for (const [value, up] of [[0.3, 0.5], [1, 1], [1.01, 2], [4.9, 5], [5.1, 10], [0.02, 0.02]]) assert.ok(Math.abs(roundUp(value) - up) < 1e-12);
