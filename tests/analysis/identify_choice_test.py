#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`identify` chooses its model: emulated benches that have more than one mode, against closed forms in NumPy."""
import json

import numpy as np

import tacto

# Table I of Wiertlewski 2011: stiffness k_r + k_p, mass, damping; the amplifier's pole; gain at rest.
STIFFNESS, MASS, DAMPING, POLE_HZ, GAIN = 80520.0, 6.8e-3, 4.49, 143.06319, 20e-6
SHARE, INNER_DAMPING = 0.15, 0.03  # of the emulated second mode


def two_masses(mode_hz):
    """Resonances and damping ratios, the lower one first, of a tray with a part of its mass on a spring and damper, whose
    upper mode without damping is at mode_hz; and the frequency of that part alone, the anti-resonance."""
    outer, inner = (1 - SHARE) * MASS, SHARE * MASS
    w = 2 * np.pi * mode_hz
    # (k + k2 - m1 w^2) (k2 - m2 w^2) = k2^2 is linear in k2.
    rest = STIFFNESS - outer * w**2
    spring = inner * w**2 * rest / (rest - inner * w**2)
    damper = 2 * INNER_DAMPING * np.sqrt(spring * inner)
    link = np.poly1d([damper, spring])
    poles = (np.poly1d([outer, DAMPING, STIFFNESS]) + link) * (np.poly1d([inner, 0, 0]) + link) - link * link
    roots = sorted((r for r in poles.roots if r.imag > 0), key=abs)
    return [(abs(r) / (2 * np.pi), -r.real / abs(r)) for r in roots], np.sqrt(spring / inner) / (2 * np.pi)


def truth_of(mode_hz=None, cutoff_hz=None):
    truth = {"gain_m_per_v": GAIN, "pole_hz": POLE_HZ}
    if cutoff_hz:
        truth["reconstruction_cutoff_hz"] = cutoff_hz
    if not mode_hz:
        return {**truth, "resonance_hz": np.sqrt(STIFFNESS / MASS) / (2 * np.pi), "damping_ratio": DAMPING / (2 * np.sqrt(STIFFNESS * MASS))}
    (first, second), zero_hz = two_masses(mode_hz)
    return {**truth, "resonance_hz": first[0], "damping_ratio": first[1], "second_mode_hz": second[0],
            "second_mode_damping_ratio": second[1], "second_mode_zero_hz": zero_hz, "second_mode_zero_damping_ratio": INNER_DAMPING}


def chosen(keys, model, truth, *options):
    said = tacto.run_json("identify", "-d", f"sim:tray_sensor=on{keys}", "-o", "bench", "--force", *options)
    assert said["verdict"] == "fits" and said["model"] == model, (keys, said["verdict"], said["because"], said["tried"])
    rows = {row["parameter"]: row for row in said["parameters"]}
    assert rows.keys() == truth.keys(), rows
    for name, value in truth.items():
        row = rows[name]
        # Five standard errors and a little: of some 60 parameters none misses by chance.
        half = 2.6 * (row["high_of_95"] - row["low_of_95"]) / 2 + 1e-4 * value
        assert abs(row["value"] - value) < half, (keys, row, value)
    tried = {row["model"]: row for row in said["tried"]}
    best = min(row["left_out_error_over_noise"] for row in tried.values() if row["converged"])
    # Within the noise: at 56 frequencies its RMS has a standard deviation of 7 %.
    assert tried[model]["left_out_error_over_noise"] < 1.3 and not tried[model]["misfit"], tried[model]
    assert tried[model]["left_out_error_over_noise"] < 1.1 * best and model in said["choice"], said["choice"]
    stored = json.load(open("bench.transducer.json"))
    assert ("second_mode" in stored) == ("second mode" in model) and ("reconstruction_cutoff_hz" in stored) == ("filter" in model)
    assert stored["identification"]["conditions"].endswith("model: " + model) and not stored["identification"]["misfit"]
    return said


def the_model_is_chosen():
    for mode_hz in (800, 1500):  # in the band, and above its end
        said = chosen(f",second_mode={mode_hz}Hz", "second mode", truth_of(mode_hz))
        one = said["tried"][0]
        assert one["model"] == "one mode" and one["parameters"] == 4 and one["misfit"] and one["left_out_error_over_noise"] > 50, one
    chosen(",reconstruction=butterworth3", "filter", truth_of(cutoff_hz=600))
    chosen(",second_mode=800Hz,reconstruction=butterworth3", "second mode, filter", truth_of(800, 600))
    chosen("", "one mode", truth_of())


def noise_is_no_misfit_and_adds_no_parameters():
    for seed in range(1, 5):
        said = chosen(f",tray_sensor_noise=1um,seed={seed}", "one mode", truth_of(), *(["--method", "multisine"] if seed > 1 else []))
        assert "third_harmonic_percent" not in said or said["third_harmonic_percent"] == 0, said  # noise is no harmonic


def a_filter_and_a_hysteresis_are_found_and_undone():
    """The operator behind a filter: its charge is smaller at high frequencies."""
    # Of seven models, two of which fit as well: the filter's error is 1.03 to 1.18 times the smallest with the seeds 1 to 8.
    said = chosen(",hysteresis=0.16,reconstruction=butterworth3,seed=3", "filter", truth_of(cutoff_hz=600))
    assert abs(said["loop_opening_percent"] - 16) < 0.3, said["loop_opening_percent"]
    chosen(",reconstruction=butterworth3", "filter", truth_of(cutoff_hz=600))
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "c")
    tacto.run("spatial", "c", "-o", "c")
    errors = {}
    for transducer in ("bench", "wiertlewski2011"):
        rows = tacto.run_json("fidelity", "c-01", "-d", "sim:reconstruction=butterworth3", "--transducer", transducer, "--speed", "51.7mm/s")
        errors[transducer] = max(row["error_db"] for row in rows["fidelity"])
    assert errors["bench"] < min(-40, errors["wiertlewski2011"] - 20), errors


for test in (the_model_is_chosen, noise_is_no_misfit_and_adds_no_parameters, a_filter_and_a_hysteresis_are_found_and_undone):
    tacto.in_folder(test)
