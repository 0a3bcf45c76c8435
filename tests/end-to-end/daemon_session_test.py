#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactographd on an emulated device that does not keep real time: from load to a session that replays, a fault, and refusals.
What depends on real time is in daemon_test.py, daemon_load_test.py and daemon_clients_test.py."""
import base64
import hashlib
import json
import os
import pathlib
import struct
import subprocess
import sys

import numpy as np

import tacto
from run_daemon import Client, DAEMON, daemon, prepare_files, ticks_of

UNPACED = "sim:paced=0"  # emulated time passes only while the daemon reads: no watchdog can expire


def wait_until_played(client, duration_s):
    """In emulated time, which passes while the device is armed, too; the fault is the error."""
    while (status := client.must(request="status"))["played_s"] < duration_s:
        assert status["state"] in ("armed", "playing"), status
    return status


def wait_for_state(client, state):
    while (status := client.must(request="status"))["state"] != state:
        assert status["state"] != "fault", status
    return status


def load_arm_play_stop():
    prepare_files(device=UNPACED)
    with daemon():
        client, watcher = Client(), Client()
        assert watcher.must(request="watch")["state"] == "idle"
        refused = client.ask(request="play")
        assert not refused["ok"], refused
        assert client.must(request="load", file="oak", gain_m_per_n=0.0005)["gain_m_per_n"] == 0.0005
        session = client.must(request="arm")["session"]
        client.must(request="play")
        status = wait_until_played(client, 1.5)
        assert status["state"] == "playing" and status["lost_ticks"] == 0 and status["drive_peak_v"] > 0.01, status
        client.must(request="gain", gain=0.5)
        wait_until_played(client, 3)
        assert client.must(request="status")["gain"] == 0.5
        client.must(request="stop")
        wait_for_state(client, "armed")
        client.must(request="disarm")
        wait_for_state(client, "idle")
        states = []
        while not states or states[-1] != "idle":
            event = json.loads(watcher.lines.readline())
            states += [event["state"]] if event["event"] == "state" else []
    assert states == ["armed", "playing", "armed", "idle"], states
    replayed = tacto.run_json("replay", session)
    assert replayed["same_to_the_bit"] and replayed["ticks_compared"] >= 6000, replayed
    assert tacto.run_json("info", session)["ending"] == "closed"
    assert tacto.run_json("validate", session)["valid"]
    drive = ticks_of(session)["drive_v"]
    assert drive[0] == 0 and drive[-1] == 0 and np.max(np.abs(drive)) > 0.01, drive
    assert np.max(np.abs(np.diff(drive))) <= 15708 / 2000 * (1 + 1e-6), "the transducer's slew limit, V/s over ticks a second"


def watched_ticks_are_those_of_the_session():
    """Each tick that arrives is the session's, also at 8 kHz, where two of each 0.5 ms arrive; a daemon that nobody asks
    sends none. Emulated time is faster than a reader, so events may be lost."""
    tick = np.dtype([("after_ns", "<u4"), ("encoder", "<i4"), ("drive_v", "<f4"), ("flags", "<u4"), ("lateness_ns", "<i4")])
    for rate_hz, per_cell in ((2000, None), (8000, 4)):
        prepare_files(device=UNPACED + ",rate=8kHz", rate_hz=rate_hz)
        with daemon():
            client, watcher, other = Client(), Client(), Client()
            assert other.ask(request="status", ticks=True)["error"]["fault"] == 3
            other.must(request="watch")
            watcher.must(request="watch", ticks=True)
            client.must(request="load", file="oak", gain_m_per_n=0.0005)
            session = client.must(request="arm")["session"]
            client.must(request="play")
            events = [watcher.next_event("ticks") for _ in range(20)]
            client.must(request="disarm")
            names = {event["event"] for event in other.rest_of_events()}
            assert {"state", "status"} <= names and "ticks" not in names, names
        table = ticks_of(session)
        device_ns = np.round(1e9 * table["device_time_s"])
        count = 0
        for event in events:
            assert event["block"] == 1 and event.get("cell_ticks") == per_cell, event
            payload = base64.b64decode(event["ticks"])
            first, time_ns, rows = struct.unpack_from("<QqI", payload)
            ticks = np.frombuffer(payload, tick, rows, offset=20)
            times = time_ns + ticks["after_ns"].astype(np.int64)
            place = np.searchsorted(device_ns, times - 1000)  # of the table's rows; its times have nine digits
            assert per_cell or np.array_equal(table["tick"][place], first + np.arange(rows)), (first, rows)
            assert np.max(np.abs(device_ns[place] - times)) < 1000
            assert np.array_equal(table["encoder_count"][place], ticks["encoder"])
            assert np.allclose(table["drive_v"][place], ticks["drive_v"], rtol=1e-6, atol=1e-9)
            count += rows
        assert count > 500, count


def a_jump_of_the_encoder_is_a_fault():
    """The drive is zero within 20 ms of the fault and stays zero; the session replays."""
    prepare_files(device=UNPACED)
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.9,0.006\n0.90001,0.016\n1.8,0.020\n")
    with daemon():
        client = Client()
        client.must(request="load", file="oak", gain_m_per_n=0.0005)
        # Emulated time does not wait for this test: where it stops between two requests, the jump comes before
        # `play`. The path is repeated without end.
        session = client.must(request="arm")["session"]
        while not client.ask(request="play")["ok"]:
            assert client.must(request="status")["state"] == "fault"
            client.must(request="disarm")
            wait_for_state(client, "idle")
            session = client.must(request="arm")["session"]
        while (status := client.must(request="status"))["state"] != "fault":
            assert status["state"] in ("armed", "playing"), status
        assert status["fault"], status
        assert not client.ask(request="play")["ok"]
        faulted = status["ticks"]
        while client.must(request="status")["ticks"] < faulted + 100:
            pass
        client.must(request="disarm")
        wait_for_state(client, "idle")
    ticks = ticks_of(session)
    fault = int(np.argmax(ticks["fault"] > 0))
    assert ticks["fault"][fault] > 0 and len(ticks) > fault + 40, (fault, len(ticks))
    assert np.all(ticks["drive_v"][fault + 40:] == 0)
    assert tacto.run_json("replay", session)["same_to_the_bit"]


def wrong_files_are_refused():
    prepare_files(device=UNPACED)
    with daemon():
        client = Client()
        refused = client.ask(request="load", file="nothing")
        assert not refused["ok"] and "nothing" in refused["error"]["where"], refused
        refused = client.ask(request="arm")
        assert not refused["ok"], refused
        second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=60)
        assert second.returncode == 5, second
        assert os.stat("control").st_mode & 0o777 == 0o600
    prepare_files(device_=1)
    done = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 4 and "device_" in done.stderr, done


def a_scene_of_forces_is_played_and_set():
    prepare_files(device="sim:planar,paced=0", finger_path="still.csv")
    pathlib.Path("still.csv").write_text("time_s,x_m,y_m\n0,0.03,0\n1,0.03,0\n")
    spring = {"type": "spring", "stiffness_n_per_m": {"value": 50, "slider": {"from": 0, "to": 200}},
              "centre_x_m": {"value": 0, "slider": {"from": -0.02, "to": 0.02}}, "centre_y_m": 0}
    pathlib.Path("bench.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "patches": [
        {"name": "bench", "place": {"x_m": 0, "y_m": 0}, "size": {"width_m": 0.2, "height_m": 0.2}, "layers": [spring]}]}))
    number = "bench.spring.stiffness_n_per_m"

    def refused(client, fault, **request):
        answer = client.ask(**request)
        assert not answer["ok"] and answer["error"]["fault"] == fault, answer

    def steady_force(client, newtons):
        """At 4 kHz a change is over after 41 ticks, and the ticks come every 10 ms."""
        wait_until_played(client, client.must(request="status")["played_s"] + 0.1)
        status = client.must(request="status")
        assert abs(status["force_x_n"] - newtons) < 1e-6 and status["force_y_n"] == 0 and abs(status["x_m"] - 0.03) < 1e-9, status

    with daemon():
        client, watcher = Client(), Client()
        watcher.must(request="watch")
        refused(client, 1, request="set", number=number, value=100)
        refused(client, 4, request="load", file="oak")
        refused(client, 1, request="load", file="bench.scene.json", at_m=0.01)
        loaded = client.must(request="load", file="bench.scene.json")
        assert loaded["rate_hz"] == 4000 and loaded["patches"] == 1, loaded
        refused(client, 1, request="set", number=number, value=100)
        refused(client, 4, request="gain", gain=0.5)
        session = client.must(request="arm")["session"]
        client.must(request="play")
        steady_force(client, -1.5)
        shown = tacto.run("ctl", "top", "--time", "0s", "--socket", "control")[0]
        assert "x -1.500 N" in shown and "drive" not in shown and "gain" not in shown, shown
        assert client.must(request="set", number=number, value=100)["over_s"] == 0.01
        printed = [watcher.next_event("set")]  # at once: of a watcher that does not read, events are dropped
        steady_force(client, -3)
        tacto.run("ctl", "set", number, "20", "--over", "0s", "--socket", "control")
        printed.append(watcher.next_event("set"))
        steady_force(client, -0.6)
        tacto.run("ctl", "set", "bench.0.centre_x_m", "-0.01", "--socket", "control")
        printed.append(watcher.next_event("set"))
        steady_force(client, -0.8)
        refused(client, 1, request="set", number=number, value=201)
        refused(client, 1, request="set", number="bench.spring.centre_y_m", value=0)
        refused(client, 1, request="load", file="bench.scene.json")
        refused(client, 3, request="set", number=number)
        assert "'spring'" in tacto.run("ctl", "set", "bench.sprng.stiffness_n_per_m", "20", "--socket", "control", code=2)[1]
        watcher = Client()
        watcher.must(request="watch")
        moved = client.must(request="move", patch="bench", x_m=0.01, y_m=0)
        event_of_move = watcher.next_event("move")
        # 10 mm of the patch of 200 mm, on a grid of 101 columns.
        assert moved["over_s"] == 0.01 and " 4.95 % " in moved["note_1"] and (event_of_move["x_m"], event_of_move["over_s"]) == (0.01, 0.01), moved
        assert client.must(request="raise", patch="bench")["patch"] == watcher.next_event("raise")["patch"] == "bench"
        assert "note_1" not in client.must(request="move", patch="bench", x_m=0, y_m=0)
        client.must(request="move", patch="bench", x_m=0.01, y_m=0)
        steady_force(client, -0.6)
        tacto.run("ctl", "move", "bench", "-10mm,0mm", "--over", "0s", "--socket", "control")
        steady_force(client, -1)
        assert "outside the travel" in client.must(request="move", patch="bench", x_m=0.15, y_m=0)["note_1"]
        steady_force(client, 0)
        tacto.run("ctl", "raise", "bench", "--socket", "control")
        refused(client, 1, request="raise", patch="bnech")
        refused(client, 3, request="move", patch="bench", x_m=0)
        refused(client, 3, request="move", x_m=0, y_m=0)
        refused(client, 3, request="raise", patch="bench", over_s=0.1)
        for wrong, word in ((("move", "bnech", "0mm,0mm"), "'bench'"), (("move", "bench", "10mm"), "10mm,20mm"), (("move", "bench", "1,2"), "mm"),
                            (("move", "bench"), "X,Y"), (("raise",), "PATCH"), (("raise", "bench", "3"), "value"), (("raise", "bench", "--over", "1s"), "--over")):
            assert word in tacto.run("ctl", *wrong, "--socket", "control", code=2)[1], wrong
        client.must(request="stop")
        wait_for_state(client, "armed")
        client.must(request="disarm")
        wait_for_state(client, "idle")
        assert [(event["number"], event["value"], event["over_s"]) for event in printed] == [(number, 100, 0.01), (number, 20, 0), ("bench.0.centre_x_m", -0.01, 0.01)], printed
    assert tacto.run_json("replay", session)["same_to_the_bit"] is True
    events = [event["event"] for event in tacto.run_json("session", session)["events"]]
    assert {"move bench 0.01 m,0 m over 0.01 s", "move bench -0.01 m,0 m over 0 s", "raise bench"} <= set(events), events
    assert f"set {number} 100 over 0.01 s" in events and f"set {number} 20 over 0 s" in events, events


def what_is_between_the_marks_of_any_client_is_proven():
    sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "data-schema/python"))
    import tactograph
    prepare_files(device=UNPACED)
    # Again and again 30 mm at 60 mm/s, and back, with turns where the texture has no slope (a turn elsewhere is a kink of
    # the displacement, which no filter follows): 2.2 s contain at least three whole strokes.
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.00425\n0.5,0.03425\n1,0.00425\n")

    def play_for(client, duration_s):
        until_s = client.status()["played_s"] + duration_s
        while client.status()["played_s"] < until_s:
            pass

    with daemon():
        with tactograph.Daemon("control") as client:
            try:
                client.mark("too early")
                raise AssertionError("a mark without a session")
            except tactograph.DaemonProblem as early:
                assert early.kind == "usage", early
            client.load("oak", gain_m_per_n=0.0005)
            session = client.arm()["session"]
            client.play()
            play_for(client, 1)  # the onset
            ticks = []
            for trial in ("trial 1", "trial 2"):
                ticks.append(client.mark(trial)["tick"])
                play_for(client, 2.2)
                ended = client.mark("\u3000 end\u00a0")
                assert ended["text"] == "end", ended
                ticks.append(ended["tick"])
                play_for(client, 0.5)
            client.stop()
            client.mark("at rest")
            tacto.run("ctl", "mark", "Größe 2", "--socket", "control")
            for point in (0, 9, 0x1F, 0x7F, 0x80, 0x85, 0x9F, 0x61C, 0x200E, 0x200F, 0x2028, 0x2029, 0x202A, 0x202E, 0x2066, 0x2069):
                try:
                    client.mark(f"Gr\u00f6\u20ac\U0001F600{chr(point)}")
                    raise AssertionError(hex(point))
                except tactograph.DaemonProblem as refused:
                    assert refused.kind == "malformed" and f"U+{point:04X}" in str(refused) and "character 6 " in str(refused), refused
            for wrong in ({}, {"text": ""}, {"text": " \u2003\u200b"}, {"text": "two\nlines"}, {"text": "a" * 201}, {"text": "a", "file": "oak"}):
                try:
                    client.ask("mark", **wrong)
                    raise AssertionError(wrong)
                except tactograph.DaemonProblem as refused:
                    assert refused.kind == "malformed", (wrong, refused)
            client.disarm()
        for text in ((), (" ",), ("a\u202e",), ("a" * 201,)):
            wrong = tacto.error_of("ctl", "mark", *text, "--socket", "control", code=2)
            assert wrong["where"] == ("TEXT" if text else "command line"), wrong
    assert ticks == sorted(ticks) and ticks[1] - ticks[0] > 2.2 * 2000 - 2, ticks
    listed = tacto.run_json("session", session)
    assert [mark["mark"] for mark in listed["marks"]] == ["trial 1", "end", "trial 2", "end", "at rest", "Größe 2"], listed["marks"]
    assert [mark["tick"] for mark in listed["marks"]][:4] == ticks
    assert not any("trial" in event["event"] for event in listed["events"])
    assert tacto.run_json("replay", session)["same_to_the_bit"] is True
    proof = tacto.run_json("experiment", "prove", session)
    assert proof["same_to_the_bit"] is True and "proven" not in proof and "emulated" in proof["simulated"] and "-20 dB" in proof["limits"], proof
    found = {row["mark"]: row for row in proof["intervals"]}
    assert list(found) == ["trial 1", "trial 2", "at rest", "Größe 2"] and proof["marked_intervals"] == 4 and proof["delivered"] == 2, proof
    strokes = listed["strokes"]
    for i, trial in enumerate(("trial 1", "trial 2")):
        row = found[trial]
        assert row["delivered"] == "yes" and row["why"] == "" and row["ticks"] == ticks[2 * i + 1] - ticks[2 * i], row
        whole = [stroke for stroke in strokes if row["from_s"] <= stroke["from_s"] and stroke["to_s"] <= row["to_s"]]
        assert row["strokes"] == len(whole) >= 3 and row["predicted_error_db"] == max(stroke["predicted_error_db"] for stroke in whole)
        assert abs(row["slowest_mps"] - 0.06) < 0.001 and abs(row["fastest_mps"] - 0.06) < 0.001  # 1 um counts; a stroke's end by 0.2 mm
        assert row["lost_ticks"] == row["fault_ticks"] == row["late_ticks"] == row["blind_ticks"] == 0
    assert found["at rest"]["delivered"] == "unknown" and found["at rest"]["strokes"] == 0, found["at rest"]
    # A protocol with a lower limit of speed: the same strokes are too fast.
    tacto.run("experiment", "new", "stretch", "-o", "slow")
    protocol = json.loads(pathlib.Path("slow.protocol.json").read_text())
    protocol["delivered"]["fastest_mps"], protocol["delivered"]["slowest_mps"], protocol["pace"]["speed_mps"] = 0.055, 0.04, 0.05
    pathlib.Path("slow.protocol.json").write_text(json.dumps(protocol))
    slow = tacto.run_json("experiment", "prove", session, "--protocol", "slow")
    assert slow["delivered"] == 0 and "too fast" in slow["intervals"][0]["why"] and slow["intervals"][0]["delivered"] == "no"
    assert slow["same_to_the_bit"] is True
    # A session with another drive in one tick, and correct checksums: exit code 5, whatever was delivered.
    whole, at = bytearray(pathlib.Path(session).read_bytes()), 0
    while True:
        _, kind, size, _ = struct.unpack_from("<IB3xI8s", whole, at)
        if kind == 1 and any(whole[at + 48:at + 52]):  # ticks: the drive of the first one
            break
        at += 20 + size
    whole[at + 48] ^= 1
    whole[at + 12:at + 20] = hashlib.sha256(struct.pack("<BI", kind, size) + whole[at + 20:at + 20 + size]).digest()[:8]
    pathlib.Path("other.session").write_bytes(whole)
    assert tacto.run_json("experiment", "prove", "other.session", code=5)["same_to_the_bit"] is False
    # A session whose writer was killed: the open interval is not complete.
    whole = pathlib.Path(session).read_bytes()
    at = whole.index("mark: trial 2".encode())
    pathlib.Path("cut.session").write_bytes(whole[:at + 2000])
    cut = json.loads(subprocess.run([tacto.COMMAND, "experiment", "prove", "cut.session", "--json"], capture_output=True, text=True).stdout)
    assert cut["intervals"][-1]["mark"] == "trial 2" and "not complete" in cut["intervals"][-1]["why"], cut["intervals"]


if __name__ == "__main__":
    for test in (load_arm_play_stop, watched_ticks_are_those_of_the_session, what_is_between_the_marks_of_any_client_is_proven, a_scene_of_forces_is_played_and_set, a_jump_of_the_encoder_is_a_fault, wrong_files_are_refused):
        tacto.in_folder(test)
