#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` from protocol to proof on the emulated device: the order by hashlib, blind files, attempts that
come again, SIGKILL and resume, a swapped stimulus, answers from a file, and the fit."""
import csv
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess

import experiment_files
import numpy as np
import scipy.special
import scipy.stats
import tacto

OBSERVER = "weber=25.3%,lapse=2%,hurry=20%,seed=1"
LEVELS = [-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7]


def new_study(name, repetitions):
    tacto.run("experiment", "new", "stretch", "-o", name, "--seed", "lab-7")
    path = pathlib.Path(f"{name}.protocol.json")
    protocol = json.loads(path.read_text())
    assert protocol["levels"] == LEVELS and protocol["repetitions"] == 10 and protocol["keep"] == "slope"
    assert (protocol["standard"]["period_m"], protocol["standard"]["amplitude_m"]) == (1.76e-3, 12.8e-6)
    protocol["repetitions"], protocol["most_attempts"] = repetitions, 20
    path.write_text(json.dumps(protocol))


def journal(run):
    """The entries, each with its number and its check."""
    entries = []
    for number, line in enumerate(pathlib.Path(f"{run}.trials.jsonl").read_bytes().splitlines(), 1):
        body, check = line[:line.rindex(b',"check":"')] + b"}", line[-18:-2].decode()
        assert hashlib.sha256(body).hexdigest()[:16] == check and json.loads(line)["line"] == number
        entries.append(json.loads(line))
    return entries


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def key_of(study):
    return {row["code"]: row for row in json.loads(pathlib.Path(f"{study}.key.json").read_text())["stimuli"]}


def the_files_are_coded():
    new_study("stretch", 1)
    valid = tacto.run_json("experiment", "check", "stretch", "-d", "sim:")
    assert valid["valid"] is True and valid["trials"] == 8
    key = key_of("stretch")
    assert sorted(row["stretch"] for row in key.values()) == sorted(LEVELS + [0])
    for code, row in key.items():
        assert hashlib.sha256(pathlib.Path(f"stretch/{code}.texture.wav").read_bytes()).hexdigest() == row["sha256"]
    by_sum = sorted(LEVELS + [0], key=lambda level: hashlib.sha256(f"lab-7/code/{level:g}".encode()).hexdigest())
    assert [key[f"K{i + 1}"]["stretch"] for i in range(9)] == by_sum
    valid = tacto.run_json("validate", "stretch.protocol.json", "stretch.key.json")
    assert [file["kind"] for file in valid["files"]] == ["protocol", "protocol_key"] and valid["valid"] is True
    for name in ("stretch.protocol.json", "stretch.key.json"):
        assert not any(f'"{code}"' in tacto.run("info", name, "--json")[0] for code in key)
    tacto.run("experiment", "new", "stretch", "-o", "stretch", code=2)  # exists


def a_lead_is_longer_than_the_slowest_load():
    """A device that keeps time: preparing and sending 22 mm of texture takes more than 1 ms and less than a minute."""
    new_study("lead", 1)
    path = pathlib.Path("lead.protocol.json")
    protocol = json.loads(path.read_text())
    path.write_text(json.dumps({**protocol, "lead_s": 60}))
    slowest = tacto.run_json("experiment", "check", "lead", "-d", "sim:paced=1")["slowest_load_s"]
    assert 0.001 < slowest < 60, slowest
    # A warning below twice the load, with both figures. A load varies, so each verdict is by the figure of its own run.
    for lead_s in [60] + [1.5 * slowest] * 5 + [3 * slowest] * 5:
        path.write_text(json.dumps({**protocol, "lead_s": lead_s}))
        done = subprocess.run([tacto.COMMAND, "experiment", "check", "lead", "-d", "sim:paced=1", "--json"], capture_output=True, text=True)
        if done.returncode == 5:
            continue  # a load that took longer than this lead
        report = json.loads(done.stdout)
        load_s = report["slowest_load_s"]
        warned = any(f"{lead_s:g} s" in warning and f"{load_s:.3f} s" in warning for warning in report.get("warnings", []))
        assert done.returncode == 0 and warned == (lead_s < 2 * load_s), (lead_s, done)
    path.write_text(json.dumps({**protocol, "lead_s": 0.001}))
    for verb in (["check", "lead"], ["run", "lead", "--participant", "P01", "--observer", OBSERVER]):
        _, said = tacto.run("experiment", *verb, "-d", "sim:paced=1", code=5)
        assert "lead.protocol.json#/lead_s" in tacto.unwrapped(said), said
    # An emulated device that does not keep time has no clock to be late for.
    assert "slowest_load_s" not in tacto.run_json("experiment", "check", "lead", "-d", "sim:")
    tacto.run("experiment", "check", "lead")


def a_run_is_proven():
    out, err = tacto.run("experiment", "run", "stretch", "-d", "sim:", "--participant", "P01", "--observer", OBSERVER)
    for level in LEVELS:
        assert f"{level:g}" not in out + err, (level, out)
    entries, key = journal("stretch-P01"), key_of("stretch")
    begun = [entry for entry in entries if entry["event"] == "begun"]
    trials = [f"{code}.1" for code in key if key[code]["stretch"] != 0]
    order = sorted(trials, key=lambda trial: hashlib.sha256(f"lab-7/P01/1/{trial}".encode()).hexdigest())
    assert [entry["trial"] for entry in begun[:8]] == order
    events = [entry["event"] for entry in entries]
    assert events == ["plan"] + ["begun", "delivered", "answered"] * len(begun) + ["end"]
    failed = [entry["attempt"] for entry in entries if entry["event"] == "delivered" and not entry["delivered"]]
    assert failed and len(begun) == 8 + len(failed)  # of seed 1: some trials are too fast, and come again
    for entry in entries:
        assert entry["event"] != "delivered" or entry["delivered"] == (not any("too fast" in why for why in entry["why"]))
    rows = table("stretch-P01")
    assert [row["delivered"] for row in rows].count("yes") == 8 and len(rows) == len(begun)
    for row in rows:
        assert abs(float(row["predicted_stretch"]) - float(row["nominal_stretch"])) < 0.01
        assert float(row["nominal_stretch"]) == key[row["trial"].split(".")[0]]["stretch"]
    proof = tacto.run_json("experiment", "prove", "stretch-P01")
    assert proof["proven"] is True and proof["delivered"] == proof["trials"] == 8 and proof["not_delivered"] == len(failed)
    assert proof["sessions"] == proof["same_to_the_bit"] == 2 * len(begun) and proof["stretch_error"] < 0.01
    assert tacto.run_json("replay", "stretch-P01/001-1")["same_to_the_bit"] is True
    tacto.run("experiment", "run", "stretch", "-d", "sim:", "--participant", "P01", "--observer", OBSERVER, code=2)
    tacto.run("experiment", "resume", "stretch-P01", code=2)  # complete


def a_session_that_was_changed_is_found():
    shutil.copy("stretch-P01/001-1.session", "kept.session")
    shutil.copy("stretch-P01/001-2.session", "stretch-P01/001-1.session")
    assert tacto.run_json("experiment", "prove", "stretch-P01", code=5)["proven"] is False
    shutil.move("kept.session", "stretch-P01/001-1.session")


def killed_at(lines, command):
    """Runs until the journal has so many lines, then kills."""
    process = subprocess.Popen([tacto.COMMAND, *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    path = pathlib.Path("stretch-P02.trials.jsonl")
    while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < lines):
        pass
    process.kill()
    process.wait()


def a_killed_run_is_resumed():
    random.seed(5)
    command = ["experiment", "run", "stretch", "-d", "sim:", "--participant", "P02", "--observer", "weber=25.3%,lapse=2%,seed=1"]
    lines = 0
    for _ in range(4):
        killed_at(lines + random.randrange(1, 4), command)
        whole = pathlib.Path("stretch-P02.trials.jsonl").read_bytes()
        kept = whole[:whole.rindex(b"\n") + 1]
        lines = kept.count(b"\n")
        command = ["experiment", "resume", "stretch-P02"]
        if b'"event":"end"' in kept:  # where this process waited long
            break
    else:
        tacto.run(*command)
    assert pathlib.Path("stretch-P02.trials.jsonl").read_bytes().startswith(kept)
    counted = [row["trial"] for row in table("stretch-P02") if row["delivered"] == "yes" and row["answer"]]
    assert sorted(counted) == sorted({row["trial"] for row in table("stretch-P02")}) and len(counted) == 8
    assert tacto.run_json("experiment", "prove", "stretch-P02")["proven"] is True


def answers_from_a_file():
    pathlib.Path("answers.txt").write_text("first\nj\nsecond\n")
    command = ["-d", "sim:", "--answers", "answers.txt"]
    partly = tacto.run_json("experiment", "run", "stretch", *command, "--participant", "P03")
    assert partly["complete"] is False and partly["delivered_and_answered"] == 3
    pathlib.Path("answers.txt").write_text("first\nj\nsecond\n" + "f\n" * 5)
    assert tacto.run_json("experiment", "resume", "stretch-P03", *command)["complete"] is True
    answers = [entry["choice"] for entry in journal("stretch-P03") if entry["event"] == "answered"]
    assert answers == [1, 2, 2, 1, 1, 1, 1, 1]
    pathlib.Path("answers.txt").write_text("first\nmaybe\n")
    assert "line 2" in tacto.run("experiment", "run", "stretch", *command, "--participant", "P04", code=4)[1]
    assert not pathlib.Path("stretch-P04.trials.jsonl").exists()


def bad_input():
    command = ["experiment", "run", "stretch", "-d", "sim:"]
    tacto.run(*command, "--participant", "Anna", "--observer", OBSERVER, code=2)
    tacto.run(*command, "--participant", "P05", "--observer", "weber=25", code=2)
    no_terminal = subprocess.run([tacto.COMMAND, *command, "--participant", "P05"], stdin=subprocess.DEVNULL, capture_output=True)
    assert no_terminal.returncode == 2 and not pathlib.Path("stretch-P05.trials.jsonl").exists()
    tacto.run("experiment", "prove", "stretch-P09", code=3)
    tacto.run("experiment", "new", "texture", "-o", "other", code=2)
    for suffix in ("wav", "json"):
        one, other = (pathlib.Path(f"stretch/{code}.texture.{suffix}") for code in ("K1", "K2"))
        one.rename("kept"), other.rename(one), pathlib.Path("kept").rename(other)
    for verb in (["check", "stretch"], ["run", "stretch", "-d", "sim:", "--participant", "P05", "--observer", OBSERVER]):
        assert "stretch/K1" in tacto.run("experiment", *verb, code=5)[1]
    for suffix in ("wav", "json"):
        one, other = (pathlib.Path(f"stretch/{code}.texture.{suffix}") for code in ("K1", "K2"))
        one.rename("kept"), other.rename(one), pathlib.Path("kept").rename(other)
    tacto.run("experiment", "check", "stretch")
    changed = pathlib.Path("stretch.protocol.json")
    text = changed.read_text()
    changed.write_text(text.replace('"repetitions": 1', '"repetitions": 2'))
    # Another participant, too: runs of two protocols could not be analysed together.
    for verb in (["prove", "stretch-P01"], ["run", "stretch", "-d", "sim:", "--participant", "P05", "--observer", OBSERVER]):
        assert "stretch.protocol.json" in tacto.run("experiment", *verb, code=5)[1]
    assert not pathlib.Path("stretch-P05.trials.jsonl").exists()
    changed.write_text(text)


def the_answers_are_fitted():
    new_study("more", 4)
    for participant, weber in (("P01", "25%"), ("P02", "30%")):
        tacto.run("experiment", "run", "more", "-d", "sim:", "--participant", participant, "--observer", f"weber={weber},seed=4")
    tacto.run("experiment", "analyse", "more", code=5)
    assert not pathlib.Path("more.unblinded.txt").exists()
    report = tacto.run_json("experiment", "analyse", "more", "--unblind", "-o", "more.html")
    assert pathlib.Path("more.unblinded.txt").read_text().count("\n") == 1 and pathlib.Path("more.html").exists()
    assert [fit["participant"] for fit in report["fits"]] == ["P01", "P02"]
    for origin in ("observer weber=25%,seed=4 (P01)", "observer weber=30%,seed=4 (P02)", "emulated device"):
        assert origin in report["simulated"] and origin in pathlib.Path("more.html").read_text(), report["simulated"]
    # The same counts from the table of trials, by the fit of tables.
    with open("counts.csv", "w") as file:
        print("participant,stretch,longer,n", file=file)
        for participant in ("P01", "P02"):
            for level in LEVELS:
                rows = [row for row in table(f"more-{participant}") if float(row["nominal_stretch"]) == level and row["delivered"] == "yes"]
                longer = sum(row["answer_interval"] == row["standard_interval"] for row in rows)
                print(f"{participant},{level},{longer},{len(rows)}", file=file)
    fits = tacto.run_json("experiment", "fit", "counts.csv", "--by", "participant")["fits"]
    assert fits == report["fits"]
    assert "simulated" not in tacto.run_json("experiment", "fit", "counts.csv", "--by", "participant")
    for fit, weber in zip(fits, (0.25, 0.30)):  # the truth is in the interval
        assert fit["jnd_low"] < weber < fit["jnd_high"] and fit["pse_low"] < 0 < fit["pse_high"], fit


def the_trials_are_exported():
    tacto.run("experiment", "export", "more", "-o", "out", code=5)
    assert not os.path.exists("out")
    written = tacto.run_json("experiment", "export", "more", "--unblind", "-o", "out")["written"]
    assert sorted(written) == sorted(str(file) for file in pathlib.Path("out").rglob("*") if file.is_file())
    tacto.run("experiment", "export", "more", "--unblind", "-o", "out", code=2)  # exists
    with open("out/trials.csv") as file:
        rows = list(csv.DictReader(file))
    for participant in ("P01", "P02"):
        own, stem = table(f"more-{participant}"), f"out/sub-{participant}/beh/sub-{participant}_task-more_beh"
        with open(f"{stem}.tsv") as file:
            bids = list(csv.DictReader(file, delimiter="\t"))
        exported = [row for row in rows if row["participant"] == participant]
        assert len(own) == len(bids) == len(exported) >= 32
        for row, other, line in zip(own, exported, bids):
            assert row == {name: other[name] for name in row} == {name: line[name].replace("n/a", "") for name in row}, (row, other, line)
            assert other["seemed_longer"] == ("" if not row["answer"] else str(int(row["answer_interval"] == row["standard_interval"])))
        described = json.loads(pathlib.Path(f"{stem}.json").read_text())
        assert set(bids[0]) == set(described) - {"TaskName"} and all(described[name]["Description"] for name in bids[0])
    with open("out/participants.tsv") as file:
        assert [row["participant_id"] for row in csv.DictReader(file, delimiter="\t")] == ["sub-P01", "sub-P02"]
    assert json.loads(pathlib.Path("out/dataset_description.json").read_text())["Name"] == "more"


def levels_follow_the_answers():
    for method, weber in (("staircase", "20%"), ("quest_plus", "30%")):
        tacto.run("experiment", "new", "stretch", "-o", method, "--method", method, "--seed", "lab-7")
        path = pathlib.Path(f"{method}.protocol.json")
        protocol = json.loads(path.read_text())
        assert protocol["method"] == method and protocol["repetitions"] == 60 and len(protocol["levels"]) == (14 if method == "staircase" else 28)
        path.write_text(json.dumps({**protocol, "repetitions": 12, "most_attempts": 20}))
        run = f"{method}-P01"
        tacto.run("experiment", "run", method, "-d", "sim:", "--participant", "P01", "--observer", f"weber={weber},hurry=15%,seed=2")
        rows = table(run)
        counted = [row for row in rows if row["delivered"] == "yes"]
        assert sorted(int(row["trial"].split(".")[1]) for row in counted) == list(range(1, 13)) and len(rows) > 12
        numbers = sorted(range(1, 13), key=lambda i: hashlib.sha256(f"lab-7/P01/1/level.{i}".encode()).hexdigest())
        assert [int(row["trial"].split(".")[1]) for row in rows[:12]] == numbers
        proof = tacto.run_json("experiment", "prove", run)
        assert proof["proven"] is True and proof["delivered"] == proof["trials"] == 12
        tacto.run("experiment", "power", method, "--weber", "15.5%,25.3%", "--spread", "23%", code=5)
        fitted = tacto.run_json("experiment", "analyse", method, "--unblind")["fits"][0]
        # Levels of one sign cannot separate the PSE from the JND.
        assert (fitted["pse"] == 0 and fitted["pse_is_fixed"]) if method == "staircase" else "pse_low" in fitted, fitted
        if method == "quest_plus":
            continue
        level, right = 14, 0  # in steps of 5 %: two right answers down, a wrong one up
        for row in rows:
            assert abs(float(row["nominal_stretch"]) - 0.05 * level) < 1e-9, (row, level)
            if row["delivered"] != "yes":
                continue
            correct = row["answer_interval"] == row["standard_interval"]  # the stretched one is longer
            right = right + 1 if correct else 0
            if not correct or right == 2:
                level, right = min(max(level + (-1 if correct else 1), 1), 14), 0


def powers_by_numpy(people, trials=10, weber=(0.155, 0.253), spread=0.23):
    """{people: (power of groups, power of twice)} of t tests of ln W, by probit regression of 40,000 people (Newton's method).

    A person is left out whose answers are a step: the likelihood then has no maximum.
    """
    rng = np.random.default_rng(5)
    levels, quarter = np.array(LEVELS), scipy.stats.norm.ppf(0.75)
    factor = np.exp(spread * rng.normal(size=(40_000, 1)))
    logs, fitted = [], np.ones(40_000, bool)
    for each in weber:
        yes = rng.binomial(trials, scipy.special.ndtr(levels * quarter / (each * factor)))
        fitted &= ~((np.diff(yes) >= 0).all(1) & (((yes > 0) & (yes < trials)).sum(1) <= 1))
        intercept, slope = np.zeros((len(yes), 1)), np.full((len(yes), 1), 2.0)
        for _ in range(60):
            z = np.clip(intercept + slope * levels, -7, 7)
            share, density = np.clip(scipy.special.ndtr(z), 1e-12, 1 - 1e-12), scipy.stats.norm.pdf(z)
            weight = trials * density**2 / (share * (1 - share))
            zero, one, two = (weight.sum(1, keepdims=True), (weight * levels).sum(1, keepdims=True), (weight * levels**2).sum(1, keepdims=True))
            off, tilted = ((weight * (yes / trials - share) / density * x).sum(1, keepdims=True) for x in (1, levels))
            step = (zero * tilted - one * off) / (zero * two - one**2)
            damped = np.minimum(1, 2 / np.maximum(np.abs(step), 1e-12))
            intercept += damped * (two * off - one * tilted) / (zero * two - one**2)
            slope += damped * step
        logs.append(np.log(quarter / slope[:, 0], where=slope[:, 0] > 0, out=np.full(len(yes), np.nan)))
    one, other = (each[fitted] for each in logs)
    powers = {}
    for n in people:
        a, b, both = (rng.integers(0, one.size, (20_000, n)) for _ in range(3))
        powers[n] = ((scipy.stats.ttest_ind(other[b], one[a], axis=1).pvalue < 0.05).mean(),
                     (scipy.stats.ttest_rel(other[both], one[both], axis=1).pvalue < 0.05).mean())
    return powers


def participants_are_planned():
    new_study("ten", 10)
    command = ["experiment", "power", "ten", "--spread", "23%"]
    power = tacto.run_json(*command, "--weber", "15.5%,25.3%")
    assert power["people_a_group"] in (7, 8) and power["people_twice"] == 5, power
    rows = {row["people"]: (row["power_of_groups"], row["power_of_twice"]) for row in power["powers"]}
    for people, expected in powers_by_numpy((4, 5, 6, 7)).items():
        assert np.abs(np.subtract(rows[people], expected)).max() < 4 * np.hypot(0.016, 0.006), (people, rows[people], expected)
    assert power == tacto.run_json(*command, "--weber", "15.5%,25.3%", "--seed", "1")
    last = power["powers"][-1]
    assert last["people"] == power["people_a_group"] and last["power_of_groups"] >= 0.8 > power["powers"][-2]["power_of_groups"]
    assert tacto.run_json(*command, "--weber", "15.5%,25.3%", "--lapse", "2%")["people_a_group"] > power["people_a_group"]
    for wrong in (["--weber", "15.5%"], ["--weber", "15.5%,15.5%"], ["--weber", "15.5,25.3"], ["--weber", "15.5%,500%"], ["--weber", "15.5%,25.3%", "--lapse", "60%"]):
        tacto.run(*command, *wrong, code=2)
    tacto.run("experiment", "power", "nothing", "--weber", "15.5%,25.3%", "--spread", "23%", code=3)


def a_participant_withdraws():
    here = pathlib.Path(".")
    tacto.run("experiment", "analyse", "more", "--unblind", "-o", "elsewhere/more.html")
    shutil.copytree("elsewhere", "/tmp/" + here.resolve().name + "-outside")
    outside = pathlib.Path("/tmp/" + here.resolve().name + "-outside")
    tacto.run("experiment", "analyse", "more", "--unblind", "-o", f"{outside}/page.html")
    pathlib.Path("more-P011.trials.tsv").write_text("")  # of another participant
    # Files behind a link, as of a folder of sessions on another disk: refused before anything is deleted.
    for name, elsewhere in (("more-P01", outside / "sessions"), ("more-P01/001-1.session", outside / "001-1.session"), ("more-P01.trials.jsonl", outside / "journal")):
        shutil.move(name, elsewhere)
        os.symlink(elsewhere, name)
        before = sorted(here.rglob("*"))
        refused = tacto.error_of("experiment", "withdraw", "more", "--participant", "P01", "--yes", code=5)
        assert refused["where"] == name and str(elsewhere) in refused["what"], refused
        assert sorted(here.rglob("*")) == before and elsewhere.exists()
        os.remove(name)
        shutil.move(elsewhere, name)
    listed = tacto.run_json("experiment", "withdraw", "more", "--participant", "P01", code=2)
    files = set(listed["to_be_deleted"])
    expected = {"more-P01.trials.jsonl", "more-P01.trials.tsv", *map(str, here.glob("more-P01/*"))}
    assert listed["withdrawn"] is False and expected < files and all(map(os.path.exists, files)), listed
    assert {os.path.basename(file) for file in files - expected} >= {"more.html", "trials.csv", "sub-P02_task-more_beh.tsv"} and len(files - expected) == 10, files - expected
    assert [os.path.basename(file) for file in listed["outside_the_study"]] == ["page.html"]
    # Copies in the study's folder are named, without what is to be deleted, links, other codes and large tables.
    assert [os.path.relpath(path) for path in listed["not_deleted"]] == ["counts.csv"], listed
    shutil.copytree("out", "copies/1")
    shutil.copytree("out", "copies/2", ignore=shutil.ignore_patterns("sub-*"))
    shutil.copy("more-P01.trials.jsonl", "copies/more-P01.trials.jsonl")
    pathlib.Path("out/sub-P01/notes.txt").write_text("")
    pathlib.Path("copies/other.json").write_text('["P011", "xP01", "p01"]')
    pathlib.Path("copies/large.csv").write_text("P01," * 1_000_001)
    shutil.copytree("copies/1/sub-P01", outside / "sub-P01")
    os.symlink(outside, "copies/link")
    left = {f"copies/{name}" for name in ("1/sub-P01", "1/participants.tsv", "1/trials.csv", "2/participants.tsv", "2/trials.csv", "more-P01.trials.jsonl")} | {"out/sub-P01/notes.txt", "counts.csv"}
    listed = tacto.run_json("experiment", "withdraw", "more", "--participant", "P01", code=2)
    assert set(listed["to_be_deleted"]) == files and {os.path.relpath(path) for path in listed["not_deleted"]} == left, listed
    # As if it had been killed after the record and one file: the run counts no more, and the rest is deleted by repeating it.
    pathlib.Path("more.withdrawn.txt").write_text("2026-01-01T00:00:00Z\tP01\n")
    os.remove("more-P01.trials.tsv")
    tacto.run("experiment", "prove", "more-P01", code=5)
    tacto.run("experiment", "resume", "more-P01", code=5)
    fits = tacto.run_json("experiment", "analyse", "more", "--unblind")["fits"]
    assert [fit["participant"] for fit in fits] == ["P02"]
    os.makedirs("out/sub-P02/notes")  # not of the export
    done = tacto.run_json("experiment", "withdraw", "more.protocol.json", "--participant", "P01", "--yes")
    assert done["withdrawn"] is True and set(done["deleted"]) == files - {"more-P01.trials.tsv"}
    assert not any(map(os.path.exists, files)) and not os.path.exists("more-P01") and (outside / "page.html").exists()
    assert sorted(map(str, pathlib.Path("out").rglob("*"))) == ["out/sub-P01", "out/sub-P01/notes.txt", "out/sub-P02", "out/sub-P02/notes"]
    assert {os.path.relpath(path) for path in done["not_deleted"]} == left - {"out/sub-P01/notes.txt"} | {"out/sub-P01"} and all(map(os.path.exists, left))
    assert pathlib.Path("more.withdrawn.txt").read_text().count("P01") == 1
    assert os.path.exists("more-P02.trials.jsonl") and os.path.exists("more/K1.texture.wav") and os.path.exists("more-P011.trials.tsv")
    assert tacto.run_json("experiment", "withdraw", "more", "--participant", "P01", "--yes")["deleted"] == []  # again
    tacto.run("experiment", "run", "more", "-d", "sim:", "--participant", "P01", "--observer", OBSERVER, code=5)
    tacto.run("experiment", "withdraw", "more", "--participant", "P09", "--yes", code=3)
    tacto.run("experiment", "withdraw", "more", "--participant", "../more", "--yes", code=2)
    tacto.run("experiment", "withdraw", "nothing", "--participant", "P01", "--yes", code=3)
    shutil.rmtree(outside)


def study():
    the_files_are_coded()
    a_lead_is_longer_than_the_slowest_load()
    a_run_is_proven()
    a_session_that_was_changed_is_found()
    a_killed_run_is_resumed()
    answers_from_a_file()
    bad_input()
    the_answers_are_fitted()
    the_trials_are_exported()
    levels_follow_the_answers()
    participants_are_planned()
    a_participant_withdraws()
    experiment_files.keep_to_their_schemas("delivered", "resumed")


if __name__ == "__main__":
    tacto.in_folder(study)
