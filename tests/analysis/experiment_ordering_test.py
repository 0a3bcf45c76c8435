#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` with the protocol ordering on the emulated device: arrangement and order by their hashes, a person at
a terminal, a killed run, ranks against SciPy, answers from a file, export, withdrawal, and wrong use."""
import csv
import hashlib
import json
import os
import pathlib
import re
import signal
import subprocess
import time

import numpy as np
import scipy.stats

import experiment_files
import tacto
from person import Person

NAMES, INTENDED = "ACE", [0.5, 2.0, 1.0]
RUN = ["experiment", "run", "rough", "-d", "sim:"]


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def key():
    return {row["code"]: row["name"] for row in json.loads(pathlib.Path("rough.key.json").read_text())["stimuli"]}


def sum_of(text):
    return hashlib.sha256(text.encode()).hexdigest()


def arranged(participant, trial):
    return sorted(key(), key=lambda code: sum_of(f"lab/{participant}/1/{trial}/{code}"))


def a_study_is_made_of_textures():
    for surface in NAMES:
        tacto.run("record", "-d", f"sim:surface={surface},speed=50mm/s,seed=1", "--time", "2s", "-o", f"recording-{surface}")
        tacto.run("spatial", f"recording-{surface}", "-o", surface, "--stroke", "1")
    new = ["experiment", "new", "ordering", "--seed", "lab", "-o", "rough", "--textures"]
    tacto.run(*new, "A", code=2)
    tacto.run(*new, "A,A", code=2)
    for wrong in (["--intended", "1"], ["--comparisons", "A"], ["--goal", "least"]):
        assert tacto.error_of(*new, "A,C", *wrong, code=2)["where"] == wrong[0]
    tacto.run("experiment", "new", "amplitude", "--textures", "A", "--intended", "1", code=2)
    tacto.run(*new, "C,E,A", "--intended", "2,1,0.5")  # the numbers follow the textures
    protocol = json.loads(pathlib.Path("rough.protocol.json").read_text())
    assert (protocol["standards"], protocol["intended"], protocol["repetitions"]) == (list(NAMES), INTENDED, 3)
    checked = tacto.run_json("experiment", "check", "rough", "-d", "sim:")
    assert checked["valid"] is True and (checked["task"], checked["trials"], checked["standards"]) == ("ordering", 3, 3)
    assert tacto.run_json("validate", "rough.protocol.json", "rough.key.json")["valid"] is True
    for observer in ("weber=25%", "template", "threshold=20%"):
        tacto.run(*RUN, "--participant", "P01", "--observer", observer, code=2)
    assert not pathlib.Path("rough-P01.trials.jsonl").exists()


def each_texture_is_felt_until_it_was_delivered():
    out, err = tacto.run(*RUN, "--participant", "P01", "--observer", "order,noise=0dB,hurry=25%,seed=3")
    assert not any(re.search(rf"\b{name}\b", out + err) for name in NAMES), out + err
    entries = journal("rough-P01")
    begun = [entry["trial"] for entry in entries if entry["event"] == "begun"]
    assert begun == sorted((f"all.{i}" for i in (1, 2, 3)), key=lambda trial: sum_of(f"lab/P01/1/{trial}"))
    explored = {}
    for entry in entries:
        if entry["event"] == "explored":
            explored.setdefault(entry["attempt"], []).append(entry["stimulus"])
    judged = {entry["attempt"]: entry for entry in entries if entry["event"] == "delivered"}
    fast = 0
    for attempt, trial in enumerate(begun, 1):
        facts = judged[attempt]["intervals"]
        assert len(facts) == len(explored[attempt]) and judged[attempt]["delivered"] is True
        good = [code for code, fact in zip(explored[attempt], facts) if fact["fastest_mps"] < 0.065]
        assert good == arranged("P01", trial), (good, explored[attempt])  # each once more after each failure
        fast += len(facts) - len(good)
    assert fast > 0  # of seed 3
    rows = table("rough-P01")
    assert [int(row["explorations"]) for row in rows] == [len(explored[i]) for i in (1, 2, 3)]
    assert len({row["order"] for row in rows}) == 1 and sorted(rows[0]["order"].split()) == list(NAMES)
    assert all([key()[code] for code in row["answer"].split()] == row["order"].split() for row in rows)
    proof = tacto.run_json("experiment", "prove", "rough-P01")
    assert proof["proven"] is True and (proof["delivered"], proof["trials"]) == (3, 3)
    assert proof["sessions"] == proof["same_to_the_bit"] == 9 + fast


def what_is_never_felt_is_abandoned():
    path = pathlib.Path("rough.protocol.json")
    protocol = json.loads(path.read_text())
    pathlib.Path("once.protocol.json").write_text(json.dumps({**protocol, "most_attempts": 2, "repetitions": 1}))
    pathlib.Path("once.key.json").write_bytes(pathlib.Path("rough.key.json").read_bytes())
    os.symlink("rough", "once")
    done = tacto.run_json("experiment", "run", "once", "-d", "sim:", "--participant", "P31", "--observer", "order,hurry=100%")
    assert done["complete"] is True and (done["abandoned"], done["delivered_and_answered"], done["attempts"]) == (1, 0, 2)
    assert [row["explorations"] for row in table("once-P31")] == ["6", "6"]
    assert tacto.run_json("experiment", "prove", "once-P31")["proven"] is True
    tacto.run("experiment", "analyse", "once", "--unblind", code=5)


def answers_come_from_a_file():
    answers = pathlib.Path("answers.txt")
    command = [*RUN, "--participant", "P02", "--answers", "answers.txt"]
    for wrong in ("1 2", "1 2 2", "1 2 4", "K1 K2 K3", ""):
        answers.write_text(f"1 2 3\n{wrong}\n")
        assert tacto.error_of(*command, code=4)["where"].endswith("line 2")
    assert not pathlib.Path("rough-P02.trials.jsonl").exists()
    answers.write_text("2 1 3\n")
    assert tacto.run_json(*command)["complete"] is False
    answers.write_text("2 1 3\n3 2 1\n1 2 3\n")
    assert tacto.run_json("experiment", "resume", "rough-P02", "--answers", "answers.txt")["complete"] is True
    rows = [row for row in table("rough-P02") if row["answer"]]
    for row, line in zip(rows, ("213", "321", "123"), strict=True):
        places = arranged("P02", row["trial"])
        assert row["answer"].split() == [places[int(number) - 1] for number in line]


def a_person_explores_at_the_terminal():
    person = Person(*RUN, "--participant", "P03")
    path = pathlib.Path("rough-P03.trials.jsonl")

    def press(keys, event, count):
        """Repeats keys until the journal has that event so often: a key from before its prompt is left out."""
        while path.read_bytes().count(f'"event":"{event}"'.encode()) < count:
            person.press(keys)
            time.sleep(0.02)

    person.until(b"1 2 3\n")  # to be felt
    press(b"2", "explored", 1)
    person.until(b"1 3\n")
    person.press(b" ")  # too early for the order
    press(b"1", "explored", 2)
    person.until(b": 3\n")
    press(b"3", "explored", 3)
    press(b"2", "explored", 4)  # again
    press(b" ", "delivered", 1)
    person.until(b"Backspace")
    # A number twice is left out, backspace removes, and the space bar ends only a whole order.
    press(b"\x7f\x7f\x7f33 1\x7f21 ", "answered", 1)
    person.press(b"\x03")
    person.ends()
    entries = journal("rough-P03")
    places = arranged("P03", entries[1]["trial"])
    assert [entry["stimulus"] for entry in entries if entry["event"] == "explored" and entry["attempt"] == 1] == [places[i] for i in (1, 0, 2, 1)]
    (answered,) = [entry for entry in entries if entry["event"] == "answered"]
    assert answered["word"].split() == [places[2], places[1], places[0]] and answered["answer_s"] > 0


def a_killed_run_is_resumed():
    path = pathlib.Path("rough-P04.trials.jsonl")
    process = subprocess.Popen([tacto.COMMAND, *RUN, "--participant", "P04", "--observer", "order,noise=6dB,seed=5"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < 9):
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = path.read_bytes()[:path.read_bytes().rindex(b"\n") + 1]
    if b'"event":"end"' not in kept:  # else this process waited long
        assert tacto.run_json("experiment", "resume", "rough-P04")["complete"] is True
    assert path.read_bytes().startswith(kept)
    assert sorted(row["trial"] for row in table("rough-P04") if row["answer"]) == ["all.1", "all.2", "all.3"]
    assert tacto.run_json("experiment", "prove", "rough-P04")["proven"] is True


def places_of(run):
    """A row per answer: the place of each name."""
    return np.array([[row["order"].split().index(name) + 1 for name in NAMES] for row in table(run) if row["answer"] and row["delivered"] == "yes"])


def ranks_are_compared():
    tacto.run("experiment", "analyse", "rough", code=5)
    assert not pathlib.Path("rough.unblinded.txt").exists()
    report = tacto.run_json("experiment", "analyse", "rough", "--unblind", "-o", "rough.html", "-o", "rough.svg", "-o", "rough.results.json")
    assert pathlib.Path("rough.html").exists() and pathlib.Path("rough.unblinded.txt").exists()
    assert "order,noise=6dB,seed=5 (P04)" in report["simulated"]
    people = {person["participant"]: person for person in report["people"]}
    assert sorted(people) == ["P01", "P02", "P03", "P04"] and people["P03"]["orders"] == 1 and "w" not in people["P03"]
    means = []
    for name, person in people.items():
        if name == "P03":  # not complete: no table
            means.append([person["mean_ranks"][0][each] for each in NAMES])
            continue
        places = places_of(f"rough-{name}")
        means.append(places.mean(0))
        assert np.allclose([person["mean_ranks"][0][each] for each in NAMES], places.mean(0), rtol=1e-9)
        friedman = scipy.stats.friedmanchisquare(*places.T)
        assert abs(person["w"] - friedman.statistic / (len(places) * 2)) < 1e-9
    (over,) = report["over_people"]
    friedman = scipy.stats.friedmanchisquare(*np.array(means).T)
    assert abs(over["chi_squared"] - friedman.statistic) < 1e-8 and abs(over["p"] - friedman.pvalue) < 1e-8
    mean = np.mean(means, 0)
    assert abs(over["spearman_rho"] - scipy.stats.spearmanr(INTENDED, mean)[0]) < 1e-9
    assert abs(over["kendall_tau"] - scipy.stats.kendalltau(INTENDED, mean)[0]) < 1e-9
    assert people["P01"]["w"] == 1


def progress_is_watched():
    watched = tacto.run_json("experiment", "watch", "rough", "--time", "0.1s")["runs"]
    assert {run["run"]: run["complete"] for run in watched} == {"rough-P01": True, "rough-P02": True, "rough-P03": False, "rough-P04": True}
    assert [run["delivered_and_answered"] for run in watched] == [3, 3, 1, 3] and all(run["trials"] == 3 for run in watched)
    _, lines = tacto.run("experiment", "watch", "rough", "--time", "0.1s")
    assert len(re.findall(r"^rough-P0\d: \d of 3 ", lines, re.M)) == 4 and not re.search(r"\bK\d|\b[ACE]\b", lines), lines
    assert tacto.run_json("experiment", "watch", "once")["runs"][0]["complete"] is True  # none goes on: it ends
    tacto.run("experiment", "watch", "nothing", code=3)


def other_verbs():
    tacto.run("experiment", "export", "rough", "--unblind", "-o", "out")
    with open("out/trials.csv") as file:
        rows = list(csv.DictReader(file))
    assert {row["participant"] for row in rows} == {"P01", "P02", "P03", "P04"} and "correct" not in rows[0]
    assert {"order", "explorations"} <= set(json.loads(pathlib.Path("out/sub-P01/beh/sub-P01_task-rough_beh.json").read_text()))
    tacto.run("experiment", "power", "rough", "--weber", "15.5%,25.3%", "--spread", "23%", code=5)
    deleted = tacto.run_json("experiment", "withdraw", "rough", "--participant", "P01", "--yes")["deleted"]
    assert {"rough-P01.trials.jsonl", "rough-P01.trials.tsv"} <= set(deleted) and not pathlib.Path("rough-P01").exists()
    report = tacto.run_json("experiment", "analyse", "rough", "--unblind")
    assert [person["participant"] for person in report["people"]] == ["P02", "P03", "P04"]
    for verb in (["resume", "rough-P01"], ["run", "rough", "-d", "sim:", "--participant", "P01", "--observer", "order"]):
        tacto.run("experiment", *verb, code=5 if verb[0] == "run" else 3)


def study():
    a_study_is_made_of_textures()
    each_texture_is_felt_until_it_was_delivered()
    what_is_never_felt_is_abandoned()
    answers_come_from_a_file()
    a_person_explores_at_the_terminal()
    a_killed_run_is_resumed()
    ranks_are_compared()
    progress_is_watched()
    other_verbs()
    experiment_files.keep_to_their_schemas("delivered", "explored", "resumed")


if __name__ == "__main__":
    tacto.in_folder(study)
