// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon's ticks and status as the page of the device shows them: decoded, as a trace, a spectrum, and words.

export const CELL_S = 0.002;        // of the trace
export const SPECTRUM_LENGTH = 1024;
const LONGEST_GAP = 5000;           // cells; after a longer one the trace begins again
const FLAGS = {amplitude: 8, slew: 16, energy: 64, gated: 128, touching: 512};  // of ticks (WIRE.md)
const LATE_BOUNDS = ['10us', '50us', '100us', '500us', '1000us'];
export const SILENT_MS = 1500;      // an armed daemon sends 50 messages a second

/** Of an event `ticks` (CONTROL.md): per tick its number, time (ns), encoder count of the first axis, flags, and value: the
 * drive in volts, or the force in newtons of a device with forces. `step`: ticks from one value to the next.
 * @param {{block: number, ticks: string, cell_ticks?: number}} event
 * @param {number} period_s of a tick */
export function decodeTicks({block, ticks, cell_ticks}, period_s) {
  const bytes = Uint8Array.from(atob(ticks), (c) => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  const count = view.getUint32(16, true), axes = block === 8 ? view.getUint32(20, true) : 0;
  const head = axes > 0 ? 24 : 20, size = axes > 0 ? 8 + 8 * axes : 20;
  const first = Number(view.getBigUint64(0, true)), from_ns = Number(view.getBigInt64(8, true));
  const rows = Array.from({length: count}, (_, i) => {
    const at = head + i * size, after_ns = view.getUint32(at, true);
    const number = first + (cell_ticks ? Math.round(1e-9 * after_ns / period_s) : i);
    const forces = Array.from({length: axes}, (_, k) => view.getFloat32(at + 4 + 4 * axes + 4 * k, true));
    return {number, time_ns: from_ns + after_ns, count: view.getInt32(at + 4, true),
            value: axes > 0 ? Math.hypot(...forces) : view.getFloat32(at + 8, true),
            flags: view.getUint32(at + (axes > 0 ? 4 + 8 * axes : 12), true)};
  });
  return {rows, step: cell_ticks ?? 1};
}

/** Least and greatest value of each CELL_S. */
export class Cells {
  constructor() { this.index = null; }
  /** The cells that are complete, as [least, greatest, ...]; without ticks NaN. */
  take({rows}) {
    const done = [];
    for (const {time_ns, value} of rows) {
      const index = Math.floor(time_ns / (1e9 * CELL_S));
      if (this.index === null || index < this.index || index > this.index + LONGEST_GAP) this.begin(index);
      for (; this.index < index; ++this.index) {
        done.push(this.least, this.most);
        this.least = this.most = NaN;
      }
      this.least = Number.isNaN(this.least) ? value : Math.min(this.least, value);
      this.most = Number.isNaN(this.most) ? value : Math.max(this.most, value);
    }
    return done;
  }
  begin(index) {
    this.index = index;
    this.least = this.most = NaN;
  }
}

/** Amplitudes of the last SPECTRUM_LENGTH values without a gap; of a reduced stream a value is the middle of its cell. */
export class Spectrum {
  constructor() {
    this.values = new Float64Array(SPECTRUM_LENGTH);
    this.filled = 0;
    this.last = null;
  }
  take({rows, step}) {
    for (const {number, value} of rows) {
      const index = Math.floor(number / step), at = index % SPECTRUM_LENGTH;
      if (index === this.last) {
        this.values[at] = (this.values[at] + value) / 2;
        continue;
      }
      this.filled = index - 1 === this.last ? Math.min(SPECTRUM_LENGTH, this.filled + 1) : 1;
      this.values[at] = value;
      this.last = index;
    }
  }
  /** Of the frequencies k / (SPECTRUM_LENGTH x step x period), by a Hann window; null before it is full. A sine of
   * amplitude 1 has 1 at its frequency (a whole k). */
  amplitudes() {
    if (this.filled < SPECTRUM_LENGTH) return null;
    const n = SPECTRUM_LENGTH, re = new Float64Array(n), im = new Float64Array(n);
    for (let i = 0; i < n; ++i)
      re[i] = this.values[(this.last + 1 + i) % n] * (1 - Math.cos(2 * Math.PI * i / n)) * 2 / n;
    transform(re, im);
    return Float64Array.from({length: n / 2}, (_, k) => Math.hypot(re[k], im[k]) / (k === 0 ? 2 : 1));
  }
}

const STEADY = 0.1;         // part of the mean speed
const SPEEDS_KEPT_S = 60;   // the longest span

/** Whether the finger's speed is steady: a spectrum has one spatial period only then. */
export class Speeds {
  constructor() { this.seen = []; }
  take(time_s, speed_mps) {
    if (!Number.isFinite(time_s) || !Number.isFinite(speed_mps)) return;
    if (time_s < this.seen.at(-1)?.time_s) this.seen = [];  // a new clock
    this.seen.push({time_s, speed_mps});
    this.seen = this.seen.filter((one) => one.time_s > time_s - SPEEDS_KEPT_S);
  }
  /** The mean speed (m/s, without sign) of the last `span_s`, if all speeds in it are within STEADY of it; else null. */
  steady(span_s) {
    const from_s = this.seen.at(-1)?.time_s - span_s, speeds = this.seen.filter(({time_s}) => time_s >= from_s).map((one) => one.speed_mps);
    if (!(this.seen[0]?.time_s <= from_s)) return null;  // not seen for that long
    const mean = speeds.reduce((sum, speed) => sum + speed, 0) / speeds.length;
    return speeds.every((speed) => Math.abs(speed - mean) <= STEADY * Math.abs(mean)) ? Math.abs(mean) : null;
  }
}

// Fast Fourier transform in place, radix 2 (Cooley and Tukey 1965).
function transform(re, im) {
  const n = re.length;
  for (let i = 1, j = 0; i < n; ++i) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) [re[i], re[j], im[i], im[j]] = [re[j], re[i], im[j], im[i]];
  }
  for (let size = 2; size <= n; size *= 2)
    for (let from = 0; from < n; from += size)
      for (let k = 0; k < size / 2; ++k) {
        const angle = -2 * Math.PI * k / size, c = Math.cos(angle), s = Math.sin(angle), a = from + k, b = a + size / 2;
        const x = re[b] * c - im[b] * s, y = re[b] * s + im[b] * c;
        [re[b], im[b]] = [re[a] - x, im[a] - y];
        [re[a], im[a]] = [re[a] + x, im[a] + y];
      }
}

/** The state for shape and colour, and in words. `daemon`: the event of that name, null before it; `silent_ms`: since the
 * last word of the daemon; `server`: whether the page is connected. */
export function stateOf({server, daemon, state, silent_ms}) {
  if (!server) return {state: 'lost', words: 'lost: tactograph live does not answer; if you start it again, open its new address'};
  if (daemon === null) return {state: 'lost', words: 'connecting'};
  if (!daemon.here) return {state: 'lost', words: 'lost: no daemon; trying again'};
  const runs = state === 'armed' || state === 'playing';
  if (runs && silent_ms > SILENT_MS) return {state: 'lost', words: 'lost: the daemon does not answer'};
  return {state, words: state === 'lost' ? 'lost: the device does not answer' : state};
}

/** `asked`: undefined if another client has set the gain. */
export function gainWords({forces, asked, effective, gain_m_per_n}) {
  if (forces) return 'a scene of forces has no gain';
  if (effective === undefined) return 'no gain: load a texture';
  const is = `${effective.toFixed(2)} (${(1e3 * gain_m_per_n).toFixed(3)} mm/N)`;
  return asked === undefined ? is : `asked ${asked.toFixed(2)}, effective ${is}`;
}

/** Where the finger is and what it gets; of a device with forces the hand, along its axes. */
export function placeWords(status, place_m) {
  const mm = (metres) => `${(1e3 * metres).toFixed(2)} mm`, fixed = (name) => (status[name] ?? 0).toFixed(2);
  if (status.x_m === undefined)
    return `finger at ${mm(place_m)}, ${(1e3 * (status.speed_mps ?? 0)).toFixed(0)} mm/s; drive ${fixed('drive_v')} V, RMS ${fixed('drive_rms_v')} V, peak ${fixed('drive_peak_v')} V`;
  const axes = ['x', 'y', 'z'].filter((axis) => status[`${axis}_m`] !== undefined);
  return `hand at ${axes.map((axis) => `${axis} ${mm(status[`${axis}_m`])}`).join(', ')}; force ` +
      `${axes.map((axis) => `${axis} ${fixed(`force_${axis}_n`)} N`).join(', ')}; peak ${fixed('force_peak_n')} N`;
}

export function contactWords(flags) {
  if (flags & FLAGS.gated) return 'no contact: the drive is held back';
  return flags & FLAGS.touching ? 'in contact' : 'not measured';
}

export function limitWords(status, flags) {
  const now = ['amplitude', 'slew', 'energy'].filter((name) => flags & FLAGS[name]);
  const words = [now.length > 0 ? `now: ${now.join(', ')}` : 'now: nothing'];
  if (status.limits_took !== undefined) words.push(status.limits_took);
  if (status.limits_took_last_second_db !== undefined) words.push(`last second ${status.limits_took_last_second_db.toFixed(1)} dB`);
  if (status.limits_took_db !== undefined) words.push(`since arming ${status.limits_took_db.toFixed(1)} dB`);
  return words.join('; ');
}

/** How late ticks of a loop on this computer were: [words, part of the ticks]; null for a device's own loop. */
export function lateRows(status) {
  if (status.late_over_10us_part === undefined) return null;
  const beyond = LATE_BOUNDS.map((bound) => status[`late_over_${bound}_part`]);
  const words = ['under 10 µs', '10 to 50 µs', '50 to 100 µs', '100 to 500 µs', '0.5 to 1 ms', 'over 1 ms'];
  return words.map((word, i) => [word, Math.max(0, (i === 0 ? 1 : beyond[i - 1]) - (beyond[i] ?? 0))]);
}

/** 1, 2 or 5 times a power of ten, not below `value`. */
export function roundUp(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return decade * [1, 2, 5, 10].find((factor) => factor * decade >= value * (1 - 1e-9));
}
