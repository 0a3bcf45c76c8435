#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A spectrogram's netCDF file: decibels for plots, and a checksum that detects changed cells, units and attributes."""
import hashlib
import shutil
import struct

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
    texts = [data.attrs.get(name, "") for name in ("texture", "simulated", "quantity", "quantity_unit", "scaling", "window", "detrend")]
    numbers = [data.attrs[name] for name in ("window_mm", "hop_mm", "pitch_mm", "window_coherent_gain", "padded_samples", "decimation")]
    units = [data[name].attrs["units"] for name in ("position", "spatial_frequency", "known_from", "known_to", "density", "density_db")]
    return hashlib.sha256(b"".join(np.ascontiguousarray(part).astype(part.dtype.newbyteorder("<")).tobytes() for part in parts)
                          + "".join(text + "\n" for text in texts).encode() + struct.pack(f"<{len(numbers)}d", *numbers)
                          + "".join(unit + "\n" for unit in units).encode()).hexdigest()


def make():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "rec")
    tacto.run("spectrogram", "rec.json", "-o", "all.nc")
    tacto.run("spatial", "rec", "--stroke", "1", "-o", "oak")
    tacto.run("spectrogram", "oak", "-o", "oak.nc")


def decibels_stand_beside_densities_frequency_first():
    make()
    for name in ("oak.nc", "all.nc"):
        with xarray.open_dataset(name) as data:
            assert data.attrs["version"] == "1.0"
            assert data.density_db.dims[-2:] == ("spatial_frequency", "position"), data.density_db.dims
            assert data.density.dims[-2:] == ("position", "spatial_frequency"), data.density.dims
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


# Attributes that give no number a meaning.
ONLY_WORDS = {"Conventions", "title", "source", "long_name", "flag_values", "flag_meanings", "_FillValue"}


def another_value(value):
    return value + "x" if isinstance(value, str) else np.asarray(value) * 2 + 1


def each_attribute_with_a_meaning_is_covered():
    """One of the variables' and of the file's attributes at a time, changed or deleted."""
    make()
    tacto.run("spectrogram", "oak", "-o", "amplitude.nc", "--scaling", "amplitude")
    for name in ("oak.nc", "all.nc", "amplitude.nc"):
        with netCDF4.Dataset(name) as file:
            places = [(variable, attribute) for variable in (None, *file.variables)
                      for attribute in (file[variable] if variable else file).ncattrs() if attribute not in ONLY_WORDS]
        assert {(None, "window_mm"), (None, "hop_mm"), (None, "pitch_mm"), (None, "padded_samples"), (None, "decimation"), (None, "window"),
                ("position", "units"), ("spatial_frequency", "units"), ("known_from", "units"), ("known_to", "units")} < set(places), places
        for variable, attribute in places:
            for delete in (False, True):
                shutil.copy(name, "changed.nc")
                with netCDF4.Dataset("changed.nc", "a") as file:
                    item = file[variable] if variable else file
                    if delete:
                        item.delncattr(attribute)
                    else:
                        item.setncattr(attribute, another_value(item.getncattr(attribute)))
                tacto.run("validate", "changed.nc", code=MALFORMED)


def a_file_without_a_checksum_is_read_and_invalid():
    make()
    with xarray.open_dataset("oak.nc", mask_and_scale=False) as data:
        old = data.copy()
        del old.attrs["sha256"]
        old.to_netcdf("old.nc")
    report = tacto.run_json("validate", "old.nc", code=MALFORMED)
    assert not report["valid"] and [fault["where"] for fault in report["faults"]] == ["old.nc"] and "sha256" in report["faults"][0]["what"], report
    new, before = (tacto.run_json("info", name) for name in ("oak.nc", "old.nc"))
    assert {**new, "file": ""} == {**before, "file": ""}


if __name__ == "__main__":
    for test in (decibels_stand_beside_densities_frequency_first, changed_cells_are_found, each_attribute_with_a_meaning_is_covered,
                 a_file_without_a_checksum_is_read_and_invalid):
        tacto.in_folder(test)
