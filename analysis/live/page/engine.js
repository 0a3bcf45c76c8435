// SPDX-License-Identifier: GPL-3.0-or-later
// Finger, device and modelled tray, tick by tick. It runs in the AudioWorklet, or in the page where there is none.

import {Core, METRES_PER_COUNT, RATE_HZ} from './core.js';
import {Finger} from './finger.js';

const BLOCK = 32;                  // ticks: the finger touches or not for a whole block
const REPORT_TICKS = 256;          // a report every 16 ms
const CELL_TICKS = 32;             // of the trace: one column for 2 ms
const PART = 32768;                // bytes of the next texture's frames for each block
const LOUDEST = 0.7;               // of full scale
const RELEASE = Math.exp(-1 / (0.2 * RATE_HZ));

// A second-order Butterworth section by the bilinear transform (Audio EQ Cookbook, R. Bristow-Johnson).
class Section {
  constructor(kind, hz) {
    const w = 2 * Math.PI * hz / RATE_HZ, cos = Math.cos(w), alpha = Math.sin(w) * Math.SQRT1_2;
    const sign = kind === 'high' ? 1 : -1;
    const b1 = kind === 'high' ? -(1 + cos) : 1 - cos;
    this.b0 = (1 + sign * cos) / 2 / (1 + alpha);
    this.b1 = b1 / (1 + alpha);
    this.a1 = -2 * cos / (1 + alpha);
    this.a2 = (1 - alpha) / (1 + alpha);
    this.s1 = this.s2 = 0;
  }
  filter(x) {
    const y = this.b0 * x + this.s1;
    this.s1 = this.b1 * x - this.a1 * y + this.s2;
    this.s2 = this.b0 * x - this.a2 * y;
    return y;
  }
}

// The displacement of the tray: the drive through the transducer's impulse response.
class Tray {
  constructor(taps) {
    this.taps = taps;
    this.past = new Float32Array(2 * taps.length);
    this.at = 0;
  }
  displacement(drive_v) {
    const n = this.taps.length, past = this.past;
    this.at = this.at === 0 ? n - 1 : this.at - 1;
    past[this.at] = past[this.at + n] = drive_v;
    let sum = 0;
    for (let i = 0; i < n; ++i) sum += this.taps[i] * past[this.at + i];
    return sum;
  }
}

// Displacement, 15 to 500 Hz, or its velocity (x f / 200 Hz, for small speakers), limited to LOUDEST.
class Sound {
  constructor(full_m) {
    this.full_m = full_m;
    this.high = new Section('high', 15);
    this.low = new Section('low', 500);
    this.before = 0;
    this.peak = LOUDEST;
    this.velocity = false;
    this.volume = 0;
    this.fading = 0;
  }
  sample(displacement_m) {
    const moved = this.low.filter(this.high.filter(displacement_m / this.full_m));
    const speed = (moved - this.before) * RATE_HZ / (2 * Math.PI * 200);
    this.before = moved;
    this.fading += (this.volume - this.fading) * 0.002;
    const value = this.fading * (this.velocity ? speed : moved);
    this.peak = Math.max(LOUDEST, Math.abs(value), LOUDEST + (this.peak - LOUDEST) * RELEASE);
    return value * LOUDEST / this.peak;
  }
}

export class Engine {
  /** @param {WebAssembly.Module} module
   *  @param {(report: object) => void} report */
  constructor(module, report) {
    this.core = new Core(module);
    this.finger = new Finger();
    this.report = report;
    this.tray = new Tray(new Float32Array(1));
    this.sound = new Sound(1);
    this.sounds = new Float32Array(this.core.counts.length);
    this.count = 0;
    this.forgetChanges();
    this.clear();
  }

  forgetChanges() {
    this.coming = this.next = null;  // changes of the texture: of which parts are uploaded, and the one after it
    this.fading = 0;                 // ticks
  }

  clear() {
    this.ticks = 0;
    this.drivePeak_v = 0;
    this.cell = {least: 0, most: 0, ticks: 0};
    this.cells = [];
  }

  /** Messages of the page. */
  obey(message) {
    const finger = this.finger;
    switch (message.what) {
      case 'texture': return this.load(message);
      case 'play': return this.play(message.gain_m_per_n);
      case 'stop': return this.stop();
      case 'change': this.next = message; break;
      case 'gain': this.core.steer('gain', message.gain_m_per_n); break;
      case 'sound': this.sound.volume = message.volume; this.sound.velocity = message.velocity; break;
      case 'down': finger.down(message.time_s, message.place_m); break;
      case 'reports': for (const r of message.reports) finger.report(r.time_s, r.place_m); break;
      case 'move': finger.move(message.velocity_mps, message.end_m, false); break;
      case 'stroke': finger.stroke(message.velocity_mps, message.from_m, message.end_m); break;
      case 'land': finger.land(message.place_m); finger.rest(); break;
      case 'rest': finger.rest(); break;
      case 'lift': finger.lift(); break;
    }
  }

  load({upload, tray, full_m}) {
    this.tray = new Tray(tray);
    const {velocity, volume} = this.sound;
    this.sound = Object.assign(new Sound(full_m), {velocity, volume});
    this.finger = new Finger();
    this.forgetChanges();
    this.loaded = this.core.upload(upload);
    this.clear();
    this.report({what: 'loaded', accepted: this.loaded});
  }

  play(gain_m_per_n) {
    const ok = this.core.state === 'idle' && this.core.steer('gain', gain_m_per_n) && this.core.steer('arm') &&
               this.core.steer('play');
    if (!ok) this.report({what: 'refused'});
  }

  // The drive falls, then the device is idle.
  stop() {
    this.forgetChanges();
    this.finger.lift();
    if (this.core.state !== 'idle') this.core.steer('disarm');
  }

  /** Runs `ticks`, at most sounds.length; then `sounds` has a sample of the sound for each. */
  advance(ticks) {
    for (let done = 0; done < ticks;) {
      const block = Math.min(BLOCK, ticks - done);
      this.change(block);
      this.runBlock(block, done);
      done += block;
      this.ticks += block;
      if (this.ticks >= REPORT_TICKS) this.tell();
    }
  }

  // Changes the texture while it plays: its frames part by part, so that no block of sound waits for them, then the fade.
  // The log up to there is sent before the report, the change itself after it.
  change(block) {
    this.fading = Math.max(0, this.fading - block);
    if (this.coming === null && this.next !== null && this.fading === 0) [this.coming, this.next] = [{...this.next, at: 0}, null];
    const coming = this.coming;
    if (coming === null) return;
    const used = ['armed', 'playing'].includes(this.core.state) ? this.core.uploadPart(coming.upload, coming.at, PART) : 0;
    coming.at += used;
    if (used > 0 && coming.at < coming.upload.length) return;
    this.coming = null;
    this.tell();
    const accepted = used > 0 && this.core.steer('change', coming.fade_s);
    if (accepted) this.fading = Math.ceil(coming.fade_s * RATE_HZ) + 2 * BLOCK;
    this.report({what: 'changed', accepted, note: coming.note});
  }

  runBlock(block, at) {
    const {core, finger} = this;
    // At its beginning: a finger that lifts in it does so at its end. One that lands has been away for a block:
    // without it, its new place would be a jump of the encoder.
    const touches = finger.touches && !finger.lands;
    finger.lands = false;
    for (let i = 0; i < block; ++i) {
      finger.tick();
      if (touches) this.count = Math.round(finger.place_m / METRES_PER_COUNT);
      core.counts[i] = this.count;
    }
    core.run(block, touches);
    for (let i = 0; i < block; ++i) {
      const drive_v = core.drives[i], moved_m = this.tray.displacement(drive_v);
      this.drivePeak_v = Math.max(this.drivePeak_v, Math.abs(drive_v));
      this.sounds[at + i] = this.sound.sample(moved_m);
      this.trace(moved_m);
    }
  }

  trace(moved_m) {
    const cell = this.cell;
    cell.least = cell.ticks === 0 ? moved_m : Math.min(cell.least, moved_m);
    cell.most = cell.ticks === 0 ? moved_m : Math.max(cell.most, moved_m);
    if (++cell.ticks < CELL_TICKS) return;
    this.cells.push(cell.least, cell.most);
    cell.ticks = 0;
  }

  tell() {
    const {core, finger} = this;
    this.report({
      what: 'ticks', log: core.takeLog(), state: core.state, fault: core.fault, faultDetail: core.faultDetail,
      flags: core.takeFlags(), place_m: finger.place_m, speed_mps: finger.speed_mps, touches: finger.touches,
      moves: finger.mode === 'pointer' || finger.velocity_mps !== 0, drivePeak_v: this.drivePeak_v, cells: this.cells,
    });
    this.ticks = 0;
    this.drivePeak_v = 0;
    this.cells = [];
  }
}
