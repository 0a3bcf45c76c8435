// SPDX-License-Identifier: GPL-3.0-or-later
// Sliders for what a texture is: a texture of the folder, stretched or cut to a band; or a computed one.

import {errorText, get} from './answers.js';
import {make} from './library.js';

// Positions of a slider are 0 to STEPS, from `low` to `high` in the slider's unit, which is `times` the unit of its query.
const STEPS = 200;
const KINDS = {
  texture: [
    {query: 'stretch', words: 'Stretch', unit: '×', times: 1, low: 0.5, high: 2, start: 1, logarithmic: true},
    {query: 'low_per_m', words: 'Band from (longest period)', unit: '/mm', times: 1e-3, low: 0.05, high: 20, start: 0.05, logarithmic: true, off: 0.05, period: true},
    {query: 'high_per_m', words: 'Band to (shortest period)', unit: '/mm', times: 1e-3, low: 0.05, high: 20, start: 20, logarithmic: true, off: 20, period: true},
  ],
  grating: [
    {query: 'period_m', words: 'Period', unit: 'mm', times: 1e3, low: 0.2, high: 20, start: 2, logarithmic: true},
    {query: 'depth_m', words: 'Depth', unit: 'µm', times: 1e6, low: 0.5, high: 200, start: 10, logarithmic: true},
    {query: 'duty', words: 'High part', unit: '%', times: 100, low: 10, high: 90, start: 50},
    {query: 'smooth_m', words: 'Filter of the edges', unit: 'mm', times: 1e3, low: 0.05, high: 1, start: 0.1, logarithmic: true},
  ],
  noise: [
    {query: 'period_m', words: 'Coarsest period', unit: 'mm', times: 1e3, low: 0.2, high: 20, start: 2, logarithmic: true},
    {query: 'depth_m', words: 'Depth', unit: 'µm', times: 1e6, low: 0.5, high: 200, start: 20, logarithmic: true},
    {query: 'slope_db', words: 'Slope', unit: 'dB/octave', times: 1, low: -24, high: 0, start: -6},
    {query: 'seed', words: 'Seed', unit: '', times: 1, low: 0, high: 200, start: 1, digits: 0},
  ],
};

const digitsOf = (value, digits) => (digits === undefined ? Number(value.toPrecision(3)) : Math.round(value));

/** The value at a position, in the slider's unit. */
export function valueAt({low, high, logarithmic, digits}, position) {
  const part = position / STEPS;
  return digitsOf(logarithmic ? low * (high / low) ** part : low + part * (high - low), digits);
}

export function positionOf({low, high, logarithmic}, value) {
  return Math.round(STEPS * (logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low)));
}

const isOff = ({off}, value) => off !== undefined && value === off;
const withPeriod = (per_mm) => `${per_mm} /mm (${Number((1 / per_mm).toPrecision(3))} mm)`;

/** "1.3 ×", "off"; a spatial frequency also as its period: "0.5 /mm (2 mm)". */
export function valueWords(slider, value) {
  if (isOff(slider, value)) return 'off';
  return slider.period ? withPeriod(value) : `${value}${slider.unit === '' ? '' : ` ${slider.unit}`}`;
}

/** The query of sliders with their values; empty for a texture as it is. */
export function queryOf(sliders, values, keepSlope) {
  const parts = sliders.map((slider, i) => (isOff(slider, values[i]) || (slider.query === 'stretch' && values[i] === 1) ? null
      : `${slider.query}=${Number((values[i] / slider.times).toPrecision(12))}`)).filter((part) => part !== null);
  return parts.length > 0 && keepSlope && parts[0].startsWith('stretch') ? [...parts, 'keep_slope=1'].join('&') : parts.join('&');
}

/** What the server has made, in words: "stretch 1.3, its period 3 mm, ..." */
export function effectiveWords(shape) {
  const mm = (metres) => `${Number((1e3 * metres).toPrecision(4))} mm`, perMm = (per_m) => withPeriod(Number((1e-3 * per_m).toPrecision(4)));
  const words = {
    factor: (x) => `stretch ${x}`, period_m: (x) => `period ${mm(x)}${shape.factor === undefined ? '' : ' before'}`, low_per_m: (x) => `band from ${perMm(x)}`,
    high_per_m: (x) => `to ${perMm(x)}`, removed_share: (x) => (x > 1e-3 ? `${(100 * x).toPrecision(2)} % of the RMS removed, above ${perMm(shape.removed_above_per_m)}` : ''),
    joint_error: (x) => (x > 0.1 ? `the joint fits poorly: ${(100 * x).toFixed(0)} %` : ''), depth_m: (x) => `depth ${Number((1e6 * x).toPrecision(3))} µm`,
    duty: (x) => `${Number((100 * x).toPrecision(3))} % high`, smooth_m: (x) => `edges filtered by ${mm(x)}`, slope_db: (x) => `${x} dB/octave`,
    octaves: (x) => `${x} octave${x === 1 ? '' : 's'}`, seed: (x) => `seed ${x}`,
  };
  const said = Object.entries(words).map(([name, say]) => (shape[name] === undefined ? '' : say(shape[name]))).filter((text) => text !== '');
  return said.length > 0 ? said.join(', ') : 'as it is';
}

export class Shape {
  /** `element`: an empty fieldset. `changed(index)` gives the texture of this index to the device; it returns a promise. */
  constructor(element, changed) {
    this.changed = changed;
    this.source = null;              // index of the texture
    this.sources = 0;                // how many there have been
    this.made = null;                // what plays: the server's answer
    this.wanted = this.busy = false;
    this.kind = make('select', {id: 'shape-kind'}, ...[['texture', 'the texture'], ['grating', 'a grating (computed)'], ['noise', 'noise (computed)']].map(([value, text]) => new Option(text, value)));
    this.sliders = make('div', {className: 'sliders'});
    this.keep = make('input', {type: 'checkbox', id: 'shape-keep'});
    this.keepRow = make('label', {className: 'check'}, this.keep, ' Keep slopes: stretch the values, too');
    this.inverse = make('select', {id: 'shape-filter'}, ...[['', 'default'], ...['full', 'magnitude', 'gain', 'none'].map((word) => [word, word])].map(([value, text]) => new Option(text, value)));
    this.plays = make('p', {className: 'figures', id: 'shape-plays'});
    this.plays.setAttribute('role', 'status');
    this.saved = make('p', {className: 'hint', id: 'shape-saved'});
    this.saved.setAttribute('role', 'status');
    this.save = make('button', {type: 'button', id: 'shape-save', disabled: true, onclick: () => this.keepFile()}, 'Save as a texture');
    element.append(make('legend', {}, 'Shape'), make('label', {}, 'Of ', this.kind), this.sliders, this.keepRow, make('label', {}, 'Inverse filter of the transducer ', this.inverse),
                   make('div', {className: 'row'}, make('button', {type: 'button', onclick: () => { this.reset(); this.apply(); }}, 'Reset'), this.save), this.plays, this.saved);
    this.kind.addEventListener('input', () => {
      this.reset();
      this.apply();
    });
    for (const part of [this.sliders, this.keep, this.inverse]) part.addEventListener('input', () => this.apply());
    this.reset();
  }

  /** Of the transducer: a word of the server, or ''. */
  get filter() { return this.inverse.value; }

  /** The texture that is shaped from now on; its sliders are reset. */
  of(index) {
    this.source = index;
    ++this.sources;
    this.made = null;
    this.kind.value = 'texture';
    this.reset();
  }

  reset() {
    const kind = KINDS[this.kind.value];
    this.sliders.replaceChildren(...kind.map((slider) => {
      const range = make('input', {type: 'range', id: `shape-${slider.query}`, min: 0, max: STEPS, step: 1}), value = make('output', {});
      range.value = positionOf(slider, slider.start);
      return make('label', {}, `${slider.words} `, make('span', {}, range, ' ', value));
    }));
    this.keep.checked = false;
    this.keep.disabled = this.keepRow.hidden = this.kind.value !== 'texture';
    this.values = kind.map(({start}) => start);
    this.show();
  }

  read() {
    this.values = KINDS[this.kind.value].map((slider, i) => {
      const {value} = this.sliders.children[i].querySelector('input');
      return Number(value) === positionOf(slider, slider.start) ? slider.start : valueAt(slider, Number(value));
    });
  }

  show() {
    for (const [i, slider] of KINDS[this.kind.value].entries()) {
      const label = this.sliders.children[i], words = valueWords(slider, this.values[i]);
      label.querySelector('output').textContent = words;
      label.querySelector('input').setAttribute('aria-valuetext', words);
    }
    this.save.disabled = this.made?.query === undefined;
    if (this.made !== null) this.plays.textContent = `Plays: ${effectiveWords(this.made)}${this.busy ? '; the next one is on its way' : ''}`;
    else this.plays.textContent = 'The sliders act at once.';
  }

  /** Makes what the sliders ask for: one at a time, the newest next. */
  async apply() {
    this.read();
    this.wanted = true;
    this.saved.textContent = '';
    if (this.busy) return this.show();
    this.busy = true;
    while (this.wanted) {
      this.wanted = false;
      this.show();
      const source = this.sources;
      try {
        const made = await this.make();
        if (source === this.sources) await this.changed(made.index);
        if (source === this.sources) this.made = made;
      } catch (error) {
        this.saved.textContent = `Not changed: ${error.message}`;
      }
    }
    this.busy = false;
    this.show();
  }

  async make() {
    const kind = this.kind.value, query = queryOf(KINDS[kind], this.values, this.keep.checked);
    if (kind === 'texture' && this.source === null) throw new Error('choose a texture first');
    if (kind === 'texture' && query === '') return {index: this.source};
    return {...await (await get(`shape/${kind === 'texture' ? this.source : kind}?${query}`)).json(), query};
  }

  keepFile() {
    const socket = new WebSocket(`ws://${location.host}/jobs`);
    socket.onopen = () => socket.send(JSON.stringify({request: 'save', texture: this.made.index}));
    socket.onmessage = ({data}) => {
      const answer = JSON.parse(data);
      if (answer.ok === undefined) return;  // the list of jobs
      this.saved.textContent = answer.ok ? `Saved: ${answer.saved}` : `Not saved: ${errorText(answer.error)}`;
      socket.close();
    };
    socket.onerror = () => { this.saved.textContent = 'Not saved: tactograph live does not answer'; };
  }
}
