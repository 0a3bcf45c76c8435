// SPDX-License-Identifier: GPL-3.0-or-later
// The engine in the audio thread: one tick for every third of 48,000 samples a second.

import {Engine} from './engine.js';

const SAMPLES_PER_TICK = 3;

class EngineProcessor extends AudioWorkletProcessor {
  constructor(options) {
    super();
    this.engine = new Engine(options.processorOptions.module, (report) => this.port.postMessage(report));
    this.port.onmessage = (event) => this.engine.obey(event.data);
    this.phase = 0;
    this.before = this.next = 0;
  }

  process(inputs, outputs) {
    const out = outputs[0][0];
    let tick = 0;
    this.engine.advance(Math.floor((this.phase + out.length) / SAMPLES_PER_TICK));
    for (let i = 0; i < out.length; ++i) {
      if (++this.phase === SAMPLES_PER_TICK) {
        this.phase = 0;
        this.before = this.next;
        this.next = this.engine.sounds[tick++];
      }
      out[i] = this.before + (this.next - this.before) * this.phase / SAMPLES_PER_TICK;
    }
    return true;
  }
}

registerProcessor('engine', EngineProcessor);
