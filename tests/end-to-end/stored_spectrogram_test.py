#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A spectrogram's netCDF file: decibels for plots, and a checksum that detects changed cells."""
import hashlib
import shutil

import netCDF4
import numpy as np
import xarray

import tacto

MALFORMED = 4


def checksum(data, stroke=None):
    """As described in `spectrogram_sum.hpp`."""
    rows = data if stroke is None else data.isel(stroke=stroke)
    whole = ~np.isnan(rows.density.values).all(axis=1)
    parts = [rows.density.values[whole], rows.known_from.values[whole], rows.known_to.values[whole],
             rows.position.values[whole], rows.spatial_frequency.values]
    return hashlib.sha256(b"".join(np.ascontiguousarray(part).astype(part.dtype.newbyteorder("<")).tobytes()
                                   for part in parts)).hexdigest()


def make():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "rec")
    tacto.run("spectrogram", "rec.json", "-o", "all.nc")
    tacto.run("spatial", "rec", "--stroke", "1", "-o", "oak")
    tacto.run("spectrogram", "oak", "-o", "oak.nc")


def decibels_stand_beside_densities_frequency_first():
    make()
    for name in ("oak.nc", "all.nc"):
        with xarray.open_dataset(name) as data:
            assert data.attrs["version"] == "1.2"
            assert data.density_db.dims[-2:] == ("spatial_frequency", "position"), data.density_db.dims
            assert data.density.dims[-2:] == ("position", "spatial_frequency"), "as in version 1.1"
            assert data.density_db.attrs["units"] == "dB" and "re 1 N2 mm" in data.density_db.attrs["long_name"]
            density = np.moveaxis(data.density.values.astype(np.float64), -1, -2)
            with np.errstate(divide="ignore"):
                expected = np.where(density > 0, 10 * np.log10(density), np.nan)
            # to_decibels(): within 2e-5 dB, and a rounding of numbers down to -300 dB in single precision.
            np.testing.assert_allclose(data.density_db.values, expected, rtol=0, atol=4e-5)


def changed_cells_are_found():
    make()
    for name in ("oak.nc", "all.nc"):
        tacto.run("validate", name)
        with xarray.open_dataset(name) as data:
            strokes = data.sizes.get("stroke")
            sums = [checksum(data)] if strokes is None else [checksum(data, n) for n in range(strokes)]
            assert data.attrs["sha256"].split("\n") == sums
        for variable, factor in (("density", 1.5), ("density_db", 1.01), ("known_from", 1.2), ("position", 1.0001), ("known", 0)):
            shutil.copy(name, "changed.nc")
            with netCDF4.Dataset("changed.nc", "a") as file:
                file.set_auto_mask(False)
                values = file[variable][:]
                middle = tuple(size // 2 for size in values.shape)
                if variable == "known":
                    middle = tuple(np.argwhere(values == 1)[len(np.argwhere(values == 1)) // 2])
                values[middle] = values[middle] * factor
                file[variable][:] = values
            report, _ = tacto.run("validate", "changed.nc", code=MALFORMED)
            assert "changed.nc" in report, report


def files_without_a_checksum_still_read():
    """Files of version 1.1: no decibels, no checksum."""
    make()
    with xarray.open_dataset("oak.nc", mask_and_scale=False) as data:
        old = data.drop_vars("density_db")
        old.attrs = {**data.attrs, "version": "1.1"}
        del old.attrs["sha256"]
        old.to_netcdf("old.nc")
    said, _ = tacto.run("validate", "old.nc")
    assert "no checksum" in said, said
    new, before = (tacto.run_json("info", name) for name in ("oak.nc", "old.nc"))
    assert {**new, "file": ""} == {**before, "file": ""}


if __name__ == "__main__":
    for test in (decibels_stand_beside_densities_frequency_first, changed_cells_are_found, files_without_a_checksum_still_read):
        tacto.in_folder(test)
