#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of fidelity (tests/MEASURED.md): texture C of the emulated device and a real finger's, looped, through the
emulated transducer. Takes the measuring program; fails if row (a) is worse than -50 dB, or if an encoder's step causes
more than a constant shift at whole and half counts per tick (rows b). Rows (b) use 9 speeds and 4 phases of the encoder
per rate; TACTO_ALL_PHASES=1 uses 40 of each (two minutes of CPU). Without the real data, and under the sanitizers,
which find nothing more with other numbers, only texture C is measured.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import made_files as made
from measured import not_measured

DATA = pathlib.Path(os.environ.get("TACTO_DATA", "")) / "bare-finger" / "bare_finger_10kHz.csv"


def make_textures(folder):
    made.report_of("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--strokes", "1", "-o", folder / "C", "--no-calibration")
    made.report_of("spatial", folder / "C", "-o", folder / "texture-C")
    names = [folder / "texture-C"]
    if DATA.is_file() and "TACTO_SANITIZED" not in os.environ:
        made.report_of("import", DATA, "-o", folder / "finger", "--rate", "10kHz", "--channel",
                       "tangential_force=lateral_V*0.444444N", "--channel", "position=encoder_count*0.5um")
        made.report_of("spatial", folder / "finger", "-o", folder / "real-finger", "--from", "4.55s", "--to", "6.85s")
        names.append(folder / "real-finger")
    else:
        not_measured("fidelity_table.real_finger.*", "no real data, or under sanitizers")
    return [str(name) for name in names]


def main():
    with tempfile.TemporaryDirectory() as name:
        textures = make_textures(pathlib.Path(name))
        phases = ["--all-phases"] if "TACTO_ALL_PHASES" in os.environ else []
        run = subprocess.run([sys.argv[1], *phases, *textures], capture_output=True, text=True)
    print(run.stdout.replace(name + "/", ""), run.stderr)
    rows = [line for line in run.stdout.splitlines() if line.startswith("| (")]
    assert len(rows) == len(textures) * len({row.split("|")[1] for row in rows}) >= 30 * len(textures), "rows are missing"
    assert sum(row.startswith("| (b)") for row in rows) == 6 * len(textures), "a kind of speed is missing"
    assert run.returncode == 0, "row (a) is worse than -50 dB, or a row (b) is beyond its bar"


if __name__ == "__main__":
    main()
