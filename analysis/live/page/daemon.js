// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the device: shows what tactographd does, and steers it.

import {errorText, get} from './answers.js';
import {Shape} from './shape.js';
import {css, drawFinger, drawMap, sized, Trace} from './strip.js';
import {CELL_S, Cells, contactWords, decodeTicks, gainWords, lateRows, limitWords, placeWords, roundUp, Spectrum, SPECTRUM_LENGTH, Speeds, stateOf} from './ticks.js';

const RECONNECT_MS = 500;
const BEAT_MS = 400;             // the daemon stops the drive after 2 s without a word of the page that armed
const LONGEST_SHOWN_S = 10;
const CALM_MS = 250;             // between figures; with prefers-reduced-motion also between pictures
const SPECTRUM_DB = 60;          // of the picture
const SETTLES_MS = 500;
const SETTLED_MS = 100;          // after a fade, until the daemon accepts another one

const at = (id) => document.getElementById(id);
const calm = matchMedia('(prefers-reduced-motion: reduce)');
const trace = new Trace(at('trace'), LONGEST_SHOWN_S / CELL_S);
const gain = at('gain');

let socket = null, server = false;
let daemon = null, status = {}, steering = {here: false, taken: false};  // the newest events
let cells = new Cells(), spectrum = new Spectrum(), speeds = new Speeds(), last = null;  // last: the newest tick
let step = 1, m_per_count = null, missed = 0;
let map = null, mapOf = null, seen = {from_m: 0, to_m: 0};
let shown = 'lost';                // the state in one word
let held = [];                   // cells of a pause
let heard_ms = 0, beat_ms = 0, worded_ms = 0, mapDrawn = false, paused = false;
let numbers = 0, waiting = new Map();  // requests without an answer, by id

const mm = (metres, digits = 2) => `${(1e3 * metres).toFixed(digits)} mm`;
function put(id, text) { if (at(id).textContent !== text) at(id).textContent = text; }

// Server and daemon.
function connect() {
  socket = new WebSocket(`ws://${location.host}/daemon`);
  socket.onopen = () => { server = true; };
  socket.onmessage = (event) => hear(JSON.parse(event.data));
  socket.onclose = () => {
    server = false;
    forget('tactograph live does not answer');
    setTimeout(connect, RECONNECT_MS);
  };
}

function forget(why) {
  for (const {fail} of waiting.values()) fail(new Error(why));
  waiting = new Map();
  steering = {here: false, taken: false};
  status = {};
  last = map = mapOf = mine = null;
  missed = 0;
  cells = new Cells();
  spectrum = new Spectrum();
  speeds = new Speeds();
  trace.clear(1);
  held = [];
  mapDrawn = false;
  put('map-hint', '');
  show();
  showFigures();  // also in a pause
}

/** The daemon's answer; fails with its error's text. */
function ask(request, members = {}) {
  if (!server || !daemon?.here) return Promise.reject(new Error('there is no daemon'));
  const id = ++numbers;
  socket.send(JSON.stringify({request, id, ...members}));
  return new Promise((done, fail) => waiting.set(id, {done, fail}));
}

function hear(message) {
  const now_ms = performance.now();
  heard_ms = now_ms;
  if (message.ok !== undefined) hearAnswer(message);
  if (message.event === 'daemon') hearDaemon(message);
  if (message.event === 'steering') steering = message;
  if (message.event === 'status') hearStatus(message);
  if (message.event === 'state') status = {...status, state: message.state, why: message.why, fault: message.state === 'fault' ? message.why : undefined};
  if (message.event === 'ticks') hearTicks(message);
  // By messages and not by a timer: browsers slow down the timers of pages in the background.
  const runs = status.state === 'armed' || status.state === 'playing';
  if (steering.here && runs && now_ms - beat_ms > BEAT_MS) {
    beat_ms = now_ms;
    ask('status').catch(() => {});
  }
  if (message.event !== 'ticks') show();
}

function hearAnswer(message) {
  const asked = waiting.get(message.id);
  waiting.delete(message.id);
  if (message.ok) asked?.done(message);
  else if (asked) asked.fail(new Error(errorText(message.error)));
  else say(errorText(message.error));
}

function hearDaemon(message) {
  daemon = message;
  if (daemon.here) return say('');
  const steers = steering;
  forget(errorText(daemon));
  steering = steers;
  say(errorText(daemon));
}

function hearStatus(message) {
  if (message.loaded !== status.loaded || message.length_m !== status.length_m || message.start_m !== status.start_m) mapDrawn = false;
  status = message;
  if (Math.abs(status.encoder_count) >= 1000 && !withForces()) m_per_count = status.position_m / status.encoder_count;
  if (mapOf !== (status.loaded ?? '')) fetchMap();
  speeds.take(status.device_s, status.speed_mps);
  // A status that was on its way with the answer may still have the gain before it.
  if (adjusting || performance.now() - adjusted_ms < SETTLES_MS) return;
  if (mine !== null && status.gain_times_default !== mine.effective) mine = null;  // another client has set it since
  if (status.gain_times_default !== undefined) gain.value = status.gain_times_default;
}

function hearTicks(message) {
  const ticks = decodeTicks(message, status.period_s);
  const {rows} = ticks;
  if (last !== null && rows[0].number > last.number + ticks.step) missed += rows[0].number - last.number - 1;
  if (last !== null && rows[0].number < last.number) missed = 0;  // a new session
  last = rows.at(-1);
  step = ticks.step;
  spectrum.take(ticks);
  const done = cells.take(ticks);
  if (paused) held = [...held, ...done].slice(-2 * trace.count);
  else trace.add(done);
}

async function fetchMap() {
  const wanted = mapOf = status.loaded ?? '';
  map = null;
  mapDrawn = false;
  put('map-hint', '');
  if (wanted === '') return;
  const found = await get('loaded').then((answer) => answer.arrayBuffer()).catch((error) => error);
  if (wanted !== mapOf) return;
  if (found instanceof Error) put('map-hint', `No picture: ${found.message}`);
  else map = new Float32Array(found);
  mapDrawn = false;
}

// Steering.
function say(text) { put('message', text); }
const complain = (error) => say(error.message);

async function request(what, members) {
  say('');
  try {
    return await ask(what, members);
  } catch (error) {
    complain(error);
    return null;
  }
}

// Also while `play` is on its way.
function stop() {
  if (status.state === 'armed' || status.state === 'playing') request('stop');
}

let wanted = null, adjusting = false, adjusted_ms = -Infinity;
let mine = null;                 // {asked, effective}: the gain, if this page has set it
async function adjust() {
  wanted = Number(gain.value);
  showGain();
  if (adjusting) return;
  adjusting = true;
  while (wanted !== null) {
    const asked = wanted;
    wanted = null;
    const answer = await request('gain', {times_default: asked});
    if (answer === null) continue;
    status = {...status, gain_times_default: answer.gain_times_default, gain_m_per_n: answer.gain_m_per_n};
    mine = {asked, effective: answer.gain_times_default};
    adjusted_ms = performance.now();
  }
  adjusting = false;
  showGain();
}

/** Gives the device the texture of this index; while it plays, the next one has to wait for the end of the fade. */
async function loadTexture(index) {
  const answer = await ask('load', {texture: index, ...(shape.filter === '' ? {} : {inverse: shape.filter})});
  if (answer.changed) await new Promise((done) => setTimeout(done, 1e3 * answer.fade_s + SETTLED_MS));
}
const shape = new Shape(at('shape'), loadTexture);

// Words.
const withForces = () => status.x_m !== undefined;  // then the pictures show the magnitude of the force

function showGain() {
  const {gain_times_default: effective, gain_m_per_n} = status;
  put('gain-words', gainWords({forces: withForces(), asked: wanted ?? mine?.asked, effective, gain_m_per_n}));
}

function show() {
  const silent_ms = performance.now() - heard_ms;
  const {state, words} = stateOf({server, daemon, state: status.state, silent_ms});
  const loaded = status.loaded !== undefined, here = state !== 'lost';
  at('state').dataset.state = shown = state;
  put('state-word', words);
  put('fault', state === 'fault' && status.fault ? `fault: ${status.fault}` : '');
  if (!daemon?.here) put('device', 'The device of the daemon');
  else put('device', `${daemon.device_name}, ${daemon.device}${daemon.device.startsWith('sim:') ? ' (simulated)' : ''}`);
  put('loaded', loaded ? status.loaded.replace(/^.*\//, '').replace(/\.(texture|scene)\.json$/, '') : 'No texture is loaded');
  const force = withForces();
  put('trace-title', force ? 'Force' : 'Drive');
  put('spectrum-title', force ? 'Spectrum of the force on the hand' : 'Spectrum of the drive under the finger');
  put('steers', !here ? 'Nothing can be steered.' : steering.taken ? 'Another page steers; this one watches, and can stop.' : 'This page steers the daemon.');
  at('steer').hidden = !steering.taken;
  at('shape').disabled = !here || steering.taken || state === 'fault';
  const may = {steer: steering.taken, load: at('texture').value !== '' && state !== 'fault', arm: state === 'idle' && loaded,
               play: state === 'armed', disarm: state === 'armed' || state === 'playing' || state === 'fault', gain: status.gain_times_default !== undefined};
  for (const [id, allowed] of Object.entries(may))
    at(id).disabled = !allowed || !here || (steering.taken && id !== 'steer' && id !== 'disarm');
  showGain();
}

function showFigures() {
  const lost = shown === 'lost', place = lost ? '–' : status.ticks > 0 ? placeWords(status, placeOf()) : 'no ticks yet';
  put('place', place);
  at('strip').setAttribute('aria-label', `${withForces() ? 'Hand along x' : 'Finger on the texture'}: ${lost ? 'lost' : place}`);
  if (lost) {
    for (const id of ['contact', 'limits', 'ticks', 'session', 'latency', 'trace-words', 'spectrum-words']) put(id, '–');
    at('late').hidden = true;
    return;
  }
  put('contact', last === null ? '–' : contactWords(last.flags));
  put('limits', limitWords(status, last?.flags ?? 0));
  const count = (name) => status[name] ?? 0;
  put('ticks', `${count('ticks')}, lost ${count('lost_ticks')}, late ${count('late_ticks')}${missed > 0 ? `; ${missed} did not reach this page` : ''}`);
  put('session', status.session ?? 'none');
  showLate();
}

function showLate() {
  const rows = lateRows(status);
  at('late').hidden = rows === null;
  if (rows !== null && at('late').rows.length === 0)
    at('late').append(...rows.map(([words]) => {
      const row = document.createElement('tr');
      const head = Object.assign(document.createElement('th'), {scope: 'row', textContent: words});
      const bar = document.createElement('td');
      bar.append(Object.assign(document.createElement('meter'), {max: 1, ariaLabel: words}));
      row.append(head, document.createElement('td'), bar);
      return row;
    }));
  if (status.period_s === undefined) return put('latency', '–');
  rows?.forEach(([, part], i) => {
    at('late').rows[i].cells[1].textContent = `${(100 * part).toFixed(2)} %`;
    at('late').rows[i].cells[2].firstChild.value = part;
  });
  put('latency', rows === null
    ? `The device closes the loop: it reads the encoder and sets the drive in the same tick, within ${(1e3 * status.period_s).toFixed(2)} ms. Round trip of a message: ${(1e3 * status.round_trip_s).toFixed(2)} ms.`
    : `From the encoder's edge to the drive: median ${(1e3 * status.latency_p50_s).toFixed(2)} ms, 99 % within ${(1e3 * status.latency_p99_s).toFixed(2)} ms. Computing: 99 % within ${(1e6 * status.busy_p99_s).toFixed(1)} µs.`);
}

// Pictures.
const unit = () => (withForces() ? 'N' : 'V');

function placeOf() {
  const place_m = status.position_m ?? status.x_m ?? 0;
  return last === null || m_per_count === null ? place_m : place_m + (last.count - status.encoder_count) * m_per_count;
}

// The texture with a margin; without one, where the finger has been.
function view() {
  if (status.length_m > 0) return {from_m: status.start_m - 0.05 * status.length_m, to_m: status.start_m + 1.05 * status.length_m};
  const place_m = placeOf();
  seen = {from_m: Math.min(seen.from_m, place_m), to_m: Math.max(seen.to_m, place_m, seen.from_m + 1e-3)};
  return seen;
}

function drawSpectrum() {
  const {ink, width, height} = sized(at('spectrum')), values = spectrum.amplitudes();
  ink.clearRect(0, 0, width, height);
  if (values === null || !(status.period_s > 0)) return put('spectrum-words', `needs ${SPECTRUM_LENGTH} ticks without a gap`);
  const hz = 1 / (status.period_s * step * SPECTRUM_LENGTH);
  const shown = Math.min(values.length, Math.ceil(Math.max(100, 1.2 * (status.passes_to_hz ?? 400)) / hz));
  let peak = 2;  // above the window's width
  for (let k = 2; k < shown; ++k) if (values[k] > values[peak]) peak = k;
  const top = roundUp(Math.max(values[peak], 1e-3));
  ink.fillStyle = css('--trace');
  for (let k = 0; k < shown; ++k) {
    const level = Math.max(0, 1 + 20 * Math.log10(Math.max(values[k], 1e-9) / top) / SPECTRUM_DB);
    ink.fillRect(k / shown * width, height * (1 - level), Math.max(1, width / shown - 0.5), height * level);
  }
  const speed = speeds.steady(1 / hz), period = speed > 1e-3 ? `, at this speed a period of ${mm(speed / (peak * hz))}` : '';
  const largest = values[peak] > 1e-3 ? `largest: ${values[peak].toFixed(3)} ${unit()} at ${(peak * hz).toFixed(0)} Hz${period}; ` : '';
  put('spectrum-words', `${largest}0 to ${(shown * hz).toFixed(0)} Hz, last ${(1 / hz).toFixed(2)} s; upper edge ${top} ${unit()}, lower edge ${SPECTRUM_DB} dB below`);
}

function drawTrace() {
  const shown_s = Number(at('span').value), shown = shown_s / CELL_S;
  trace.full_m = roundUp(Math.max(0.01, trace.peak(shown)));
  trace.draw(shown);
  put('trace-words', `last ${shown_s} s${paused ? ' before the pause' : ''}; edges ±${trace.full_m} ${unit()}`);
}

function draw(now_ms) {
  requestAnimationFrame(draw);
  const wordy = now_ms - worded_ms >= CALM_MS;
  if (wordy) worded_ms = now_ms;
  if (wordy) show();  // also when nothing is heard
  if (wordy && shown === 'lost') showFigures();
  if (paused || (calm.matches && !wordy)) return;
  const strip = view();
  if (!mapDrawn) drawMap(at('map'), map && {map, start_m: status.start_m, length_m: status.length_m}, strip, at('colours').value);
  mapDrawn = true;
  drawFinger(at('finger'), strip, status.ticks > 0 ? placeOf() : null, true);
  drawTrace();
  if (!wordy) return;
  drawSpectrum();
  showFigures();
}

async function listTextures() {
  const {textures} = await (await get('textures')).json();
  const options = textures.filter(({reason}) => reason === undefined).map(({index, name}) => new Option(name, index));
  at('texture').replaceChildren(...options);
  if (options.length > 0) shape.of(Number(at('texture').value));
  if (options.length === 0) at('texture').append(new Option('this folder has none', ''));
  show();
}

at('load').addEventListener('click', () => {
  say('');
  shape.of(Number(at('texture').value));
  loadTexture(shape.source).catch(complain);
});
at('texture').addEventListener('input', () => shape.of(Number(at('texture').value)));
for (const id of ['arm', 'play', 'disarm']) at(id).addEventListener('click', () => request(id));
at('steer').addEventListener('click', () => { if (server) socket.send(JSON.stringify({request: 'steer'})); });
at('stop').addEventListener('click', stop);
addEventListener('keydown', (event) => { if (event.key === 'Escape') stop(); });
gain.addEventListener('input', adjust);
at('pause').addEventListener('click', () => {
  paused = !paused;
  at('pause').setAttribute('aria-pressed', String(paused));
  put('pause', paused ? 'Paused' : 'Pause');
  trace.add(held);
  held = [];
  drawTrace();
});
at('span').addEventListener('input', drawTrace);
const redraw = () => { mapDrawn = false; };
at('colours').addEventListener('input', redraw);
new ResizeObserver(redraw).observe(at('strip'));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
at('controls').addEventListener('submit', (event) => event.preventDefault());
connect();
requestAnimationFrame(draw);
listTextures().catch(complain);
