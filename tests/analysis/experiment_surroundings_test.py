#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What surrounds the trials of an experiment, on the emulated device: masking noise and its level, breaks, texts in another
language at a terminal, the pacing cue, and words about the normal force."""
import csv
import json
import pathlib
import re

import numpy as np
import soundfile

import experiment_files
import tacto
from person import Person

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


def in_german(shown):
    """The key that the last text asks for."""
    said = max(GERMAN.values(), key=lambda text: shown.rfind(text.encode()))
    return {"BEGINN": b" ", "FRAGE": b"j", "PAUSE": b"x"}.get(said, b"")


def practice_is_in_no_table():
    german = {**GERMAN, "practice": "PROBE"}
    new_study("probe", practice=2, breaks={"after_trials": 100}, texts={"en": german}, analysis="the JND of each person")
    checked = tacto.run_json("experiment", "check", "probe")
    assert (checked["practice"], checked["trials"], checked["languages"]) == (2, 2, ["en"])
    person = Person(*run("probe", "P01"))
    assert person.ends(in_german) == 0 and person.shown.count(b"PROBE") == 2 and person.shown.count(b"WILLKOMMEN") == 1
    begun = [entry for entry in journal("probe-P01") if entry["event"] == "begun"]
    assert [entry["block"] for entry in begun][:3] == [0, 0, 1] and len(begun) >= 4
    with open("probe-P01.trials.tsv") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    assert [int(row["attempt"]) for row in rows] == list(range(3, len(begun) + 1))
    proof = tacto.run_json("experiment", "prove", "probe-P01")
    assert proof["proven"] is True and proof["attempts"] == len(rows) and proof["sessions"] == 2 * len(begun)
    tacto.run(*run("probe", "P02", "--observer", "weber=25%,hurry=100%"))  # practice is not repeated
    assert [entry["block"] for entry in journal("probe-P02") if entry["event"] == "begun"] == [0, 0] + [1] * 6
    tacto.run("experiment", "export", "probe", "--unblind", "-o", "probe-out")
    with open("probe-out/trials.csv") as file:
        exported = list(csv.DictReader(file))
    assert len(exported) == len(rows)  # nothing of P02 counts
    for row in exported:
        assert row["seemed_longer"] == str(int(row["answer_interval"] == row["standard_interval"])), row


def no_screen_names_a_stimulus():
    """What the participant and the operator see of a whole run."""
    new_study("blind", breaks={"after_trials": 1}, texts={"en": GERMAN})
    person = Person(*run("blind", "P01"))
    operator = Person("experiment", "watch", "blind", "--time", "60s")
    assert person.ends(in_german) == 0 and operator.ends() == 0
    key = json.loads(pathlib.Path("blind.key.json").read_text())["stimuli"]
    names = {each["code"] for each in key} | {f"{each['stretch']:g}" for each in key} | {each["sha256"][:8] for each in key}
    for screen in (person.shown, operator.shown):
        assert not any(re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.])", screen.decode()) for name in names - {"0"}), screen
    assert b"complete" in operator.shown and b"FRAGE" in person.shown


def a_person_reads_another_language_and_has_a_break():
    english = new_study("words", breaks={"after_trials": 1}, texts={"de": GERMAN})["texts"]["en"]
    assert tacto.error_of(*run("words", "P01", "--language", "fr"), code=2)["where"] == "--language"
    tacto.run(*run("words", "P01", "--language", "de", "--observer", "weber=25%"), code=2)
    person = Person(*run("words", "P01", "--language", "de"))
    assert person.ends(in_german) == 0, person.shown
    assert all(text.encode() in person.shown for text in GERMAN.values()) and english["question"].encode() not in person.shown
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


def cues_in(session):
    return [event["event"] for event in tacto.run_json("session", session)["events"] if event["event"].startswith("cue")]


def the_screen_shows_how_to_move():
    texts = {"en": {name: text for name, text in GERMAN.items() if name != "break"}}
    assert "as the mark" in new_study("paced", "--pacing-cue")["texts"]["en"]["interval"]
    new_study("paced", "--force", "--pacing-cue", texts=texts)
    assert tacto.run_json("experiment", "check", "paced")["pacing_cue"] is True and tacto.run_json("experiment", "check", "loud")["pacing_cue"] is False
    person = Person(*run("paced", "P01"))
    assert person.ends(in_german) == 0, person.shown
    # The mark goes forth and back along the bar of 41 columns, once in each interval.
    intervals = person.shown.split(b"FAHREN")[1:]
    for shown in intervals:
        places = [bar.index(b"O") for bar in re.findall(rb"\|([ O]{41})\|", shown)]
        turn = places.index(max(places))
        assert places[0] == 0 and places[turn] > 35 and places[-1] < 5 and len(places) > 20, places
        assert places[:turn] == sorted(places[:turn]) and places[turn:] == sorted(places[turn:], reverse=True), places
    sessions = sorted(pathlib.Path("paced-P01").glob("*.session"))
    assert len(sessions) == len(intervals) >= 4 and all(cues_in(session) == ["cue 1", "cue 2"] for session in sessions)
    assert tacto.run_json("experiment", "prove", "paced-P01")["proven"] is True
    # An observer has no screen, so it has no cue.
    tacto.run(*run("paced", "P02", "--observer", "weber=25%"))
    assert not any(map(cues_in, pathlib.Path("paced-P02").glob("*.session")))
    # On a device that keeps time the beginning is counted down.
    person = Person("experiment", "run", "paced", "-d", "sim:paced=1", "--participant", "P03")
    person.until(rb"\|O {40}\| 0\.[1-4] s", in_german)
    person.press(b"\x03")
    person.ends()


def the_screen_says_how_the_finger_presses():
    words = {"force_below": "SCHWACH", "force_within": "RICHTIG", "force_above": "STARK"}
    new = ["--normal-force", "0.3N,0.8N"]
    assert new_study("pressed", *new)["normal_force"] == {"low_n": 0.3, "high_n": 0.8}
    new_study("pressed", "--force", *new, texts={"en": {**{name: text for name, text in GERMAN.items() if name != "break"}, **words}})
    assert "normal_force_reported" in tacto.run_json("experiment", "check", "pressed")
    for device, load, share in (("sim:load=0.1N", "force_below", 0), ("sim:load=0.5N", "force_within", 1), ("sim:load=1N", "force_above", 0)):
        assert tacto.run_json("experiment", "check", "pressed", "-d", device)["normal_force_reported"] == "yes"
        name = "P" + str(share) + load[-1]  # a code for each
        person = Person("experiment", "run", "pressed", "-d", device, "--participant", name)
        assert person.ends(in_german) == 0 and {word for word in words.values() if word.encode() in person.shown} == {words[load]}, person.shown
        judged = [entry for entry in journal(f"pressed-{name}") if entry["event"] == "delivered"]
        assert judged and all(entry["delivered"] and entry["force_within"] == [share, share] for entry in judged)
        with open(f"pressed-{name}.trials.tsv") as file:
            assert {row["force_within"] for row in csv.DictReader(file, delimiter="\t")} == {f"{share:.3f}"}
        assert "no session" in tacto.run_json("experiment", "prove", f"pressed-{name}")["normal_force"]
    tacto.run("experiment", "export", "pressed", "--unblind", "-o", "pressed-out")
    assert "force_within" in json.loads(pathlib.Path("pressed-out/sub-P1n/beh/sub-P1n_task-pressed_beh.json").read_text())
    for wrong in ("0.8N,0.3N", "0.3N", "0.3,0.8", "0.3N,0.8mm"):
        assert tacto.error_of("experiment", "new", "stretch", "-o", "none", "--normal-force", wrong, code=2)["where"] == "--normal-force"
    assert not pathlib.Path("none.protocol.json").exists()


def a_missing_or_unknown_text_is_one_error():
    new_study("bad", "--normal-force", "0.3N,0.8N", normal_force={"low_n": 0.9, "high_n": 0.8})
    assert tacto.error_of("experiment", "check", "bad", code=4)["where"].endswith("#/normal_force/high_n")
    new_study("bad", "--force", normal_force={"low_n": 0.1, "high_n": 0.8})
    assert tacto.error_of("experiment", "check", "bad", code=4)["where"].endswith("#/texts/en/force_below")
    for change, place in (({"de": {**GERMAN, "break": ""}}, "/texts/de/break"), ({"de": {**GERMAN, "pause": "P"}}, "/texts/de/pause"), ({"german": GERMAN}, "/texts/german")):
        new_study("odd", "--force", breaks={"after_s": 60}, texts=change)
        assert tacto.error_of("experiment", "check", "odd", code=4)["where"].endswith("odd.protocol.json#" + place), place


def study():
    the_noise_is_written_and_its_level_is_logged()
    a_protocol_without_noise_says_so()
    practice_is_in_no_table()
    no_screen_names_a_stimulus()
    a_person_reads_another_language_and_has_a_break()
    the_screen_shows_how_to_move()
    the_screen_says_how_the_finger_presses()
    a_missing_or_unknown_text_is_one_error()
    experiment_files.keep_to_their_schemas("delivered", "resumed", "break")


if __name__ == "__main__":
    tacto.in_folder(study)
