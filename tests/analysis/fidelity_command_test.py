#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`fidelity` names the limit behind an error in each row, and what was lost at each speed."""
import os
import pathlib

import tacto


def the_limit_behind_an_error_is_named():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "C", "--no-calibration")
    tacto.run("spatial", "C", "-o", "C", "--stroke", "1")
    ideal = lambda done: {row["speed_mps"]: row for row in done["fidelity"] if row["tray"] == "ideal"}
    free = tacto.run_json("fidelity", "C", "--speed", "50mm/s,150mm/s")
    assert all(row["limited_by"] == "no limit" for row in free["fidelity"]), free
    # At 150 mm/s half of the texture's frequencies are above 500 Hz: no error, but lost.
    kept = {row["speed_mps"]: row["band_kept_percent"] for row in free["lost"]}
    assert kept[0.05] > 95 and 50 < kept[0.15] < 70, kept
    limited = tacto.run_json("fidelity", "C", "--speed", "50mm/s", "--gain", "3mm/N")
    row, lost = ideal(limited)[0.05], limited["lost"][0]
    assert row["limited_by"] == "drive limit" and lost["amplitude_limited_ticks"] > 0, limited
    # The ideal tray follows the drive, so its error is what the limit removed: 0.5 dB for the ways of counting.
    assert abs(row["error_db"] - lost["removed_db"]) < 0.5, (row, lost)
    # A folder for temporary files that is not there.
    folder, os.environ["TMPDIR"] = os.environ.get("TMPDIR", "/tmp"), "/nowhere"
    refused = tacto.error_of("fidelity", "C", "--speed", "50mm/s", "-o", "C.html", code=7)
    assert refused["where"].startswith("/nowhere/") and not pathlib.Path("C.html").exists(), refused
    os.environ["TMPDIR"] = folder


if __name__ == "__main__":
    tacto.in_folder(the_limit_behind_an_error_is_named)
