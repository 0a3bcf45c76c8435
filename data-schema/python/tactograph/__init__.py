# SPDX-License-Identifier: GPL-3.0-or-later
"""Read the files of tactograph into xarray datasets: labelled axes, SI units, masks and gaps; control its daemon and recordings.

    import tactograph
    recording = tactograph.read_recording("oak")       # force and position against time
    texture = tactograph.read_texture("oak")           # force against position
    session = tactograph.read_session("first")         # each tick of a playback
    spectrogram = tactograph.read_spectrogram("oak")   # density against position and spatial frequency

A file is named by its stem or in full. The package writes no files. Its needs are NumPy, xarray, soundfile and netCDF4;
`.plot()` of a dataset needs matplotlib (Debian: python3-matplotlib). `Daemon` is a client of tactographd, `Recorder` steers a
recording.
"""
from tactograph.daemon import Daemon, DaemonProblem
from tactograph.errors import FileProblem
from tactograph.recorder import Recorder, RecorderProblem
from tactograph.recording import read_recording
from tactograph.session import read_session
from tactograph.spectrogram import read_spectrogram
from tactograph.texture import read_texture

__version__ = "0.1.0"  # that of the program (CMakeLists.txt); python_reader_test.py compares them
__all__ = ["Daemon", "DaemonProblem", "FileProblem", "Recorder", "RecorderProblem", "read_recording", "read_session", "read_spectrogram", "read_texture"]
