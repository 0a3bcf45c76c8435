# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples of a WAV or RF64 file, as they are stored."""
import soundfile

from tactograph.errors import FileProblem


def read_samples(path, integers):
    """The stored numbers, shape (frames, channels): 32-bit integers, or 64-bit floats where `integers` is False.

    Integer codes come back unscaled. Raises FileProblem where the file is missing or is no WAV.
    """
    if not path.is_file():
        raise FileProblem("the samples are missing", path, "keep it beside its JSON document")
    try:
        samples, _ = soundfile.read(path, dtype="int32" if integers else "float64", always_2d=True)
    except RuntimeError as error:  # soundfile.LibsndfileError is one
        raise FileProblem(f"cannot be read as WAV ({error})", path) from error
    return samples


def expect_frames(samples, expected, path):
    """Raises FileProblem where the file has another number of frames than its document gives."""
    if len(samples) != expected:
        raise FileProblem(f"contains {len(samples)} frames, its document gives {expected}", path, "copy it again")
