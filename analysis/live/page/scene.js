// SPDX-License-Identifier: GPL-3.0-or-later
// The page of force scenes: moves the hand, shows the force on it, sets numbers, keeps sessions.

import {get} from './answers.js';
import {Hand, runHand} from './hand.js';
import {folderDevices, imageOf} from './scene_list.js';
import {IDLE_S, KeptSession, LONGEST_S} from './kept_session.js';
import {sized} from './strip.js';

const CALM_MS = 250;            // between figures; with prefers-reduced-motion also between pictures
const LONGEST_ARROW = 0.3;      // of the picture's smaller side
const LIMITS = [[8, 'peak'], [16, 'slew'], [64, 'continuous']];  // flags of ticks (WIRE.md)
const NAMES = ['x', 'y', 'z'];

const at = (id) => document.getElementById(id);
const view = at('view');
const calm = matchMedia('(prefers-reduced-motion: reduce)');
const compiled = WebAssembly.compileStreaming(get('core.wasm'));
compiled.catch((error) => say(error.message));

let scene = null, hand = null, endHand = () => {}, section = null;
let last = {state: 'idle', place_m: [0, 0, 0], force_n: [0, 0, 0], speed_mps: 0, flags: 0, ghost_m: null, values: null};
let playing = false;  // asked for
let began_ms = 0, moved_ms = 0, drawn_ms = 0, worded_ms = 0;
let picture = null, full_n = 0.1, rested = true, idleReports = 0, waiting = [], choices = 0;
let outputs = [];                       // of the sliders

const say = (text) => { at('message').textContent = text; };
const mm = (metres, digits = 2) => `${(1e3 * metres).toFixed(digits)} mm`;
const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0\.?0*)$/, '$1');  // no negative zero
const three = (value) => Number(value.toPrecision(4)).toString();

function showState() {
  const state = last.state === 'fault' ? 'fault' : playing ? 'playing' : 'stopped';
  at('state').dataset.state = state;
  const text = scene === null ? 'no scene' : state === 'stopped' && last.state !== 'idle' ? 'stopping' : state;
  if (at('state-word').textContent !== text) at('state-word').textContent = text;
  at('keep').disabled = session.state !== 'open';
}

// Server.
const session = new KeptSession('/scene-session', at('kept'), (text) => say(`${text} Press Stop, then begin again.`), showState);

// The scene of the address: scene.html#3.
async function choose() {
  const index = location.hash.slice(1), mine = ++choices;
  if (!/^\d+$/.test(index)) return;
  say('');
  endHand();
  scene = hand = picture = null;
  playing = false;
  session.state = 'none';
  at('scene-title').textContent = 'Preparing …';
  showState();
  try {
    const device = at('device').value;
    const figures = await (await get(`scene/${index}${device === '' ? '' : `?device=${device}`}`)).json();
    const upload = new Uint8Array(await (await get(`scene-upload/${figures.made}`)).arrayBuffer()), module = await compiled;
    if (mine !== choices) return;  // another one has been chosen since
    hand = new Hand(module, figures, upload, report);
    scene = figures;
    endHand = runHand(hand);
    showScene();
  } catch (error) {
    if (mine === choices) at('scene-title').textContent = 'Choose a scene';
    if (mine === choices) say(error.message);
  }
  showState();
}

function make(tag, members, ...parts) {
  const element = Object.assign(document.createElement(tag), members);
  element.append(...parts);
  return element;
}

function showScene() {
  const {axes, name, device, rate_hz, pieces = [], sections, notes = []} = scene, space = axes.length > 2;
  last = {...last, state: 'idle', place_m: axes.map(({start_m}) => start_m), force_n: axes.map(() => 0), ghost_m: null, values: null};
  full_n = 0.1;
  at('scene-title').textContent = name;
  at('pieces').replaceChildren(...pieces.map(({name: piece, shape, colour}) => {
    const swatch = make('canvas', {width: 12, height: 12, className: 'swatch', ariaHidden: 'true'}), ink = swatch.getContext('2d');
    ink.fillStyle = colour;
    ink.fillRect(0, 0, 12, 12);
    return make('li', {}, swatch, `${piece}: ${shape}`);
  }));
  at('notes').replaceChildren(...[`Device: ${device}, ${rate_hz} ticks a second.`, ...notes].map((text) => make('li', {}, text)));
  if (notes.length > 0) say(notes[0] + (notes.length > 1 ? ` (and ${notes.length - 1} more below, in “How exact this is”)` : ''));
  at('section').replaceChildren(...sections.map(({right, up}, i) => make('option', {value: i}, `${NAMES[right]} ${NAMES[up]}`)));
  at('section').value = space ? 1 : 0;
  at('section-controls').hidden = at('across-keys').hidden = at('section').disabled = at('across').disabled = !space;
  at('ghost').hidden = !scene.ghost;
  showSliders();
  showSection();
}

function showSliders() {
  const rows = scene.sliders.map((slider, i) => {
    const input = make('input', {id: `slider-${i}`, type: 'range', min: slider.from, max: slider.to, step: (slider.to - slider.from) / 200 || 1, value: slider.value});
    input.value = slider.value;
    input.addEventListener('input', () => {
      hand.set(slider, Number(input.value));
      showValues();
    });
    return {slider, input, output: make('output', {})};
  });
  outputs = rows;
  at('sliders').hidden = rows.length === 0;
  at('sliders').replaceChildren(make('legend', {}, 'Numbers'), ...rows.map(({slider, input, output}) => make('label', {}, make('span', {}, slider.name), input, output)));
  showValues();
}

// Asked for, and in effect.
function showValues() {
  outputs.forEach(({slider, input, output}, i) => {
    const asked = hand.asked.get(slider) ?? slider.value, now = last.values?.[i];
    const text = `${three(asked)}${now === undefined ? ', plays from the next start on' : Math.fround(asked) === now ? ', in effect' : `, in effect: ${three(now)}`}`;
    if (output.textContent !== text) output.textContent = text;
    input.setAttribute('aria-valuetext', three(asked));
  });
}

// The section: its axes, and the picture through the place across it.
function showSection() {
  section = scene.sections[Number(at('section').value)];
  view.style.aspectRatio = `${section.columns} / ${section.rows}`;
  view.style.maxWidth = `min(40rem, ${80 * section.columns / section.rows}vh)`;
  const axis = scene.axes[section.across], slider = at('across');
  picture = null;
  if (axis) {
    [slider.min, slider.max] = [1e3 * axis.from_m, 1e3 * axis.to_m];
    slider.value = 1e3 * last.place_m[section.across];
    at('across-name').textContent = `Place along ${axis.name}`;
  }
  showPicture();
}

let bringing = false, stale = false;  // one picture at a time, the newest next
async function showPicture() {
  at('across-value').textContent = `${Number(at('across').value).toFixed(1)} mm`;
  stale = true;
  if (bringing) return;
  bringing = true;
  while (stale && scene !== null) {
    stale = false;
    const of = section, through_m = scene.axes.length > 2 ? 1e-3 * Number(at('across').value) : 0;
    const path = `section/${scene.made}/${scene.sections.indexOf(of)}/${through_m}`;
    const bytes = await get(path).then((answer) => answer.arrayBuffer()).catch((error) => say(error.message));
    if (bytes && of === section) picture = imageOf(new Uint32Array(bytes), of.columns);
    drawPicture();
  }
  bringing = false;
}

const onPage = ({width, height}, [right_m, up_m]) => [
  (right_m - section.left_m) / (section.columns * section.pixel_m) * width, (section.top_m - up_m) / (section.rows * section.pixel_m) * height];

function drawPicture() {
  const canvas = sized(at('picture')), {ink, width, height, ratio} = canvas;
  ink.clearRect(0, 0, width, height);
  if (picture === null || scene === null) return;
  ink.drawImage(picture, 0, 0, width, height);
  ink.lineWidth = ratio;
  ink.font = `${12 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
  for (const {name, x_m, y_m, width_m, height_m, angle_deg} of scene.patches ?? []) {
    const turn = angle_deg * Math.PI / 180;
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
      const u = a * width_m / 2, v = b * height_m / 2;
      return onPage(canvas, [x_m + u * Math.cos(turn) - v * Math.sin(turn), y_m + u * Math.sin(turn) + v * Math.cos(turn)]);
    });
    ink.strokeStyle = '#000';
    ink.beginPath();
    corners.forEach(([x, y], i) => (i === 0 ? ink.moveTo(x, y) : ink.lineTo(x, y)));
    ink.closePath();
    ink.stroke();
    const [x, y] = onPage(canvas, [x_m, y_m]), size = ink.measureText(name);
    ink.fillStyle = 'rgba(255, 255, 255, .85)';
    ink.fillRect(x - size.width / 2 - 2 * ratio, y - 8 * ratio, size.width + 4 * ratio, 16 * ratio);
    ink.fillStyle = '#000';
    ink.fillText(name, x - size.width / 2, y + 4 * ratio);
  }
  drawScale(canvas);
}

// A bar of a fifth of the width or less, with its length and the names of the axes.
function drawScale({ink, width, height, ratio}) {
  const most_mm = 200 * section.columns * section.pixel_m, power = 10 ** Math.floor(Math.log10(most_mm));
  const long_mm = power * [5, 2, 1].find((times) => times * power <= most_mm), long = long_mm / (5 * most_mm) * width;
  const text = `${three(long_mm)} mm; right ${NAMES[section.right]}, up ${NAMES[section.up]}`, x = 8 * ratio, y = height - 10 * ratio;
  ink.fillStyle = 'rgba(255, 255, 255, .85)';
  ink.fillRect(0, height - 32 * ratio, Math.max(long, ink.measureText(text).width) + 16 * ratio, 32 * ratio);
  ink.fillStyle = '#000';
  ink.fillRect(x, y, long, 3 * ratio);
  ink.fillText(text, x, y - 6 * ratio);
}

// The hand (ring), the ghost (diamond), and the force from the hand on (arrow). White below black: seen on any picture.
function drawHand() {
  const canvas = sized(at('arrow')), {ink, width, height, ratio} = canvas;
  ink.clearRect(0, 0, width, height);
  if (scene === null) return;
  const inSection = (values) => [values[section.right], values[section.up]];
  const [x, y] = onPage(canvas, inSection(last.place_m)), ghost = last.ghost_m && onPage(canvas, inSection(last.ghost_m));
  const [fx, fy] = inSection(last.force_n).map((force) => force / full_n * LONGEST_ARROW * Math.min(width, height));
  const long = Math.hypot(fx, fy);
  for (const [colour, thickness] of [['#fff', 5 * ratio], ['#000', 2 * ratio]]) {
    ink.strokeStyle = ink.fillStyle = colour;
    ink.lineWidth = thickness;
    ink.beginPath();
    if (ghost) {
      const [u, v] = ghost, r = 6 * ratio;
      ink.moveTo(u, v - r);
      for (const [a, b] of [[r, 0], [0, r], [-r, 0], [0, -r]]) ink.lineTo(u + a, v + b);
      ink.moveTo(x, y);
      ink.lineTo(u, v);
    }
    ink.moveTo(x + 7 * ratio, y);
    ink.arc(x, y, 7 * ratio, 0, 2 * Math.PI);
    if (long > ratio) {
      const [u, v] = [fx / long, -fy / long], [tx, ty] = [x + fx, y - fy], head = Math.min(10 * ratio, 0.6 * long);
      ink.moveTo(x, y);
      ink.lineTo(tx, ty);
      for (const side of [-1, 1]) {
        ink.moveTo(tx, ty);
        ink.lineTo(tx - head * u - side * 0.5 * head * v, ty - head * v + side * 0.5 * head * u);
      }
    }
    ink.stroke();
  }
}

// Playing.
function play() {
  if (hand === null || last.state === 'fault') return false;
  moved_ms = performance.now();
  if (playing) return true;
  if (last.state !== 'idle') return false;  // it still falls
  say('');
  session.begin(scene.made, 'scenes');
  playing = true;
  began_ms = performance.now();
  last = {...last, state: 'armed'};
  hand.play();
  showState();
  return true;
}

function stop() {
  pointer = null;
  keys.clear();
  playing = false;
  hand?.stop();
  showState();
}

function until(when) {
  return when() ? Promise.resolve() : new Promise((done) => waiting.push({when, done}));
}

function report(message) {
  if (message.what === 'refused') {
    playing = false;
    say('The device refused to play. Press Stop, then begin again.');
    return;
  }
  last = {...last, ...message};
  if (message.log.length > 0) session.send(message.log);
  idleReports = message.state === 'idle' ? idleReports + 1 : 0;
  const now_ms = performance.now(), force_n = Math.hypot(...message.force_n);
  while (force_n > full_n) full_n *= /^[15]/.test(full_n.toExponential()) ? 2 : 2.5;  // 1, 2, 5, 10
  if (message.moves) moved_ms = now_ms;
  if (playing && (now_ms - moved_ms > 1e3 * IDLE_S || now_ms - began_ms > 1e3 * LONGEST_S)) stop();
  if (message.state === 'fault' && playing) {
    playing = false;
    if (at('message').textContent === '') say(`Fault ${message.fault}. Press Stop, then begin again.`);
  }
  waiting = waiting.filter(({when, done}) => !when() || done());
  if (message.moves) rested = false;
  else if (!rested) {
    rested = true;
    at('spoken').textContent = `${forceWords()}; ${placeWords()}`;
  }
  showState();
}

async function keep() {
  stop();
  idleReports = 0;
  await until(() => idleReports >= 2);  // the last ticks are sent
  session.keep();
}

// The pointer: it is the hand while it is pressed.
let pointer = null;  // {id, place_m}
function placeOf(event) {
  const box = at('picture').getBoundingClientRect(), place_m = [0, 0, 0];  // within the border
  place_m[section.right] = section.left_m + (event.clientX - box.left) / box.width * section.columns * section.pixel_m;
  place_m[section.up] = section.top_m - (event.clientY - box.top) / box.height * section.rows * section.pixel_m;
  return place_m;
}
view.addEventListener('pointerdown', (event) => {
  if (event.button !== 0 || pointer !== null || !play()) return;
  view.setPointerCapture(event.pointerId);
  pointer = {id: event.pointerId, place_m: placeOf(event)};
  hand.down(section, event.timeStamp / 1e3, pointer.place_m);
});
view.addEventListener('onpointerrawupdate' in window ? 'pointerrawupdate' : 'pointermove', (event) => {
  if (pointer?.id !== event.pointerId) return;
  const each = event.getCoalescedEvents?.() ?? [];
  for (const part of each.length > 0 ? each : [event]) {
    pointer.place_m = placeOf(part);
    hand.moved(section, part.timeStamp / 1e3, pointer.place_m);
  }
});
for (const name of ['pointerup', 'pointercancel'])
  view.addEventListener(name, (event) => {
    if (pointer?.id !== event.pointerId) return;
    pointer = null;
    hand.rest();
  });

// Keys: exact speeds. Each key moves along one axis; the last one pressed of two that oppose each other counts.
const keys = new Map();  // key: axis
const DIRECTION = {ArrowRight: ['right', 1], ArrowLeft: ['right', -1], ArrowUp: ['up', 1], ArrowDown: ['up', -1], PageUp: ['across', 1], PageDown: ['across', -1]};
view.addEventListener('keydown', (event) => {
  if (DIRECTION[event.key] === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  if (event.repeat || pointer !== null || !play()) return;
  const [way, direction] = DIRECTION[event.key], axis = section[way];
  if (axis >= scene.axes.length) return;
  keys.set(event.key, axis);
  hand.move(axis, 1e-3 * direction * Number(at('key-speed').value));
});
function release(key) {
  const axis = keys.get(key);
  if (!keys.delete(key) || [...keys.values()].includes(axis)) return;
  hand.fingers[axis].rest();
  if (axis !== section.across) return;
  at('across').value = 1e3 * hand.fingers[axis].place_m;
  showPicture();
}
view.addEventListener('keyup', (event) => release(event.key));
view.addEventListener('blur', () => { for (const key of [...keys.keys()]) release(key); });

// Controls.
at('section').addEventListener('input', showSection);
at('across').addEventListener('input', () => {
  const to_m = 1e-3 * Number(at('across').value), axis = section.across, speed_mps = 1e-3 * Number(at('key-speed').value);
  hand.move(axis, Math.sign(to_m - hand.fingers[axis].place_m) * speed_mps, to_m);
  showPicture();
});
at('device').addEventListener('input', choose);
at('keep').addEventListener('click', keep);
at('stop').addEventListener('click', stop);
addEventListener('keydown', (event) => { if (event.key === 'Escape') stop(); });
at('controls').addEventListener('submit', (event) => event.preventDefault());
addEventListener('hashchange', choose);
new ResizeObserver(drawPicture).observe(view);

// Pictures and figures, and the place of a pointer that rests.
const components = (values, digits, factor) => scene.axes.map(({name}, i) => `${name} ${fixed(factor * values[i], digits)}`).join(', ');
const forceWords = () => `force on the hand ${Math.hypot(...last.force_n).toFixed(3)} N: ${components(last.force_n, 3, 1)} N`;
const placeWords = () => `hand at ${components(last.place_m, 2, 1e3)} mm, ${(1e3 * last.speed_mps).toFixed(0)} mm/s`;

function draw(now_ms) {
  requestAnimationFrame(draw);
  if (pointer !== null) hand.moved(section, now_ms / 1e3, pointer.place_m);
  if (calm.matches && now_ms - drawn_ms < CALM_MS) return;
  drawn_ms = now_ms;
  drawHand();
  if (scene === null || now_ms - worded_ms < CALM_MS) return;
  worded_ms = now_ms;
  const limits = LIMITS.filter(([bit]) => (last.flags & bit) !== 0).map(([, word]) => word);
  at('force').textContent = `${forceWords()}; ${limits.length > 0 ? `limited: ${limits.join(', ')}` : 'not limited'}`;
  at('place').textContent = placeWords();
  at('ghost').textContent = last.ghost_m === null ? 'ghost: none while stopped'
      : `ghost at ${components(last.ghost_m, 2, 1e3)} mm, ${mm(Math.hypot(...last.ghost_m.map((m, i) => m - last.place_m[i])), 3)} from the hand`;
  at('arrow-words').textContent = `Ring: the hand. Arrow: the force on it, its two components in the picture; ${(100 * LONGEST_ARROW).toFixed(0)} % of the picture's smaller side are ${three(full_n)} N.${scene.ghost ? ' Diamond: the ghost point, which stays outside of the pieces.' : ''}`;
  showValues();
}

async function listDevices() {
  const devices = await folderDevices, broken = devices.filter(({reason}) => reason !== undefined);
  at('device').append(...devices.filter(({reason}) => reason === undefined).map(({index, name}) => new Option(name, index)));
  at('device-words').textContent = ['Its axes, largest rate and limits are used. Built in are sandpaper-1990 (patches) and arm (pieces); your own one is NAME.device.json in this folder.',
    ...broken.map(({name, reason}) => `${name} can't be read: ${reason}`)].join(' ');
}

requestAnimationFrame(draw);
listDevices();
choose();
