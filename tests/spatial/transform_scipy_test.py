#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`transform` against SciPy's resampling and against sums of harmonics, and what its sidecar says."""
import hashlib
import json
import pathlib
import re

import numpy as np
import soundfile
from scipy.signal import resample

import tacto

SAMPLES = 20000
TURN = 2 * np.pi


def write(stem, values, quantity="height", unit="m", pitch_m=1e-6, **more):
    soundfile.write(f"{stem}.texture.wav", np.asarray(values, dtype=np.float32), round(1 / pitch_m), subtype="FLOAT")
    wav = pathlib.Path(f"{stem}.texture.wav")
    side = {"kind": "texture", "version": "1.0",
            "data": {"file": wav.name, "sha256": hashlib.sha256(wav.read_bytes()).hexdigest(), "samples": len(values)},
            "pitch_m": pitch_m, "quantity": quantity, "unit": unit, "direction": 1, "source_origin_m": 0, **more}
    pathlib.Path(f"{stem}.texture.json").write_text(json.dumps(side))


def step_of(stem):
    return tacto.texture(stem)[2]["transform"]["steps"][-1]


class Harmonics:
    """A sum of random harmonics of 20 mm: periodic, so that SciPy's Fourier resampling is exact; no shorter period."""

    def __init__(self, order, seed):
        random = np.random.default_rng(seed)
        self.order = np.asarray(order)
        self.size = random.uniform(0.5, 1.5, self.order.size)
        self.phase = random.uniform(0, TURN, self.order.size)

    def samples(self):
        spectrum = np.zeros(SAMPLES // 2 + 1, dtype=complex)
        spectrum[self.order] = SAMPLES / 2 * self.size * np.exp(1j * self.phase)
        return np.fft.irfft(spectrum, SAMPLES)

    def at(self, places):
        return np.cos(TURN * np.outer(places, self.order) / SAMPLES + self.phase) @ self.size


def interior_of(count):
    """Away from the ends of the record, which the interpolation continues by mirroring."""
    return slice(64, count - 64)


def longer_is_scipys():
    values = Harmonics(range(20, 201), seed=1).samples()  # 1 to 10 /mm
    write("surface", values)
    report = tacto.run_json("transform", "surface", "-o", "longer", "--stretch", "1.3x")
    expected = resample(values, 26000)[:SAMPLES]
    _, got, _ = tacto.texture("longer")
    assert got.size == SAMPLES, got.size
    error = np.max(np.abs(got - expected)[interior_of(SAMPLES)]) / np.max(np.abs(values))
    # windowed_sinc_test allows 2e-6 of a tone; float32 adds 6e-8 twice.
    assert error < 3e-6, error
    step = step_of("longer")
    assert step["lengthening"] == "best_fit" and step["joints"] == 0 and "joint_error" not in step, step
    np.testing.assert_allclose(step["left_out_m"], (SAMPLES - 1) * (1 - 1 / 1.3) * 1e-6, rtol=1e-9)
    assert report["steps"][0]["factor"] == 1.3, report
    print(f"stretched by 1.3: {error:.2g} of the peak from SciPy's")


def shorter_is_scipys_up_to_the_joint_and_the_surface_behind_it():
    surface = Harmonics(range(20, 201), seed=2)
    values = surface.samples()
    write("surface", values)
    tacto.run("transform", "surface", "-o", "shorter", "--stretch", "0.7x")
    _, got, _ = tacto.texture("shorter")
    step = step_of("shorter")
    assert got.size == SAMPLES, got.size
    late = SAMPLES - 1 - round(step["left_out_m"] / 1e-6)  # the source's sample at which the joint is
    first = int(np.ceil(late / (1 / 0.7)))
    peak = np.max(np.abs(values))
    before = np.max(np.abs(got[:first] - resample(values, 14000)[:first])[interior_of(first)]) / peak
    assert before < 3e-6, before
    # Behind it the surface goes on from an early sample, which is found by its values, to the joint again.
    behind = np.arange(first, SAMPLES) / 0.7 - late
    misses = [np.max(np.abs(surface.at(early + behind[:40]) - got[first:first + 40])) for early in range(16, SAMPLES // 4 + 1)]
    early = 16 + int(np.argmin(misses))
    length = late - early
    error = np.max(np.abs(got[first:] - surface.at(early + np.fmod(behind, length)))) / peak
    assert error < 3e-6, (error, early)
    assert step["joints"] == 1 + int(behind[-1] // length), (step, length)
    around = surface.at(np.array([late, early, late + 0.5, late - 0.5, early + 0.5, early - 0.5]))
    jump, kink = around[0] - around[1], around[2] - around[3] - around[4] + around[5]
    joint = np.hypot(jump / np.std(values), kink / tacto.rms(np.diff(values)))
    # Both are interpolated to 3e-6 of the peak, which is some 4 RMS; a slope's RMS is 0.04 of the values'.
    assert abs(joint - step["joint_error"]) < 1e-3 and step["joint_error"] < 0.01, (joint, step)
    print(f"stretched by 0.7: {before:.2g} before and {error:.2g} behind the joint; its error {joint:.2g}")


def what_the_grid_cannot_hold_is_removed():
    # 100 to 215 /mm, and 235 to 400 /mm, which would be 470 to 800 /mm.
    values = Harmonics([*range(2000, 4300), *range(4700, 8001)], seed=3).samples()
    write("fine", values, valid_band=[{"position_m": 0, "low_per_m": 1e5, "high_per_m": 4e5}])
    _, warnings = tacto.run("transform", "fine", "-o", "half", "--stretch", "0.5x")
    assert "removed" in warnings, warnings
    _, got, side = tacto.texture("half")
    step = step_of("half")
    spectrum = np.fft.rfft(values)
    kept = np.arange(spectrum.size) / SAMPLES <= 0.45 * 0.5
    expected = resample(np.fft.irfft(spectrum * kept, SAMPLES), SAMPLES // 2)
    share = np.sqrt(np.sum(np.abs(spectrum[~kept]) ** 2) / np.sum(np.abs(spectrum) ** 2))
    assert abs(step["removed_share"] / share - 1) < 0.05, (step, share)  # Welch's estimate from 8 windows
    np.testing.assert_allclose(step["removed_above_per_m"], 450000)
    assert all(point["high_per_m"] <= 450001 and point["low_per_m"] >= 199999 for point in side["valid_band"]), side
    # The nearest lines are 200 lines, 0.01 of the rate, from the filter's edge: 64 times 2.5 / 16384, at which its
    # gain is exact to 1e-3 (band_kernel.hpp). The middle is 4,000 samples from the ends.
    middle = slice(2000, 6000)
    error = tacto.rms((got[:SAMPLES // 2] - expected)[middle]) / tacto.rms(expected)
    assert error < 0.01, error
    print(f"halved: {100 * share:.1f} % of the RMS removed; the rest within {error:.2g} of SciPy's")


def sidecar_says_of_what_and_how():
    position = np.arange(17600)
    write("grating", 12.8e-6 * np.sin(TURN * position / 1760), surface="grating")
    write("ripple", 2e-6 * np.sin(TURN * position / 440), surface="ripple")
    options = ("--weights", "1x,50%", "--band", "0/mm..50/mm", "--stretch", "1.3x", "--keep-slope", "--gain", "-2x")
    report = tacto.run_json("transform", "grating", "ripple.texture.json", "-o", "both", *options)
    _, got, side = tacto.texture("both")
    for source, name in zip(side["transform"]["sources"], ("grating", "ripple"), strict=True):
        wav = pathlib.Path(f"{name}.texture.wav").read_bytes()
        assert source == {"texture": f"{name}.texture.json", "sha256": hashlib.sha256(wav).hexdigest()}, source
    mixed, band, stretched, gain = side["transform"]["steps"]
    assert mixed == {"operation": "mix", "weights": [1, 0.5]}, mixed
    assert band["operation"] == "filter" and np.allclose([band["low_per_m"], band["high_per_m"]], [0, 50000]), band
    assert stretched["operation"] == "stretch" and stretched["keep_slope"] and stretched["factor"] == 1.3, stretched
    assert stretched["lengthening"] == "periods" and abs(stretched["period_m"] / 1.76e-3 - 1) < 1e-4, stretched
    assert gain == {"operation": "gain", "factor": -2}, gain
    assert "source" not in side and side["surface"] == "grating; ripple", side
    place = np.arange(got.size) / 1.3
    expected = -2 * 1.3 * (12.8e-6 * np.sin(TURN * place / 1760) + 1e-6 * np.sin(TURN * place / 440))
    middle = slice(got.size // 4, 3 * got.size // 4)
    # The filter's ends are treated: fourier_filter.hpp states 0.2 % in the middle half.
    assert np.max(np.abs(got - expected)[middle]) < 0.004 * np.max(expected)

    info = tacto.run_json("info", "both")
    assert [row["texture"] for row in info["made_from"]] == ["grating.texture.json", "ripple.texture.json"], info
    assert [row["weight"] for row in info["made_from"]] == [1, 0.5], info
    assert [row["operation"] for row in info["steps"]] == ["mix", "filter", "stretch", "gain"], info
    assert info["steps"] == report["steps"] and "steps" not in tacto.run_json("info", "grating")
    tacto.run("validate", "both", "grating")
    tacto.run("report", ".", "-o", "page.html")
    assert "grating.texture.json, ripple.texture.json" in pathlib.Path("page.html").read_text()

    # Made from a made one: the sidecar names that file, whose own sidecar has the rest.
    tacto.run("transform", "both", "-o", "third", "--gain", "0.5x")
    third = tacto.texture("third")[2]["transform"]
    assert [source["texture"] for source in third["sources"]] == ["both.texture.json"] and len(third["steps"]) == 1, third

    # The numbers are covered by the checksum, the names are not.
    path = pathlib.Path("third.texture.json")
    path.write_text(path.read_text().replace('"factor": 0.5', '"factor": 0.6'))
    tacto.run("info", "third", code=4)


def whole_periods_keep_repeating():
    """A texture of whole periods is filtered as one that repeats itself: exactly, up to its ends."""
    grating = 12.8e-6 * np.sin(TURN * np.arange(17600) / 1760)
    write("grating", grating)
    for band in ("0.5/mm..10/mm", "0/mm..1/mm"):
        tacto.run("transform", "grating", "-o", "kept", "--band", band, "--force")
        assert np.max(np.abs(tacto.texture("kept")[1] - grating)) < 1e-6 * 12.8e-6, band
    tacto.run("transform", "grating", "-o", "shorter", "--band", "0/mm..5/mm", "--stretch", "70%")
    assert step_of("shorter")["joint_error"] < 1e-4, step_of("shorter")
    # With a wrong period the end does not continue with the beginning.
    _, warnings = tacto.run("transform", "grating", "-o", "loop", "--stretch", "130%", "--period", "3mm")
    assert "warning" in warnings and step_of("loop")["joint_error"] > 0.5, (warnings, step_of("loop"))


def textures_of_other_places_are_mixed_with_a_warning():
    values = Harmonics(range(20, 201), seed=4).samples()
    write("one", values)
    write("other", values, source_origin_m=0.008, direction=-1)
    _, warnings = tacto.run("transform", "one", "other", "-o", "both")
    assert warnings.count("warning") == 2 and "direction" in warnings and "bench" in warnings, warnings
    assert tacto.run("transform", "one", "one", "-o", "twice")[1] == ""


def bad_requests():
    grating = 12.8e-6 * np.sin(TURN * np.arange(17600) / 1760)
    write("grating", grating)
    write("force", grating, quantity="tangential_force", unit="N")
    write("short", grating[:100])
    write("surface", Harmonics(range(20, 201), seed=4).samples())
    options = set(re.findall(r"--[a-z-]+", tacto.run("transform", "--help")[0]))
    for code, *arguments in (
            (2, "grating", "-o", "new"),
            (2, "grating", "-o", "new", "--stretch", "1.3"),
            (2, "grating", "-o", "new", "--stretch", "0.001x"),
            (2, "grating", "-o", "new", "--gain", "0.5mm/N"),
            (2, "grating", "-o", "new", "--gain", "0x"),
            (2, "grating", "-o", "new", "--gain", "2x", "--keep-slope"),
            (2, "grating", "-o", "new", "--gain", "2x", "--weights", "1x,2x"),
            (2, "grating", "-o", "new", "--gain", "2x", "--weights", "2x"),
            (2, "grating", "surface", "-o", "new", "--weights", "0x,1x"),
            (2, "grating", "-o", "new", "--stretch", "70%", "--lengthen", "best", "--period", "1.76mm"),
            (2, "grating", "-o", "new", "--band", "4/mm..1/mm"),
            (2, "grating", "-o", "new", "--band", "off"),
            (5, "grating", "-o", "new", "--gain", "1e300x"),
            (2, "grating", "-o", "surface", "--gain", "2x"),
            (2, "grating", "-o", "./grating", "--gain", "2x", "--force"),
            (2, "grating", "--gain", "2x"),
            (3, "absent", "-o", "new", "--gain", "2x"),
            (5, "grating", "force", "-o", "new"),
            (5, "short", "-o", "new", "--stretch", "1.3x"),
            (5, "surface", "-o", "new", "--stretch", "1.3x", "--lengthen", "periods"),
            (5, "grating", "-o", "new", "--band", "4/mm..600/mm"),
            (5, "grating", "-o", "new", "--stretch", "1.3x", "--period", "30mm")):
        _, said = tacto.run("transform", *arguments, code=code)
        assert not pathlib.Path("new.texture.json").exists(), arguments
        # A remedy does not name an option of another verb, except with the verb.
        assert set(re.findall(r"(?<!'spatial' makes it with )--[a-z-]+", tacto.unwrapped(said))) <= options, (arguments, said)
    tacto.run("transform", "grating", "-o", "surface", "--gain", "2x", "--force")
    np.testing.assert_allclose(tacto.texture("surface")[1], 2 * grating, rtol=1e-6, atol=1e-12)


if __name__ == "__main__":
    for test in (longer_is_scipys, shorter_is_scipys_up_to_the_joint_and_the_surface_behind_it,
                 what_the_grid_cannot_hold_is_removed, sidecar_says_of_what_and_how, whole_periods_keep_repeating,
                 textures_of_other_places_are_mixed_with_a_warning, bad_requests):
        tacto.in_folder(test)
