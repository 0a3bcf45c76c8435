#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The script of `experiment export` in R: the answers of real people (with the figures of lme4), and those of a study."""
import csv
import io
import os
import pathlib
import shutil
import subprocess

import tacto

SPEEDS = pathlib.Path(os.environ.get("TACTO_DATA", pathlib.Path(__file__).parents[3] / "shared/data")) / "psychophysics/tactile-speed.csv"


def script(*arguments):
    done = subprocess.run(["Rscript", "export/analysis.R", *map(str, arguments)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done
    return {row["condition"]: row for row in csv.DictReader(io.StringIO(done.stdout))}


def a_staircase_has_no_pse():
    """The same model as the verb's: one slope, no lapses."""
    table = pathlib.Path("export/trials.csv")
    whole = table.read_text()
    head, *rows = whole.splitlines()
    column = head.split(",").index("nominal_stretch")
    table.write_text("\n".join([head, *(row for row in rows if float(row.split(",")[column]) > 0)]) + "\n")
    fitted = script()["all"]
    assert float(fitted["pse"]) == 0 and 0.253 * 0.55 < float(fitted["jnd"]) < 0.253 * 1.45, fitted
    table.write_text(whole)


def the_exported_script_runs():
    tacto.run("experiment", "new", "stretch", "-o", "stretch", "--seed", "lab-7")
    for participant in ("P01", "P02"):
        tacto.run("experiment", "run", "stretch", "-d", "sim:", "--participant", participant, "--observer", "weber=25.3%,seed=4")
    tacto.run("experiment", "export", "stretch", "--unblind", "-o", "export")
    fitted = script()["all"]
    # Both observers have the same Weber fraction. 160 trials: its standard error is below 15 % (binomial information).
    assert 0.253 * 0.55 < float(fitted["jnd"]) < 0.253 * 1.45 and abs(float(fitted["pse"])) < 0.15, fitted
    a_staircase_has_no_pse()
    if not SPEEDS.exists():
        print("skipped: no real data")
        return
    fitted = script(SPEEDS, "participant", "speed_cm_per_s", "faster", "slower", "vibration_hz")
    # glmer of lme4 1.1-31 with speed * vibration + (1 + speed | participant): to the digits of that table.
    assert abs(float(fitted["0"]["jnd"]) - 2.864) < 0.002 and abs(float(fitted["32"]["jnd"]) - 3.469) < 0.002, fitted


if __name__ == "__main__":
    if shutil.which("Rscript") is None or subprocess.run(["Rscript", "-e", "library(lme4)"], capture_output=True).returncode != 0:
        print("skipped: no R with lme4")
    else:
        tacto.in_folder(the_exported_script_runs)
