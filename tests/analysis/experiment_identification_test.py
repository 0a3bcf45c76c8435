#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` with the protocol identification on the emulated device: order of blocks, labels of real samples,
a run that is killed, confusions against NumPy, a swapped stimulus, export and power."""
import csv
import hashlib
import json
import pathlib
import shutil
import subprocess

import numpy as np

import experiment_files
import tacto
from person import Person

NAMES, COMPARISONS = "ABCDE", "CDE"
RUN = ["experiment", "run", "faces", "-d", "sim:"]


def new_study(stem, repetitions=2, **changes):
    tacto.run("experiment", "new", "identification", "--textures", ",".join(NAMES), "--comparisons", ",".join(COMPARISONS), "-o", stem, "--seed", "lab")
    path = pathlib.Path(f"{stem}.protocol.json")
    protocol = json.loads(path.read_text())
    assert protocol["most_trials"] == 100 and protocol["longest_s"] == 900 and 3 * protocol["repetitions"] >= 100
    path.write_text(json.dumps({**protocol, "repetitions": repetitions, **changes}))


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def key():
    return {row["code"]: row["name"] for row in json.loads(pathlib.Path("faces.key.json").read_text())["stimuli"]}


def order_of(participant, block):
    trials = [f"{code}.{i}" for code, name in key().items() if name in COMPARISONS for i in (1, 2)]
    return sorted(trials, key=lambda trial: hashlib.sha256(f"lab/{participant}/{block}/{trial}".encode()).hexdigest())


def a_study_is_made_of_textures():
    for surface in NAMES:
        tacto.run("record", "-d", f"sim:surface={surface},speed=50mm/s,seed=1", "--time", "2s", "-o", f"recording-{surface}")
        tacto.run("spatial", f"recording-{surface}", "-o", surface, "--stroke", "1")
    new_study("faces")
    by_sum = sorted(NAMES, key=lambda name: hashlib.sha256(f"lab/code/{name}".encode()).hexdigest())
    assert [key()[f"K{i}"] for i in range(1, 6)] == by_sum
    for code, name in key().items():  # the texture's samples, and nothing that names it
        sidecar = json.loads(pathlib.Path(f"faces/{code}.texture.json").read_text())
        assert not {"surface", "source", "notes"} & set(sidecar)
        # Without the words about the surface, which name it, the stimuli say the same: the emulated device and its seed.
        assert sidecar["simulated"].endswith("emulated device, seed 1"), sidecar["simulated"]
        assert np.array_equal(tacto.texture(f"faces/{code}")[1], tacto.texture(name)[1]), name
    checked = tacto.run_json("experiment", "check", "faces", "-d", "sim:")
    assert checked["valid"] is True and checked["trials"] == 12 and checked["task"] == "identification"
    assert tacto.run_json("validate", "faces.protocol.json", "faces.key.json")["valid"] is True
    new = ["experiment", "new", "identification", "-o", "other"]
    tacto.run(*new, code=2)
    tacto.run(*new, "--textures", "A,A", code=2)
    tacto.run(*new, "--textures", "A,B,F", code=3)
    tacto.run("experiment", "new", "stretch", "-o", "other", "--textures", "A,B", code=2)
    tacto.run(*new, "--textures", "A,B", "--comparisons", "C", code=2)
    for name in ("1", "K12", "0", "Bäume"):
        shutil.copy("A.texture.json", f"{name}.texture.json"), shutil.copy("A.texture.wav", f"{name}.texture.wav")
    assert tacto.run_json(*new[:-1], "digit", "--textures", "1,B")["answer_keys"] == ["1: 1", "2: B"]
    for textures in ("0,1", "A,K12"):  # 1 is the key of 0; K12 could be a label
        tacto.run(*new, "--textures", textures, code=4)
    assert tacto.error_of(*new, "--textures", "A,Bäume", code=2)["where"] == "--textures"
    assert tacto.error_of(*new, "--textures", "A,B", "--seed", "a b", code=2)["where"] == "--seed"


def a_run_without_noise_is_right():
    """The observer gets the predicted displacement only; without errors of its own it names each texture."""
    out, err = tacto.run(*RUN, "--participant", "P01", "--observer", "template,noise=0dB,hurry=20%,seed=2")
    entries = journal("faces-P01")
    begun = [entry for entry in entries if entry["event"] == "begun"]
    assert entries[0]["order"] == 1
    real = [entry for entry in begun if entry["block"] == 1]
    virtual = [entry for entry in begun if entry["block"] == 2]
    assert [entry["trial"] for entry in real] == order_of("P01", 1) and not any(entry["sessions"] for entry in real)
    assert [entry["trial"] for entry in virtual[:6]] == order_of("P01", 2) and all(len(entry["sessions"]) == 1 for entry in virtual)
    failed = [entry for entry in entries if entry["event"] == "delivered" and not entry["delivered"]]
    assert failed and len(virtual) == 6 + len(failed) and all(any("too fast" in why for why in entry["why"]) for entry in failed), (failed, virtual)
    assert [entry["label"] for entry in entries if entry["event"] == "placed"] == [entry["trial"].split(".")[0] for entry in real]
    rows = table("faces-P01")
    assert [row["condition"] for row in rows] == ["real"] * 6 + ["virtual"] * len(virtual)
    assert [row["delivered"] for row in rows[:6]] == ["unknown"] * 6 and [row["delivered"] for row in rows].count("yes") == 6
    assert all(row["answer"] == row["presented"] == key()[row["trial"].split(".")[0]] for row in rows if row["delivered"] != "no"), rows
    proof = tacto.run_json("experiment", "prove", "faces-P01")
    assert proof["proven"] is True and (proof["delivered"], proof["real_samples"], proof["trials"]) == (6, 6, 12)
    assert proof["sessions"] == proof["same_to_the_bit"] == len(virtual) and "stretch_error" not in proof


def a_study_is_replaced_only_without_runs():
    new = ["experiment", "new", "identification", "--textures", "A,B", "-o"]
    tacto.run(*new, "again")
    tacto.run(*new, "again", code=2)
    tacto.run(*new, "again", "--force", "--seed", "2")
    assert json.loads(pathlib.Path("again.protocol.json").read_text())["seed"] == "2"
    tacto.run("experiment", "check", "again")
    assert tacto.error_of(*new, "faces", "--force", code=7)["where"].endswith("faces.protocol.json")
    pathlib.Path("folder").mkdir()
    tacto.run(*new, "folder", "--force", code=2)


def labels_are_typed():
    """P02 gets the other order of blocks. A wrong label ends the run before the answer, and the run goes on."""
    labels = [trial.split(".")[0] for trial in order_of("P02", 2)]
    answers = ["1", "B", "3", "D", "5", "A"] + ["2"] * 6
    command = ["-d", "sim:", "--answers", "answers.txt"]
    wrong = "K1" if labels[0] != "K1" else "K2"
    pathlib.Path("answers.txt").write_text("\n".join(answers[:6] + [wrong] + answers[6:]))
    refused = tacto.error_of("experiment", "run", "faces", *command, "--participant", "P02", code=4)
    assert refused["where"].endswith("line 7") and wrong in refused["what"] and labels[0] in refused["what"], refused
    assert [entry["event"] for entry in journal("faces-P02")][-1] == "begun"
    pathlib.Path("answers.txt").write_text("\n".join(answers[:6]))
    assert tacto.run_json("experiment", "resume", "faces-P02", *command)["complete"] is False
    # The trial that was begun without its label is the next one again, so the corrected file of the whole run fits.
    again = labels
    pathlib.Path("answers.txt").write_text("\n".join(answers[:6] + [line for label in again for line in (label, "2")]))
    assert tacto.run_json("experiment", "resume", "faces-P02", *command)["complete"] is True
    entries = journal("faces-P02")
    assert entries[0]["order"] == 2 and [entry["label"] for entry in entries if entry["event"] == "placed"] == again
    assert [entry["choice"] for entry in entries if entry["event"] == "answered"] == [1, 2, 3, 4, 5, 1] + [2] * 6
    proof = tacto.run_json("experiment", "prove", "faces-P02")
    assert proof["proven"] is True and "abandoned" not in proof


def a_label_is_corrected_while_it_is_typed():
    new_study("typed", 2, conditions=["real"])
    person = Person("experiment", "run", "typed", "-d", "sim:", "--participant", "P51")
    person.press(b"early")  # before the prompt
    label = person.until(rb"press Enter\. (K[0-9]+)\n")
    person.press(b" Kx\x7f\x01\x08" + label[1] + b"  \n")
    person.until(b"Which one was it", lambda shown: b" ")  # the go-ahead
    person.press(b"\x03")  # Ctrl-C
    person.ends()
    entries = journal("typed-P51")
    assert [entry["event"] for entry in entries] == ["plan", "begun", "placed"] and entries[2]["label"] == label[1].decode(), entries


def a_killed_run_is_resumed():
    path = pathlib.Path("faces-P03.trials.jsonl")
    command = [*RUN, "--participant", "P03", "--observer", "template,seed=3"]
    for lines in (5, 14, 25):
        process = subprocess.Popen([tacto.COMMAND, *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and (not path.exists() or path.read_bytes().count(b"\n") < lines):
            pass
        process.kill()
        process.wait()
        kept = path.read_bytes()[:path.read_bytes().rindex(b"\n") + 1]
        command = ["experiment", "resume", "faces-P03"]
        if b'"event":"end"' in kept:  # where this process waited long
            break
    else:
        tacto.run(*command)
    assert path.read_bytes().startswith(kept) and journal("faces-P03")[0]["order"] == 1
    counted = [(row["block"], row["trial"]) for row in table("faces-P03") if row["answer"]]
    assert sorted(counted) == sorted((str(block), trial) for block in (1, 2) for trial in order_of("P03", block))
    assert tacto.run_json("experiment", "prove", "faces-P03")["proven"] is True


def information_bit(matrix):
    """Plug-in value, and the jackknife over the answers of each stimulus with the stimuli's shares fixed."""
    shares = matrix.sum(1) / matrix.sum()

    def mutual(rows):
        answers = [row / row.sum() for row in rows]
        mixed = sum(share * answer for share, answer in zip(shares, answers))
        entropy = lambda p: -sum(x * np.log2(x) for x in p if x > 0)
        return entropy(mixed) - sum(share * entropy(answer) for share, answer in zip(shares, answers))

    plug_in = jackknife = mutual(matrix)
    for i, row in enumerate(matrix):
        for j, count in enumerate(row):
            if count:
                without = matrix.copy()
                without[i, j] -= 1
                jackknife += (row.sum() - 1) * count / row.sum() * (plug_in - mutual(without))
    return plug_in, jackknife


def confusions_are_counted():
    tacto.run("experiment", "analyse", "faces", code=5)
    assert "html" in tacto.error_of("experiment", "analyse", "faces", "--unblind", "-o", "m.svg", code=2)["remedy"]
    report = tacto.run_json("experiment", "analyse", "faces", "--unblind", "-o", "faces.html", "-o", "faces.results.json")
    assert pathlib.Path("faces.html").exists() and "observer template,seed=3 (P03)" in report["simulated"]
    rows = [row for person in ("P01", "P02", "P03") for row in table(f"faces-{person}") if row["answer"] and row["delivered"] != "no"]
    assert [(one["participant"], one["condition"]) for one in report["people"]] == [("P01", "real"), ("P01", "virtual"), ("P02", "virtual"), ("P02", "real"), ("P03", "real"), ("P03", "virtual")]
    for over in report["conditions"]:
        (cells,) = over["answers"]
        for name in COMPARISONS:
            for answer in NAMES:
                expected = sum(row["condition"] == over["condition"] and row["presented"] == name and row["answer"] == answer for row in rows)
                assert cells[name][0][answer] == expected, (over["condition"], name, answer)
        people = [one for one in report["people"] if one["condition"] == over["condition"]]
        assert over["people"] == len(people) == 3
        assert np.isclose(over["success"], np.mean([one["success"] for one in people]), rtol=1e-12)
        assert np.isclose(over["success_deviation"], np.std([one["success"] for one in people], ddof=1), rtol=1e-9)
        assert np.isclose(over["information_bit"], np.mean([one["information_bit"] for one in people]), rtol=1e-12)
    for one in report["people"]:
        matrix = np.array([[one["answers"][0][name][0][answer] for answer in NAMES] for name in COMPARISONS])
        assert np.isclose(one["success"], sum(matrix[i, NAMES.index(name)] for i, name in enumerate(COMPARISONS)) / matrix.sum(), rtol=1e-12)
        plug_in, jackknife = information_bit(matrix)
        assert abs(one["plug_in_bit"] - plug_in) < 1e-12 and abs(one["information_bit"] - jackknife) < 1e-12
    first = report["people"][0]
    assert first["success"] == 1 and abs(first["plug_in_bit"] - np.log2(3)) < 1e-12


def other_verbs():
    tacto.run("experiment", "export", "faces", "--unblind", "-o", "out")
    assert not pathlib.Path("out/analysis.R").exists()
    with open("out/trials.csv") as file:
        for row in csv.DictReader(file):
            assert row["correct"] == ("" if not row["answer"] else str(int(row["answer"] == row["presented"])))
    tacto.run("experiment", "power", "faces", "--weber", "15.5%,25.3%", "--spread", "23%", code=5)
    for observer in ("weber=25%", "template,weber=25%"):
        tacto.run(*RUN, "--participant", "P04", "--observer", observer, code=2)
    deleted = tacto.run_json("experiment", "withdraw", "faces", "--participant", "P03", "--yes")["deleted"]
    assert "faces-P03.trials.jsonl" in deleted and [one["participant"] for one in tacto.run_json("experiment", "analyse", "faces", "--unblind")["people"]].count("P03") == 0


def a_swapped_stimulus_is_refused():
    for suffix in ("wav", "json"):
        one, other = (pathlib.Path(f"faces/{code}.texture.{suffix}") for code in ("K1", "K2"))
        one.rename("kept"), other.rename(one), pathlib.Path("kept").rename(other)
    tacto.run(*RUN, "--participant", "P05", "--observer", "template", code=5)


def totals_are_those_of_the_paper():
    """One participant with all trials: the standard error of a success of 100 trials is 2.6 and 4.3 %, the bound four of them."""
    new_study("total", 34)
    tacto.run("experiment", "run", "total", "-d", "sim:", "--participant", "P11", "--observer", "template,seed=1")
    totals = {one["condition"]: one for one in tacto.run_json("experiment", "analyse", "total", "--unblind")["conditions"]}
    assert abs(totals["real"]["success"] - 0.93) < 0.103 and abs(totals["virtual"]["success"] - 0.75) < 0.174, totals
    assert journal("total-P11")[-1]["event"] == "end" and len([1 for row in table("total-P11") if row["answer"]]) >= 200


def a_block_ends_after_its_time():
    new_study("short", 2, longest_s=1e-9)
    done = tacto.run_json("experiment", "run", "short", "-d", "sim:", "--participant", "P21", "--observer", "template")
    assert done["complete"] is True and done["trials"] == 0 == done["delivered_and_answered"], done
    assert done["after_time_limit"] == 12 == tacto.run_json("experiment", "prove", "short-P21")["after_time_limit"]
    assert [entry["event"] for entry in journal("short-P21")] == ["plan", "block_over", "block_over", "end"]


def a_gain_beyond_the_transducer_is_refused_at_once():
    new_study("loud", 2, gain_m_per_n=1)
    for command in (["check", "loud"], ["run", "loud", "--participant", "P41", "--observer", "template"]):
        assert tacto.error_of("experiment", *command, "-d", "sim:", code=5)["where"].endswith("#/gain_m_per_n")
    assert not pathlib.Path("loud-P41.trials.jsonl").exists()


def what_is_never_delivered_is_abandoned():
    new_study("once", 2, most_attempts=1)
    done = tacto.run_json("experiment", "run", "once", "-d", "sim:", "--participant", "P31", "--observer", "template,hurry=100%")
    assert done["abandoned"] == 6 and (done["trials"], done["delivered_and_answered"]) == (12, 6)
    assert tacto.run_json("experiment", "prove", "once-P31")["abandoned"] == 6
    assert tacto.run_json("experiment", "analyse", "once", "--unblind")["abandoned"] == 6


def study():
    a_study_is_made_of_textures()
    a_run_without_noise_is_right()
    a_study_is_replaced_only_without_runs()
    labels_are_typed()
    a_label_is_corrected_while_it_is_typed()
    a_killed_run_is_resumed()
    confusions_are_counted()
    other_verbs()
    a_swapped_stimulus_is_refused()
    totals_are_those_of_the_paper()
    a_block_ends_after_its_time()
    what_is_never_delivered_is_abandoned()
    a_gain_beyond_the_transducer_is_refused_at_once()
    experiment_files.keep_to_their_schemas("delivered", "placed", "resumed", "block_over")


if __name__ == "__main__":
    tacto.in_folder(study)
