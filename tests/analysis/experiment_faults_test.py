#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What can go wrong in a run of `tactograph experiment`, on the emulated device: SIGKILL, lost ticks, drives beyond a limit; and
what the tray's sensor measures."""
import json
import pathlib
import random
import signal
import subprocess
import time

import experiment_files
import tacto
from experiment_study_test import journal, new_study, table


def two_stretches(name, **changes):
    """A study of the stretches -50 and 50 %."""
    new_study(name, 10)
    path, key = pathlib.Path(f"{name}.protocol.json"), pathlib.Path(f"{name}.key.json")
    path.write_text(json.dumps({**json.loads(path.read_text()), "levels": [-0.5, 0.5], **changes}))
    stimuli = json.loads(key.read_text())
    key.write_text(json.dumps({**stimuli, "stimuli": [each for each in stimuli["stimuli"] if each["stretch"] in (-0.5, 0, 0.5)]}))


def no_kill_loses_an_answer():
    """SIGKILL at 50 random moments, from before the journal exists to the end of a run."""
    two_stretches("kills")
    random.seed(11)
    kills, people = 0, 0
    while kills < 50:
        people += 1
        run, kept = f"kills-P{people}", b""
        path = pathlib.Path(f"{run}.trials.jsonl")
        while b'"event":"end"' not in kept:
            begins = ["run", "kills", "-d", "sim:", "--participant", f"P{people}", "--observer", "weber=25.3%,lapse=2%,seed=1"]
            process = subprocess.Popen([tacto.COMMAND, "experiment", *(["resume", run] if kept else begins)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                process.wait(None if kills >= 50 else random.uniform(0, 0.4))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
            whole = path.read_bytes() if path.exists() else b""
            assert whole.startswith(kept), run
            kept = whole[:whole.rfind(b"\n") + 1]
            if whole and not kept:
                path.unlink()  # the plan was not whole, as 'resume' says
        answers = [(entry["event"], entry["attempt"]) for entry in journal(run) if entry["event"] == "answered"]
        assert len(answers) == len(set(answers)) == 20 and len({row["trial"] for row in table(run) if row["answer"]}) == 20
        assert tacto.run_json("experiment", "prove", run)["proven"] is True


def stopped_run(run):
    """A run whose process stops while the device plays, and in the next interval while it waits for the beginning. Where it
    stops is seen by the size of the session, whose upload has 30 kB. None if the link lost the answer to a command, too: then
    the run ends with exit code 8."""
    command = ["experiment", "run", "lost", "-d", "sim:paced=1,link_buffer=20ms", "--participant", run.split("-")[1], "--observer", "weber=25%"]
    process = subprocess.Popen([tacto.COMMAND, *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for name, size in (("001-1", 70_000), ("001-2", 31_000)):
        session = pathlib.Path(f"{run}/{name}.session")
        while process.poll() is None and not (session.exists() and session.stat().st_size > size):
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.4)
        process.send_signal(signal.SIGCONT)
    assert process.wait() in (0, 8)
    return table(run) if process.returncode == 0 else None


def lost_ticks_come_again():
    """What the link could not keep is lost, the device's watchdog ends the playback, the trial says so and comes again, and
    the run is proven. On a busy machine the stop may come after the interval, so several runs may be needed."""
    two_stretches("lost", repetitions=1, most_attempts=2, lead_s=0.3, pace={"from_m": 0.01, "to_m": 0.03, "speed_mps": 0.06, "strokes": 2})
    for person in range(1, 6):
        run = f"lost-P{person}"
        rows = stopped_run(run)
        if rows is None:
            continue
        proof = tacto.run_json("experiment", "prove", run)
        assert proof["proven"] is True and "faults" not in proof, proof
        if "lost ticks" in rows[0]["why"]:
            break
    assert rows and rows[0]["delivered"] == "no" and "lost ticks" in rows[0]["why"], rows[0]
    assert [row["trial"] for row in rows].count(rows[0]["trial"]) > 1 and proof["same_to_the_bit"] < proof["sessions"]


def what_the_limits_remove_is_not_delivered():
    preset = pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json"
    weak = {**json.loads(preset.read_text()), "name": "weak", "drive_limit_v": 0.3}
    pathlib.Path("weak.transducer.json").write_text(json.dumps(weak))
    two_stretches("weak", repetitions=1, most_attempts=2)
    done = tacto.run_json("experiment", "run", "weak", "-d", "sim:transducer=weak", "--participant", "P01", "--observer", "weber=25%")
    assert done["abandoned"] == 2 and done["attempts"] == 4, done
    assert all(row["delivered"] == "no" and "removed by limits -" in row["why"] for row in table("weak-P01"))
    assert tacto.run_json("experiment", "prove", "weak-P01")["proven"] is True


def what_the_tray_s_sensor_measures_is_in_the_table():
    """Its noise is 20 nm, its delay one shift: neither changes a period of a displacement of 8 um."""
    two_stretches("tray", repetitions=2)
    tacto.run("experiment", "run", "tray", "-d", "sim:tray_sensor=on", "--participant", "P01", "--observer", "weber=25%")
    for row in table("tray-P01"):
        assert abs(float(row["measured_stretch"]) - float(row["nominal_stretch"])) < 0.01 and row["delivered"] == "yes", row
        assert row["measured_stretch"] != row["predicted_stretch"] and float(row["measured_error_db"]) < -20
    proof = tacto.run_json("experiment", "prove", "tray-P01")
    assert 0 < proof["measured_stretch_error"] < 0.01 and proof["proven"] is True
    assert {row["measured_stretch"] for row in table("weak-P01")} == {""}  # without the sensor


def runs():
    no_kill_loses_an_answer()
    lost_ticks_come_again()
    what_the_limits_remove_is_not_delivered()
    what_the_tray_s_sensor_measures_is_in_the_table()
    experiment_files.keep_to_their_schemas("delivered", "resumed")


if __name__ == "__main__":
    tacto.in_folder(runs)
