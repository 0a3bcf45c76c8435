#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The script of `experiment export` in R: the answers of real people (with the figures of lme4), and those of a study. R's glm against `experiment fit`."""
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


# The probit fit of each person and condition, iterated until the deviance changes by less than 1e-14.
GLM = """
answers <- read.csv(commandArgs(trailingOnly = TRUE)[1])
for (each in split(answers, list(answers$participant, answers$vibration_hz))) {
  b <- coef(glm(cbind(faster, slower) ~ speed_cm_per_s, family = binomial(link = probit), data = each,
                control = glm.control(epsilon = 1e-14, maxit = 100)))
  cat(sprintf("%s,%s,%.15g,%.15g\n", each$participant[1], each$vibration_hz[1], -b[1] / b[2], qnorm(0.75) / b[2]))
}
"""


def probit_fits_of_real_people_are_those_of_glm():
    if not SPEEDS.exists():
        print("skipped: no real data")
        return
    pathlib.Path("glm.R").write_text(GLM)
    done = subprocess.run(["Rscript", "glm.R", str(SPEEDS)], capture_output=True, text=True, check=True, timeout=600)
    expected = {(person, vibration): (float(pse), float(jnd)) for person, vibration, pse, jnd in csv.reader(io.StringIO(done.stdout))}
    fits = tacto.run_json("experiment", "fit", SPEEDS, "--by", "participant,vibration_hz", "--lapse", "0%")["fits"]
    assert len(fits) == len(expected) == 18, (fits, expected)
    for fit in fits:
        pse, jnd = expected[fit["participant"], fit["vibration_hz"]]
        assert abs(fit["pse"] / pse - 1) < 1e-6 and abs(fit["jnd"] / jnd - 1) < 1e-6, (fit, pse, jnd)


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
        for test in (probit_fits_of_real_people_are_those_of_glm, the_exported_script_runs):
            tacto.in_folder(test)
