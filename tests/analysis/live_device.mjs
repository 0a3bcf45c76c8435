// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the page's own modules (beside this file) without a browser: the device under random programs of the finger.
// Arguments: core.wasm, upload, tray, seed, seconds, kind, output, and a JSON list of changes {frames (a file), note}.
// Kinds: "" writes the log of the wire; "fault" too, with a jump of the encoder at its end; "change" too, with changes of
// the texture, and OUTPUT.changes: a list of {at (the byte of the log), note}; "tone" and "velocity" write the sound
// (float32) of strokes at 50 and 100 mm/s, with the first change between them if there is one.
import {readFileSync, writeFileSync} from 'node:fs';
import {Core, METRES_PER_COUNT, RATE_HZ} from './core.js';
import {Engine} from './engine.js';
import {FOLLOWER_HZ, Finger} from './finger.js';
import {check, drawsOf} from './live_draws.mjs';

const [wasm, upload, tray, seed, seconds, kind, output, list] = process.argv.slice(2);
const module = new WebAssembly.Module(readFileSync(wasm));

const {random, between} = drawsOf(seed);

const changes = list ? JSON.parse(readFileSync(list, 'utf8')).map(({frames, note}) => (
  {what: 'change', upload: new Uint8Array(readFileSync(frames)), fade_s: 0.05, note})) : [];

const log = [], changed = [];
let seen = {};
const engine = new Engine(module, (report) => {
  seen = {...seen, ...report};
  if (report.log) log.push(report.log);
  if (report.what === 'changed' && report.accepted) changed.push({at: log.reduce((sum, part) => sum + part.length, 0), note: report.note});
});
const frames = new Uint8Array(readFileSync(upload)), taps = readFileSync(tray);
engine.obey({what: 'texture', upload: frames, tray: new Float32Array(taps.buffer, taps.byteOffset, taps.length / 4), full_m: 1e-5});
check(seen.accepted, 'the device accepts the upload');
// No sound until it is asked for.
engine.obey({what: 'play', gain_m_per_n: 1e-3});
engine.obey({what: 'stroke', velocity_mps: 0.1, from_m: 0, end_m: 0.03});
for (let ticks = 0; ticks < 0.2 * RATE_HZ; ticks += 64) {
  engine.advance(64);
  check(engine.sounds.subarray(0, 64).every((sample) => sample === 0), 'there is no sound before it is asked for');
}
check(seen.drivePeak_v > 0, 'the tray was driven without sound');
engine.obey({what: 'stop'});
for (let ticks = 0; ticks < RATE_HZ; ticks += 64) engine.advance(64);
engine.tell();
log.length = 0;  // as in the page: a session begins with its first command
engine.obey({what: 'sound', volume: 1, velocity: kind === 'velocity'});
if (kind === 'tone' || kind === 'velocity') {
  const sounds = [];
  for (let ticks = 0; ticks < RATE_HZ; ticks += 64) engine.advance(64);  // the volume rises
  engine.obey({what: 'play', gain_m_per_n: 1e-3});
  for (const velocity_mps of [0.05, 0.1]) {
    engine.obey({what: 'stroke', velocity_mps, from_m: 0, end_m: 0.035});
    for (let ticks = 0; ticks < 0.3 * RATE_HZ; ticks += 64) {
      engine.advance(64);
      sounds.push(...engine.sounds.subarray(0, 64));
    }
    if (changes.length > 0) engine.obey(changes[0]);
    for (let ticks = 0; ticks < 0.1 * RATE_HZ; ticks += 64) engine.advance(64);
  }
  writeFileSync(output, new Uint8Array(Float32Array.from(sounds).buffer));
  process.exit(0);
}

// A pointer of 125 Hz on pixels of 29 um, strokes, keys, lifts and levels, in random order.
const LENGTH_M = 0.03;
let time_s = 0, pointer = null, loudest = 0, driven = 0;
function advance(ticks) {
  engine.advance(ticks);
  for (let i = 0; i < ticks; ++i) {
    check(Number.isFinite(engine.sounds[i]), 'the sound is finite');
    loudest = Math.max(loudest, Math.abs(engine.sounds[i]));
  }
  driven = Math.max(driven, seen.drivePeak_v ?? 0);
  time_s += ticks / RATE_HZ;
}
function act() {
  if (kind === 'change') engine.obey(changes[Math.floor(random() * changes.length)]);
  const choice = Math.floor(random() * 7);
  if (choice !== 6) pointer = null;
  if (choice === 0) engine.obey({what: 'stroke', velocity_mps: between(0.02, 0.1), from_m: 0, end_m: LENGTH_M});
  if (choice === 1) engine.obey({what: 'stroke', velocity_mps: -between(0.02, 0.2), from_m: LENGTH_M, end_m: 0});
  if (choice === 2) engine.obey({what: 'land', place_m: between(0, LENGTH_M)});
  if (choice === 2) engine.obey({what: 'move', velocity_mps: between(-0.1, 0.1), end_m: between(0, LENGTH_M)});
  if (choice === 3) engine.obey({what: 'lift'});
  if (choice === 4) engine.obey({what: 'gain', gain_m_per_n: between(-1e-3, 1e-3)});
  if (choice >= 5) pointer = {centre_m: between(0.01, 0.02), hz: between(0.5, 2), next_s: time_s, down: false};
}
function report() {
  if (pointer === null || time_s < pointer.next_s) return;
  const place_m = Math.round((pointer.centre_m + 0.008 * Math.sin(2 * Math.PI * pointer.hz * time_s)) / 29e-6) * 29e-6;
  engine.obey(pointer.down ? {what: 'reports', reports: [{time_s, place_m}]} : {what: 'down', time_s, place_m});
  pointer.down = true;
  pointer.next_s = time_s + 0.008;
}

engine.obey({what: 'play', gain_m_per_n: 1e-3});
let next_s = 0;
for (const end_s = Number(seconds); time_s < end_s;) {
  if (time_s >= next_s) {
    act();
    next_s = time_s + between(0.05, 0.5);
  }
  report();
  advance(Math.floor(between(1, 64)));
  check(seen.state !== 'fault', 'no movement of the finger is a jump of the encoder');
}
check(driven > 0, 'the tray was driven');
check(loudest > 0 && loudest <= 0.7001, 'the sound is limited');
if (kind === 'fault') {
  engine.obey({what: 'land', place_m: 0.001});
  for (let i = 0; i < 100; ++i) advance(64);
  engine.finger.place_m = 0.02;  // a finger that jumps without lifting
  for (let i = 0; i < 20; ++i) advance(64);
  check(seen.state === 'fault' && seen.fault === 3, 'a jump of the encoder is a fault');
}
engine.obey({what: 'stop'});
for (let i = 0; i < 20; ++i) advance(64);
check(seen.state === 'idle', 'stop makes the device idle');
engine.tell();
check(engine.core.takeLog().length === 0, 'everything is in the log');

// The finger follows a hand: its place is that of the hand some milliseconds earlier.
{
  const hand = (t) => 0.02 + 0.012 * Math.sin(2 * Math.PI * 0.8 * t) + 0.001 * Math.sin(2 * Math.PI * 2.3 * t + 1);
  const finger = new Finger(), places = [], waiting = [];
  const reported = (t) => Math.round(hand(t) / 29e-6) * 29e-6;
  finger.down(0, reported(0));
  for (let i = 0, next = 0.008; i < 6 * RATE_HZ; ++i) {
    if (next <= i / RATE_HZ) {
      waiting.push({time_s: next, due_s: next + between(0.002, 0.008)});
      next += 0.008;
    }
    if (waiting.length > 0 && waiting[0].due_s <= i / RATE_HZ) finger.report(waiting[0].time_s, reported(waiting.shift().time_s));
    finger.tick();
    places.push(finger.place_m);
  }
  const rms = (late) => Math.sqrt(places.slice(RATE_HZ).reduce((sum, x, i) => sum + (x - hand(1 + (i - late) / RATE_HZ)) ** 2, 0) / (5 * RATE_HZ));
  let best = {error_m: 1, late_s: 0};
  for (let late = 0; late < 0.06 * RATE_HZ; late += 8) if (rms(late) < best.error_m) best = {error_m: rms(late), late_s: late / RATE_HZ};
  // The lag of the reports, that of the follower (2 / omega = 8 ms), and two of their periods.
  check(best.late_s < 2 * 0.008 + 2 / (2 * Math.PI * FOLLOWER_HZ) + 0.008, `${best.late_s} s late`);
  console.error(`a pointer's finger: ${(1e6 * best.error_m).toFixed(1)} um, ${(1e3 * best.late_s).toFixed(1)} ms late`);
  check(best.error_m < 25e-6, 'the error is below 25 um: less than a pixel of 29 um');
  check(Math.abs(METRES_PER_COUNT - 1e-6) < 1e-15 && new Core(module).state === 'idle', 'a new device is idle');
}

check(kind !== 'change' || changed.length > 5, 'the texture has changed several times');
writeFileSync(output, Buffer.concat(log));
writeFileSync(`${output}.changes`, JSON.stringify(changed));
