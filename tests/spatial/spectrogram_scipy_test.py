# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `spectrogram` against scipy.signal.spectrogram; its files against independent readers."""

import csv
import hashlib
import json
import os
import resource
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

import tacto

TACTOGRAPH = tacto.COMMAND
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


def write_recording(stem):
    """Three strokes of 40 mm at 50 mm/s over lines of 2 and 8 /mm, back and forth, as another program would write
    them."""
    rate_hz, frames = 10000, 30000
    t = np.arange(frames) / rate_hz
    way_mm = np.minimum(50 * (t % 1), 40)
    position_mm = np.round(np.where(t.astype(int) % 2 == 0, way_mm, 40 - way_mm), 3)
    force_n = 0.3 + 0.05 * np.sin(2 * np.pi * 2 * position_mm) + 0.02 * np.sin(2 * np.pi * 8 * position_mm)
    table = Path(f"{stem}.csv.in")
    np.savetxt(table, np.column_stack([force_n, position_mm]), "%.9g", ",", header="f,x", comments="")
    channels = ["--channel", "tangential_force=f*1N", "--channel", "position=x*1mm"]
    command = [TACTOGRAPH, "import", table, "-o", stem, "--rate", "10kHz", *channels]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    table.unlink()


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
        done = run(*arguments, "--force")
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
        self.check_cells(density, expected)
        return attributes

    def check_cells(self, density, expected):
        """Magnitudes exact to -120 dB of the largest, as required for complex spectra; densities 60 dB below it to
        1e-4, which short jobs reach because their transforms use double precision."""
        error = np.abs(np.sqrt(density) - np.sqrt(expected))
        self.assertLess(error.max(), 1e-6 * np.sqrt(expected.max()))
        strong = expected > 1e-6 * expected.max()
        self.assertGreater(strong.sum(), 1000)
        self.assertLess((np.abs(density - expected)[strong] / expected[strong]).max(), 1e-4)

    def test_agrees_with_scipy_as_it_stands(self):
        attributes = self.compare([], 10000, 100, 16384, "constant")
        self.assertEqual(attributes["window"], "blackman")
        self.assertAlmostEqual(attributes["window_mm"], 10)
        self.assertAlmostEqual(attributes["hop_mm"], 0.1)
        self.assertEqual(attributes["decimation"], 16)

    def test_agrees_with_scipy_at_whole_resolution(self):
        attributes = self.compare(["--resolution", "whole"], 10000, 100, 16384, "constant")
        self.assertEqual(attributes["decimation"], 1)
        attributes = self.compare(["--max-frequency", "500/mm"], 10000, 100, 16384, "constant", 500)
        self.assertEqual(attributes["decimation"], 1)

    def test_agrees_with_scipy_where_the_hop_does_not_divide(self):
        self.compare(["--hop", "0.101mm"], 10000, 101, 16384, "constant")
        attributes = self.compare(["--padding", "10.007mm"], 10000, 100, 10007, "constant")  # a prime
        self.assertEqual(attributes["decimation"], 1)
        done = self.made(self.stem, "-o", self.here / "oak.nc", "--padding", "10.007mm", "--json")
        self.assertIn("10007 padded samples", json.loads(done.stdout)["whole_because"])

    def test_amplitudes_are_scipys(self):
        values = chirp_and_noise()
        write_texture(self.stem, values)
        x = np.asarray(values, np.float32).astype(float)
        power = signal.spectrogram(x, 1e6, "blackman", 10000, 9900, 16384, detrend="constant", scaling="spectrum")[2].T
        factor = np.full(power.shape[1], 2.0)
        factor[[0, -1]] = 1  # zero and half the sampling frequency have no negative counterpart
        expected = np.sqrt(power * factor)
        for highest in ("15/mm", "500/mm"):
            self.made(self.stem, "-o", self.here / "oak.nc", "--scaling", "amplitude", "--max-frequency", highest)
            with netCDF4.Dataset(self.here / "oak.nc") as file:
                amplitude = file["amplitude"][:].data
                self.assertEqual(file["amplitude"].units, "N")
                self.assertTrue(file.scaling.startswith("amplitude"))
                self.assertAlmostEqual(file.window_coherent_gain, 0.42)
            error = np.abs(amplitude - expected[:, : amplitude.shape[1]])
            self.assertLess(error.max(), 1e-6 * expected.max())

    def test_a_sine_reads_its_amplitude(self):
        x = np.arange(40000) * PITCH_M
        write_texture(self.stem, 0.02 * np.sin(2 * np.pi * 2000 * x))
        options = ["--scaling", "amplitude", "--padding", "10mm"]
        done = self.made(self.stem, "-o", self.here / "oak.nc", "-o", self.here / "oak.csv", *options, "--json")
        report = json.loads(done.stdout)
        self.assertEqual((report["scaling"], report["level_reference"]), ("amplitude", "1 N"))
        self.assertAlmostEqual(report["textures"][0]["peak_level_db"], 20 * np.log10(0.02), delta=1e-4)
        self.assertAlmostEqual(report["textures"][0]["band_rms_n"], 0.02 / np.sqrt(2), delta=2e-6)
        self.assertIn("N at 2/mm", (self.here / "oak.csv").read_text().split("\n")[0])
        info = subprocess.run([TACTOGRAPH, "info", self.here / "oak.nc", "--json"], capture_output=True, text=True)
        self.assertEqual(json.loads(info.stdout)["scaling"], "amplitude")

    def test_exports_what_the_recording_could_know(self):
        band = [
            {"position_m": 0, "low_per_m": 300, "high_per_m": 10000},
            {"position_m": 0.02, "low_per_m": 600, "high_per_m": 12000},
            {"position_m": 0.03, "low_per_m": 600, "high_per_m": 9000},
        ]
        write_texture(self.stem, chirp_and_noise(), valid_band=band)
        self.made(self.stem, "-o", self.here / "oak.nc", "-o", self.here / "oak.csv")
        with netCDF4.Dataset(self.here / "oak.nc") as file:
            known = file["known"][:].data
            position, frequency = file["position"][:].data, file["spatial_frequency"][:].data
            self.assertEqual(list(file["known"].flag_values), [0, 1])
            limits = file["known_from"][:].data, file["known_to"][:].data
        # The valid limits throughout the 39.2 % of the window that contain 90 % of its power, by a fine grid.
        at = position[:, None] + np.linspace(-1.96, 1.96, 2001)[None, :]
        places = [1e3 * point["position_m"] for point in band]
        low = np.interp(at, places, [1e-3 * point["low_per_m"] for point in band]).max(axis=1)
        high = np.interp(at, places, [1e-3 * point["high_per_m"] for point in band]).min(axis=1)
        np.testing.assert_allclose(limits[0], low, rtol=1e-3)
        np.testing.assert_allclose(limits[1], high, rtol=1e-3)
        expected = (frequency >= limits[0][:, None]) & (frequency <= limits[1][:, None])
        np.testing.assert_array_equal(known, expected)
        with open(self.here / "oak.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0][:3], ["position_mm", "known_from_per_mm", "known_to_per_mm"])
        np.testing.assert_allclose(np.array([row[1] for row in rows[1:]], float), limits[0], rtol=1e-8)

    def test_agrees_with_scipy_without_detrending(self):
        self.compare(["--detrend", "none"], 10000, 100, 16384, False)

    def test_a_measured_height_profile_agrees_with_scipy(self):
        profile = Path(os.environ["TACTO_DATA"]) / "profiles" / "edm.xml"
        if not profile.exists():
            self.skipTest("skipped: no real data")
        data = xml.parse(profile).getroot().find("DATAFILE")
        height_m = 1e-6 * np.array(data.find("DATA_POINT_VALUES").text.split(), float)
        pitch_m = 1e-6 * float(data.find("SPACING").text)
        write_texture(self.stem, height_m, pitch_m, quantity="height", unit="m")
        x = np.asarray(height_m, np.float32).astype(float)
        for highest in (100, 2000):
            options = ["--window", "1mm", "--hop", "10um", "--max-frequency", f"{highest}/mm"]
            report = json.loads(self.made(self.stem, "-o", self.here / "edm.nc", *options, "--json").stdout)
            self.assertEqual(report["level_reference"], "1 um^2 mm")
            k, _, expected = signal.spectrogram(
                x, 1 / pitch_m, "blackman", 4000, 3960, 4096, detrend="constant", scaling="density"
            )
            density = read_nc(self.here / "edm.nc")[2]
            expected = expected[k * 1e-3 <= highest * (1 + 1e-9)].T * 1e3  # m^3 to m^2 mm
            self.assertEqual(density.shape, expected.shape)
            self.check_cells(density, expected)

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
        # With the window's weights, the power of a sine is A^2 / 2; with 20 periods per window the deviation is far
        # below 1e-4.
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
            ["--padding", "100m"], ["--window", "1e300m"], ["--hop", "1e300m"], ["--scaling", "power"],
            ["--dynamic-range", "60"], ["--dynamic-range", "0dB"], ["--detrend", "linear"],
        ):  # fmt: skip
            with self.subTest(options=options):
                self.refused(2, self.stem, *out, *options)
        self.refused(2, self.stem)
        self.refused(2, self.stem, "-o", self.here / "oak.jpg")
        self.refused(2, self.stem, *out, "-o", self.here / "." / "oak.nc")
        self.refused(3, self.here / "ash", *out)
        self.refused(7, self.stem, *out, "-o", f"{self.stem}.texture.json/oak.png")  # no folder can have that name

    def test_absurd_lengths_name_the_range(self):
        write_texture(self.stem, chirp_and_noise())
        message = self.refused(2, self.stem, "-o", self.here / "oak.nc", "--padding", "100m")
        self.assertIn("use 10 mm (the window) to 16.78 m", message)
        message = self.refused(2, self.stem, "-o", self.here / "oak.nc", "--window", "1e300m")
        self.assertIn("use 8 um (8 samples) to 16.78 m", message)

    def test_a_name_stands_for_its_numbered_textures(self):
        write_recording(self.stem)
        for number, amplitude in ((1, 1), (2, 2), (10, 3)):
            write_texture(f"{self.stem}-{number:02}", amplitude * chirp_and_noise())
        write_texture(f"{self.stem}-down", chirp_and_noise())
        report = json.loads(self.made(self.stem, "-o", self.here / "oak.nc", "--json").stdout)
        self.assertEqual([row["texture"] for row in report["textures"]], ["oak-01", "oak-02", "oak-10"])
        self.assertEqual(read_nc(self.here / "oak.nc")[2].shape, (3, 201, 246))

    def test_a_recordings_strokes_become_textures_on_the_way(self):
        write_recording(self.stem)
        report = json.loads(self.made(self.stem, "-o", self.here / "direct.nc", "--json").stdout)
        self.assertEqual([row["texture"] for row in report["textures"]], ["oak-01", "oak-02", "oak-03"])
        subprocess.run([TACTOGRAPH, "spatial", self.stem], check=True, capture_output=True)
        self.made(self.stem, "-o", self.here / "stored.nc")
        direct, stored = (read_nc(self.here / name)[2] for name in ("direct.nc", "stored.nc"))
        # A stored texture is rounded to single precision: 6e-8 of each sample.
        error = np.abs(np.sqrt(direct) - np.sqrt(stored))
        self.assertLess(np.nanmax(error), 1e-6 * np.sqrt(np.nanmax(stored)))
        # Its full name selects the recording again.
        self.made(f"{self.stem}.json", "-o", self.here / "again.nc")
        np.testing.assert_array_equal(read_nc(self.here / "again.nc")[2], direct)

    def test_a_full_disk_is_told_and_leaves_what_was_there(self):
        """A limit of the file size fails like a full disk, including the clean-up of netCDF and HDF5."""
        write_texture(self.stem, chirp_and_noise())
        self.made(self.stem, "-o", self.here / "small.nc", "--window", "20mm", "--hop", "20mm", "--max-frequency", "1/mm")
        small = (self.here / "small.nc").read_bytes()
        table = b"position_mm,N^2 mm at 0/mm,before\n"
        # Files of the same kind may be replaced, so that only the disk prevents it.
        for name, before in (("oak.nc", small), ("oak.csv", table), ("oak.png", table)):
            (self.here / name).write_bytes(before)
            done = subprocess.run(
                [TACTOGRAPH, "spectrogram", self.stem, "--force", "-o", self.here / name],
                capture_output=True, text=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)),
            )  # fmt: skip
            self.assertEqual(done.returncode, 7, name + done.stderr)
            # Without a sanitizer's own warnings.
            said = [line for line in done.stderr.splitlines() if "==WARNING: " not in line]
            self.assertEqual(len(said), 1, done.stderr)
            self.assertEqual((self.here / name).read_bytes(), before)
            self.assertEqual([path.name for path in self.here.glob(".*")], [])

    def test_memory_does_not_grow_with_textures_or_bins(self):
        """All 8,193 bins of 0.4 m of texture, 128 MB of cells, need only a few megabytes more than one short
        texture."""
        peaks = []
        for name, length_m, highest in (("short", 0.011, "15/mm"), ("long", 0.4, "500/mm")):
            write_texture(self.here / name, chirp_and_noise(length_m))
            peaks.append(
                tacto.peak_mb("spectrogram", name, "-o", f"{name}.nc", "--max-frequency", highest, cwd=self.here)
            )
        # The texture itself is in memory, in double precision and as read from the file.
        tacto.expect_little_memory("all bins of 0.4 m against 11 mm up to 15 /mm", peaks[1], peaks[0])

    def test_a_texture_shorter_than_the_window_says_what_fits(self):
        write_texture(self.stem, chirp_and_noise(0.008))
        message = self.refused(5, self.stem, "-o", self.here / "oak.nc")
        self.assertIn("use a window of 8 mm or less", message)
        done = self.made(self.stem, "-o", self.here / "oak.nc", "--window", "8mm")
        self.assertIn("only slightly longer than the window", done.stderr)

    def test_a_hop_beyond_the_window_is_warned_of(self):
        write_texture(self.stem, chirp_and_noise())
        done = self.made(self.stem, "-o", self.here / "oak.nc", "--window", "2mm", "--hop", "3mm")
        self.assertIn("the parts between windows are ignored", done.stderr)


if __name__ == "__main__":
    sys.exit(unittest.main())
