// SPDX-License-Identifier: GPL-3.0-or-later
// The lists of the folder's textures and recordings: searched, sorted, with small pictures.

import {drawMap} from './strip.js';

const byName = (a, b) => a.name.localeCompare(b.name, undefined, {numeric: true});
const longest = (row) => row.length_m ?? row.duration_s;
const ORDERS = {
  name: byName,
  length: (a, b) => longest(b) - longest(a) || byName(a, b),
  strength: (a, b) => (a.unit ?? '').localeCompare(b.unit ?? '') || (b.rms ?? 0) - (a.rms ?? 0) || byName(a, b),
  newest: (a, b) => b.changed_s - a.changed_s || byName(a, b),
};

/** The rows whose name or surface contains each word of `search`, in order; those that can't be read come last. */
export function arrange(rows, search, order) {
  const words = search.toLowerCase().split(/\s+/).filter((word) => word !== '');
  const found = rows.filter(({name, surface}) => words.every((word) => `${name} ${surface ?? ''}`.toLowerCase().includes(word)));
  const readable = (row) => row.reason === undefined;
  return [...found.filter(readable).sort(ORDERS[order]), ...found.filter((row) => !readable(row)).sort(byName)];
}

/** "5 textures", "2 of 5 textures, 1 can't be read". */
export function countWords(shown, all) {
  const broken = all.filter((row) => row.reason !== undefined).length;
  return `${shown.length < all.length ? `${shown.length} of ` : ''}${all.length} texture${all.length === 1 ? '' : 's'}` +
      (broken > 0 ? `, ${broken} can't be read` : '');
}

const PREFIXES = [['', 1], ['m', 1e3], ['µ', 1e6], ['n', 1e9]];
/** A value in SI with a prefix: "12.3 mN". */
export function withPrefix(value, unit) {
  if (value === 0 || !/^[A-Za-z]$/.test(unit)) return `${value.toPrecision(3)}${unit === '1' ? '' : ` ${unit}`}`;
  const [prefix, factor] = PREFIXES.find(([, one]) => Math.abs(value) * one >= 1) ?? PREFIXES.at(-1);
  return `${(value * factor).toPrecision(3)} ${prefix}${unit}`;
}

/** "4.0 s, 2 kHz, tangential_force, position, 3 strokes, surface oak". */
export function recordingWords({duration_s, sample_rate_hz, channels, strokes, missing_frames, surface}) {
  return `${duration_s.toPrecision(3)} s, ${Number((sample_rate_hz / 1e3).toPrecision(4))} kHz, ${channels.join(', ')}, ` +
      `${strokes} stroke${strokes === 1 ? '' : 's'}${missing_frames > 0 ? `, ${missing_frames} frames missing` : ''}${surface ? `, surface ${surface}` : ''}`;
}

/** An element with its properties and what is in it. */
export function make(tag, members, ...parts) {
  const element = Object.assign(document.createElement(tag), members);
  element.append(...parts);
  return element;
}

export class Library {
  /** `list`, `recordings`, `search`, `order`, `count`, `colours`: elements of the page. `choose(row)` and `chooseB(row)` are called for
   * a texture's buttons. `get(path)` fetches. */
  constructor({list, recordings, search, order, count, colours, choose, chooseB, get}) {
    Object.assign(this, {list, recordings, search, order, count, colours, choose, chooseB, get});
    this.rows = [];
    this.recorded = [];
    this.chosen = {A: null, B: null};  // their indices
    this.pictures = new Map();         // promises of thumbnails, by index
    this.seen = new IntersectionObserver((entries) => {
      for (const {isIntersecting, target} of entries) if (isIntersecting) this.draw(target);
    });
    for (const control of [search, order]) control.addEventListener('input', () => this.show());
    colours.addEventListener('input', () => this.show());
  }

  /** Fails with the server's error. */
  async read() {
    const {textures, recordings, reason} = await (await this.get('textures')).json();
    this.rows = textures;
    this.recorded = recordings;
    this.reason = reason;
    this.pictures.clear();
    this.show();
  }

  /** Marks the textures that are A and B. */
  mark(chosen) {
    this.chosen = chosen;
    for (const item of this.list.children) this.markItem(item);
  }

  markItem(item) {
    const index = Number(item.dataset.index), [a, b] = item.querySelectorAll('button');
    if (a === undefined) return;
    if (index === this.chosen.A) a.setAttribute('aria-current', 'true');
    else a.removeAttribute('aria-current');
    b.setAttribute('aria-pressed', String(index === this.chosen.B));
  }

  show() {
    const shown = arrange(this.rows, this.search.value, this.order.value);
    this.seen.disconnect();
    this.list.replaceChildren(...shown.map((row) => this.item(row)));
    const recorded = arrange(this.recorded, this.search.value, this.order.value);
    this.recordings.replaceChildren(...recorded.length > 0 ? recorded.map((row) => this.item(row)) : [make('li', {}, make('p', {}, 'none'))]);
    this.count.textContent = this.reason !== undefined ? `The folder can't be read: ${this.reason}`
        : this.rows.length > 0 ? countWords(shown, this.rows)
        : 'This folder has no textures. Make them with tactograph spatial, or see tactograph demo.';
  }

  item(row) {
    const item = make('li', {});
    item.dataset.index = row.index;
    if (row.reason !== undefined) {
      item.append(make('p', {}, `${row.name} can't be read: ${row.reason}`));
      return item;
    }
    const picture = make('canvas', {ariaHidden: 'true'});
    this.seen.observe(item);
    const jobs = make('a', {href: `jobs.html#${row.index}`, ariaLabel: `Jobs with ${row.name}`}, 'Jobs');
    if (row.duration_s !== undefined) {
      item.append(row.name, make('small', {}, recordingWords(row)), picture, jobs);
      return item;
    }
    const words = `${(1e3 * row.length_m).toFixed(1)} mm, RMS ${withPrefix(row.rms, row.unit)}${row.surface ? `, surface ${row.surface}` : ''}`;
    const a = make('button', {type: 'button', className: 'texture', onclick: () => this.choose(row)}, row.name, make('small', {}, words), picture);
    const b = make('button', {type: 'button', ariaLabel: `Compare with ${row.name} as B`, onclick: () => this.chooseB(row)}, 'as B');
    const look = make('a', {href: `explorer.html#${row.index}`, ariaLabel: `Spectrogram of ${row.name}`}, 'Spectrogram');
    item.append(a, make('div', {className: 'row'}, b, look, jobs));
    this.markItem(item);
    return item;
  }

  async draw(item) {
    const index = Number(item.dataset.index), row = [...this.rows, ...this.recorded].find((one) => one.index === index), canvas = item.querySelector('canvas');
    if (canvas === null) return;
    if (!this.pictures.has(index)) this.pictures.set(index, this.get(`thumbnail/${index}`).then((answer) => answer.arrayBuffer()));
    const map = await this.pictures.get(index).catch(() => null);
    if (map === null) return;  // it has changed since the list was read
    drawMap(canvas, {map: new Float32Array(map), start_m: 0, length_m: longest(row)}, {from_m: 0, to_m: longest(row)}, this.colours.value);
  }
}
