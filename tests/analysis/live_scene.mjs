// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the page's own modules (beside this file) without a browser: a force device under random programs of the hand.
// Arguments: core.wasm, the answer to /scene/N, the bytes of /scene-upload/M, seed, seconds, a JSON list of places (m, or null)
// to which the hand goes in the end, output (the log of the wire). It prints JSON: what the hand met last ({place_m, force_n,
// ghost_m, values}), the largest force and the time of a tick in us.
import {readFileSync, writeFileSync} from 'node:fs';
import {Hand} from './hand.js';
import {check, drawsOf} from './live_draws.mjs';

const [wasm, about, upload, seed, seconds, targets, output] = process.argv.slice(2);
const scene = JSON.parse(readFileSync(about, 'utf8')), bytes = new Uint8Array(readFileSync(upload));
const module = new WebAssembly.Module(readFileSync(wasm));

const {random, between} = drawsOf(seed);

const log = [];
let seen = {}, pushed_n = 0;
const hand = new Hand(module, scene, bytes, (report) => {
  seen = {...seen, ...report};
  if (!report.log) return;
  log.push(report.log);
  report.force_n.forEach((force) => check(Number.isFinite(force), 'the force is finite'));
  pushed_n = Math.max(pushed_n, Math.hypot(...report.force_n));
});

let time_s = 0;
function advance(ticks) {
  hand.advance(ticks);
  time_s += ticks / scene.rate_hz;
  check(hand.core.state !== 'fault', 'no movement of the hand is a jump of an encoder');
  hand.fingers.forEach(({place_m}, i) => check(place_m >= scene.axes[i].from_m - 1e-3 && place_m <= scene.axes[i].to_m + 1e-3, 'the hand is in the travel'));
}

// Pointers of 125 Hz, also beyond the travel; keys along one axis; sliders; a stop and a new beginning.
let pointer = null;
const somewhere = () => scene.axes.map(({from_m, to_m}) => between(1.1 * from_m, 1.1 * to_m));
function act() {
  const choice = Math.floor(random() * 5), axis = Math.floor(random() * scene.axes.length);
  if (choice < 2) hand.rest();
  pointer = null;
  if (choice === 0) hand.move(axis, between(-0.1, 0.1) || 0.05);
  if (choice >= 2) {
    pointer = {section: scene.sections[Math.floor(random() * scene.sections.length)], next_s: time_s, at_m: somewhere(), to_m: somewhere(), down: false};
  }
  for (const slider of scene.sliders) if (random() < 0.5) hand.set(slider, between(slider.from, slider.to));
}
function report() {
  if (pointer === null || time_s < pointer.next_s) return;
  pointer.at_m = pointer.at_m.map((place, i) => place + 0.02 * (pointer.to_m[i] - place));
  if (pointer.down) hand.moved(pointer.section, time_s, pointer.at_m);
  else hand.down(pointer.section, time_s, pointer.at_m);
  pointer.down = true;
  pointer.next_s = time_s + 0.008;
}
function goTo(places_m) {
  pointer = null;
  hand.rest();
  places_m.forEach((place_m, axis) => {
    if (place_m === null) return;
    hand.move(axis, Math.sign(place_m - hand.fingers[axis].place_m) * 0.1, place_m);
    while (hand.fingers[axis].velocity_mps !== 0) advance(16);
  });
  for (let ticks = 0; ticks < scene.rate_hz; ticks += 32) advance(32);  // speeds are measured as zero then
}

hand.play();
let next_s = 0;
for (const end_s = Number(seconds); time_s < end_s;) {
  if (time_s >= next_s) {
    act();
    next_s = time_s + between(0.05, 0.5);
  }
  report();
  advance(1 + Math.floor(random() * 40));
}
check(pushed_n > 0.05, 'the scene pushed the hand');
// The numbers of the file again, then from place to place, to that of a closed form.
for (const slider of scene.sliders) hand.set(slider, slider.value);
for (const places_m of JSON.parse(targets)) goTo(places_m);
const from_ms = performance.now();
advance(5 * scene.rate_hz);
const tick_us = 1e3 * (performance.now() - from_ms) / (5 * scene.rate_hz);
hand.tell();
const {place_m, force_n, ghost_m, values} = seen;
hand.stop();
for (let i = 0; i < 1000 && hand.core.state !== 'idle'; ++i) advance(32);
check(hand.core.state === 'idle' && seen.force_n.every((force) => force === 0 || seen.state !== 'idle'), 'stop makes the device idle');
hand.tell();
writeFileSync(output, Buffer.concat(log));
console.log(JSON.stringify({place_m, force_n, ghost_m, values, pushed_n, tick_us}));
