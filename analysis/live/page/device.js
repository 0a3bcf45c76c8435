// SPDX-License-Identifier: GPL-3.0-or-later
// Where the engine runs: in the audio thread, or, without AudioWorklet or sound device, on a timer of the page.

import {Engine} from './engine.js';
import {RATE_HZ} from './core.js';

const SAMPLE_RATE_HZ = 48000;
const STARTS_WITHIN_MS = 2000;
const TIMER_MS = 10;
const MOST_BEHIND_S = 0.25;  // a page in the background does not catch up

async function audioDevice(module, report) {
  const audio = new AudioContext({sampleRate: SAMPLE_RATE_HZ, latencyHint: 'interactive'});
  const late = new Promise((_, fail) => setTimeout(() => fail(new Error('the sound device does not start')), STARTS_WITHIN_MS));
  await Promise.race([Promise.all([audio.resume(), audio.audioWorklet.addModule('worklet.js')]), late]);
  const node = new AudioWorkletNode(audio, 'engine', {numberOfInputs: 0, outputChannelCount: [1], processorOptions: {module}});
  node.connect(audio.destination);
  node.port.onmessage = (event) => report(event.data);
  return {sounds: true, send: (message) => node.port.postMessage(message)};
}

function timerDevice(module, report) {
  const engine = new Engine(module, report);
  let done_s = performance.now() / 1000;
  setInterval(() => {
    const now_s = performance.now() / 1000;
    done_s = Math.max(done_s, now_s - MOST_BEHIND_S);
    for (let ticks = Math.floor((now_s - done_s) * RATE_HZ); ticks > 0;) {
      const part = Math.min(ticks, engine.sounds.length);
      engine.advance(part);
      ticks -= part;
      done_s += part / RATE_HZ;
    }
  }, TIMER_MS);
  return {sounds: false, send: (message) => engine.obey(message)};
}

/** Call it after a click or key: before, browsers start no sound. Returns {sounds, why, send(message)}. */
export async function startDevice(module, report) {
  try {
    return await audioDevice(module, report);
  } catch (error) {
    return Object.assign(timerDevice(module, report), {why: String(error.message ?? error)});
  }
}
