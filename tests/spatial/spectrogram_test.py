# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `spectrogram` against scipy.signal.spectrogram, and the files it writes against what reads such files."""

import csv
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

import netCDF4
import numpy as np
import soundfile
from scipy import signal

TACTOGRAPH = os.environ["TACTOGRAPH"]
PITCH_M = 1e-6


def write_texture(stem, values, pitch_m=PITCH_M, **members):
    """A texture file as another program would write it."""
    wav = Path(f"{stem}.texture.wav")
    values = np.asarray(values, np.float32)
    soundfile.write(wav, values, round(1 / pitch_m), subtype="FLOAT", format="RF64" if len(values) > 2**29 else "WAV")
    body = {
        "kind": "texture",
        "version": "1.0",
        "data": {
            "file": wav.name,
            "sha256": hashlib.sha256(wav.read_bytes()).hexdigest(),
            "samples": len(values),
        },
        "pitch_m": pitch_m,
        "quantity": "tangential_force",
        "unit": "N",
        "direction": 1,
        "source_origin_m": 0,
        **members,
    }
    Path(f"{stem}.texture.json").write_text(json.dumps(body))


def chirp_and_noise(length_m=0.03):
    x = np.arange(round(length_m / PITCH_M)) * PITCH_M
    noise = np.random.default_rng(1).normal(size=len(x))
    tones = 0.02 * np.sin(2 * np.pi * (500 * x + 1e5 * x**2)) + 0.01 * np.sin(2 * np.pi * 1500 * x)
    return 0.05 + tones + 1e-3 * signal.lfilter(*signal.butter(2, 0.01), noise)


def run(*arguments):
    return subprocess.run([TACTOGRAPH, "spectrogram", *map(str, arguments)], capture_output=True, text=True)


def read_nc(path):
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        return (
            file["position"][:].copy(),
            file["spatial_frequency"][:].copy(),
            file["density"][:].astype(float),
            {name: file.getncattr(name) for name in file.ncattrs()},
        )


class Spectrogram(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.here = Path(self.folder.name)
        self.stem = self.here / "oak"

    def tearDown(self):
        self.folder.cleanup()

    def made(self, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def refused(self, code, *arguments):
        before = sorted(path.name for path in self.here.iterdir())
        done = run(*arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(sorted(path.name for path in self.here.iterdir()), before)
        return done.stderr

    def compare(self, arguments, nperseg, hop, nfft, detrend, highest_per_mm=15):
        values = chirp_and_noise()
        write_texture(self.stem, values)
        self.made(self.stem, "-o", self.here / "oak.nc", *arguments)
        position_mm, frequency_per_mm, density, attributes = read_nc(self.here / "oak.nc")
        x = np.asarray(values, np.float32).astype(float)
        k, centre, expected = signal.spectrogram(
            x, 1 / PITCH_M, "blackman", nperseg, nperseg - hop, nfft, detrend=detrend, scaling="density"
        )
        kept = k * 1e-3 <= highest_per_mm * (1 + 1e-9)
        expected = expected[kept].T * 1e3  # N^2 m to N^2 mm
        np.testing.assert_allclose(position_mm, centre * 1e3, rtol=1e-9)
        np.testing.assert_allclose(frequency_per_mm, k[kept] * 1e-3, rtol=1e-9, atol=1e-12)
        self.assertEqual(density.shape, expected.shape)
        strong = expected > 1e-6 * expected.max()
        self.assertGreater(strong.sum(), 1000)
        # What the issue asks for; both are double precision until stored as float (6e-8).
        error = np.abs(density - expected)[strong] / expected[strong]
        self.assertLess(error.max(), 1e-4)
        return attributes

    def test_agrees_with_scipy_as_it_stands(self):
        attributes = self.compare([], 10000, 100, 16384, "constant")
        self.assertEqual(attributes["window"], "blackman")
        self.assertAlmostEqual(attributes["window_mm"], 10)
        self.assertAlmostEqual(attributes["hop_mm"], 0.1)

    def test_agrees_with_scipy_without_detrending(self):
        self.compare(["--detrend", "none"], 10000, 100, 16384, False)

    def test_agrees_with_scipy_for_odd_lengths_and_all_bins(self):
        options = ["--window", "3.001mm", "--hop", "0.25mm", "--padding", "4.095mm", "--max-frequency", "500/mm"]
        self.compare(options, 3001, 250, 4095, "constant", 500)

    def test_reports_what_it_found(self):
        x = np.arange(40000) * PITCH_M
        write_texture(self.stem, 0.02 * np.sin(2 * np.pi * 2000 * x))
        report = json.loads(self.made(self.stem, "-o", self.here / "oak.nc", "--json").stdout)
        row = report["textures"][0]
        self.assertEqual(row["positions"], 301)
        self.assertLess(abs(row["peak_frequency_per_m"] - 2000), 1e6 / 16384)
        # Over the window's weights, a sine keeps A^2 / 2; a window of 20 periods differs by far less than 1e-4.
        self.assertAlmostEqual(row["band_rms_n"], 0.02 / np.sqrt(2), delta=2e-6)
        self.assertEqual(report["level_reference"], "1 N^2 mm")

    def test_writes_all_forms_together(self):
        write_texture(self.stem, chirp_and_noise(), simulated="a formula")
        outputs = [self.here / f"oak.{form}" for form in ("png", "svg", "nc", "csv")]
        self.made(self.stem, *(word for output in outputs for word in ("-o", output)))
        self.assertEqual(outputs[0].read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        words = {element.text for element in xml.parse(outputs[1]).iter("{http://www.w3.org/2000/svg}text")}
        for label in ("position (mm)", "spatial frequency (1/mm)", "wavelength (mm)", "force (mN)", "oak"):
            self.assertIn(label, words)
        self.assertIn("SIMULATED: a formula", words)
        with open(outputs[3], newline="") as file:
            rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
        density = read_nc(outputs[2])[2]
        table = np.array(rows[1:], float)
        np.testing.assert_allclose(table[:, -density.shape[1] :], density, rtol=1e-5)

    def test_two_runs_give_the_same_pictures(self):
        write_texture(self.stem, chirp_and_noise())
        for name in ("a", "b"):
            self.made(self.stem, "-o", self.here / f"{name}.png", "-o", self.here / f"{name}.svg")
        for form in ("png", "svg"):
            self.assertEqual((self.here / f"a.{form}").read_bytes(), (self.here / f"b.{form}").read_bytes())

    def test_several_textures_share_a_file(self):
        write_texture(self.here / "a", chirp_and_noise(0.03))
        write_texture(self.here / "b", chirp_and_noise(0.02))
        # A file named twice counts once.
        named = [self.here / "a", self.here / "b.texture.json", self.here / "b.texture.wav"]
        done = self.made(*named, "-o", self.here / "ab.nc", "-o", self.here / "ab.svg", "--json")
        self.assertEqual([row["texture"] for row in json.loads(done.stdout)["textures"]], ["a", "b"])
        density = read_nc(self.here / "ab.nc")[2]
        self.assertEqual(density.shape, (2, 201, 246))
        self.assertTrue(np.isnan(density[1, 101:]).all() and np.isfinite(density[1, :101]).all())

    def test_other_kinds_are_skipped_among_many(self):
        write_texture(self.stem, chirp_and_noise())
        self.made(self.stem, "-o", self.here / "oak.nc")
        done = self.made(self.stem, self.here / "oak.nc", "-o", self.here / "again.csv")
        self.assertIn("oak.nc: is a spectrogram, not a texture; skipped", done.stderr)
        self.assertIn("not a texture", self.refused(5, self.here / "oak.nc", "-o", self.here / "more.csv"))

    def test_textures_of_different_grids_are_refused(self):
        write_texture(self.here / "a", chirp_and_noise())
        write_texture(self.here / "b", chirp_and_noise(), pitch_m=2e-6)
        for form in ("png", "nc", "csv"):
            message = self.refused(5, self.here / "a", self.here / "b", "-o", self.here / f"ab.{form}")
            self.assertIn("2 um", message)

    def test_impossible_options_are_refused(self):
        write_texture(self.stem, chirp_and_noise())
        out = ["-o", self.here / "oak.nc"]
        for options in (
            ["--window", "0mm"], ["--window", "-1mm"], ["--window", "7um"], ["--window", "10"], ["--hop", "0mm"],
            ["--padding", "9mm"], ["--max-frequency", "0/mm"], ["--min-frequency", "20/mm"],
            ["--dynamic-range", "60"], ["--dynamic-range", "0dB"], ["--detrend", "linear"],
        ):  # fmt: skip
            with self.subTest(options=options):
                self.refused(2, self.stem, *out, *options)
        self.refused(2, self.stem)
        self.refused(2, self.stem, "-o", self.here / "oak.jpg")
        self.refused(2, self.stem, *out, "-o", self.here / "." / "oak.nc")
        self.refused(3, self.here / "ash", *out)
        self.refused(7, self.stem, *out, "-o", self.here / "nowhere" / "oak.png")

    def test_a_texture_shorter_than_the_window_says_what_fits(self):
        write_texture(self.stem, chirp_and_noise(0.008))
        message = self.refused(5, self.stem, "-o", self.here / "oak.nc")
        self.assertIn("a window of 8 mm would fit", message)
        done = self.made(self.stem, "-o", self.here / "oak.nc", "--window", "8mm")
        self.assertIn("hardly longer than the window", done.stderr)

    def test_a_hop_beyond_the_window_is_warned_of(self):
        write_texture(self.stem, chirp_and_noise())
        done = self.made(self.stem, "-o", self.here / "oak.nc", "--window", "2mm", "--hop", "3mm")
        self.assertIn("what lies between windows is not seen", done.stderr)


if __name__ == "__main__":
    sys.exit(unittest.main())
