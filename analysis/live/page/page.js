// SPDX-License-Identifier: GPL-3.0-or-later
// The page: chooses a texture, moves the finger, shows what the device does, keeps sessions.

import {startDevice} from './device.js';
import {drawFinger, drawMap, Trace} from './strip.js';

const IDLE_S = 30;              // without motion: then the drive falls and the session ends
const LONGEST_S = 590;          // of a session; the server accepts 600
const MOST_LEVEL = 4;
const RECONNECT_MS = 2000;
const LIMITS = [[8, 'amplitude'], [16, 'slew'], [64, 'energy']];  // flags of ticks (WIRE.md)
const CALM_MS = 250;            // between figures; with prefers-reduced-motion also between pictures

const at = (id) => document.getElementById(id);
const strip = at('strip'), level = at('level'), scale = at('scale'), start = at('start');
const trace = new Trace(at('trace'));
const calm = matchMedia('(prefers-reduced-motion: reduce)');

const compiled = WebAssembly.compileStreaming(get('core.wasm'));
let device = null, starting = null, socket = null;
let chosen = null;              // {figures, map}
let last = {state: 'idle', touches: false, place_m: 0, speed_mps: 0};  // the last report
let fitted = true;              // the strip shows the whole texture
let playing = false;            // asked for
let session = 'none';           // 'none', 'open', 'kept'
let began_ms = 0, moved_ms = 0, mapDrawn = false, drawn_ms = 0, worded_ms = 0;
let waiting = [];               // for the device: {when, done}

// Words.
function say(text) { at('message').textContent = text; }
const errorText = ({what, where, remedy}) => `${where ? where + ': ' : ''}${what}${remedy ? ` (${remedy})` : ''}`;
const mm = (metres, digits = 2) => `${(1e3 * metres).toFixed(digits)} mm`;

function showState() {
  const state = last.state === 'fault' ? 'fault' : playing ? 'playing' : 'stopped';
  at('state').dataset.state = state;
  const words = {playing: last.touches ? 'playing' : 'playing, finger lifted', fault: 'fault',
                 stopped: last.state === 'idle' ? 'stopped' : 'stopping'};
  const text = chosen === null ? 'no texture' : words[state] + (device?.sounds === false ? ', no sound device' : '');
  if (at('state-word').textContent !== text) at('state-word').textContent = text;
  at('keep').disabled = session !== 'open';
}

// Server.
function connect() {
  socket = new WebSocket(`ws://${location.host}/session`);
  socket.binaryType = 'arraybuffer';
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => {
    if (session === 'open') session = 'none';
    at('kept').textContent = 'The server is gone: nothing can be kept. Trying again.';
    setTimeout(connect, RECONNECT_MS);
  };
  socket.onopen = () => { if (at('kept').textContent.startsWith('The server is gone')) at('kept').textContent = 'The server is back.'; };
}

const send = (data) => { if (socket.readyState === WebSocket.OPEN) socket.send(data); };

function hear(message) {
  if (message.error) {
    session = 'none';
    at('kept').textContent = `Not kept: ${errorText(message.error)}`;
  }
  if (message.event === 'fault') say(`Fault: ${message.what}. ${message.remedy ?? ''} Press Stop, then touch again.`);
  if (message.kept !== undefined) {
    session = 'kept';
    at('kept').textContent = `Kept: ${message.kept}, ${message.ticks} ticks${message.lost_ticks > 0 ? `, ${message.lost_ticks} lost` : ''}. Check it: tactograph replay ${message.kept}`;
  }
  showState();
}

async function get(path) {
  const answer = await fetch(path);
  if (answer.ok) return answer;
  const body = await answer.text();
  let text = body;
  try { text = errorText(JSON.parse(body).error); } catch { /* no JSON: the text itself */ }
  throw new Error(text);
}

// Textures.
async function listTextures() {
  const {textures} = await (await get('textures')).json();
  const rows = textures.map((row) => {
    const item = document.createElement('li');
    if (row.reason !== undefined) {
      item.append(Object.assign(document.createElement('p'), {textContent: `${row.name} can't be read: ${row.reason}`}));
      return item;
    }
    const button = Object.assign(document.createElement('button'), {type: 'button'});
    button.append(row.name, Object.assign(document.createElement('small'), {textContent: mm(row.length_m, 1)}));
    button.onclick = () => choose(row.index, button).catch((error) => say(error.message));
    item.append(button);
    return item;
  });
  at('textures').replaceChildren(...rows);
  if (rows.length === 0) at('textures').append(Object.assign(document.createElement('li'),
    {textContent: 'This folder has no textures. Make them with tactograph spatial, or see tactograph demo.'}));
}

async function load(index) {
  const figures = await (await get(`texture/${index}`)).json();
  const parts = ['map', 'tray', 'upload'].map(async (part) => (await get(`${part}/${figures.made}`)).arrayBuffer());
  const [map, tray, upload] = await Promise.all(parts);
  return {figures, map: new Float32Array(map), tray: new Float32Array(tray), upload: new Uint8Array(upload)};
}

let choices = 0;
async function choose(index, button) {
  const mine = ++choices;
  say('');
  stop();
  chosen = null;
  session = 'none';
  const loading = load(index);
  starting ??= compiled.then((module) => startDevice(module, report));
  device = await starting;
  sound();
  await until(() => last.state === 'idle');
  const {figures, map, tray, upload} = await loading;
  if (mine !== choices) return;  // another texture has been chosen since
  last.what = '';
  const full_m = Math.min(figures.tray_peak_m || Infinity, figures.displacement_limit_m);
  device.send({what: 'texture', upload, tray, full_m});
  await until(() => last.what === 'loaded');
  if (!last.accepted) throw new Error('the device in this page refused the texture; load the page again');
  chosen = {figures, map};
  for (const other of at('textures').querySelectorAll('button')) other.removeAttribute('aria-current');
  button.setAttribute('aria-current', 'true');
  showTexture();
}

function showTexture() {
  const {figures} = chosen;
  at('strip-title').textContent = figures.name;
  at('notes').replaceChildren(...[`Transducer: ${figures.transducer}.`, ...figures.notes ?? []].map((text) =>
    Object.assign(document.createElement('li'), {textContent: text})));
  const most = Math.floor(100 * Math.min(MOST_LEVEL, figures.displacement_limit_m / figures.tray_peak_m)) / 100;
  level.max = most;
  level.value = Math.min(1, most);
  at('level-hint').textContent = `Displacement for force: ${(1e3 * figures.gain_m_per_n).toFixed(3)} mm/N at level 1. Largest level: ${most}` +
    (most < MOST_LEVEL ? `; above it the tray could move more than its ${(1e6 * figures.displacement_limit_m).toFixed(0)} µm.` : '.');
  trace.clear(Math.min(figures.displacement_limit_m, 1.2 * figures.tray_peak_m || Infinity));
  fitted = true;
  showLevel();
  showView();
  last = {...last, place_m: figures.start_m};
  showState();
}

// The view: what the strip shows.
function view() {
  const from_m = (chosen?.figures.start_m ?? 0) + 1e-3 * Number(start.value);
  return {from_m, to_m: from_m + 1e-3 * Number(scale.value || 1) * strip.clientWidth};
}

function showView() {
  if (chosen === null) return;
  if (fitted) {
    scale.value = Math.ceil(1e8 * chosen.figures.length_m / strip.clientWidth) / 1e5;
    start.value = 0;
  }
  const {from_m, to_m} = view(), beyond_mm = 1e3 * (chosen.figures.length_m - (to_m - from_m));
  start.max = Math.max(0, beyond_mm);
  start.disabled = beyond_mm <= 0.1;
  strip.setAttribute('aria-valuemin', (1e3 * from_m).toFixed(2));
  strip.setAttribute('aria-valuemax', (1e3 * to_m).toFixed(2));
  mapDrawn = false;
}

// Playing.
function gain() { return chosen.figures.gain_m_per_n * Number(level.value); }

/** Starts the device if it rests. False if there is nothing to play. */
function play() {
  if (chosen === null || device === null || last.state === 'fault') return false;
  moved_ms = performance.now();
  if (playing) return true;
  if (last.state !== 'idle') return false;  // it still falls
  say('');
  send(JSON.stringify({request: 'begin', made: chosen.figures.made}));
  device.send({what: 'play', gain_m_per_n: gain()});
  session = socket.readyState === WebSocket.OPEN ? 'open' : 'none';
  if (session === 'open') at('kept').textContent = 'Keep stops and writes the session into the folder of the textures.';
  playing = true;
  began_ms = performance.now();
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
  waiting = waiting.filter(({when, done}) => !when() || done());
  showState();
}

function hearTicks(message) {
  if (message.log.length > 0) send(message.log);
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
  at('kept').textContent = 'Keeping …';
  send(JSON.stringify({request: 'keep'}));
}

// The pointer. It touches while it is pressed and within the strip.
let pointer = null;  // {id, touches, place_m}

function placeOf(event) {
  const box = strip.getBoundingClientRect(), {from_m, to_m} = view();
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

// Controls.
function showLevel() { at('level-value').textContent = Number(level.value).toFixed(2); }
level.addEventListener('input', () => {
  showLevel();
  if (playing) device.send({what: 'gain', gain_m_per_n: gain()});
});

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
  connect();
  requestAnimationFrame(draw);
  await Promise.all([compiled, listTextures()]);
}

begin().catch((error) => say(error.message));
