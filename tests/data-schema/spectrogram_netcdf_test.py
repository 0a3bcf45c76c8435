# SPDX-License-Identifier: GPL-3.0-or-later
"""Our spectrograms as xarray and netCDF4 read them. Argument: the program write_spectrogram."""
import os
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
import xarray


def expected(positions, factor):
    p = np.arange(positions)[:, None]
    k = np.arange(40)[None, :]
    return factor * (1 + p + 100 * k) * 1e-3  # N^2 mm


def check_axes(data, positions):
    np.testing.assert_allclose(data.position, 5 + 0.5 * np.arange(positions), rtol=1e-14)
    np.testing.assert_allclose(data.spatial_frequency, np.arange(40) * 1e3 / 16384, rtol=1e-14)
    assert data.position.attrs["units"] == "mm" and data.position.attrs["long_name"]
    assert data.spatial_frequency.attrs["units"] == "1/mm"
    assert data.density.attrs["units"] == "N2 mm"
    assert data.density.attrs["long_name"] == "power spectral density of tangential_force"
    assert data.density.dtype == np.float32


def check_attributes(attributes):
    texts = {"Conventions": "CF-1.10", "kind": "spectrogram", "version": "1.0", "window": "blackman",
             "scaling": "density, one-sided", "quantity": "tangential_force", "simulated": "a formula"}
    for name, text in texts.items():
        assert attributes[name] == text, name
    numbers = {"window_mm": 10, "hop_mm": 0.5, "pitch_mm": 1e-3, "padded_samples": 16384}
    for name, number in numbers.items():
        assert abs(attributes[name] / number - 1) < 1e-14, name
    assert attributes["source"].startswith("tactograph ")


def check_one(path):
    with xarray.open_dataset(path) as data:
        assert data.density.dims == ("position", "spatial_frequency")
        check_axes(data, 30)
        check_attributes(data.attrs)
        # Single precision: half a unit in the last place for each of two roundings.
        np.testing.assert_allclose(data.density, expected(30, 1), rtol=2.0**-23)


def check_two(path):
    with xarray.open_dataset(path) as data:
        assert data.density.dims == ("stroke", "position", "spatial_frequency")
        check_axes(data, 30)
        assert list(data.stroke) == [1, 2]
        assert data.attrs["texture"].split("\n") == ["oak-01", "oak-02"]
        np.testing.assert_allclose(data.density[0], expected(30, 1), rtol=2.0**-23)
        np.testing.assert_allclose(data.density[1, :20], expected(20, 2), rtol=2.0**-23)
        assert np.isnan(data.density[1, 20:]).all()


def check_storage(path):
    with netCDF4.Dataset(path) as file:
        assert file.data_model == "NETCDF4"
        density = file["density"]
        assert not density.filters()["zlib"] and file["known"].filters()["zlib"]
        assert np.isnan(density.getncattr("_FillValue"))


def check_known(path):
    """The valid bins of the example are 2.5 + p to 20.5 (at position p)."""
    with xarray.open_dataset(path) as data:
        known = data.known.values
        assert known.dtype == np.int8
        assert list(data.known.attrs["flag_values"]) == [0, 1] and data.known.attrs["flag_meanings"] == "unknown known"
        p, k = np.arange(30)[:, None], np.arange(40)[None, :]
        expected_known = (k >= 2.5 + p) & (k <= 20.5)
        np.testing.assert_array_equal(known[0], expected_known)
        np.testing.assert_array_equal(known[1, :20], expected_known[:20])
        assert not known[1, 20:].any()
        np.testing.assert_allclose(data.known_to[0], 20.5 * 1e3 / 16384, rtol=1e-14)
        assert data.known_from.attrs["units"] == "1/mm" and np.isnan(data.known_from[1, 20:]).all()


with tempfile.TemporaryDirectory() as folder:
    out = os.path.join(folder, "oak")
    subprocess.run([sys.argv[1], out], check=True)
    check_one(out + ".nc")
    check_two(out + "-two.nc")
    check_storage(out + ".nc")
    check_known(out + "-two.nc")
print("spectrograms open in xarray and netCDF4 with labelled axes")
