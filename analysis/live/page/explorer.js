// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a spectrogram: its cells under a cross-hair, zoom, formants, files.

import {get} from './answers.js';
import {Axis, Cells, cellWords, exportQuery, frequencyMarks, marks, paint, powers} from './cells.js';
import {css, palette, sized} from './strip.js';

const LEFT = 62, RIGHT = 10, TOP = 8, BOTTOM = 44;  // around the cells, CSS pixels
const LEAST_CELLS = 2;          // of a view, along each axis
const LEAST_DRAG = 5;           // CSS pixels; less is a click
const WHEEL = 1.25;

const at = (id) => document.getElementById(id);
const plot = at('plot');
let shown = null;               // the spectrogram: Cells
let positions = null, frequencies = null;  // the view: axes
let cross = null;               // the cell under the cross-hair
let dragged = null;             // {from, to}: places on the plot
let picture = null;             // of the cells: kept, because a new one for each frame would cost more than its pixels
let heatDrawn = false, overDrawn = false, choices = 0;

function put(id, text) { if (at(id).textContent !== text) at(id).textContent = text; }
function say(text) { put('message', text); }

// The spectrogram.
async function choose(index) {
  const mine = ++choices;
  say('');
  const about = await (await get(`spectrogram/${index}`)).json();
  const parts = ['cells', 'known'].map(async (part) => new Float32Array(await (await get(`${part}/${about.made}`)).arrayBuffer()));
  const [cells, known] = await Promise.all(parts);
  if (mine !== choices) return;  // another one has been chosen since
  shown = new Cells(about, cells, known);
  at('brightest').value = about.high_db;
  at('range').value = about.high_db - about.low_db;
  if (about.speed_mps > 0) at('speed').value = Number((1e3 * about.speed_mps).toPrecision(3));
  put('title', `${about.name}${about.simulated ? ' (simulated)' : ''}`);
  put('method', `Blackman window ${mm(about.window_m)}, hop ${mm(about.hop_m)}, ${about.rows} windows of ${about.bins} frequencies; lines closer than ${perMm(about.resolution_per_m)} are not separated.`);
  cross = shown.at((about.first_position_m + about.last_position_m) / 2, Math.sqrt(about.lowest_per_m * shown.highest_per_m));
  listFormants();
  showAll();
}

const mm = (metres) => `${Number((1e3 * metres).toPrecision(4))} mm`;
const perMm = (per_m) => `${Number((1e-3 * per_m).toPrecision(4))} /mm`;

function listFormants() {
  put('formants-title', `Formants (${shown.formants.length})`);
  const row = (cells, kind) => {
    const line = document.createElement('tr');
    line.append(...cells.map((text) => Object.assign(document.createElement(kind), {textContent: text, ...(kind === 'th' ? {scope: 'col'} : {})})));
    return line;
  };
  at('formant-rows').replaceChildren(row(['from (mm)', 'to (mm)', 'frequency (1/mm)', 'period (mm)', 'level (dB)', 'prominence (dB)'], 'th'),
    ...shown.formants.map(({from_m, to_m, frequency_per_m, level_db, prominence_db}) =>
      row([(1e3 * from_m).toFixed(2), (1e3 * to_m).toFixed(2), (1e-3 * frequency_per_m).toFixed(4), (1e3 / frequency_per_m).toFixed(3), level_db.toFixed(1), prominence_db.toFixed(1)], 'td')));
}

// The view.
const logarithmic = () => at('spacing').value === 'log';
const positionLimits = () => new Axis(shown.start_m, shown.end_m);
const frequencyLimits = () => new Axis(logarithmic() ? shown.frequency_step_per_m : 0, shown.highest_per_m);

function showAll() {
  positions = positionLimits();
  frequencies = new Axis(logarithmic() ? shown.lowest_per_m : 0, shown.highest_per_m, logarithmic());
  showView();
}

function showView() {
  for (const [id, value] of [['from', 1e3 * positions.low], ['to', 1e3 * positions.high], ['low', 1e-3 * frequencies.low], ['high', 1e-3 * frequencies.high]])
    if (document.activeElement !== at(id)) at(id).value = Number(value.toPrecision(6));
  heatDrawn = overDrawn = false;
}

/** A view of at least some cells; else it stays. */
function look(nextPositions, nextFrequencies) {
  const enough = nextPositions.high - nextPositions.low >= LEAST_CELLS * shown.hop_m &&
      nextFrequencies.high - nextFrequencies.low >= LEAST_CELLS * shown.frequency_step_per_m;
  if (!enough) return;
  [positions, frequencies] = [nextPositions, nextFrequencies];
  showView();
}

function zoom(x, y, place = {x: 0.5, y: 0.5}) {
  if (shown !== null) look(positions.zoomed(x, place.x, positionLimits()), frequencies.zoomed(y, place.y, frequencyLimits()));
}

function typed() {
  const number = (id) => (at(id).value === '' ? NaN : 1e-3 * Number(at(id).value));
  const from = number('from'), to = number('to'), low = 1e6 * number('low'), high = 1e6 * number('high');
  if (shown !== null && to > from && high > low)
    look(positions.within(from, to, positionLimits()), frequencies.within(low, high, frequencyLimits()));
}

// The cross-hair.
function showCell() {
  if (cross !== null) put('cell', cellWords(shown, cross, speed_mps()));
  overDrawn = false;
}

const speed_mps = () => 1e-3 * (Number(at('speed').value) || 50);

function move(rows, bins) {
  const kept = (value, most) => Math.max(0, Math.min(most - 1, value));
  cross = {row: kept(cross.row + rows, shown.rows), bin: kept(cross.bin + bins, shown.bins)};
  const [x, y] = [positions.showing(shown.position_m(cross.row), positionLimits()),
                  frequencies.showing(Math.max(shown.frequency_per_m(cross.bin), frequencyLimits().low), frequencyLimits())];
  if (x !== positions || y !== frequencies) look(x, y);
  showCell();
}

/** The place of a pointer on the cells: x and y from 0 to 1, y upwards. */
function placeOf(event) {
  const box = plot.getBoundingClientRect(), part = (value, size) => Math.max(0, Math.min(1, value / size));
  return {x: part(event.clientX - box.left - LEFT, box.width - LEFT - RIGHT), y: 1 - part(event.clientY - box.top - TOP, box.height - TOP - BOTTOM)};
}

plot.addEventListener('pointermove', (event) => {
  if (shown === null) return;
  const place = placeOf(event);
  if (dragged !== null) dragged.to = place;
  cross = shown.at(positions.value(place.x), frequencies.value(place.y));
  showCell();
});
plot.addEventListener('pointerdown', (event) => {
  if (shown === null || event.button !== 0) return;
  plot.setPointerCapture(event.pointerId);
  dragged = {from: placeOf(event), to: placeOf(event)};
});
plot.addEventListener('pointercancel', () => { dragged = null; overDrawn = false; });
plot.addEventListener('pointerup', () => {
  if (dragged === null) return;
  const {from, to} = dragged, size = {x: plot.clientWidth, y: plot.clientHeight};
  dragged = null;
  overDrawn = false;
  if (['x', 'y'].some((side) => Math.abs(to[side] - from[side]) * size[side] < LEAST_DRAG)) return;
  const [left, right] = [from.x, to.x].sort((a, b) => a - b), [low, high] = [from.y, to.y].sort((a, b) => a - b);
  look(positions.within(positions.value(left), positions.value(right), positionLimits()),
       frequencies.within(frequencies.value(low), frequencies.value(high), frequencyLimits()));
});
plot.addEventListener('dblclick', () => { if (shown !== null) showAll(); });
plot.addEventListener('wheel', (event) => {
  if (shown === null || (document.activeElement !== plot && !event.ctrlKey)) return;  // else the page scrolls
  event.preventDefault();
  const times = event.deltaY > 0 ? WHEEL : 1 / WHEEL;
  zoom(event.altKey ? 1 : times, event.shiftKey ? 1 : times, placeOf(event));
}, {passive: false});

const STEPS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1]};
plot.addEventListener('keydown', (event) => {
  if (shown === null || event.ctrlKey || event.altKey || event.metaKey) return;
  const step = STEPS[event.key], times = event.shiftKey ? 10 : 1;
  const around = {x: positions.place(shown.position_m(cross.row)), y: frequencies.place(Math.max(shown.frequency_per_m(cross.bin), frequencies.low))};
  if (step !== undefined) move(times * step[0], times * step[1]);
  else if (event.key === '+' || event.key === '=') zoom(0.5, 0.5, around);
  else if (event.key === '-') zoom(2, 2, around);
  else if (event.key === '0') showAll();
  else return;
  event.preventDefault();
});

// Controls.
for (const id of ['from', 'to', 'low', 'high']) {
  at(id).addEventListener('input', typed);
  at(id).addEventListener('blur', () => { if (shown !== null) showView(); });  // what holds
}
at('zooms').addEventListener('click', ({target}) => {
  const {x, y} = target.dataset;
  if (x !== undefined || y !== undefined) zoom(Number(x ?? 1), Number(y ?? 1));
});
at('whole').addEventListener('click', () => { if (shown !== null) showAll(); });
at('spacing').addEventListener('input', () => {
  if (shown === null) return;
  const low = logarithmic() ? Math.max(frequencies.low, shown.frequency_step_per_m) : frequencies.low;
  frequencies = new Axis(low, frequencies.high, logarithmic());
  showView();
});
for (const id of ['unit', 'speed']) at(id).addEventListener('input', () => { heatDrawn = false; showCell(); });
for (const id of ['colours', 'brightest', 'range', 'formants']) at(id).addEventListener('input', () => { heatDrawn = overDrawn = false; });
at('controls').addEventListener('submit', (event) => event.preventDefault());

at('texture').addEventListener('input', () => { location.hash = at('texture').value; });
addEventListener('hashchange', () => fromAddress().catch((error) => say(error.message)));

at('exports').addEventListener('click', async ({target}) => {
  const {form} = target.dataset;
  if (form === undefined || shown === null) return;
  const selection = at('part').value === 'view', range_db = Number(at('range').value);
  const query = exportQuery(shown, positions, frequencies, {selection, range_db, formants: at('formants').checked && (form === 'png' || form === 'svg')});
  put('exported', `Making ${form} …`);
  try {
    const file = URL.createObjectURL(await (await get(`export/${shown.made}/${form}?${query}`)).blob());
    const link = Object.assign(document.createElement('a'), {href: file, download: `${shown.name}.${form}`});
    link.click();
    setTimeout(() => URL.revokeObjectURL(file), 60000);
    put('exported', `${shown.name}.${form}: ${selection ? 'the view' : 'all'}`);
  } catch (error) {
    put('exported', `Not made: ${error.message}`);
  }
});

// Pictures.
function drawHeat() {
  const {ink, width, height, ratio} = sized(at('heat')), inner = innerOf(width, height, ratio);
  const range_db = Math.max(1, Number(at('range').value) || 60), high_db = Number(at('brightest').value);
  const levels = {high_db, low_db: high_db - range_db};
  if (picture?.width !== inner.width || picture.height !== inner.height) picture = ink.createImageData(inner.width, inner.height);
  paint(shown, positions, frequencies, levels, palette(at('colours').value), inner.width, inner.height, new Uint32Array(picture.data.buffer));
  ink.clearRect(0, 0, width, height);
  ink.putImageData(picture, inner.x, inner.y);
  drawAxes(ink, inner, ratio);
  put('scale-words', `Colours from ${levels.low_db} to ${levels.high_db} dB re ${powers(shown.level_unit)}, dark to light; a pixel shows the largest of its cells. ` +
      `At the ends, without colour, a window of ${mm(shown.window_m)} would reach beyond the texture.` + (shown.known.length > 0 ? ' Dashed lines: limits of the valid band; beyond them nothing was measured.' : ''));
}

function innerOf(width, height, ratio) {
  const [x, y] = [LEFT, TOP].map((edge) => Math.round(edge * ratio));
  return {x, y, width: Math.max(1, width - x - Math.round(RIGHT * ratio)), height: Math.max(1, height - y - Math.round(BOTTOM * ratio))};
}

function drawAxes(ink, inner, ratio) {
  const unit = at('unit').value, most = (size, each) => Math.max(2, Math.round(size / (each * ratio)));
  ink.fillStyle = css('--text');
  ink.strokeStyle = css('--line');
  ink.lineWidth = ratio;
  ink.font = `${12 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
  ink.strokeRect(inner.x - 0.5, inner.y - 0.5, inner.width + 1, inner.height + 1);
  const tick = (x, y, dx, dy) => {
    ink.beginPath();
    ink.moveTo(x, y);
    ink.lineTo(x + dx * ratio, y + dy * ratio);
    ink.stroke();
  };
  ink.textAlign = 'center';
  ink.textBaseline = 'top';
  const mmAxis = new Axis(1e3 * positions.low, 1e3 * positions.high);
  for (const value of marks(mmAxis, most(inner.width, 80))) {
    const x = inner.x + mmAxis.place(value) * inner.width;
    tick(x, inner.y + inner.height, 0, 5);
    ink.fillText(String(value), x, inner.y + inner.height + 8 * ratio);
  }
  ink.fillText('position (mm)', inner.x + inner.width / 2, inner.y + inner.height + 25 * ratio);
  ink.textAlign = 'right';
  ink.textBaseline = 'middle';
  for (const [place, text] of frequencyMarks(frequencies, most(inner.height, 40), unit, speed_mps())) {
    const y = inner.y + (1 - place) * inner.height;
    tick(inner.x, y, -5, 0);
    ink.fillText(text, inner.x - 8 * ratio, y);
  }
  ink.save();
  ink.translate(12 * ratio, inner.y + inner.height / 2);
  ink.rotate(-Math.PI / 2);
  ink.textAlign = 'center';
  ink.fillText({'1/mm': 'spatial frequency (1/mm)', mm: 'period (mm)', Hz: `frequency at ${1e3 * speed_mps()} mm/s (Hz)`}[unit], 0, 0);
  ink.restore();
}

// A line in black with a white edge is seen on all colours.
function line(ink, ratio, points, dashes = []) {
  for (const [colour, width] of [['#000', 3.5], ['#fff', 1.5]]) {
    ink.strokeStyle = colour;
    ink.lineWidth = width * ratio;
    ink.setLineDash(dashes.map((dash) => dash * ratio));
    ink.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? ink.moveTo(x, y) : ink.lineTo(x, y)));
    ink.stroke();
  }
  ink.setLineDash([]);
}

function drawOver() {
  const {ink, width, height, ratio} = sized(at('over')), inner = innerOf(width, height, ratio);
  const x = (position_m) => inner.x + positions.place(position_m) * inner.width;
  const y = (per_m) => inner.y + (1 - frequencies.place(Math.max(per_m, 1e-3))) * inner.height;
  ink.clearRect(0, 0, width, height);
  ink.save();
  ink.beginPath();
  ink.rect(inner.x, inner.y, inner.width, inner.height);
  ink.clip();
  for (const side of [0, 1])
    if (shown.known.length > 0) line(ink, ratio, Array.from({length: shown.rows}, (_, row) => [x(shown.position_m(row)), y(shown.known[2 * row + side])]), [6, 4]);
  if (at('formants').checked)
    for (const {track} of shown.formants) line(ink, ratio, track.map(({position_m, frequency_per_m}) => [x(position_m), y(frequency_per_m)]));
  const [crossX, crossY] = [x(shown.position_m(cross.row)), y(shown.frequency_per_m(cross.bin))];
  line(ink, ratio, [[crossX, inner.y], [crossX, inner.y + inner.height]], [2, 2]);
  line(ink, ratio, [[inner.x, crossY], [inner.x + inner.width, crossY]], [2, 2]);
  if (dragged !== null) {
    const [left, top, right, bottom] = [inner.x + dragged.from.x * inner.width, inner.y + (1 - dragged.from.y) * inner.height,
                                        inner.x + dragged.to.x * inner.width, inner.y + (1 - dragged.to.y) * inner.height];
    line(ink, ratio, [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]]);
  }
  ink.restore();
}

function draw() {
  requestAnimationFrame(draw);
  if (shown === null) return;
  if (!heatDrawn) drawHeat();
  if (!overDrawn) {
    drawOver();
    showCell();
  }
  heatDrawn = overDrawn = true;
}

new ResizeObserver(() => { heatDrawn = overDrawn = false; }).observe(plot);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { heatDrawn = false; });

async function fromAddress() {
  const index = location.hash.slice(1) || at('texture').options[0]?.value;
  if (index === undefined) return put('cell', 'This folder has no textures. Make them with tactograph spatial, or see tactograph demo.');
  at('texture').value = index;
  if (at('texture').value !== index) throw new Error('there is no such texture in this folder');
  await choose(index);
}

async function begin() {
  const {textures} = await (await get('textures')).json();
  at('texture').replaceChildren(...textures.filter(({reason}) => reason === undefined).map(({index, name}) => new Option(name, index)));
  requestAnimationFrame(draw);
  await fromAddress();
}

begin().catch((error) => say(error.message));
