#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A known force through the emulated transducer, and back to newtons by `spatial`.

The force is defined here as in known_force.hpp, the sensor as in Wiertlewski 2011 (Table I, scipy.signal); no code of
the emulated device or of the equaliser is used. Complex amplitudes of the tones are fitted by least squares."""
import json

import numpy as np
import soundfile
from scipy import interpolate, signal

import tacto
from measured import measured

RATE_HZ = 10e3
STROKE = "strokes=1,length=500mm"  # 10 s at 50 mm/s: far from the record's ends, where the band-pass lacks samples


def multisine(low_hz, high_hz, tones=16):
    """Frequencies and phases of force=multisine."""
    k = np.arange(tones)
    return np.floor(low_hz * (high_hz / low_hz) ** (k / (tones - 1)) * 1e6 + 0.5) / 1e6, np.pi * k**2 / tones


def sensor_v_per_n(frequency_hz):
    """H_s of Table I, scaled to 26 V/N at 100 Hz."""
    delta, k_p, k_r, m, b_r, c_p, v_max, g_s, r_s = 82.35e-6, 76.47e3, 4.05e3, 6.8e-3, 4.49, 818e-9, 100, 100, 12e3
    beta = delta / (2 * v_max)
    system = signal.TransferFunction([-2 * g_s * r_s * k_p * beta, 0],
                                     np.polymul([2 * r_s * c_p, 1], [m, b_r, k_r + k_p]))
    at = lambda f: signal.freqresp(system, 2 * np.pi * np.atleast_1d(f))[1]
    return at(frequency_hz) * 26 / abs(at(100)[0])


def recorded(stem):
    """Times (frame i is of (i + 1) / rate), newtons as stored, positions."""
    side = json.load(open(f"{stem}.json"))
    codes, _ = soundfile.read(f"{stem}.wav", dtype="int32")
    force, position = (codes[:, i] * side["channels"][i]["scale"] + side["channels"][i].get("offset", 0) for i in (0, 1))
    assert "known force" in side["simulated"], side["simulated"]
    return (np.arange(len(codes)) + 1) / RATE_HZ, force, position, side


def record(stem, parameters, time_s=10.5):
    tacto.run("record", "-d", f"sim:{STROKE},{parameters}", "-o", stem, "--time", f"{time_s}s")


def texture_in_time(stem, *options):
    """The texture's values with the finger's times, by SciPy's inverse of the recorded path. Without the ramps."""
    tacto.run("spatial", stem, "-o", stem, "--force", *options)
    x, values, side = tacto.texture(stem)
    time_s, _, position, _ = recorded(stem)
    grows = np.concatenate([[True], np.diff(np.maximum.accumulate(position)) > 0])
    there = interpolate.PchipInterpolator(position[grows], time_s[grows])(x + side["source_origin_m"])
    middle = slice(len(x) // 10, -len(x) // 10)
    return there[middle], values[middle], side


def tone_ratios(time_s, values, tones, amplitude_n=0.02):
    """Complex amplitude of each tone over that of the force."""
    frequencies, phases = tones
    turns = 2 * np.pi * np.outer(time_s, frequencies) + phases
    fitted, *_ = np.linalg.lstsq(np.hstack([np.sin(turns), np.cos(turns)]), values, rcond=None)
    return (fitted[:len(frequencies)] + 1j * fitted[len(frequencies):]) / amplitude_n


def worst(ratios, wanted=1.0):
    return float(np.max(np.abs(ratios / wanted - 1)))


def volts_are_the_equations():
    tones = multisine(15, 500)
    record("volts", "force=multisine,noise=off", 5)
    time_s, force, _, side = recorded("volts")
    settled = time_s > 1
    volts = force[settled] * (sensor_v_per_n(100)[0].real)  # the sidecar's scale is the nominal gain, that of 100 Hz
    seen, wanted = tone_ratios(time_s[settled], volts, tones), sensor_v_per_n(tones[0])
    print(f"volts against the closed form, 15-500 Hz: {worst(seen, wanted):.1e} at most; "
          f"{abs(seen[8]):.1f} V/N at {tones[0][8]:.0f} Hz, {abs(seen[15]):.1f} V/N at 500 Hz")
    measured("sensor_path.volts_error", worst(seen, wanted))
    measured("sensor_path.gain_at_97hz_v_per_n", abs(seen[8]))
    measured("sensor_path.gain_at_500hz_v_per_n", abs(seen[15]))
    assert worst(seen, wanted) < 2e-4  # a converter of 16 bits over 40000 frames: 3e-5 of a tone of 0.5 V
    assert abs(abs(np.interp(100, tones[0], abs(seen))) - 26) < 0.02 * 26
    assert 3.8 < abs(seen[15]) / 26 < 4.3
    assert worst(tone_ratios(time_s[settled], force[settled], tones)) > 2, "without equalising these are no newtons"
    assert side["transducer"]["name"] == "wiertlewski2011"


def newtons_come_back():
    """Tones at the ends of the band, so the band is slightly wider; noise, speed variation and encoder as on a
    bench."""
    tones = multisine(15, 500)
    record("force", "force=multisine")
    time_s, values, side = texture_in_time("force", "--band", "12Hz..600Hz")
    assert side["source"]["equalised"] and side["unit"] == "N" and "known force" in side["simulated"]
    ratios = tone_ratios(time_s, values, tones)
    print(f"newtons over newtons, 15-500 Hz, noise on: {100 * worst(ratios):.2f} % at most, phase included; "
          f"15 Hz: {abs(ratios[0]):.4f}, {np.angle(ratios[0]):+.4f} rad")
    measured("sensor_path.newtons_error_percent", 100 * worst(ratios))
    assert worst(ratios) < 0.01
    _, raw, _ = texture_in_time("force", "--band", "12Hz..600Hz", "--equalise", "off")
    off = tone_ratios(time_s, raw, tones)
    print(f"without equalising: {abs(off[15]):.2f} times at 500 Hz, {np.angle(off[0]):+.2f} rad at 15 Hz")
    measured("sensor_path.raw_gain_at_500hz", abs(off[15]))
    measured("sensor_path.raw_phase_at_15hz_rad", np.angle(off[0]))
    assert abs(off[15]) > 3.8 and abs(np.angle(off[0])) > 0.3


def newtons_come_back_by_default():
    """`tactograph spatial NAME` without options: equalised, 15 to 500 Hz. Compares the force sample by sample."""
    tones = multisine(16, 490)
    record("plain", "force=multisine,force_low=16Hz,force_high=490Hz,noise=off,encoder_quantum=10nm")
    time_s, values, side = texture_in_time("plain")
    assert side["source"]["equalised"] and side["source"]["low_hz"] == 15 and side["source"]["high_hz"] == 500
    true_n = 0.02 * np.sin(2 * np.pi * np.outer(time_s, tones[0]) + tones[1]).sum(axis=1)
    error = tacto.rms(values - true_n) / tacto.rms(true_n)
    ratios = tone_ratios(time_s, values, tones)
    print(f"by default, 16-490 Hz: {100 * error:.2f} % of the RMS, each tone {100 * worst(ratios):.2f} % at most")
    assert error < 0.01 and worst(ratios) < 0.01


def a_chirp_comes_back():
    record("chirp", "force=chirp,force_low=30Hz,force_high=450Hz,force_sweep=3s,force_amplitude=50mN,noise=off,"
                    "encoder_quantum=10nm,wander=0")
    time_s, values, _ = texture_in_time("chirp")
    ways, s = np.divmod(time_s, 3.0)
    begin, growth = np.where(ways % 2 == 0, 30, 450), np.where(ways % 2 == 0, 1, -1) * 420 / 3
    true_n = 0.05 * np.sin(2 * np.pi * (ways * 3 * 240 + s * (begin + growth * s / 2)))
    error = tacto.rms(values - true_n) / tacto.rms(true_n)
    print(f"a chirp of 30-450 Hz: {100 * error:.2f} % of the RMS")
    assert error < 0.01


def the_noise_floor_is_what_is_left():
    """Equalised noise: 25 uN/sqrt(Hz) of the stiffness alone, divided by the sensor's shape."""
    record("noise", "force=sine,force_low=100Hz,force_amplitude=1uN")
    _, values, _ = texture_in_time("noise")
    f = np.linspace(15, 500, 20001)
    floor_n = 25e-6 * abs(sensor_v_per_n(1e-9 + f)) ** -1 * 26 * 25.2 / 26
    wanted = np.sqrt(np.trapz(floor_n**2, f))
    print(f"noise of the equalised texture: {1e3 * tacto.rms(values):.3f} mN, by the floor {1e3 * wanted:.3f} mN")
    assert abs(tacto.rms(values) / wanted - 1) < 0.05  # 8 s of 485 Hz: 1.1 % of statistics; the 25.2 V/N to 1 %


for test in (volts_are_the_equations, newtons_come_back, newtons_come_back_by_default, a_chirp_comes_back,
             the_noise_floor_is_what_is_left):
    tacto.in_folder(test)
