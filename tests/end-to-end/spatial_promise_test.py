#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`spatial --max-error` against the band-pass's definition at eight times the rate, and the part that the band-pass
removed as `--explain` reports it."""
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import oaconvolve

import tacto

RATE_HZ, FINER, LOW_HZ, HIGH_HZ = 10000, 8, 15.0, 500.0
STILL_S, WAY_M = 0.4, 60e-3


class Finger:
    """Rests, moves WAY_M at a speed that varies by a fraction `wander`, and rests again; it starts and stops within one
    sample."""

    def __init__(self, random):
        self.speed_mps, self.wander = random.uniform(30e-3, 80e-3), random.uniform(0, 0.3)
        self.turn, self.phase = 2 * np.pi * random.uniform(2, 6), random.uniform(0, 6)
        self.duration_s = WAY_M / self.speed_mps

    def position_m(self, t):
        t = np.clip(t - STILL_S, 0, self.duration_s)
        return self.speed_mps * (t + self.wander * (np.sin(self.turn * t + self.phase) - np.sin(self.phase)) / self.turn)

    def time_s(self, x):
        t = STILL_S + x / self.speed_mps
        for _ in range(50):
            speed = self.speed_mps * (1 + self.wander * np.cos(self.turn * (t - STILL_S) + self.phase))
            t = np.clip(t - (self.position_m(t) - x) / speed, STILL_S, STILL_S + self.duration_s)
        return t


def surface(random, finger):
    """Four lines at frequencies that are 25 to 450 Hz at all speeds of the finger."""
    slow, fast = finger.speed_mps * (1 - finger.wander), finger.speed_mps * (1 + finger.wander)
    lines = [(random.uniform(25 / slow, 450 / fast), random.uniform(0.005, 0.05), random.uniform(0, 6.28)) for _ in range(4)]
    return lambda x: sum(a * np.sin(2 * np.pi * k * x + phase) for k, a, phase in lines)


def beyond_end(values, rate_hz):
    """The extension of an end as in spatial/dsp/record_ends.hpp, from the inside to the outside, and the level that
    remains."""
    padding, baseline = min(int(8 / LOW_HZ * rate_hz), len(values) - 1), int(2 / LOW_HZ * rate_hz)
    slope, level = np.polyfit(np.arange(baseline), values[:baseline], 1)
    k = np.arange(1, padding + 1)
    u = k / (padding + 1)
    mirrored = values[k] - (level + slope * k)
    return level + (mirrored - slope * k) * (1 - u**3 * (10 - 15 * u + 6 * u**2)), level


def low_pass(edge, reach):
    """The ideal kernel with the window of spatial/dsp/band_kernel.hpp."""
    n = np.arange(1, reach + 1)
    u = np.clip((n / reach - 0.3) / 0.7, 0, 1)
    half = np.sin(2 * np.pi * edge * n) / (np.pi * n) * (1 - u**4 * (35 - u * (84 - u * (70 - 20 * u))))
    kernel = np.concatenate([half[::-1], [2 * edge], half])
    return kernel / kernel.sum()


def band_passed(values, rate_hz):
    before, first = beyond_end(values, rate_hz)
    after, last = beyond_end(values[::-1], rate_hz)
    reach = int(200 / LOW_HZ * rate_hz)
    extended = np.concatenate([np.full(reach, first), before[::-1], values, after, np.full(reach, last)]) - first
    kernel = low_pass(HIGH_HZ / rate_hz, reach) - low_pass(LOW_HZ / rate_hz, reach)
    return oaconvolve(extended, kernel, "valid")[len(before) : len(before) + len(values)]


def rms(values):
    return np.sqrt(np.mean(values**2))


def taken_percent(recorded, passed):
    return 100 * np.std(recorded - passed) / rms(passed)


def one_case(seed, asked_percent):
    random = np.random.default_rng(seed)
    finger = Finger(random)
    force = surface(random, finger)
    t = np.arange(int((finger.duration_s + 2 * STILL_S) * RATE_HZ)) / RATE_HZ
    x = finger.position_m(t)
    np.savetxt("touch.csv", np.c_[force(x), 1e6 * x], fmt="%.12g", delimiter=",", header="f,x", comments="")
    tacto.run("import", "touch.csv", "-o", "touch", "--force", "--rate", "10kHz", "--channel", "tangential_force=f*1N",
              "--channel", "position=x*1um")
    done = tacto.run_json("spatial", "touch", "-o", "made", "--force", "--stroke", "1", "--max-error", f"{asked_percent}%", "--explain")
    chosen, stroke = done["chosen"][0], done["textures"][0]
    # The force of a finger whose motion between the samples is known, too; band-passed; read at the texture's samples.
    fine = np.arange((len(t) - 1) * FINER + 1) / (RATE_HZ * FINER)
    exact = band_passed(force(finger.position_m(fine)), RATE_HZ * FINER)
    at, values, side = tacto.texture("made")
    at = at + side["source_origin_m"]
    inside = (at > 1e-3) & (at < WAY_M - 1e-3)
    wanted = CubicSpline(fine, exact)(finger.time_s(at[inside]))
    error = 100 * rms(values[inside] - wanted) / rms(wanted)
    surface_error = 100 * np.std(wanted - force(at[inside])) / rms(wanted)
    print(f"seed {seed}: asked {asked_percent} %, promised {chosen['guaranteed_error_percent']:.4f} %, real {error:.5f} %; the band-pass took {surface_error:.2f} %")
    assert error <= chosen["guaranteed_error_percent"] <= asked_percent, (seed, error, chosen)
    said_is_true(chosen, stroke, t, force(x), exact[::FINER])
    # The error against the surface itself may exceed the request by the part that the band-pass removed; the report has
    # it.
    assert surface_error <= chosen["removed_by_filter_percent"] and f"{chosen['removed_by_filter_percent']:.3g} %" in chosen["error_does_not_include"], chosen


def said_is_true(chosen, stroke, t, recorded, passed):
    first, last = np.searchsorted(t, [stroke["from_s"] - 1e-9, stroke["to_s"] + 1e-9])
    quarter = (last - first) // 4
    for key, frames in (("removed_by_filter_percent", slice(first, last)), ("removed_by_filter_inside_percent", slice(first + quarter, last - quarter))):
        wanted = taken_percent(recorded[frames], passed[frames])
        # The record's filter uses only its samples, the reference also values between them: if the finger starts within
        # one sample, the difference is 1e-4 of the RMS.
        assert abs(chosen[key] - wanted) <= 1e-3 * wanted + 0.01, (key, chosen[key], wanted)


def the_promise_is_kept_behind_the_same_band_pass():
    for seed, asked_percent in ((1, 0.02), (2, 0.1), (3, 1), (4, 0.02)):
        one_case(seed, asked_percent)


if __name__ == "__main__":
    tacto.in_folder(the_promise_is_kept_behind_the_same_band_pass)
