// SPDX-License-Identifier: GPL-3.0-or-later
// Where the finger is in each tick: from a pointer, keys, or a stroke at an exact speed.
//
// A pointer is reported every 8 to 17 ms in whole pixels. Used as it comes, each report would be a jump of the
// encoder. So the reports are interpolated linearly, late by as much as they need to be there in time, and then
// followed by a critically damped system of 40 Hz. Keys and strokes move exactly, in every tick.

import {RATE_HZ} from './core.js';

export const FOLLOWER_HZ = 40;
export const FASTEST_MPS = 1;       // the follower's limit; the encoder's is 2 m/s
const OMEGA = 2 * Math.PI * FOLLOWER_HZ;
const FIRST_LAG_S = 0.02;           // 1.2 periods of 60 Hz
const SPARE_S = 0.002;              // reports that are there earlier than this before their use: the lag shrinks
const HURRY = 1.02;                 // by this

export class Finger {
  /** @param {number} [rate_hz] of the ticks */
  constructor(rate_hz = RATE_HZ) {
    this.period_s = 1 / rate_hz;
    this.touches = false;
    this.lands = false;             // it touches a place to which it did not slide; set back by the engine
    this.place_m = 0;
    this.speed_mps = 0;
    this.mode = 'up';               // 'pointer', 'moving', 'up'
    this.reports = [];              // {time_s, place_m}, of the pointer, by its clock
    this.cursor_s = 0;              // the present, by the pointer's clock
    this.spare_s = 0;
    this.from = {time_s: 0, place_m: 0};
    this.velocity_mps = 0;
    this.end_m = 0;
  }

  /** The pointer touches: from here on its reports are followed. */
  down(time_s, place_m) {
    this.land(place_m);
    this.approach(time_s, place_m);
  }

  /** The same for a hand that is somewhere else: it goes there from where it is. */
  approach(time_s, place_m) {
    this.mode = 'pointer';
    this.reports = [];
    this.from = {time_s, place_m};
    this.cursor_s = time_s - FIRST_LAG_S;
    this.spare_s = FIRST_LAG_S;
    this.report(time_s, place_m);
  }

  /** Reports in the order of their times; others are ignored. Repeat the last place while the pointer rests. */
  report(time_s, place_m) {
    const last = this.reports.at(-1) ?? this.from;
    if (this.mode !== 'pointer' || (this.reports.length > 0 && time_s <= last.time_s)) return;
    this.reports.push({time_s, place_m});
  }

  land(place_m) {
    this.lift();
    this.touches = this.lands = true;
    this.place_m = place_m;
  }

  /** From here at an exact speed (m/s, with its sign) to an end; it lifts there if `lifts`. */
  move(velocity_mps, end_m, lifts) {
    this.mode = 'moving';
    this.velocity_mps = velocity_mps;
    this.end_m = end_m;
    this.lifts = lifts;
  }

  /** A stroke: the finger lifts, lands at `from_m`, and moves. */
  stroke(velocity_mps, from_m, end_m) {
    this.land(from_m);
    this.move(velocity_mps, end_m, true);
  }

  /** Keys: rest where the finger is, touching. */
  rest() {
    this.mode = 'moving';
    this.velocity_mps = 0;
    this.speed_mps = 0;
  }

  lift() {
    this.mode = 'up';
    this.touches = false;
    this.speed_mps = 0;
    this.reports = [];
  }

  /** One tick: moves place_m. */
  tick() {
    if (this.mode === 'pointer') this.follow();
    if (this.mode === 'moving') this.step();
  }

  step() {
    const next_m = this.place_m + this.velocity_mps * this.period_s;
    const arrives = this.velocity_mps !== 0 && (this.end_m - next_m) * this.velocity_mps <= 0;
    this.place_m = arrives ? this.end_m : next_m;
    this.speed_mps = arrives ? 0 : this.velocity_mps;
    if (!arrives) return;
    this.velocity_mps = 0;
    if (this.lifts) this.lift();
  }

  // The cursor waits for reports that are late; it gains on them while they are early.
  follow() {
    const last_s = this.reports.length > 0 ? this.reports.at(-1).time_s : this.from.time_s;
    const early_s = last_s - this.cursor_s;
    this.spare_s = Math.min(early_s, this.spare_s + this.period_s / 20);
    this.cursor_s = Math.min(last_s, this.cursor_s + this.period_s * (this.spare_s > SPARE_S ? HURRY : 1));
    while (this.reports.length > 0 && this.reports[0].time_s <= this.cursor_s) this.from = this.reports.shift();
    const target_m = this.interpolated();
    const push = OMEGA * OMEGA * (target_m - this.place_m) - 2 * OMEGA * this.speed_mps;
    const speed = this.speed_mps + push * this.period_s;
    this.speed_mps = Math.max(-FASTEST_MPS, Math.min(FASTEST_MPS, speed));
    this.place_m += this.speed_mps * this.period_s;
  }

  interpolated() {
    const next = this.reports[0];
    if (next === undefined || this.cursor_s <= this.from.time_s) return this.from.place_m;
    const part = (this.cursor_s - this.from.time_s) / (next.time_s - this.from.time_s);
    return this.from.place_m + part * (next.place_m - this.from.place_m);
  }
}
