// SPDX-License-Identifier: GPL-3.0-or-later
// Two textures, A and B: with which gain each plays, and how that is said.

/** @typedef {{figures: {name: string, gain_m_per_n: number, rms: number, tray_peak_m: number, displacement_limit_m: number}}} Side */

/** The gain (m/N) of each side at level 1: its own; with `equal`, B's displacement has the RMS of A's.
 * @param {{A: Side | null, B: Side | null}} sides */
export function gainsOf({A, B}, equal) {
  const gains = {A: A?.figures.gain_m_per_n, B: B?.figures.gain_m_per_n};
  if (equal && A && B && A.figures.rms > 0 && B.figures.rms > 0)
    gains.B = Math.sign(gains.B) * Math.abs(gains.A) * A.figures.rms / B.figures.rms;
  return gains;
}

const sidesOf = (sides) => ['A', 'B'].filter((name) => sides[name] !== null);

/** The largest level, at most `most`, at which no side moves the tray beyond its limit; in hundredths. */
export function largestLevel(sides, gains, most) {
  const levels = sidesOf(sides).map((name) => {
    const {displacement_limit_m, tray_peak_m, gain_m_per_n} = sides[name].figures;
    return displacement_limit_m / (tray_peak_m * Math.abs(gains[name] / gain_m_per_n));
  });
  return Math.floor(100 * Math.min(most, ...levels)) / 100;
}

/** Full scale of the sound and edge of the trace (m), the same for both sides. */
export function fullScale(sides, gains) {
  const peaks = sidesOf(sides).map((name) => sides[name].figures.tray_peak_m * Math.abs(gains[name] / sides[name].figures.gain_m_per_n));
  return Math.min(Math.max(...peaks) || Infinity, ...sidesOf(sides).map((name) => sides[name].figures.displacement_limit_m));
}

/** Both gains, what equal RMS has changed, and both RMS. */
export function compareWords(sides, gains, equal) {
  if (sides.B === null) return 'Press “as B” at a texture of the list to compare it with the chosen one, which is A.';
  const side = (name) => {
    const {figures} = sides[name], times = gains[name] / figures.gain_m_per_n, db = 20 * Math.log10(Math.abs(times));
    const changed = Math.abs(times - 1) < 5e-4 ? 'its default' : `${times.toFixed(3)} times its default (${db > 0 ? '+' : ''}${db.toFixed(1)} dB)`;
    return `${name}: ${figures.name}, ${(1e3 * gains[name]).toFixed(3)} mm/N, ${changed}, RMS ${(1e6 * Math.abs(gains[name]) * figures.rms).toFixed(1)} µm`;
  };
  const refused = equal && !(sides.A.figures.rms > 0 && sides.B.figures.rms > 0) ? ' A texture without any force has no equal RMS.' : '';
  return `${side('A')}. ${side('B')}. RMS of the displacement that is asked of the tray at level 1, over the whole texture.${refused}`;
}
