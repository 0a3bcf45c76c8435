// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the scripts that run the page's devices under random programs: numbers that a seed repeats, and a check.

/** {random(): from 0 to below 1, between(least, most)}; mulberry32 (T. Ettinger). */
export function drawsOf(seed) {
  let state = Number(seed);
  function random() {
    state = (state + 0x6D2B79F5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  }
  return {random, between: (least, most) => least + random() * (most - least)};
}

/** Ends the script with code 1 if it does not hold. */
export function check(holds, what) {
  if (holds) return;
  console.error(`not so: ${what}`);
  process.exit(1);
}
