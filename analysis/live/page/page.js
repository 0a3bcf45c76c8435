// SPDX-License-Identifier: GPL-3.0-or-later
// The page: chooses a texture, moves the finger, shows what the device does, keeps sessions.

import {get} from './answers.js';
import {compareWords, fullScale, gainsOf, largestLevel} from './compare.js';
import {startDevice} from './device.js';
import {IDLE_S, KeptSession, LONGEST_S} from './kept_session.js';
import {Library} from './library.js';
import {Shape} from './shape.js';
import {drawFinger, drawMap, Trace} from './strip.js';

const MOST_LEVEL = 4;
const FADE_S = 0.05;            // from A to B and back
const LIMITS = [[8, 'amplitude'], [16, 'slew'], [64, 'energy']];  // flags of ticks (WIRE.md)
const CALM_MS = 250;            // between figures; with prefers-reduced-motion also between pictures

const at = (id) => document.getElementById(id);
const strip = at('strip'), level = at('level'), scale = at('scale'), start = at('start');
const trace = new Trace(at('trace'));
const calm = matchMedia('(prefers-reduced-motion: reduce)');

const compiled = WebAssembly.compileStreaming(get('core.wasm'));
let device = null, starting = null;
let sides = {A: null, B: null}, heard = 'A';  // textures (load), and the one that is heard
let chosen = null;              // the side that is heard, once the device has it
let gains = {A: 0, B: 0};       // m/N, at level 1
let base = {made: 0, gain_m_per_n: 0};  // what the device got at rest
let stale = false;              // the device has another side now: it gets the one that is heard before it plays again
const brought = new Map();      // frames of changes, by path: promises
let last = {state: 'idle', touches: false, place_m: 0, speed_mps: 0};  // the last report
let fitted = true;              // the strip shows the whole texture
let playing = false;            // asked for
let began_ms = 0, moved_ms = 0, mapDrawn = false, drawn_ms = 0, worded_ms = 0;
let waiting = [];               // for the device: {when, done}

// Words.
function say(text) { at('message').textContent = text; }
const mm = (metres, digits = 2) => `${(1e3 * metres).toFixed(digits)} mm`;

function showState() {
  const state = last.state === 'fault' ? 'fault' : playing ? 'playing' : 'stopped';
  at('state').dataset.state = state;
  const words = {playing: last.touches ? 'playing' : 'playing, finger lifted', fault: 'fault',
                 stopped: last.state === 'idle' ? 'stopped' : 'stopping'};
  const text = chosen === null ? 'no texture' : words[state] + (device?.sounds === false ? ', no sound device' : '');
  if (at('state-word').textContent !== text) at('state-word').textContent = text;
  at('keep').disabled = session.state !== 'open';
}

// Server.
const session = new KeptSession('/session', at('kept'), (text) => say(`${text} Press Stop, then touch again.`), showState);

// Textures.
const library = new Library({
  list: at('textures'), recordings: at('recordings'), search: at('search'), order: at('order'), count: at('count'), colours: at('colours'), get,
  choose: (row) => choose('A', row).catch((error) => say(error.message)),
  chooseB: (row) => choose('B', row).catch((error) => say(error.message)),
});
const shape = new Shape(at('shape'), reshape);
let filter = '';                // of the transducer, of both sides

async function load(index) {
  const figures = await (await get(`texture/${index}${filter === '' ? '' : `?inverse=${filter}`}`)).json();
  const parts = ['map', 'tray', 'upload'].map(async (part) => (await get(`${part}/${figures.made}`)).arrayBuffer());
  const [map, tray, upload] = await Promise.all(parts);
  return {figures, map: new Float32Array(map), tray: new Float32Array(tray), upload: new Uint8Array(upload)};
}

let choices = 0;
/** `name`: the side that it will be; the texture that is B already is taken away. */
async function choose(name, row) {
  const mine = ++choices, side = sides.A === null ? 'A' : name;
  const loading = side === 'B' && row.index === library.chosen.B ? null : load(row.index);
  loading?.catch(() => {});  // it is awaited below
  say('');
  stop();
  chosen = null;
  session.state = 'none';
  try {
    starting ??= compiled.then((module) => startDevice(module, report));
    device = await starting;
    sound();
    await until(() => last.state === 'idle');
    const loaded = await loading;
    if (mine !== choices) return;  // another texture has been chosen since
    sides = {...sides, [side]: loaded};
    heard = 'A';
    brought.clear();
    library.mark({...library.chosen, [side]: loaded && row.index});
    if (side === 'A' && row.name !== undefined) shape.of(row.index);
    last.what = '';
    loadHeard();
    await until(() => last.what === 'loaded');
    if (!last.accepted) throw new Error('the device in this page refused the texture; load the page again');
  } finally {
    if (mine === choices) chosen = sides[heard];
    showState();
  }
  showTexture();
}

// Gives the resting device the side that is heard.
function loadHeard() {
  gains = gainsOf(sides, at('equal').checked);
  const {figures, upload, tray} = sides[heard];
  base = {made: figures.made, gain_m_per_n: gains[heard]};
  stale = false;
  device.send({what: 'texture', upload, tray, full_m: fullScale(sides, gains)});
}

// The frames that change the playing device to a side, with what the server needs to know of it.
function broughtFor(name) {
  const note = {made: sides[name].figures.made, playing: base.made, times: gains[name] / base.gain_m_per_n};
  const path = `change/${note.made}/${note.playing}/${note.times}`;
  if (!brought.has(path)) brought.set(path, get(path).then((answer) => answer.arrayBuffer()).then((bytes) => new Uint8Array(bytes)));
  return brought.get(path).then((upload) => ({what: 'change', upload, fade_s: FADE_S, note}));
}

/** Hear this side: at once with a cross-fade while it plays, else from the next touch on. */
async function hearSide(name) {
  if (sides[name] === null || chosen === null) return;
  heard = name;
  chosen = sides[name];
  stale = true;
  showSides();
  if (!playing) return;
  const message = await broughtFor(name).catch((error) => say(error.message));
  if (message && playing && heard === name) device.send(message);
}

/** Another texture as A: at once with a cross-fade while it plays. */
async function reshape(index) {
  if (filter !== shape.filter) {  // it can't be faded: the device stops and begins with one texture
    filter = shape.filter;
    sides = {A: null, B: null};
    library.mark({...library.chosen, B: null});
  }
  if (sides.A === null || chosen === null) return choose('A', {index});
  const mine = choices, loaded = await load(index), before = {sides, gains};
  if (mine !== choices) return;  // another texture has been chosen since
  sides = {...sides, A: loaded};
  gains = gainsOf(sides, at('equal').checked);
  try {
    if (playing) await broughtFor('A');
  } catch (error) {
    if (mine === choices) ({sides, gains} = before);
    throw error;
  }
  for (const path of [...brought.keys()]) if (path.startsWith(`change/${before.sides.A.figures.made}/`)) brought.delete(path);
  await hearSide('A');
  setLevel();
}

function showTexture() {
  if (chosen === null) return;
  level.max = largestLevel(sides, gains, MOST_LEVEL);
  level.value = Math.min(1, level.max);
  trace.clear(1.2 * fullScale(sides, gains));
  fitted = true;
  last = {...last, place_m: chosen.figures.start_m};
  showSides();
  showView();
  showState();
}

function showSides() {
  const {figures} = chosen, equal = at('equal').checked, most = largestLevel(sides, gains, MOST_LEVEL);
  at('strip-title').textContent = figures.name;
  at('notes').replaceChildren(...[`Transducer: ${figures.transducer}.`, ...figures.notes ?? []].map((text) =>
    Object.assign(document.createElement('li'), {textContent: text})));
  level.max = most;
  at('level-hint').textContent = `Displacement for force: ${(1e3 * gains[heard]).toFixed(3)} mm/N at level 1. Largest level: ${most}` +
    (most < MOST_LEVEL ? `; above it the tray could move more than its ${(1e6 * figures.displacement_limit_m).toFixed(0)} µm.` : '.');
  for (const name of ['A', 'B']) {
    at(`side-${name}`).disabled = sides[name] === null;
    at(`side-${name}`).setAttribute('aria-pressed', String(name === heard));
    at(`side-${name}`).lastChild.textContent = ` ${sides[name]?.figures.name ?? 'none'}`;
  }
  at('equal').disabled = sides.B === null;
  at('compare-words').textContent = compareWords(sides, gains, equal);
  showLevel();
  mapDrawn = false;
}

// From the first texture's beginning to the last one's end, so that the finger stays in its place when the side changes.
function span() {
  const all = [sides.A, sides.B].filter((side) => side !== null).map(({figures}) => figures);
  const start_m = Math.min(...all.map((figures) => figures.start_m));
  return {start_m, length_m: Math.max(...all.map((figures) => figures.start_m + figures.length_m)) - start_m};
}

// The view: what the strip shows.
function view() {
  const from_m = (chosen ? span().start_m : 0) + 1e-3 * Number(start.value);
  return {from_m, to_m: from_m + 1e-3 * Number(scale.value || 1) * strip.clientWidth};
}

function showView() {
  if (chosen === null) return;
  if (fitted) {
    scale.value = Math.ceil(1e8 * span().length_m / strip.clientWidth) / 1e5;
    start.value = 0;
  }
  const {from_m, to_m} = view(), beyond_mm = 1e3 * (span().length_m - (to_m - from_m));
  start.max = Math.max(0, beyond_mm);
  start.disabled = beyond_mm <= 0.1;
  strip.setAttribute('aria-valuemin', (1e3 * from_m).toFixed(2));
  strip.setAttribute('aria-valuemax', (1e3 * to_m).toFixed(2));
  mapDrawn = false;
}

// Playing.
function gain() { return base.gain_m_per_n * Number(level.value); }

/** Starts the device if it rests. False if there is nothing to play. */
function play() {
  if (chosen === null || device === null || last.state === 'fault') return false;
  moved_ms = performance.now();
  if (playing) return true;
  if (last.state !== 'idle') return false;  // it still falls
  say('');
  if (stale) loadHeard();
  session.begin(base.made, 'textures');
  device.send({what: 'play', gain_m_per_n: gain()});
  playing = true;
  began_ms = performance.now();
  if (sides.B !== null) for (const name of ['A', 'B']) broughtFor(name).catch(() => {});  // ready for its key
  last = {...last, state: 'armed'};
  showState();
  return true;
}

function stop() {
  pointer = null;
  keys.clear();
  playing = false;
  device?.send({what: 'stop'});
  showState();
}

function until(when) {
  return when() ? Promise.resolve() : new Promise((done) => waiting.push({when, done}));
}

let idleReports = 0;
function report(message) {
  if (message.what === 'refused') {
    playing = false;
    say('The device refused to play. Press Stop, then touch again.');
  } else {
    last = {...last, ...message};
  }
  if (message.what === 'ticks') hearTicks(message);
  if (message.what === 'changed') hearChanged(message);
  if (message.what === 'loaded' && !message.accepted && playing) stop();  // choose() says it of a texture that is new
  waiting = waiting.filter(({when, done}) => !when() || done());
  showState();
}

// The log goes on with the change, so the server has to know of it first.
function hearChanged({accepted, note}) {
  if (accepted && session.state === 'open') session.request('change', note);
  if (!accepted && playing) say('The device did not change the texture. Press Stop, then touch again.');
}

function hearTicks(message) {
  if (message.log.length > 0) session.send(message.log);
  idleReports = message.state === 'idle' ? idleReports + 1 : 0;
  trace.add(message.cells);
  const now_ms = performance.now();
  if (message.moves) moved_ms = now_ms;
  if (playing && now_ms - moved_ms > 1e3 * IDLE_S) stop();
  if (playing && now_ms - began_ms > 1e3 * LONGEST_S) stop();
  if (message.state === 'fault' && playing) {
    playing = false;
    if (at('message').textContent === '') say(`Fault ${message.fault}. Press Stop, then touch again.`);
  }
}

async function keep() {
  stop();
  idleReports = 0;
  await until(() => idleReports >= 2);  // the last ticks are sent
  session.keep();
}

// The pointer. It touches while it is pressed and within the strip.
let pointer = null;  // {id, touches, place_m}

function placeOf(event) {
  const box = at('map').getBoundingClientRect(), {from_m, to_m} = view();  // within the border
  const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
  return {within: x >= 0 && x <= 1 && y >= 0 && y <= 1, place_m: from_m + x * (to_m - from_m)};
}

function follow(event) {
  if (pointer?.id !== event.pointerId) return;
  const each = event.getCoalescedEvents?.() ?? [];
  for (const part of each.length > 0 ? each : [event]) {
    const {within, place_m} = placeOf(part), time_s = part.timeStamp / 1e3;
    pointer.place_m = place_m;
    if (within && pointer.touches) device.send({what: 'reports', reports: [{time_s, place_m}]});
    if (within && !pointer.touches) device.send({what: 'down', time_s, place_m});
    if (!within && pointer.touches) device.send({what: 'lift'});
    pointer.touches = within;
  }
}

strip.addEventListener('pointerdown', (event) => {
  if (event.button !== 0 || pointer !== null || !play()) return;
  strip.setPointerCapture(event.pointerId);
  pointer = {id: event.pointerId, touches: false, place_m: 0};
  follow(event);
});
strip.addEventListener('onpointerrawupdate' in window ? 'pointerrawupdate' : 'pointermove', follow);
for (const name of ['pointerup', 'pointercancel'])
  strip.addEventListener(name, (event) => {
    if (pointer?.id !== event.pointerId) return;
    pointer = null;
    device.send({what: 'lift'});
  });

// Keys and strokes: exact speeds.
const keys = new Set();
const DIRECTION = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1};

function land(place_m) { device.send({what: 'land', place_m}); }

strip.addEventListener('keydown', (event) => {
  const direction = DIRECTION[event.key], {from_m, to_m} = view();
  if (direction === undefined && event.key !== 'Home' && event.key !== 'End') return;
  event.preventDefault();
  if (event.repeat || pointer !== null || !play()) return;
  const end_m = Math.min(to_m, chosen.figures.start_m + chosen.figures.length_m);
  if (direction === undefined) return land(event.key === 'Home' ? from_m : end_m);
  keys.add(event.key);
  if (!last.touches) land(Math.max(from_m, Math.min(end_m, last.place_m)));
  device.send({what: 'move', velocity_mps: 1e-3 * direction * Number(at('key-speed').value), end_m: direction > 0 ? end_m : from_m});
});
function release(key) { if (keys.delete(key) && keys.size === 0) device.send({what: 'rest'}); }
strip.addEventListener('keyup', (event) => release(event.key));
strip.addEventListener('blur', () => { for (const key of [...keys]) release(key); });

at('strokes').addEventListener('click', (event) => {
  const speed = Number(event.target.dataset.speed);
  if (!speed || !play()) return;
  const {start_m, length_m} = chosen.figures;
  device.send({what: 'stroke', velocity_mps: 1e-3 * speed, from_m: start_m, end_m: start_m + length_m});
});

// A and B, by buttons and by their keys.
function press(name) { if (name !== heard) hearSide(name); }
for (const name of ['A', 'B']) at(`side-${name}`).addEventListener('click', () => press(name));
for (const place of [strip, at('compare')])
  place.addEventListener('keydown', (event) => {
    const name = event.key.toUpperCase();
    if (!['A', 'B'].includes(name) || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    press(name);
  });
at('equal').addEventListener('input', () => {
  gains = gainsOf(sides, at('equal').checked);
  hearSide(heard);
  setLevel();
});

// Controls.
function showLevel() { at('level-value').textContent = Number(level.value).toFixed(2); }
function setLevel() {
  showLevel();
  if (playing) device.send({what: 'gain', gain_m_per_n: gain()});
}
level.addEventListener('input', setLevel);

function sound() {
  const on = at('sound').getAttribute('aria-pressed') === 'true';
  device?.send({what: 'sound', volume: on ? Number(at('volume').value) : 0, velocity: at('velocity').checked});
}
at('sound').addEventListener('click', () => {
  const on = at('sound').getAttribute('aria-pressed') !== 'true';
  at('sound').setAttribute('aria-pressed', String(on));
  at('sound').textContent = `Sound: ${on ? 'on' : 'off'}`;
  sound();
});
for (const id of ['volume', 'velocity']) at(id).addEventListener('input', sound);
scale.addEventListener('input', () => {
  fitted = false;
  showView();
});
for (const control of [start, at('colours')]) control.addEventListener('input', showView);
at('keep').addEventListener('click', keep);
at('stop').addEventListener('click', stop);
addEventListener('keydown', (event) => { if (event.key === 'Escape') stop(); });
at('controls').addEventListener('submit', (event) => event.preventDefault());
new ResizeObserver(showView).observe(strip);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', showView);

// Pictures, and the place of a pointer that rests.
function draw(now_ms) {
  requestAnimationFrame(draw);
  if (pointer?.touches) device.send({what: 'reports', reports: [{time_s: now_ms / 1e3, place_m: pointer.place_m}]});
  if (calm.matches && now_ms - drawn_ms < CALM_MS) return;
  drawn_ms = now_ms;
  if (!mapDrawn) drawMap(at('map'), chosen && {map: chosen.map, ...chosen.figures}, view(), at('colours').value);
  mapDrawn = true;
  drawFinger(at('finger'), view(), chosen && last.place_m, last.touches);
  trace.draw();
  if (chosen === null || now_ms - worded_ms < CALM_MS) return;
  worded_ms = now_ms;
  const limits = LIMITS.filter(([bit]) => (last.flags & bit) !== 0).map(([, word]) => word);
  const place = `finger ${last.touches ? 'touches' : 'is lifted'} at ${mm(last.place_m)}, ${(1e3 * last.speed_mps).toFixed(0)} mm/s`;
  at('place').textContent = place;
  at('tray').textContent = `tray up to ${(1e6 * (last.cells ?? []).reduce((peak, value) => Math.max(peak, Math.abs(value)), 0)).toFixed(1)} µm ` +
    `(edges of the trace: ${(1e6 * trace.full_m).toFixed(0)} µm); drive up to ${(last.drivePeak_v ?? 0).toFixed(2)} V of ${chosen.figures.drive_limit_v.toFixed(0)} V; ` +
    (limits.length > 0 ? `limited: ${limits.join(', ')}` : 'not limited');
  strip.setAttribute('aria-valuenow', (1e3 * last.place_m).toFixed(1));
  strip.setAttribute('aria-valuetext', place);
}

async function begin() {
  history.replaceState(null, '', '/');  // the token is in a cookie now
  requestAnimationFrame(draw);
  await Promise.all([compiled, library.read()]);
}

begin().catch((error) => say(error.message));
