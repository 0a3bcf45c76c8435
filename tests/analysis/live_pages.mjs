// SPDX-License-Identifier: GPL-3.0-or-later
// The pure parts of the pages of tactograph live (modules beside this file), without a browser.
import assert from 'node:assert';
import {compareWords, fullScale, gainsOf, largestLevel} from './compare.js';
import {arrange, countWords, withPrefix} from './library.js';

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
