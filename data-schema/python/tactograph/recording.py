# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings: physical quantities against time (NAME.json and NAME.wav)."""
import numpy as np
import xarray

from tactograph.documents import check_sum, find, plain_attributes, read_document
from tactograph.errors import FileProblem
from tactograph.wav import expect_frames, read_samples


def read_recording(name, check=False):
    """A recording as an xarray.Dataset along `time`.

    name: the stem, NAME.json or NAME.wav. check: also compare the samples with the SHA-256 of the document.

    One variable a channel, float64, in its SI unit (physical = stored x scale + offset), named as in the document.
    `time` (s) is the device's sequence over the rate: where frames are missing it goes on behind the gap, and nothing is
    filled in. `sequence` is each frame's number with the missing ones counted; `after_gap` is True at a gap's next frame.
    A channel with a `native_rate_hz` is slower than the recording: each of its values is repeated.
    `NAME_clipped` is True where the channel NAME is at an end of its range; only channels with a known range have it.
    Gaps and marks are attributes, as JSON texts. Raises FileProblem.
    """
    path = find(name, [".json", ".wav"])
    document = read_document(path, "recording")
    wav = path.with_name(document["data"]["file"])
    samples = read_samples(wav, integers=document["data"]["format"] == "pcm32")
    expect_frames(samples, document["data"]["frames"], wav)
    if samples.shape[1] != len(document["channels"]):
        raise FileProblem(f"holds {samples.shape[1]} channels, its document names {len(document['channels'])}", wav)
    if check:
        check_sum(wav, document["data"]["sha256"])
    return _dataset(document, samples)


def _dataset(document, samples):
    sequence, after_gap = _sequence(document.get("gaps", []), len(samples))
    time = xarray.Variable("time", sequence / document["sample_rate_hz"], {"units": "s", "long_name": "time"})
    variables = {}
    for stored, channel in zip(samples.T, document["channels"]):
        variables.update(_channel(stored, channel))
    variables["sequence"] = ("time", sequence, {"long_name": "frame number, missing frames counted"})
    variables["after_gap"] = ("time", after_gap, {"long_name": "frames are missing before this one"})
    return xarray.Dataset(variables, {"time": time}, plain_attributes(document, {"channels", "data"}))


def _sequence(gaps, frames):
    """Each frame's number with missing frames counted, and where a gap ends."""
    sequence = np.arange(frames, dtype=np.int64)
    after_gap = np.zeros(frames, dtype=bool)
    for gap in gaps:
        sequence[gap["frame"]:] += gap["count"]
        after_gap[gap["frame"]:gap["frame"] + 1] = True
    return sequence, after_gap


def _channel(stored, channel):
    values = stored * channel["scale"] + channel["offset"]
    attributes = {"units": channel["unit"], "long_name": channel["quantity"].replace("_", " ")}
    attributes.update(plain_attributes(channel, {"unit", "name", "range_min", "range_max"}))
    made = {channel["name"]: ("time", values, attributes)}
    if "range_min" in channel and "range_max" in channel:
        step = abs(channel["scale"]) / 2
        clipped = (values <= channel["range_min"] + step) | (values >= channel["range_max"] - step)
        made[channel["name"] + "_clipped"] = ("time", clipped, {"long_name": "at an end of the converter's range"})
    return made
