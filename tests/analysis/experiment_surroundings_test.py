#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What surrounds the trials of an experiment, on the emulated device: masking noise and its level, breaks, and texts in another
language at a terminal."""
import csv
import json
import os
import pathlib
import pty
import select
import subprocess

import numpy as np
import soundfile

import tacto

GERMAN = {"welcome": "WILLKOMMEN", "begin": "BEGINN", "interval": "FAHREN", "question": "FRAGE", "break": "PAUSE", "end": "ENDE"}


def journal(run):
    return [json.loads(line) for line in pathlib.Path(f"{run}.trials.jsonl").read_text().splitlines()]


def new_study(name, *options, **changes):
    tacto.run("experiment", "new", "stretch", "-o", name, "--seed", "lab", *options)
    path = pathlib.Path(f"{name}.protocol.json")
    protocol = json.loads(path.read_text())
    protocol.update(repetitions=1, levels=[-0.5, 0.5])
    for member, change in changes.items():
        protocol[member] = {**protocol[member], **change} if isinstance(change, dict) and member in protocol else change
    path.write_text(json.dumps(protocol))
    key = pathlib.Path(f"{name}.key.json")  # of two stretches
    stimuli = json.loads(key.read_text())
    stimuli["stimuli"] = [each for each in stimuli["stimuli"] if each["stretch"] in (-0.5, 0, 0.5)]
    key.write_text(json.dumps(stimuli))
    return protocol


def run(study, participant, *options):
    return ["experiment", "run", study, "-d", "sim:", "--participant", participant, *options]


def the_noise_is_written_and_its_level_is_logged():
    protocol = new_study("quiet", "--masking-noise", "65dB")
    assert protocol["masking_noise"] == {"low_hz": 15, "high_hz": 1500, "level_db": 65, "tolerance_db": 3}
    assert "65 dB" in tacto.run_json("experiment", "check", "quiet")["masking_noise"]
    done = tacto.run_json("experiment", "noise", "quiet", "-o", "noise.wav")
    assert done["written"] == ["noise.wav"] and "not measured" in done["level_at_the_ear"]
    tacto.run("experiment", "noise", "quiet", "-o", "noise.wav", code=2)  # exists
    tacto.run("experiment", "noise", "quiet", "-o", "noise.mp3", code=2)
    samples, rate = soundfile.read("noise.wav")
    assert rate == 48000 and samples.ndim == 1 and len(samples) == 30 * rate and abs(samples).max() < 1
    power = abs(np.fft.rfft(samples)) ** 2
    hertz = np.fft.rfftfreq(len(samples), 1 / rate)
    inside = (hertz >= 15 - 1e-9) & (hertz <= 1500 + 1e-9)
    assert abs(20 * np.log10(samples.std()) + 20) < 1e-3 and power[~inside].sum() / power.sum() < 1e-10
    assert power[inside].max() / power[inside].min() < 1.01  # white, but for the rounding to 32 bits
    observer = ["--observer", "weber=25%"]
    for wrong in ("69dB", "61dB"):
        assert tacto.error_of(*run("quiet", "P01", *observer, "--masking-level", wrong), code=2)["where"] == "--masking-level"
    assert not pathlib.Path("quiet-P01.trials.jsonl").exists()
    done = tacto.run_json(*run("quiet", "P01", *observer, "--masking-level", "64.5dB"))
    assert journal("quiet-P01")[0]["masking_level"] == "64.5 dB" and "64.5 dB" in done["masking_noise"]
    done = tacto.run_json(*run("quiet", "P02", *observer))
    assert journal("quiet-P02")[0]["masking_level"] == "not measured" and "not measured" in done["masking_noise"]
    assert "not measured" in tacto.run_json("experiment", "prove", "quiet-P02")["masking_noise"]
    tacto.run("experiment", "export", "quiet", "--unblind", "-o", "out")
    with open("out/participants.tsv") as file:
        assert [row["masking_level"] for row in csv.DictReader(file, delimiter="\t")] == ["64.5 dB", "not measured"]
    # After an interruption the level is measured again.
    pathlib.Path("answers.txt").write_text("f\n")
    tacto.run(*run("quiet", "P03", "--answers", "answers.txt", "--masking-level", "66dB"))
    pathlib.Path("answers.txt").write_text("f\nf\nj\nj\n")
    tacto.run("experiment", "resume", "quiet-P03", "--answers", "answers.txt", "--masking-level", "90dB", code=2)
    tacto.run("experiment", "resume", "quiet-P03", "--answers", "answers.txt")
    assert [entry["masking_level"] for entry in journal("quiet-P03") if entry["event"] in ("plan", "resumed")] == ["66 dB", "not measured"]


def a_protocol_without_noise_says_so():
    new_study("loud")
    assert tacto.run_json("experiment", "check", "loud")["masking_noise"] == "none"
    tacto.run("experiment", "noise", "loud", "-o", "none.wav", code=5)
    tacto.run(*run("loud", "P01", "--observer", "weber=25%", "--masking-level", "65dB"), code=2)
    assert not pathlib.Path("none.wav").exists()
    tacto.run("experiment", "new", "stretch", "-o", "deaf", "--masking-noise", "90dB", code=5)
    assert not pathlib.Path("deaf.protocol.json").exists()


def a_person_reads_another_language_and_has_a_break():
    english = new_study("words", breaks={"after_trials": 1}, texts={"de": GERMAN})["texts"]["en"]
    assert tacto.error_of(*run("words", "P01", "--language", "fr"), code=2)["where"] == "--language"
    tacto.run(*run("words", "P01", "--language", "de", "--observer", "weber=25%"), code=2)
    ours, its = pty.openpty()
    command = ["setsid", "--ctty", "--wait", tacto.COMMAND, *run("words", "P01", "--language", "de")]
    person = subprocess.Popen(command, stdin=its, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    shown = b""
    while person.poll() is None:
        if select.select([person.stderr], [], [], 0.2)[0]:
            shown += os.read(person.stderr.fileno(), 4096)
            continue
        said = max(GERMAN.values(), key=lambda text: shown.rfind(text.encode()))  # the last one
        os.write(ours, {"BEGINN": b" ", "FRAGE": b"j", "PAUSE": b"x"}.get(said, b""))
    shown += person.communicate(timeout=120)[1]
    os.close(ours), os.close(its)
    assert person.returncode == 0, shown
    assert all(text.encode() in shown for text in GERMAN.values()) and english["question"].encode() not in shown
    entries = journal("words-P01")
    assert entries[0]["language"] == "de"
    events = [entry["event"] for entry in entries]
    answered = [i for i, event in enumerate(events) if event == "answered"]
    breaks = [i for i, event in enumerate(events) if event == "break"]
    assert len(answered) >= 2 and breaks == [i + 1 for i in answered[:-1]], events  # none after the last trial
    assert all(0 < entries[i]["break_s"] < 60 for i in breaks)
    assert tacto.run_json("experiment", "prove", "words-P01")["proven"] is True
    # An observer has no breaks.
    tacto.run(*run("words", "P02", "--observer", "weber=25%"))
    assert not any(entry["event"] == "break" for entry in journal("words-P02")) and "language" not in journal("words-P02")[0]


def a_missing_or_unknown_text_is_one_error():
    for change, place in (({"de": {**GERMAN, "break": ""}}, "/texts/de/break"), ({"de": {**GERMAN, "pause": "P"}}, "/texts/de/pause"), ({"german": GERMAN}, "/texts/german")):
        new_study("odd", "--force", breaks={"after_s": 60}, texts=change)
        assert tacto.error_of("experiment", "check", "odd", code=4)["where"].endswith("odd.protocol.json#" + place), place


def study():
    the_noise_is_written_and_its_level_is_logged()
    a_protocol_without_noise_says_so()
    a_person_reads_another_language_and_has_a_break()
    a_missing_or_unknown_text_is_one_error()


if __name__ == "__main__":
    tacto.in_folder(study)
