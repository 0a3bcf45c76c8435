// SPDX-License-Identifier: GPL-3.0-or-later
// The hand on a force device, and the device, tick by tick. The hand has no mass and the force does not push it: it is
// where pointer or keys bring it.

import {Core} from './core.js';
import {Finger} from './finger.js';

const BLOCK = 32;         // ticks between two signs of life for the device's watchdog
const REPORT_S = 0.016;
const TIMER_MS = 10;
const MOST_BEHIND_S = 0.25;  // a page in the background does not catch up

/** The first frame of what the server uploads: the axes. */
export function splitUpload(bytes) {
  const size = 12 + new DataView(bytes.buffer, bytes.byteOffset).getUint16(4, true) + 4;  // WIRE.md: header, payload, check
  return {axes: bytes.subarray(0, size), frames: bytes.subarray(size)};
}

export class Hand {
  /** `scene`: the figures of /scene/N; `upload`: the bytes of /scene-upload/M.
   * @param {WebAssembly.Module} module
   * @param {(report: object) => void} report */
  constructor(module, scene, upload, report) {
    const {axes, frames} = splitUpload(upload);
    this.scene = scene;
    this.report = report;
    this.core = new Core(module, {frame: axes, count: scene.axes.length, rate_hz: scene.rate_hz});
    if (!this.core.upload(frames)) throw new Error('the device in this page refused the scene');
    this.fingers = scene.axes.map(() => new Finger(scene.rate_hz));
    this.fingers.forEach((finger, i) => finger.land(scene.axes[i].start_m));
    this.fingers.forEach((finger) => finger.rest());
    this.force_n = scene.axes.map(() => 0);
    this.asked = new Map();    // values of sliders
    this.waiting = new Set();  // sliders whose values the device does not have yet
    this.ticks = 0;
    this.advance(BLOCK);  // the device knows where the hand is before it is armed
  }

  play() {
    const ok = this.core.state === 'idle' && this.core.steer('arm') && this.core.steer('play');
    if (!ok) this.report({what: 'refused'});
    this.waiting = new Set(this.asked.keys());  // the scene begins with the numbers of its file
  }

  /** The force falls, then the device is idle. */
  stop() {
    this.rest();
    if (this.core.state !== 'idle') this.core.steer('disarm');
  }

  rest() { for (const finger of this.fingers) finger.rest(); }

  /** The pointer touches: `place_m` along the axes of `section`. Reports follow. */
  down(section, time_s, place_m) { this.along(section, (finger, i) => finger.approach(time_s, this.within(i, place_m[i]))); }
  /** A report of the pointer. */
  moved(section, time_s, place_m) { this.along(section, (finger, i) => finger.report(time_s, this.within(i, place_m[i]))); }
  along(section, act) {
    for (const i of [section.right, section.up]) act(this.fingers[i], i);
  }

  /** Along one axis at an exact speed, to a place or to the end of the travel. */
  move(axis, velocity_mps, end_m = velocity_mps > 0 ? this.scene.axes[axis].to_m : this.scene.axes[axis].from_m) {
    this.fingers[axis].move(velocity_mps, end_m, false);
  }

  /** A slider: at once while the scene plays, else from its next beginning on. */
  set(slider, value) {
    this.asked.set(slider, value);
    this.waiting.add(slider);
  }

  // The device refuses a number while it has others to take: then the newest value follows.
  setNumbers() {
    if (this.waiting.size === 0 || !['armed', 'playing'].includes(this.core.state)) return;
    for (const slider of this.waiting) {
      if (!this.core.set(slider, this.asked.get(slider), this.scene.ramp_s)) return;
      this.waiting.delete(slider);
    }
  }

  within(axis, place_m) {
    const {from_m, to_m} = this.scene.axes[axis];
    return Math.max(from_m, Math.min(to_m, place_m));
  }

  advance(ticks) {
    for (let done = 0; done < ticks;) {
      const block = Math.min(BLOCK, ticks - done);
      this.run(block);
      done += block;
      this.ticks += block;
      if (this.ticks >= REPORT_S * this.scene.rate_hz) this.tell();
    }
  }

  run(block) {
    const {core, fingers, scene} = this, width = fingers.length;
    this.setNumbers();
    for (let i = 0; i < block; ++i)
      for (let k = 0; k < width; ++k) {
        fingers[k].tick();
        core.counts[i * width + k] = Math.round(fingers[k].place_m / scene.axes[k].encoder_step_m);
      }
    core.run(block, true);
    this.force_n = Array.from(core.drives.subarray((block - 1) * width, block * width));
  }

  tell() {
    const {core, fingers, scene} = this, acts = core.state !== 'idle';
    this.report({
      what: 'ticks', log: core.takeLog(), state: core.state, fault: core.fault, flags: core.takeFlags(), force_n: this.force_n,
      place_m: fingers.map((finger) => finger.place_m), speed_mps: Math.hypot(...fingers.map((finger) => finger.speed_mps)),
      moves: fingers.some((finger) => finger.mode === 'pointer' || finger.velocity_mps !== 0),
      ghost_m: acts && scene.ghost ? core.ghost() : null,
      values: acts ? scene.sliders.map((slider) => core.number(slider)) : null,
    });
    this.ticks = 0;
  }
}

/** Runs a hand by the page's clock until the returned function is called. */
export function runHand(hand) {
  let done_s = performance.now() / 1000;
  const timer = setInterval(() => {
    const now_s = performance.now() / 1000;
    done_s = Math.max(done_s, now_s - MOST_BEHIND_S);
    const ticks = Math.floor((now_s - done_s) * hand.scene.rate_hz);
    hand.advance(ticks);
    done_s += ticks / hand.scene.rate_hz;
  }, TIMER_MS);
  return () => clearInterval(timer);
}
