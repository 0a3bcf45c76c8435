// SPDX-License-Identifier: GPL-3.0-or-later
// The device: firmware-host/core as WebAssembly (playback/wasm/browser.cpp).

export const RATE_HZ = 16000;
export const METRES_PER_COUNT = 1e-6;
const STEERING = {arm: 0, play: 1, stop: 2, disarm: 3, gain: 4, change: 5};
export const STATES = ['idle', 'armed', 'playing', 'fault'];

export class Core {
  /** A tray, or a force device.
   * @param {WebAssembly.Module} module
   * @param {{frame: Uint8Array, count: number, rate_hz: number}} [axes] a frame of the wire with its axes */
  constructor(module, axes) {
    this.device = new WebAssembly.Instance(module, {}).exports;
    const memory = this.device.memory.buffer;  // it does not grow
    this.input = new Uint8Array(memory, this.device.input(), this.device.input_size());
    if (axes) this.input.set(axes.frame);
    if (!this.device.begin(axes ? axes.frame.length : 0, axes ? axes.rate_hz : RATE_HZ)) throw new Error('the device in this page refused its axes');
    // Of a force device: those of all axes for each tick; the drives are forces in N.
    const values = this.device.block_ticks() * (axes ? axes.count : 1);
    this.counts = new Int32Array(memory, this.device.counts(), values);
    this.drives = new Float32Array(memory, this.device.drives(), values);
    this.memory = memory;
  }

  /** Gives whole frames of the wire to the device; false if it refuses one.
   * @param {Uint8Array} frames */
  upload(frames) {
    for (let at = 0; at < frames.length;) {
      const used = this.uploadPart(frames, at);
      if (used === 0) return false;
      at += used;
    }
    return true;
  }

  /** The same for the first whole frames from `at` on, of `most` bytes together; returns their bytes, 0 if one is refused.
   * @param {Uint8Array} frames */
  uploadPart(frames, at, most = this.input.length) {
    const part = frames.subarray(at, at + most);
    this.input.set(part);
    return this.device.upload(part.length);
  }

  /** False if the device refuses it.
   * @param {'arm'|'play'|'stop'|'disarm'|'gain'|'change'} what
   * @param {number} [value] of gain: m/N; of change: seconds of the fade */
  steer(what, value = 0) {
    return this.device.steer(STEERING[what], value) !== 0;
  }

  /** Sets a number of the scene that plays; it changes over `ramp_s`. False if the device refuses it. */
  set({layer, number}, value, ramp_s) { return this.device.set(layer, number, value, ramp_s) !== 0; }
  /** That number as it is in effect. */
  number({layer, number}) { return this.device.number(layer, number); }
  /** The ghost's place, m. */
  ghost() { return [0, 1, 2].map((along) => this.device.ghost(along)); }

  /** Ticks at the first `ticks` counts; then `drives` has the drive of each, in volts. */
  run(ticks, touches) {
    this.device.touch(touches);
    this.device.run(ticks);
  }

  /** What the device accepted and sent since the last call: a copy of whole frames. */
  takeLog() {
    const size = this.device.take_log();
    return new Uint8Array(this.memory, this.device.log(), size).slice();
  }

  takeFlags() { return this.device.take_flags() >>> 0; }
  get state() { return STATES[this.device.state()]; }
  get fault() { return this.device.fault(); }
  get faultDetail() { return this.device.fault_detail() >>> 0; }
}
