# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures: a quantity against position (NAME.texture.json and NAME.texture.wav)."""
import numpy as np
import xarray

from tactograph.documents import check_sum, find, plain_attributes, read_document
from tactograph.wav import expect_frames, read_samples


def read_texture(name, check=False):
    """A texture as an xarray.Dataset along `position`.

    name: the stem, NAME.texture.json or NAME.texture.wav. check: also compare the samples with the document's SHA-256.

    The variable is named by its quantity (`tangential_force`, N, by default; `height`, m, of a profile). `position` (m) is 0
    at the first sample; `bench_position` (m) is where it was on the bench. `valid_from` and `valid_to` (1/m) are the
    band in which the texture is valid at each position, straight between the document's breakpoints; `valid` is False where
    no band is left. The mean of several strokes also has `standard_deviation` and `strokes`, how many were averaged there.
    Raises FileProblem.
    """
    path = find(name, [".texture.json", ".texture.wav"])
    document = read_document(path, "texture")
    wav = path.with_name(document["data"]["file"])
    samples = read_samples(wav, integers=False)
    expect_frames(samples, document["data"]["samples"], wav)
    if check:
        check_sum(wav, document["data"]["sha256"])
    return _dataset(document, samples)


def _dataset(document, samples):
    position = np.arange(len(samples)) * document["pitch_m"]
    metre = {"units": "m"}
    coordinates = {
        "position": ("position", position, metre | {"long_name": "position along the texture"}),
        "bench_position": ("position", position + document["source_origin_m"], metre | {"long_name": "position on the bench"}),
    }
    quantity, unit = document["quantity"], {"units": document["unit"]}
    variables = {quantity: ("position", samples[:, 0], unit | {"long_name": quantity.replace("_", " ")})}
    variables.update(_band(document.get("valid_band", []), position))
    if "average" in document:
        variables["standard_deviation"] = ("position", samples[:, 1], unit | {"long_name": "over the strokes"})
        variables["strokes"] = ("position", _strokes_at(document["average"]["counts"], position),
                                {"long_name": "number of strokes averaged"})
    attributes = plain_attributes(document, {"data", "valid_band", "quantity", "unit", "channels"})
    return xarray.Dataset(variables, coordinates, attributes)


def _band(points, position):
    if not points:
        return {}
    at = [point["position_m"] for point in points]
    low = np.interp(position, at, [point["low_per_m"] for point in points])
    high = np.interp(position, at, [point["high_per_m"] for point in points])
    return {
        "valid_from": ("position", low, {"units": "1/m", "long_name": "lowest valid spatial frequency"}),
        "valid_to": ("position", high, {"units": "1/m", "long_name": "highest valid spatial frequency"}),
        "valid": ("position", low < high, {"long_name": "valid in some band"}),
    }


def _strokes_at(counts, position):
    starts = [count["position_m"] for count in counts]
    # Half a sample early: the starts are samples' positions, printed as decimals.
    early = (position[1] - position[0]) / 2 if len(position) > 1 else 0.0
    index = np.searchsorted(starts, position + early, side="right") - 1
    return np.array([count["strokes"] for count in counts])[np.maximum(index, 0)]
