#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` with the protocol amplitude on the emulated device: gains by their hash, a killed run, proof of the
gain, the match of a known observer and its interval against SciPy, export, and wrong use."""
import csv
import hashlib
import json
import pathlib
import signal
import subprocess
import time

import numpy as np
import scipy.stats

import experiment_files
import tacto

TRIALS, MATCH = 30, 0.86
RUN = ["experiment", "run", "strength", "-d", "sim:"]


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def sum_of(text):
    return hashlib.sha256(text.encode()).hexdigest()


def ratio_of(participant, trial):
    return 2 * (int(sum_of(f"lab/{participant}/1/{trial}/ratio")[:13], 16) + 0.5) / 2**52


def repeat(study, times):
    path = pathlib.Path(f"{study}.protocol.json")
    protocol = json.loads(path.read_text())
    path.write_text(json.dumps({**protocol, "repetitions": times}))


def a_study_is_made_of_one_texture():
    tacto.run("record", "-d", "sim:surface=E,speed=50mm/s,seed=1", "--time", "2s", "-o", "recording")
    tacto.run("spatial", "recording", "-o", "E", "--stroke", "1")
    new = ["experiment", "new", "amplitude", "--seed", "lab", "-o", "strength"]
    tacto.run(*new, code=2)
    tacto.run(*new, "--textures", "E,F", code=3)
    tacto.run(*new, "--textures", "E", "--comparisons", "E", code=2)
    tacto.run(*new, "--textures", "E")
    repeat("strength", TRIALS)
    checked = tacto.run_json("experiment", "check", "strength", "-d", "sim:")
    assert checked["valid"] is True and (checked["task"], checked["trials"], checked["largest_ratio"]) == ("amplitude", TRIALS, 2)
    assert tacto.run_json("validate", "strength.protocol.json", "strength.key.json")["valid"] is True
    for observer in ("weber=25%", "template", "match=86%"):
        tacto.run(*RUN, "--participant", "P01", "--observer", observer, code=2)
    assert not pathlib.Path("strength-P01.trials.jsonl").exists()


def the_gain_is_the_one_that_the_hash_says():
    tacto.run(*RUN, "--participant", "P01", "--observer", "match=86%,weber=10%,lapse=2%,seed=4")
    begun = [entry["trial"] for entry in journal("strength-P01") if entry["event"] == "begun"]
    assert begun[:TRIALS] == sorted((f"K1.{i + 1}" for i in range(TRIALS)), key=lambda trial: sum_of(f"lab/P01/1/{trial}"))
    gain = json.loads(pathlib.Path("strength.protocol.json").read_text())["gain_m_per_n"]
    rows = [row for row in table("strength-P01") if row["delivered"] == "yes"]
    assert len(rows) >= TRIALS - 1, len(rows)  # of a ratio near 0 the steps of the drive are a large part
    for row in rows:
        asked = ratio_of("P01", row["trial"])
        assert abs(float(row["nominal_ratio"]) - asked) < 1e-8 and abs(float(row["predicted_ratio"]) - asked) < 0.02, row
        assert -3 <= int(row["rating"]) <= 3 and row["rating"] == row["answer"]
    for row in rows[:3]:  # the header of its session names the same gain
        header = tacto.run_json("info", f"strength-P01/{int(row['attempt']):03}-1.session")
        assert abs(header["textures"][0]["gain_m_per_n"] / (gain * ratio_of("P01", row["trial"])) - 1) < 1e-6, header
    proof = tacto.run_json("experiment", "prove", "strength-P01")
    assert proof["proven"] is True and proof["delivered"] == len(rows) and proof["same_to_the_bit"] == proof["sessions"]
    assert 0 < proof["ratio_error"] < 0.02 and "stretch_error" not in proof


def posterior(ratios, ratings):
    """Median and ends of the 95 % interval: the same model, other nodes, and all lapses."""
    low, high = min(ratios), max(ratios)
    match = np.linspace(low, high, 251)
    lapses = scipy.stats.beta(1, 19).ppf((np.arange(6) + 0.5) / 6)
    mass = np.zeros(len(match))
    for spread in np.linspace(0.0025, 0.5, 50) * (high - low):
        for half in np.linspace(0, 0.5, 25) * (high - low):
            below = scipy.stats.norm.cdf((match[:, None] - half - ratios) / spread)
            above = scipy.stats.norm.sf((match[:, None] + half - ratios) / spread)
            part = np.where(ratings < 0, below, np.where(ratings > 0, above, 1 - below - above))
            for lapse in lapses:
                mass += np.prod((1 - lapse) * part + (ratings != 0) * lapse / 2, axis=1)
    return np.interp([0.5, 0.025, 0.975], np.cumsum(mass) / mass.sum(), match + (match[1] - match[0]) / 2)


def the_match_is_found():
    tacto.run("experiment", "analyse", "strength", code=5)
    report = tacto.run_json("experiment", "analyse", "strength", "--unblind", "-o", "strength.html", "-o", "strength.results.json")
    assert pathlib.Path("strength.html").exists() and "match=86%" in report["simulated"]
    (person,) = report["people"]
    rows = [row for row in table("strength-P01") if row["delivered"] == "yes"]
    ratios, ratings = (np.array([float(row[name]) for row in rows]) for name in ("nominal_ratio", "rating"))
    assert person["rated_0"] == np.sum(ratings == 0) > 0 and abs(person["mean_ratio_at_0"] - np.mean(ratios[ratings == 0])) < 1e-8
    found = [person["match"], person["match_low"], person["match_high"]]
    # The grid's step is 0.5 % of the range, and its lapses are four.
    assert np.abs(np.array(found) - posterior(ratios, ratings)).max() < 0.015, (found, posterior(ratios, ratings))
    assert person["match_low"] < MATCH < person["match_high"] and person["match_high"] - person["match_low"] < 0.3, person
    assert (report["match"], report["match_low"]) == (person["match"], person["match_low"])


def a_killed_run_is_resumed():
    path = pathlib.Path("strength-P02.trials.jsonl")
    process = subprocess.Popen([tacto.COMMAND, *RUN, "--participant", "P02", "--observer", "match=110%,weber=10%,seed=5"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < 8):
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = path.read_bytes()[:path.read_bytes().rindex(b"\n") + 1]
    if b'"event":"end"' not in kept:  # else this process waited long
        assert tacto.run_json("experiment", "resume", "strength-P02")["complete"] is True
    assert path.read_bytes().startswith(kept)
    counted = [row["trial"] for row in table("strength-P02") if row["answer"] and row["delivered"] == "yes"]
    assert len(counted) == len(set(counted)) >= TRIALS - 1
    assert tacto.run_json("experiment", "prove", "strength-P02")["proven"] is True
    report = tacto.run_json("experiment", "analyse", "strength", "--unblind")
    matches = [person["match"] for person in report["people"]]
    assert len(matches) == 2 and abs(report["match"] - np.exp(np.mean(np.log(matches)))) < 1e-9
    assert report["people"][1]["match_low"] < 1.1 < report["people"][1]["match_high"]


def ratings_of_one_kind_are_a_bound():
    tacto.run("experiment", "new", "amplitude", "--textures", "E", "-o", "few")
    repeat("few", 3)
    pathlib.Path("answers.txt").write_text("2\nl\n" * 9)
    tacto.run("experiment", "run", "few", "-d", "sim:", "--participant", "P03", "--answers", "answers.txt")
    (person,) = tacto.run_json("experiment", "analyse", "few", "--unblind")["people"]
    assert "match" not in person and "mean_ratio_at_0" not in person and person["rated_0"] == 0
    assert {row["rating"] for row in table("few-P03") if row["answer"]} == {"2", "3"}


def other_verbs():
    tacto.run("experiment", "export", "strength", "--unblind", "-o", "out")
    assert not pathlib.Path("out/analysis.R").exists()
    with open("out/trials.csv") as file:
        rows = list(csv.DictReader(file))
    assert {row["participant"] for row in rows} == {"P01", "P02"} and "correct" not in rows[0]
    for row in rows:
        assert abs(float(row["nominal_ratio"]) - ratio_of(row["participant"], row["trial"])) < 1e-8
    sidecar = json.loads(pathlib.Path("out/sub-P01/beh/sub-P01_task-strength_beh.json").read_text())
    assert {"rating", "nominal_ratio", "predicted_ratio"} <= set(sidecar)
    tacto.run("experiment", "power", "strength", "--weber", "15.5%,25.3%", "--spread", "23%", code=5)


def study():
    a_study_is_made_of_one_texture()
    the_gain_is_the_one_that_the_hash_says()
    the_match_is_found()
    a_killed_run_is_resumed()
    ratings_of_one_kind_are_a_bound()
    other_verbs()
    experiment_files.keep_to_their_schemas("delivered", "resumed")


if __name__ == "__main__":
    tacto.in_folder(study)
