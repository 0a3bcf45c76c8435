#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactographd on the emulated device: from load to a session that replays, in both loops, and the faults of device, machine and
disk."""
import contextlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import soundfile

import tacto
from run_daemon import begin, Client, daemon, expect_a_ramp, prepare_files, SLOW, ticks_of


def from_load_to_a_session_that_replays():
    prepare_files()
    ctl = lambda *arguments, code=0: tacto.run("ctl", *arguments, "--socket", "control", code=code)
    with daemon():
        watcher = Client()
        assert watcher.must(request="watch")["state"] == "idle"
        _, said = ctl("play", code=2)
        assert "idle" in said and "arm" in said, said
        assert "500" in ctl("load", "oak", "--gain", "0.5mm/N")[0]
        ctl("arm")
        time.sleep(0.2)
        armed = Client().must(request="status")
        assert armed["played_s"] == 0 < armed["armed_s"], armed
        assert "playing" in ctl("play")[0]
        time.sleep(1)
        ctl("gain", "25%")
        time.sleep(0.5)
        status = json.loads(ctl("status", "--json")[0])
        assert status["state"] == "playing" and status["drive_peak_v"] > 0.01 and status["lost_ticks"] == 0, status
        assert abs(status["speed_mps"]) < 0.2 and status["gain"] == 0.5 and status["gain_m_per_n"] == 2.5e-4
        assert "armed" in ctl("stop")[0]
        assert "idle" in ctl("disarm")[0]
        session = json.loads(ctl("status", "--json")[0])["session"]
        ctl("arm")
        ctl("disarm")
        events = watcher.rest_of_events()
    states = [e["state"] for e in events if e["event"] == "state"]
    assert states == ["armed", "playing", "armed", "idle", "armed", "idle"], states
    times = [e["device_s"] for e in events if e["event"] == "state"]
    assert np.all(np.diff(times) > -1e-6) and times[4] > 1, times
    assert sum(e["event"] == "status" for e in events) >= 5 and all("device_s" in e for e in events)
    replayed = tacto.run_json("replay", session)
    assert replayed["same_to_the_bit"] and replayed["ticks_compared"] > 2000
    assert tacto.run_json("validate", session)["valid"]
    assert tacto.run_json("info", session)["ending"] == "closed"


def what_the_limits_took_is_found():
    """`status` has the removed part in dB, in both loops, and nothing if the limits remove nothing. After the session
    is closed it is the value that `session` reports for the whole. The command in its message also reads a running
    session."""
    preset = pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json"
    weak = {**json.loads(preset.read_text()), "name": "weak", "drive_limit_v": 0.3}
    pathlib.Path("weak.transducer.json").write_text(json.dumps(weak))
    live_members = ("limits_took_db", "limits_took_last_second_db", "limits_in_db")
    on_host = {"loop": "host", "device": "sim:rate=2kHz", "most_late_percent": 100, "watchdog_ms": 1000}
    for limited in ({"transducer": "weak"}, {"transducer": "weak", **on_host}, {"playback": {"energy_rms_v": 0.1, "energy_window_s": 0.1}}):
        prepare_files(**limited)
        with daemon():
            client = Client()
            begin(client)
            status = client.must(request="status")
            deadline = time.monotonic() + 60
            while "limits_took_last_second_db" not in status:
                assert status["state"] == "playing" and time.monotonic() < deadline, status
                limited_ticks = status["limited_ticks"] + status["energy_limited_ticks"]
                assert ("limits_in_db" in status) == (limited_ticks > 0), status
                time.sleep(0.05)
                status = client.must(request="status")
            time.sleep(1)
            asked = status["limits_in_db"].split()
            assert asked[:2] == ["tactograph", "session"] and asked[2] == status["session"], status
            so_far = tacto.run_json(*asked[1:])["removed_by_limits_db"]
            top, _ = tacto.run("ctl", "top", "--socket", "control", "--time", "0.5s")
            assert "dB since arming" in top and f"by stroke: {' '.join(asked)}" in top, top
            client.must(request="disarm")
            live = client.must(request="status")
        closed = tacto.run_json(*asked[1:])["removed_by_limits_db"]
        assert abs(live["limits_took_db"] - closed) < 1e-9, (live, closed)
        assert -20 < closed < -1 and -20 < so_far < -1, (so_far, closed)
        print(f"{limited}: limits took {so_far:.1f} dB so far, {closed:.1f} dB in all")
    prepare_files()
    with daemon():
        client = Client()
        session = begin(client)
        time.sleep(1)
        client.must(request="disarm")
        live = client.must(request="status")
    assert live["drive_peak_v"] > 0.1 and not any(member in live for member in live_members), live
    assert tacto.run_json("session", session)["removed_by_limits"] == "none"


def the_loop_closed_on_the_host():
    """The same with the kernel on this computer's real-time thread. Lateness is measured, not asserted: machines
    stall."""
    prepare_files(loop="host", device="sim:rate=2kHz", most_late_percent=100, watchdog_ms=1000)
    with daemon() as process:
        client = Client()
        session = begin(client)
        time.sleep(1.5)
        status = client.must(request="status")
        assert status["state"] == "playing" and status["drive_peak_v"] > 0.01, status
        assert client.must(request="load", file="oak", at_m=0.002, gain_m_per_n=0.0008)["changed"]
        time.sleep(0.5)
        assert client.must(request="status")["state"] == "playing"
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.1)
        process.send_signal(signal.SIGCONT)
        time.sleep(0.5)
        # The drive fell, the new count was used, the drive rose: no jump, no fault.
        after = client.must(request="status")
        assert after["state"] == "playing" and after["blind_ticks"] > status["blind_ticks"], after
        assert status["period_s"] == 1 / 2000 and 0 < status["wake_p99_s"] < 1 and status["busy_p99_s"] > 0, status
        client.must(request="disarm")
    print(f"wake-up p99 {1e6 * status['wake_p99_s']:.0f} us, work p99 {1e6 * status['busy_p99_s']:.1f} us, "
          f"missed {status['missed_ticks']}, stale {status['stale_drives']}")
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    ticks = ticks_of(session)
    assert np.sum(np.isfinite(ticks["lateness_s"])) == len(ticks) > 2000
    _, said = tacto.run("session", session, "-o", "host.wav")  # time continues during a stall of the computer
    assert said.count("periods have no tick") == 2, said
    span_s = ticks["time_s"][-1] - ticks["time_s"][0]
    drift_s = 0.005 * span_s  # the ticks follow the device's clock with an error of at most half a percent
    assert span_s > len(ticks) / 2000 + 0.08 - drift_s, (span_s, len(ticks))
    assert abs(soundfile.info("host.wav").frames / 2000 - span_s) < 2e-3 + drift_s, (span_s, len(ticks))


def kill_9_in_mid_play():
    """Synced ticks exist and replay; the next daemon takes over socket and device."""
    prepare_files()
    with daemon(code=-signal.SIGKILL) as process:
        session = begin(Client())
        time.sleep(1.5)
        process.kill()
        process.wait()
    described = tacto.run_json("info", session)
    assert described["ending"].startswith("not closed") and described["ticks"] > 2000, described
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    assert "was never closed" in tacto.run("session", session)[1]
    with daemon():
        assert Client().must(request="status")["state"] == "idle"


def sigstop_of_200_ms():
    """A link that holds 250 ms and a device that ticks on: the device must stop safely, and the daemon must report
    it."""
    prepare_files(device="sim:link_buffer=1s", watchdog_ms=100)
    with daemon() as process:
        client = Client()
        session = begin(client)
        time.sleep(0.7)
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.2 * SLOW)
        process.send_signal(signal.SIGCONT)
        status = client.wait_for("fault")
        assert "received nothing from this computer" in status["fault"], status
        assert not client.ask(request="play")["ok"]
        time.sleep(0.1)
        client.must(request="disarm")
        client.must(request="arm")
        client.must(request="play")
        client.wait_for("playing")
    expect_a_ramp(session)
    assert tacto.run_json("replay", session)["same_to_the_bit"]


def encoder_jump_of_10_mm():
    prepare_files()
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.9,0.006\n0.90001,0.016\n1.8,0.020\n")
    with daemon():
        client = Client()
        session = begin(client)
        status = client.wait_for("fault")
        assert "the encoder jumped by" in status["fault"], status
        time.sleep(0.2)
        client.must(request="disarm")
    expect_a_ramp(session)
    assert tacto.run_json("replay", session)["same_to_the_bit"]


def late_ticks_beyond_a_limit_are_a_fault():
    """A computer that stalls repeatedly plays too late: above most_late_percent it is a fault."""
    prepare_files(loop="host", device="sim:rate=2kHz", most_late_percent=1, watchdog_ms=1000)
    with daemon() as process:
        client = Client()
        session = begin(client)
        time.sleep(0.5)
        for _ in range(200):
            process.send_signal(signal.SIGSTOP)
            time.sleep(0.01)
            process.send_signal(signal.SIGCONT)
            time.sleep(0.01)
            if (status := client.must(request="status"))["state"] == "fault":
                break
        assert status["state"] == "fault" and "late" in status["fault"], status
        time.sleep(0.2)
        client.must(request="disarm")
    drive = ticks_of(session)["drive_v"]
    assert np.max(np.abs(drive)) > 0.01 and np.all(drive[-100:] == 0), drive[-100:]


def full_disk_for_the_log():
    """A limit of the file size simulates a full disk. Playback continues; missing ticks are counted and reported."""
    import resource
    prepare_files()
    with daemon(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))) as process:
        client, watcher = Client(), Client()
        watcher.must(request="watch")
        session = begin(client)
        for _ in range(int(100 * SLOW)):
            status = client.must(request="status")
            if status["recorder_lost_ticks"] > 0:
                break
            time.sleep(0.1)
        assert status["state"] == "playing" and status["recorder_lost_ticks"] > 0, status
        assert "recorder_failure" in status and status["lost_ticks"] == status["recorder_lost_ticks"]
        client.ask(request="disarm")
        kept = client.must(request="status")
        assert kept["recorder_lost_ticks"] >= status["recorder_lost_ticks"] and kept["lost_ticks"] == kept["recorder_lost_ticks"], kept
        printed = [e for e in watcher.rest_of_events() if e["event"] == "recorder"]
        # The first event may come before a tick is lost: the failure is known, and the buffer is not yet full.
        counts = [event["lost_ticks"] for event in printed]
        assert printed and all(event["why"] for event in printed), printed
        assert counts == sorted(counts) and counts[-1] > 0, printed
        said = [process.stderr.readline() for _ in range(5)]
        assert any("ticks are not in the session" in line for line in said), said
    described = tacto.run_json("info", session)
    assert described["ticks"] > 1000, described
    # Up to the hole, or to the last tick that was written: more is missing in either case.
    done = subprocess.run([tacto.COMMAND, "replay", session, "--json"], capture_output=True, text=True, timeout=60)
    replayed = json.loads(done.stdout)
    assert "first_difference_tick" not in replayed and replayed["ticks_compared"] > 1000, replayed
    assert replayed["same_to_the_bit_up_to_the_lost_tick"] and "lost_at_tick" in replayed and done.returncode == 5, replayed
    assert replayed["lost_ticks"] == described["lost_ticks"] >= status["lost_ticks"] > 0, (replayed, described, status)
    assert described["ending"] == "closed", described  # the space for it is reserved
    assert "ticks are missing" in tacto.run("session", session)[1]


def the_service_manager_is_told():
    """systemd's protocol: ready when clients can connect, alive every half of WATCHDOG_USEC, stopping at the end."""
    prepare_files()
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind("notify")
        manager.settimeout(10 * SLOW)
        with daemon(env={**os.environ, "NOTIFY_SOCKET": os.path.abspath("notify"), "WATCHDOG_USEC": "1000000"}):
            assert manager.recv(1000).decode().strip() == "READY=1"
            began = time.monotonic()
            beats = [manager.recv(1000).decode() for _ in range(4)]
            took_s = time.monotonic() - began
            assert sum("WATCHDOG=1" in beat for beat in beats) >= 3 and took_s < 4 * SLOW, (beats, took_s)
        printed = []
        with contextlib.suppress(TimeoutError):
            while not printed or "STOPPING=1" not in printed[-1]:
                printed.append(manager.recv(1000).decode())
        assert "STOPPING=1" in printed[-1], printed


def the_terminal_goes_away():
    """SIGHUP acts as SIGTERM: the drive ramps to zero, the session is closed, the socket removed. Under nohup play
    continues."""
    prepare_files()
    with daemon() as process:
        session = begin(Client())
        time.sleep(0.3)
        process.send_signal(signal.SIGHUP)
        process.wait(timeout=20)
        assert not pathlib.Path("control").exists()
    assert tacto.run_json("info", session)["ending"] == "closed"
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    with daemon(preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)) as process:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.2)
        assert Client().must(request="status")["state"] == "idle"


TESTS = [from_load_to_a_session_that_replays, what_the_limits_took_is_found, the_loop_closed_on_the_host,
         kill_9_in_mid_play, sigstop_of_200_ms, encoder_jump_of_10_mm, late_ticks_beyond_a_limit_are_a_fault,
         full_disk_for_the_log, the_service_manager_is_told, the_terminal_goes_away]

if __name__ == "__main__":
    for test in TESTS:
        if len(sys.argv) < 2 or test.__name__ in sys.argv[1:]:
            tacto.in_folder(test)
