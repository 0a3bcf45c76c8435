#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph experiment` with the protocol fidelity on the emulated device: blocks and trials by their hash, samples that the
operator places, an observer without error, d' against SciPy, answers from a file, and wrong use."""
import csv
import hashlib
import json
import pathlib

import numpy as np
import scipy.stats

import experiment_files
import tacto

RUN = ["experiment", "run", "bench", "-d", "sim:"]


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def table(run):
    with open(f"{run}.trials.tsv") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def sum_of(text):
    return hashlib.sha256(text.encode()).hexdigest()


def key_of(study):
    return {row["name"]: row["code"] for row in json.loads(pathlib.Path(f"{study}.key.json").read_text())["stimuli"]}


def d_prime_of(same_of_own, own, same_of_other, other):
    """With its 95 % interval."""
    shares = np.array([(same_of_own + 0.5) / (own + 1), (same_of_other + 0.5) / (other + 1)])
    z = scipy.stats.norm.ppf(shares)
    reach = scipy.stats.norm.ppf(0.975) * np.sqrt(np.sum(shares * (1 - shares) / np.array([own, other]) / scipy.stats.norm.pdf(z) ** 2))
    return z[0] - z[1] + reach * np.array([0, -1, 1])


def a_study_is_made_of_several_textures():
    for surface in "ACE":
        tacto.run("record", "-d", f"sim:surface={surface},speed=50mm/s,seed=1", "--time", "2s", "-o", f"recording-{surface}")
        tacto.run("spatial", f"recording-{surface}", "-o", surface, "--stroke", "1")
    new = ["experiment", "new", "fidelity", "-o", "bench", "--seed", "lab"]
    tacto.run(*new, code=2)
    assert tacto.error_of(*new, "--textures", "A", code=2)["where"] == "--textures"
    assert tacto.error_of(*new, "--textures", "A,C", "--goal", "least", code=2)["where"] == "--goal"
    tacto.run(*new, "--textures", "A,C,E")
    path = pathlib.Path("bench.protocol.json")
    protocol = json.loads(path.read_text())
    assert protocol["task"] == "fidelity" and protocol["repetitions"] == 5  # ten beside its own sample
    assert [choice["word"] for choice in protocol["answers"]["choices"]] == ["same", "different"]
    path.write_text(json.dumps({**protocol, "repetitions": 1}))
    checked = tacto.run_json("experiment", "check", "bench", "-d", "sim:")
    assert checked["valid"] is True and (checked["task"], checked["standards"], checked["trials"]) == ("fidelity", 3, 12)
    assert tacto.run_json("validate", "bench.protocol.json", "bench.key.json")["valid"] is True
    tacto.run(*RUN, "--participant", "P01", "--observer", "weber=25%", code=2)


def an_observer_without_error_is_always_right():
    tacto.run(*RUN, "--participant", "P01", "--observer", "template,noise=0dB")
    rows, entries, key = table("bench-P01"), journal("bench-P01"), key_of("bench")
    samples = sorted(key.values(), key=lambda code: sum_of(f"lab/P01/sample/{code}"))
    assert [entry["label"] for entry in entries if entry["event"] == "placed"] == samples
    assert len(rows) == 12 and all(row["delivered"] == "yes" for row in rows)
    for block, sample in enumerate(samples, 1):
        trials = [f"{code}.{i}" for code in key.values() for i in range(1, 3 if code == sample else 2)]
        mine = [row for row in rows if int(row["block"]) == block]
        assert [row["trial"] for row in mine] == sorted(trials, key=lambda trial: sum_of(f"lab/P01/{block}/{trial}"))
        for row in mine:
            assert key[row["sample"]] == sample and key[row["presented"]] == row["trial"].split(".")[0]
            assert row["answer"] == ("same" if row["sample"] == row["presented"] else "different"), row
    proof = tacto.run_json("experiment", "prove", "bench-P01")
    assert proof["proven"] is True and (proof["delivered"], proof["real_samples"], proof["sessions"]) == (12, 3, 12)


def the_answers_are_compared():
    tacto.run("experiment", "analyse", "bench", code=5)
    tacto.run(*RUN, "--participant", "P02", "--observer", "template,noise=40dB,seed=3")
    report = tacto.run_json("experiment", "analyse", "bench", "--unblind", "-o", "bench.html", "-o", "bench.results.json")
    assert pathlib.Path("bench.html").exists() and "template" in report["simulated"] and report["predicted_error_db"] < -10
    first, second = report["people"]
    assert [first[name] for name in ("same_of_own", "own", "same_of_other", "other")] == [6, 6, 0, 6]
    for person in report["people"]:
        rows = table(f"bench-{person['participant']}")
        counts = [sum(row["answer"] == "same" for row in rows if (row["sample"] == row["presented"]) is own) for own in (True, False)]
        assert (person["same_of_own"], person["same_of_other"]) == tuple(counts)
        found = [person["d_prime" + end] for end in ("", "_low", "_high")]
        assert np.allclose(found, d_prime_of(counts[0], 6, counts[1], 6), rtol=1e-9), person
    assert first["d_prime"] > second["d_prime"]  # an error of 40 dB hides the texture
    both = np.array([first["d_prime"], second["d_prime"]])
    reach = scipy.stats.t.ppf(0.975, 1) * both.std(ddof=1) / np.sqrt(2)
    assert np.allclose([report["d_prime" + end] for end in ("", "_low", "_high")], both.mean() + reach * np.array([0, -1, 1]), rtol=1e-9)
    assert len(report["pairs"]) == 9 and sum(pair["trials"] for pair in report["pairs"]) == 24


def the_operator_places_each_sample_once():
    key = key_of("bench")
    samples = sorted(key.values(), key=lambda code: sum_of(f"lab/P03/sample/{code}"))
    command = [*RUN, "--participant", "P03", "--answers", "answers.txt"]
    pathlib.Path("answers.txt").write_text(f"{samples[1]}\nf\n")
    assert tacto.error_of(*command, code=4)["where"].endswith("line 1")  # another sample
    pathlib.Path("answers.txt").write_text("\n".join([samples[0], *"fj"]) + "\n")
    assert tacto.run_json("experiment", "resume", "bench-P03", "--answers", "answers.txt")["complete"] is False
    # After an interruption the sample is placed again.
    pathlib.Path("answers.txt").write_text("\n".join([*samples[:1], *samples, *"fjfjfjfjfjfj"]) + "\n")
    assert tacto.run_json("experiment", "resume", "bench-P03", "--answers", "answers.txt")["complete"] is True
    answered = [entry["word"] for entry in journal("bench-P03") if entry["event"] == "answered"]
    assert answered == ["same", "different"] * 6
    assert tacto.run_json("experiment", "prove", "bench-P03")["proven"] is True


def other_verbs():
    tacto.run("experiment", "export", "bench", "--unblind", "-o", "out")
    with open("out/trials.csv") as file:
        rows = [row for row in csv.DictReader(file) if row["participant"] == "P01"]
    assert {"sample", "presented", "correct"} <= set(rows[0]) and all(row["correct"] == "1" for row in rows)
    assert "sample" in json.loads(pathlib.Path("out/sub-P01/beh/sub-P01_task-bench_beh.json").read_text())
    tacto.run("experiment", "power", "bench", "--weber", "15.5%,25.3%", "--spread", "23%", code=5)


def study():
    a_study_is_made_of_several_textures()
    an_observer_without_error_is_always_right()
    the_answers_are_compared()
    the_operator_places_each_sample_once()
    other_verbs()
    experiment_files.keep_to_their_schemas("delivered", "placed")


if __name__ == "__main__":
    tacto.in_folder(study)
