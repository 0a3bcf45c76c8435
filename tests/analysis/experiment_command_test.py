#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment fit` as a user runs it: published data, estimates against SciPy's, other people's tables, and
bad input."""
import csv
import json
import pathlib

import numpy as np
from scipy import optimize, stats

import tacto

PUBLISHED = tacto.DATA / "psychophysics"
SPEED = PUBLISHED / "tactile-speed.csv"
BY = ["--by", "participant,vibration_hz"]


def probit_by_scipy(level, yes, no):
    """Mean and standard deviation at the maximum of the likelihood, and the logarithm of that likelihood."""
    def cost(p):
        z = (level - p[0]) / np.exp(p[1])
        return -np.sum(yes * stats.norm.logcdf(z) + no * stats.norm.logsf(z))

    found = optimize.minimize(cost, [np.mean(level), np.log(np.std(level))], method="BFGS", options={"gtol": 1e-9})
    found = optimize.minimize(cost, found.x, method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13})
    return found.x[0], np.exp(found.x[1]), -found.fun


def eighteen_probit_fits_are_scipys():
    groups = {}
    with open(SPEED) as table:
        for row in csv.DictReader(table):
            group = groups.setdefault((row["participant"], row["vibration_hz"]), [])
            group.append([float(row[name]) for name in ("speed_cm_per_s", "faster", "slower")])
    report = tacto.run_json("experiment", "fit", SPEED, *BY, "--lapse", "0%")
    assert report["unit"] == "cm/s" and len(report["fits"]) == len(groups) == 18
    for fit in report["fits"]:
        level, yes, no = np.array(groups[fit["participant"], fit["vibration_hz"]]).T
        mean, sigma, log_likelihood = probit_by_scipy(level, yes, no)
        share = yes / (yes + no)
        most = np.sum(stats.binom.logpmf(yes, yes + no, share) - stats.binom.logpmf(yes, yes + no, 0.5) - (yes + no) * np.log(2))
        np.testing.assert_allclose([fit["pse"], fit["jnd"]], [mean, sigma * stats.norm.ppf(0.75)], rtol=1e-6)
        np.testing.assert_allclose(fit["deviance"], 2 * (most - log_likelihood), atol=1e-6)
        np.testing.assert_allclose(fit["p"], stats.chi2.sf(fit["deviance"], fit["degrees_of_freedom"]), rtol=1e-9)
        assert fit["degrees_of_freedom"] == 5 and fit["lapse"] == 0
        assert fit["pse_low"] < fit["pse"] < fit["pse_high"] and fit["jnd_low"] < fit["jnd"] < fit["jnd_high"]
    first = report["fits"][0]
    assert (first["participant"], first["vibration_hz"]) == ("S1", "0")
    np.testing.assert_allclose([first["pse"], first["jnd"]], [8.293, 3.574], atol=5e-4)
    people_are_compared_as_scipy_does(report)


def people_are_compared_as_scipy_does(report):
    jnd = {condition: [fit["jnd"] for fit in report["fits"] if fit["vibration_hz"] == condition] for condition in ("0", "32")}
    over = report["over_people"][0]
    expected = stats.ttest_rel(np.log(jnd["0"]), np.log(jnd["32"]))
    np.testing.assert_allclose([over["t"], over["p"]], [expected.statistic, expected.pvalue], rtol=1e-9)
    np.testing.assert_allclose([over["t"], over["p"]], [-4.06, 0.0036], rtol=2e-2)  # issue 36
    for condition, mean in zip(over["conditions"], (2.926, 3.619)):
        figures = np.log(jnd[condition["vibration_hz"]])
        low, high = stats.t.interval(0.95, 8, figures.mean(), stats.sem(figures))
        np.testing.assert_allclose(condition["mean"], mean, atol=5e-4)
        np.testing.assert_allclose([condition[f"geometric_mean{end}"] for end in ("", "_low", "_high")],
                                   np.exp([figures.mean(), low, high]), rtol=1e-9)


def lapses_are_fitted_by_default():
    report = tacto.run_json("experiment", "fit", SPEED, *BY)
    assert any(fit["lapse"] > 0.01 for fit in report["fits"]) and all(fit["lapse_high"] > fit["lapse"] for fit in report["fits"])
    fixed = tacto.run_json("experiment", "fit", SPEED, *BY, "--lapse", "0%")
    assert report["without_lapses"] == fixed["over_people"] and "without_lapses" not in fixed


def a_threshold_with_guessing():
    fit = tacto.run_json("experiment", "fit", PUBLISHED / "psignifit-example.csv", "--guess", "50%", "--overdispersed")["fits"][0]
    np.testing.assert_allclose([fit["threshold"], fit["width"]], [0.00464485, 0.00468384], rtol=1e-2)
    np.testing.assert_allclose([fit["threshold_low"], fit["threshold_high"]], [0.00428294, 0.00496425], rtol=1.5e-2)
    assert "jnd" not in fit and fit["overdispersion_high"] > 0
    # Two alternatives: without --guess the model is wrong, and the option is named; of the other table it is not.
    assert "--guess 50%" in tacto.run("experiment", "fit", PUBLISHED / "psignifit-example.csv")[0]
    assert "--guess 50%" not in tacto.run("experiment", "fit", SPEED, *BY)[0]
    weibull = tacto.run_json("experiment", "fit", PUBLISHED / "psignifit-example.csv", "--guess", "50%", "--function", "weibull")["fits"][0]
    assert weibull["exponent_low"] < weibull["exponent"] < weibull["exponent_high"]
    np.testing.assert_allclose(weibull["threshold"], fit["threshold"], rtol=0.02)


def a_scale_of_baseball_teams():
    scale = tacto.run_json("experiment", "fit", "--pairs", PUBLISHED / "baseball.csv")["scales"][0]
    names = ["Milwaukee", "Detroit", "Toronto", "New York", "Boston", "Cleveland", "Baltimore"]
    assert [item["item"] for item in scale["items"]] == names
    # BradleyTerry2's abilities (shared/data/psychophysics/README.md); the deviance is Agresti's, 1990
    np.testing.assert_allclose([item["ability"] for item in scale["items"]],
                               [1.5814, 1.4364, 1.2945, 1.2476, 1.1077, 0.6839, 0], atol=1e-4)
    np.testing.assert_allclose(scale["deviance"], 15.74, atol=5e-3)
    assert scale["degrees_of_freedom"] == 15


def pages_pictures_results():
    printed, _ = tacto.run("experiment", "fit", SPEED, *BY, "-o", "speed.html", "-o", "speed.results.json")
    page = pathlib.Path("speed.html").read_text()
    assert page.count("data:image/svg+xml") == 9 and "S9" in page and "speed.html" in printed
    curves = [curve["name"] for picture in json.loads(pathlib.Path("speed.results.json").read_text())["pictures"] for curve in picture["curves"]]
    assert set(curves) == {"", "vibration_hz 0", "vibration_hz 32"}, curves
    assert tacto.run_json("info", "speed.results.json")["verb"] == "experiment fit"
    tacto.run("experiment", "fit", "--pairs", PUBLISHED / "baseball.csv", "-o", "teams.svg", "-o", "teams.html")
    assert pathlib.Path("teams.svg").read_text().lstrip().startswith("<?xml") and "Milwaukee" in pathlib.Path("teams.svg").read_text()
    tacto.run("experiment", "fit", "--pairs", PUBLISHED / "baseball.csv", "-o", "teams.svg", code=2)  # exists
    tacto.run("experiment", "fit", SPEED, *BY, "-o", "speed.svg", code=2)  # nine pictures
    assert not pathlib.Path("speed.svg").exists()


def write(name, *lines):
    pathlib.Path(name).write_text("\n".join(lines) + "\n")
    return name


def other_peoples_tables():
    counts = [(1, 2), (2, 5), (3, 9), (4, 15), (5, 19)]
    plain = write("plain.csv", "level,yes,n", *(f"{level},{yes},20" for level, yes in counts))
    expected = tacto.run_json("experiment", "fit", plain)["fits"]
    german = write("german.csv", "Messung vom 3. Mai", "", "Pegel [mm];größer;kleiner",
                   *(f"{level},0;{yes};{20 - yes}" for level, yes in counts))
    report = tacto.run_json("experiment", "fit", german)
    assert report["unit"] == "mm" and report["fits"] == expected
    trials = write("trials.csv", "trial,level,answer,seconds",
                   *(f"{20 * i + k},{level},{int(k < yes)},0.7" for i, (level, yes) in enumerate(counts) for k in range(20)))
    report = tacto.run_json("experiment", "fit", trials, "--level", "level", "--yes", "answer")
    assert report["fits"] == expected
    people = write("people.csv", "who,level,yes,n", *(f"\"{who}\",{level},{yes},20" for who in ("P10", "P9, left") for level, yes in counts))
    assert [fit["who"] for fit in tacto.run_json("experiment", "fit", people, "--by", "who")["fits"]] == ["P10", "P9, left"]


def fault(*arguments, code):
    return tacto.run("experiment", "fit", *arguments, code=code)[1]


def bad_input():
    table = write("bad.csv", "level,yes,n", "1,0,10", "2,5,10", "3,11,10")
    assert "bad.csv: line 4, column 2 ('yes')" in fault(table, code=4)
    half = write("half.csv", "level,yes,n", "1,0,10", "2,5.5,10")
    assert "half.csv: line 3, column 2 ('yes')" in fault(half, code=4)
    assert "'vibration_hz'" in fault(SPEED, "--by", "participant,vibration", code=2)
    assert "5 'slower'" in fault(SPEED, code=2)
    fault(SPEED, *BY, "--level", "speed_cm_per_s", code=2)
    fault(SPEED, *BY, "--level", "speed_cm_per_s", "--yes", "faster", "--no", "slower", "--trials", "slower", code=2)
    alike = write("alike.csv", "who,level,yes,n", "A,1,1,10", "A,2,5,10", "A,3,9,10", "B,1,10,10", "B,2,10,10")
    assert "alike.csv: B" in fault(alike, "--by", "who", code=5)
    always = write("always.csv", "winner,loser,count", "a,b,3", "b,c,2", "c,b,1")
    assert " a" in fault("--pairs", always, code=5)
    fault("--pairs", SPEED, code=2)
    for option in (["--guess", "100%"], ["--guess", "0.5"], ["--lapse", "50%"], ["--guess", "50%", "--lapse", "25%"], ["-o", "x.png"]):
        fault(table, *option, code=2)
    fault("nothing.csv", code=3)
    fault(PUBLISHED / "watson2017.json", code=5)
    fault(write("names.csv", "1,2,3", "2,2,3"), code=4)


def tables_of_answers():
    if PUBLISHED.is_dir():
        eighteen_probit_fits_are_scipys()
        lapses_are_fitted_by_default()
        a_threshold_with_guessing()
        a_scale_of_baseball_teams()
        pages_pictures_results()
    other_peoples_tables()
    bad_input()


if __name__ == "__main__":
    tacto.in_folder(tables_of_answers)
