# SPDX-License-Identifier: GPL-3.0-or-later
"""Spatial spectrograms: density against position and spatial frequency (NAME.nc)."""
import numpy as np
import xarray

from tactograph.documents import check_kind, find
from tactograph.errors import FileProblem


def read_spectrogram(name):
    """A spatial spectrogram as an xarray.Dataset, loaded into memory.

    name: the stem or NAME.nc. `density` has dimensions `spatial_frequency` and `position` (and `stroke`), whatever their order in
    the file; `density_db` is 10 log10 of it (of amplitudes: `amplitude`, `amplitude_db`). `known` is True where the cell is within the texture's valid band.
    In SI units, where the file has millimetres: m, 1/m, N2 m; attributes end in `_m`. Raises FileProblem.
    """
    path = find(name, [".nc"])
    try:
        with xarray.open_dataset(path, engine="netcdf4") as opened:
            spectrogram = opened.load()
    except OSError as error:
        raise FileProblem(f"cannot be read as netCDF ({error})", path) from error
    check_kind(spectrogram.attrs, "spectrogram", path)
    if "known" in spectrogram:
        spectrogram["known"] = spectrogram["known"].astype(bool)
    for name in list(spectrogram.variables):
        spectrogram[name] = _in_metres(spectrogram[name])
    if "density" in spectrogram:
        spectrogram["density_db"] = _decibels(spectrogram["density"])
    spectrogram.attrs = {_key_in_metres(key): value * 1e-3 if key.endswith("_mm") else value
                         for key, value in spectrogram.attrs.items()}
    return spectrogram.transpose(..., "spatial_frequency", "position")


def _key_in_metres(key):
    return key[:-2] + "m" if key.endswith("_mm") else key


def _in_metres(variable):
    units = variable.attrs.get("units", "")
    if units == "1/mm":
        factor, units = 1e3, "1/m"
    elif units == "mm" or units.endswith(" mm"):
        factor, units = 1e-3, units[:-2] + "m"
    else:
        return variable
    converted = variable * np.asarray(factor, variable.dtype)
    converted.attrs = {**variable.attrs, "units": units}
    return converted


def _decibels(density):
    with np.errstate(divide="ignore"):
        level = 10 * np.log10(density.astype("float64"))
    level.attrs = {"units": "dB", "long_name": f"density re 1 {density.attrs.get('units', '')}".strip()}
    return level
