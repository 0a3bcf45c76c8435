#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` with the protocol adjustment on the emulated device: starts by their hash, settings as marks of the
session, the accepted gain from the session, a known observer against NumPy, keys at a terminal, a killed run, and wrong use."""
import csv
import hashlib
import json
import pathlib
import signal
import subprocess
import time

import numpy as np
import scipy.signal
import scipy.stats

import experiment_files
import tacto
from person import Person

LOW, HIGH = 0.05, 4.0
OBSERVER = "threshold=30%,sd=5%,hysteresis=20%,seed=2"


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def sum_of(text):
    return hashlib.sha256(text.encode()).hexdigest()


def start_of(participant, trial):
    part = (int(sum_of(f"lab/{participant}/1/{trial}/start")[:13], 16) + 0.5) / 2**52 / 4
    return LOW * (HIGH / LOW) ** part if int(trial.split(".")[1]) % 2 else HIGH / (HIGH / LOW) ** part


def new_study(name, *options, **changes):
    tacto.run("experiment", "new", "adjustment", "--textures", "E", "--seed", "lab", "-o", name, *options)
    path = pathlib.Path(f"{name}.protocol.json")
    protocol = json.loads(path.read_text())
    assert (protocol["smallest_ratio"], protocol["largest_ratio"], protocol["step_db"], protocol["repetitions"]) == (LOW, HIGH, 1, 10)
    path.write_text(json.dumps({**protocol, **changes}))


def a_study_is_made_of_one_texture():
    for surface in "AE":
        tacto.run("record", "-d", f"sim:surface={surface},speed=50mm/s,seed=1", "--time", "2s", "-o", f"recording-{surface}")
        tacto.run("spatial", f"recording-{surface}", "-o", surface, "--stroke", "1")
    new = ["experiment", "new", "adjustment", "-o", "least"]
    tacto.run(*new, code=2)
    assert tacto.error_of(*new, "--textures", "A,E", code=2)["where"] == "--textures"
    assert tacto.error_of(*new, "--textures", "E", "--reference", "A", code=2)["where"] == "--reference"
    tacto.run(*new, "--textures", "E", "--goal", "most", code=2)
    tacto.run("experiment", "new", "amplitude", "--textures", "E", "--goal", "least", code=2)
    new_study("least", repetitions=4, step_db=4)
    checked = tacto.run_json("experiment", "check", "least", "-d", "sim:")
    assert checked["valid"] is True and (checked["task"], checked["goal"], checked["trials"]) == ("adjustment", "least", 4)
    assert tacto.run_json("validate", "least.protocol.json", "least.key.json")["valid"] is True
    for observer in ("weber=25%", "order"):
        tacto.run("experiment", "run", "least", "-d", "sim:", "--participant", "P01", "--observer", observer, code=2)


def settings_are_marks_of_the_session():
    out, err = tacto.run("experiment", "run", "least", "-d", "sim:", "--participant", "P01", "--observer", OBSERVER)
    entries, rows = journal("least-P01"), table("least-P01")
    begun = [entry["trial"] for entry in entries if entry["event"] == "begun"]
    assert begun == sorted((f"K1.{i}" for i in (1, 2, 3, 4)), key=lambda trial: sum_of(f"lab/P01/1/{trial}"))
    assert all(row["delivered"] == "yes" and row["answer"] == "accepted" for row in rows), rows
    judged = [entry["intervals"][0] for entry in entries if entry["event"] == "delivered"]
    step = 10 ** (4 / 20)
    for row, facts in zip(rows, judged, strict=True):
        start, accepted = float(row["start_ratio"]), float(row["accepted_ratio"])
        assert abs(start / start_of("P01", row["trial"]) - 1) < 1e-8
        assert row["series"] == ("ascending" if int(row["trial"][3:]) % 2 else "descending")
        proven = tacto.run_json("experiment", "prove", f"least-P01/{int(row['attempt']):03}-1")
        settings = [float(each["mark"].split()[1]) for each in proven["intervals"]]
        assert abs(settings[0] / start - 1) < 1e-8 and abs(settings[-1] / accepted - 1) < 1e-6 and proven["same_to_the_bit"]
        ratios = np.array(settings[1:]) / settings[:-1]
        assert len(settings) > 2 and np.allclose(ratios, step if row["series"] == "ascending" else 1 / step, rtol=1e-6)
        # Each setting is felt along a whole pace before the next key.
        assert facts["strokes"] == 2 * len(settings) and abs(facts["last_gain"] / accepted - 1) < 1e-8, (facts, settings)
        assert abs(float(row["predicted_ratio"]) / accepted - 1) < 0.02, row
        # The setting that is nearest to what it looks for: a spread of 5 % and a hysteresis of 20 %.
        assert abs(np.log(accepted / 0.3)) < np.log(step) / 2 + 4 * 0.05 + np.log(1.2) / 2, row
    proof = tacto.run_json("experiment", "prove", "least-P01")
    assert proof["proven"] is True and (proof["delivered"], proof["sessions"], proof["same_to_the_bit"]) == (4, 4, 4)
    assert 0 < proof["ratio_error"] < 0.04


def means_of_series_are_compared():
    tacto.run("experiment", "analyse", "least", code=5)
    report = tacto.run_json("experiment", "analyse", "least", "--unblind", "-o", "least.html", "-o", "least.svg", "-o", "least.results.json")
    assert pathlib.Path("least.html").exists() and "threshold=30%" in report["simulated"] and report["goal"] == "least"
    (person,) = report["people"]
    levels = {name: np.array([20 * np.log10(float(row["accepted_ratio"])) for row in table("least-P01") if row["series"] == name]) for name in ("ascending", "descending")}
    for name, level in levels.items():
        reach = scipy.stats.t.ppf(0.975, 1) * level.std(ddof=1) / np.sqrt(2)
        found = [person[name], person[name + "_low"], person[name + "_high"]]
        assert np.allclose(found, 10 ** ((level.mean() + np.array([0, -1, 1]) * reach) / 20), rtol=1e-6)
        assert abs(person[name + "_deviation_db"] - level.std(ddof=1)) < 1e-6 and person[name + "_settings"] == 2
    difference = levels["descending"].mean() - levels["ascending"].mean()
    assert abs(person["hysteresis_db"] - difference) < 1e-6 and person["hysteresis_db_low"] <= difference <= person["hysteresis_db_high"]
    assert abs(20 * np.log10(person["ratio"]) - np.mean([level.mean() for level in levels.values()])) < 1e-6
    # The ratio 1 is the RMS of the texture on the path within 15-500 Hz at the pace, times the gain: by a transform without
    # treatment of the ends (1 % of this texture), and as the target of a session.
    protocol = json.loads(pathlib.Path("least.protocol.json").read_text())
    position, force, _ = tacto.texture("least/K1")
    inside = (position >= protocol["pace"]["from_m"]) & (position <= protocol["pace"]["to_m"])
    spectrum = np.fft.rfft(scipy.signal.detrend(force))
    hertz = np.fft.rfftfreq(len(force), position[1] - position[0]) * protocol["pace"]["speed_mps"]
    played = np.fft.irfft(np.where((hertz >= 15) & (hertz <= 500), spectrum, 0), len(force))[inside]
    unit = report["rms_m"] / (report["ratio"] * protocol["gain_m_per_n"])
    within_band = np.sqrt(np.mean(played**2))
    assert abs(unit / within_band - 1) < 0.01 and force[inside].std() / within_band > 1.02, (unit, within_band, force[inside].std())
    assert report["rms_band"].startswith("15 to 500 Hz") and person["bounds"] == 0


def a_killed_run_is_resumed():
    path = pathlib.Path("least-P02.trials.jsonl")
    process = subprocess.Popen([tacto.COMMAND, "experiment", "run", "least", "-d", "sim:", "--participant", "P02", "--observer", OBSERVER.replace("30", "40")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < 5):
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = path.read_bytes()[:path.read_bytes().rindex(b"\n") + 1]
    if b'"event":"end"' not in kept:  # else this process waited long
        assert tacto.run_json("experiment", "resume", "least-P02")["complete"] is True
    assert path.read_bytes().startswith(kept)
    assert sorted(row["trial"] for row in table("least-P02") if row["answer"]) == [f"K1.{i}" for i in (1, 2, 3, 4)]
    assert tacto.run_json("experiment", "prove", "least-P02")["proven"] is True
    report = tacto.run_json("experiment", "analyse", "least", "--unblind")
    ratios, hystereses = ([person[name] for person in report["people"]] for name in ("ratio", "hysteresis_db"))
    assert len(ratios) == 2 and abs(report["ratio"] - np.exp(np.mean(np.log(ratios)))) < 1e-9
    assert abs(report["hysteresis_db"] - np.mean(hystereses)) < 1e-9
    # Another gain at the end of a session than the journal has: the file was exchanged.
    sessions = sorted(pathlib.Path("least-P02").glob("*.session"))  # a trial that was interrupted has another number
    one, other = sessions[0], sessions[-1]
    one.write_bytes(other.read_bytes())
    proof = tacto.run_json("experiment", "prove", "least-P02", code=5)
    assert proof["proven"] is False and proof["faults"]


def answers_come_from_a_file():
    new_study("match", "--goal", "match", "--reference", "A", repetitions=2, step_db=2)
    protocol = json.loads(pathlib.Path("match.protocol.json").read_text())
    assert protocol["standards"] == ["E", "A"] and protocol["goal"] == "match"
    command = ["experiment", "run", "match", "-d", "sim:", "--participant", "P01", "--answers", "answers.txt"]
    for wrong in ("accepted", "0.01", "5", "0.5x", "nan", ""):
        pathlib.Path("answers.txt").write_text(f"1\n{wrong}\n")
        assert tacto.error_of(*command, code=4)["where"].endswith("line 2"), wrong
    pathlib.Path("answers.txt").write_text("0.5\n")
    assert tacto.run_json(*command)["complete"] is False
    pathlib.Path("answers.txt").write_text("0.5\n1.5\n")
    done = tacto.run_json("experiment", "resume", "match-P01", "--answers", "answers.txt")
    assert done["complete"] is True
    rows = [row for row in table("match-P01") if row["answer"]]
    for row, wanted in zip(rows, (0.5, 1.5), strict=True):
        assert abs(20 * np.log10(float(row["accepted_ratio"]) / wanted)) < 1.001 and row["bound"] == ""
    # Which setting was used is said.
    assert [(each["attempt"], each["asked_ratio"]) for each in done["settings"]] == [(int(row["attempt"]), wanted) for row, wanted in zip(rows, (0.5, 1.5))]
    assert all(abs(each["accepted_ratio"] / float(row["accepted_ratio"]) - 1) < 1e-8 for each, row in zip(done["settings"], rows, strict=True))
    entries = journal("match-P01")
    key = {row["name"]: row["code"] for row in json.loads(pathlib.Path("match.key.json").read_text())["stimuli"]}
    assert all(entry["stimuli"] == [key["A"], key["E"]] for entry in entries if entry["event"] == "begun")
    for entry in entries:
        assert entry["event"] != "delivered" or entry["intervals"][0]["last_gain"] == 1
    assert tacto.run_json("experiment", "prove", "match-P01")["proven"] is True


def settings_at_the_ends_are_bounds():
    new_study("ends", repetitions=4, step_db=3)
    pathlib.Path("answers.txt").write_text("0.05\n4\n1\n0.5\n")
    done = tacto.run_json("experiment", "run", "ends", "-d", "sim:", "--participant", "P01", "--answers", "answers.txt")
    rows = table("ends-P01")
    assert done["complete"] is True and [row["bound"] for row in rows] == ["lower", "upper", "", ""], rows
    step = 10 ** (3 / 20)
    assert float(rows[0]["accepted_ratio"]) / step < LOW and float(rows[1]["accepted_ratio"]) * step > HIGH
    report = tacto.run_json("experiment", "analyse", "ends", "--unblind")
    assert [person["bounds"] for person in report["people"]] == [2]


def a_hurried_finger_is_not_delivered():
    new_study("hurry", repetitions=2, most_attempts=1, step_db=6)
    done = tacto.run_json("experiment", "run", "hurry", "-d", "sim:", "--participant", "P01", "--observer", "threshold=30%,hurry=100%")
    assert (done["abandoned"], done["delivered_and_answered"]) == (2, 0)
    assert all("fast" in row["why"] for row in table("hurry-P01"))


def a_person_is_told_of_an_early_setting():
    """In real time: the key a before the first stroke ends. The trial is not delivered, and the screen says why."""
    new_study("early", repetitions=1, step_db=3, lead_s=2)
    path = pathlib.Path("early.protocol.json")
    protocol = json.loads(path.read_text())
    protocol["texts"]["en"]["too_early"] = "PATIENCE"
    path.write_text(json.dumps(protocol))
    person = Person("experiment", "run", "early", "-d", "sim:paced=1", "--participant", "P01")
    person.until(b"PATIENCE", lambda shown: b"a" if b"arrow" in shown else b" ")
    person.press(b"\x03")
    person.ends()
    judged = [entry for entry in journal("early-P01") if entry["event"] == "delivered"]
    assert judged[0]["delivered"] is False and any("strokes" in why for why in judged[0]["why"])


def a_person_uses_the_arrow_keys():
    """In emulated time a key is waited for after each pace, so the number of steps is known."""
    new_study("keys", "--goal", "greatest", repetitions=1, step_db=3)
    person = Person("experiment", "run", "keys", "-d", "sim:", "--participant", "P01")
    person.until(b"arrow", lambda shown: b" ")
    person.press(b"\x1b[A\x1b[Aj\x1b[Bfx \x1b[Aa")  # up, up, up, down, down, two keys without a meaning, up, accepted
    assert person.ends() == 0
    (row,) = table("keys-P01")
    assert row["answer"] == "accepted" and row["delivered"] == "yes"
    assert abs(20 * np.log10(float(row["accepted_ratio"]) / float(row["start_ratio"])) - 6) < 1e-4
    assert tacto.run_json("experiment", "prove", "keys-P01")["proven"] is True
    (person,) = tacto.run_json("experiment", "analyse", "keys", "--unblind")["people"]
    assert person["ascending_settings"] == 1 and not {"ratio", "hysteresis_db", "descending", "ascending_deviation_db"} & set(person)


def other_verbs():
    tacto.run("experiment", "export", "match", "--unblind", "-o", "out")
    with open("out/trials.csv") as file:
        rows = list(csv.DictReader(file))
    assert {"series", "start_ratio", "accepted_ratio", "predicted_ratio"} <= set(rows[0]) and "correct" not in rows[0]
    assert "accepted_ratio" in json.loads(pathlib.Path("out/sub-P01/beh/sub-P01_task-match_beh.json").read_text())
    tacto.run("experiment", "power", "least", "--weber", "15.5%,25.3%", "--spread", "23%", code=5)
    tacto.run("experiment", "withdraw", "match", "--participant", "P01", "--yes")
    assert not pathlib.Path("match-P01").exists() and not pathlib.Path("out/trials.csv").exists()
    tacto.run("experiment", "analyse", "match", "--unblind", code=5)


def study():
    a_study_is_made_of_one_texture()
    settings_are_marks_of_the_session()
    means_of_series_are_compared()
    a_killed_run_is_resumed()
    answers_come_from_a_file()
    settings_at_the_ends_are_bounds()
    a_hurried_finger_is_not_delivered()
    a_person_is_told_of_an_early_setting()
    a_person_uses_the_arrow_keys()
    other_verbs()
    experiment_files.keep_to_their_schemas("delivered", "resumed")


if __name__ == "__main__":
    tacto.in_folder(study)
