#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactographd on the emulated device, from the clients' side: from load to a session that replays, and the handling of
faults."""
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
import pty
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import termios
import time

import numpy as np
import soundfile

import tacto

DAEMON = os.environ.get("TACTOGRAPHD", "tactographd")
SLOW = 4 if tacto.SANITIZED else 1
USAGE, MALFORMED, UNSUITABLE = 1, 3, 4  # the member `fault` of an error (CONTROL.md)


def write_texture(stem, force_n, pitch_m=10e-6):
    wav = pathlib.Path(f"{stem}.texture.wav")
    soundfile.write(wav, force_n.astype(np.float32), round(1 / pitch_m), subtype="FLOAT")
    pathlib.Path(f"{stem}.texture.json").write_text(json.dumps({
        "kind": "texture", "version": "1.0", "pitch_m": pitch_m, "quantity": "tangential_force", "unit": "N",
        "direction": 1, "source_origin_m": 0.0,
        "data": {"file": wav.name, "sha256": hashlib.sha256(wav.read_bytes()).hexdigest(), "samples": len(force_n)}}))


def prepare_files(**changed):
    x = np.arange(4000) * 10e-6
    write_texture("oak", 0.02 * np.sin(2 * np.pi * 1000 * x))
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.2,0.004\n1.0,0.034\n1.2,0.034\n")
    config = {"kind": "daemon", "version": "1.0", "device": "sim:", "transducer": "wiertlewski2011", "rate_hz": 2000,
              "socket": "control", "sessions": "sessions", "finger_path": "path.csv",
              "watchdog_ms": 1000,  # the longest: a busy machine stops for tenths of a second
              **changed}
    pathlib.Path("tactographd.json").write_text(json.dumps(config))


def other_config(**changed):
    config = {**json.loads(pathlib.Path("tactographd.json").read_text()), **changed}
    pathlib.Path("other.json").write_text(json.dumps(config))
    return "other.json"


@contextlib.contextmanager
def daemon(code=0, **options):
    """A daemon that is ready; at the end it is told to stop, and must exit with `code`."""
    process = subprocess.Popen([DAEMON, "--config", "tactographd.json"], stderr=subprocess.PIPE, text=True, **options)
    said = []
    while not said or "ready" not in said[-1]:
        line = process.stderr.readline()
        assert line, said
        said.append(line)
    process.ready = said[-1].strip()
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.wait(timeout=20)
        process.stderr.close()
    assert process.returncode == code, process.returncode


class Client:
    def __init__(self, greet=True, port=None, **hello):
        self.socket = socket.socket(socket.AF_UNIX if port is None else socket.AF_INET)
        self.socket.settimeout(20)
        self.socket.connect("control" if port is None else ("127.0.0.1", port))
        self.lines = self.socket.makefile("r")
        if greet:
            assert self.ask(request="hello", version="1.0", **hello)["ok"]

    def ask(self, **request):
        self.socket.sendall((json.dumps(request) + "\n").encode())
        return json.loads(self.lines.readline())

    def next_event(self, name):
        """The next event of this name; those before it are passed over."""
        while (event := json.loads(self.lines.readline()))["event"] != name:
            pass
        return event

    def rest_of_events(self):
        """All unread events of a watcher, until none arrives for half a second."""
        events = []
        self.socket.settimeout(0.5)
        with contextlib.suppress(TimeoutError, OSError):
            while True:
                events.append(json.loads(self.lines.readline()))
        return events

    def must(self, **request):
        answer = self.ask(**request)
        assert answer["ok"], answer
        return answer

    def wait_for(self, state, seconds=5):
        for _ in range(int(50 * seconds * SLOW)):
            status = self.must(request="status")
            if status["state"] == state:
                return status
            time.sleep(0.02)
        raise AssertionError((state, status))


def begin(client):
    client.must(request="load", file="oak", gain_m_per_n=0.0005)
    session = client.must(request="arm")["session"]
    client.must(request="play")
    return session


def ticks_of(session):
    tacto.run("session", session, "-o", "table.csv", "--force")
    return np.genfromtxt("table.csv", delimiter=",", names=True)


def expect_a_ramp(session):
    """The drive is zero within 20 ms of the first tick in fault, and stays zero."""
    ticks = ticks_of(session)
    fault = int(np.argmax(ticks["fault"] > 0))
    assert ticks["fault"][fault] == 1 and len(ticks) > fault + 40
    assert np.all(ticks["drive_v"][fault + 40:] == 0)


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


def garbage_and_endless_lines():
    prepare_files()
    with daemon():
        client = Client(greet=False)
        assert "hello" in client.ask(request="status")["error"]["remedy"]
        answer = client.ask(request="hello", version="2.0")
        assert not answer["ok"] and "2.0" in answer["error"]["what"]
        client.must(request="hello", version="1.0")
        for line in (b"\xff\xfe\x00nothing\n", b"{}\n", b"[" * 5000 + b"\n", b'{"request":"fly"}\n', b'{"request":"gain"}\n',
                     b'{"request":"load","file":7}\n', b"\n"):
            client.socket.sendall(line)
            answer = json.loads(client.lines.readline())
            assert not answer["ok"] and answer["error"]["what"], (line, answer)
        assert client.ask(request="status", id=7)["id"] == 7
        answer = client.ask(request="gain", gain=5000)
        assert "from -1000" in answer["error"]["remedy"] and "factor" in answer["error"]["remedy"], answer
        endless = Client()
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            endless.socket.sendall(b"x" * 1_000_000)
        with contextlib.suppress(ConnectionResetError):
            assert "16384 bytes" in endless.lines.readline()
        client.must(request="status")


def many_requests_at_once():
    """Requests sent in one piece are all answered, in order, including a `stop` at the end; also if the client closes
    its sending side."""
    prepare_files()
    lines = "".join(json.dumps({"request": "gain", "gain": 0.5, "id": i}) + "\n" for i in range(70)) + '{"request":"stop","id":70}\n'
    with daemon():
        client = Client()
        begin(client)
        client.socket.sendall(lines.encode())
        answers = [json.loads(client.lines.readline()) for _ in range(71)]
        assert [a["id"] for a in answers] == list(range(71)) and all(a["ok"] for a in answers), answers
        client.wait_for("armed")
        half = Client()
        half.socket.sendall(lines.encode())
        half.socket.shutdown(socket.SHUT_WR)
        # After that the daemon closes the connection.
        assert [json.loads(line)["id"] for line in half.lines] == list(range(71))
        client.must(request="disarm")
        silent = Client()  # the same if nothing plays, and the client does not read
        silent.socket.sendall(lines.encode())
        silent.socket.close()
        client.must(request="status")


def a_thousand_clients():
    """Clients above the limit are told so; those that play continue to play."""
    prepare_files(most_clients=8)
    with daemon():
        client = Client()
        begin(client)
        crowd = []
        for _ in range(1000):
            one = socket.socket(socket.AF_UNIX)
            one.settimeout(10)
            one.connect("control")
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                one.sendall(b'{"request":"hello","version":"1.0"}\n')
            one.setblocking(False)
            crowd.append(one)
            if len(crowd) % 50 == 0:
                client.must(request="status")
        for _ in range(20):
            client.must(request="status")
        refused = 0
        for one in crowd:
            with contextlib.suppress(BlockingIOError, OSError):
                refused += b'"ok":false' in one.recv(4096).replace(b" ", b"")
        assert refused > 950, refused
        tacto.run("ctl", "status", "--socket", "control", code=5)  # the error of the daemon
        assert "armed" in tacto.run("ctl", "stop", "--socket", "control")[0]
        client.must(request="play")
        for one in crowd:
            one.close()
        status = client.must(request="status")
        assert status["state"] == "playing" and status["lost_ticks"] == 0, status
        client.must(request="disarm")
    print(f"1000 connected, {refused} refused")


def permissions():
    prepare_files()
    with daemon():
        assert os.stat("control").st_mode & 0o777 == 0o600
        if os.geteuid() == 0:
            os.chmod(".", 0o755)
            done = subprocess.run(["setpriv", "--reuid", "65534", "--clear-groups", tacto.COMMAND, "ctl", "status", "--socket",
                                   "control"], capture_output=True, text=True)
            assert done.returncode == 3 and "control" in done.stderr, done
    prepare_files(socket_group="no-such-group")
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 2 and "no-such-group" in second.stderr, second
    prepare_files(device_=1)
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 4 and "device_" in second.stderr, second


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
        told = [e for e in watcher.rest_of_events() if e["event"] == "recorder"]
        # The first event may come before a tick is lost: the failure is known, and the buffer is not yet full.
        counts = [event["lost_ticks"] for event in told]
        assert told and all(event["why"] for event in told), told
        assert counts == sorted(counts) and counts[-1] > 0, told
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
        told = []
        with contextlib.suppress(TimeoutError):
            while not told or "STOPPING=1" not in told[-1]:
                told.append(manager.recv(1000).decode())
        assert "STOPPING=1" in told[-1], told


def a_band_that_the_rate_cuts_is_told():
    """Below 2 kHz the band is narrower, and the status has its end: rate / 3.5 (playback/DECISIONS.md). It also has a
    loop's period."""
    prepare_files(rate_hz=1500)
    with daemon():
        client = Client()
        assert "passes_to_hz" not in client.must(request="status")
        begin(client)
        assert abs(client.must(request="status")["passes_to_hz"] - 1500 / 3.5) < 0.1, client.must(request="status")
        assert "loop_period_m" not in client.must(request="status")
        for request in ("stop", "disarm"):
            client.must(request=request)
        loaded = client.must(request="load", file="oak", ends="loop")
        assert abs(loaded["loop_period_m"] + loaded["loop_seam_m"] - loaded["length_m"]) < 1.1e-5 and loaded["loop_seam_m"] in (0, 0.001), loaded
        assert client.must(request="status")["loop_period_m"] == loaded["loop_period_m"]


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


def a_texture_changed_in_mid_play():
    """State and gain do not change, the drive has no step, the session replays, judges every stroke, and names the
    texture."""
    prepare_files(device="sim:link_buffer=1s")  # a device that ticks independently, so that a busy daemon is noticed
    x = np.arange(100_000) * 1e-6               # 100 mm: takes longer to prepare than the watchdog's 100 ms
    write_texture("cork", 0.01 * np.sin(2 * np.pi * 1000 * x), 1e-6)
    with daemon():
        client = Client()
        watcher = Client()
        watcher.must(request="watch")
        session = begin(client)
        client.must(request="gain", gain=0.5)
        time.sleep(2)
        answer = json.loads(tacto.run("ctl", "load", "cork", "--gain", "0.25mm/N", "--fade", "100ms", "--socket", "control", "--json")[0])
        assert answer["changed"] and answer["fade_s"] == 0.1, answer
        changed = client.must(request="status")["ticks"]
        time.sleep(3.5)  # a pass of the finger takes 1.2 s, so one whole pass is before the next change
        status = client.must(request="status")
        assert status["state"] == "playing" and status["loaded"].endswith("cork") and status["gain"] == 0.5, status
        assert status["session"] == session and status["lost_ticks"] == 0
        answer = client.ask(request="load", file="nothing")
        assert not answer["ok"], answer
        answer = client.ask(request="load", file="oak", fade_s=11)
        assert not answer["ok"] and "fade_s" in answer["error"]["where"], answer
        assert client.must(request="status")["state"] == "playing"
        answer = client.must(request="load", file="oak", gain_m_per_n=0.0005)
        assert answer["changed"] and answer["fade_s"] == 0.05
        client.must(request="disarm")
        assert not client.must(request="load", file="oak")["changed"]
        events = watcher.rest_of_events()
    states = [e["state"] for e in events if e["event"] == "state"]
    # Armed while the drive falls.
    assert states[:2] == ["armed", "playing"] and states[2:] in (["idle"], ["armed", "idle"]), states
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    described = tacto.run_json("session", session)
    judged = ["predicted_error_db" in stroke for stroke in described["strokes"]]
    assert len(judged) > 2 and all(judged), described["strokes"]
    assert all(abs(stroke["predicted_over_target_db"]) < 0.5 for stroke in described["strokes"][1:]), described["strokes"]
    info = tacto.run_json("info", session)
    assert [(pathlib.Path(c["texture"]).name, c["gain_m_per_n"]) for c in info["changes"]] == \
        [("cork.texture.json", 0.00025), ("oak.texture.json", 0.0005)], info
    assert 0 <= changed - info["changes"][0]["tick"] < 2000 and info["textures"][0]["texture"].endswith("oak.texture.json"), info
    tacto.run("validate", session)
    tacto.run("session", session, "-o", "changed.nc")
    told = tacto.run_json("info", "changed.nc")["changes"]
    again = info["changes"][1]["tick"]
    after = next(i + 1 for i, s in enumerate(described["strokes"]) if s["from_s"] > (changed + 500) / 2000 and s["to_s"] < again / 2000)
    found = tacto.run_json("compare", session, "cork", "--stroke-a", str(after))
    assert abs(found["gain"] - 1) < 0.1, found
    tacto.error_of("compare", session, "oak", "--stroke-a", str(after), code=5)
    assert len(told) == 2 and told[0].endswith("cork.texture.json") and "over 0.1 s: " in told[0], told
    ticks = ticks_of(session)
    drive = ticks["drive_v"]
    one, two = drive[600:3000], drive[changed + 400:changed + 2800]  # 1.2 s each: a pass of the finger and its rests
    assert 3.5 < np.std(one) / np.std(two) < 4.5, (np.std(one), np.std(two))  # 0.02 N x 0.5 mm/N to 0.01 N x 0.25 mm/N
    steps = np.abs(np.diff(drive[ticks["playing"] > 0]))
    assert np.max(steps) < 1.1 * np.max(np.abs(np.diff(one))), (np.max(steps), np.max(np.abs(np.diff(one))))


def terminal_shows(rows, columns, *arguments):
    """Whether a terminal of that size is sufficient: no line is too long, and there are not too many lines."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    subprocess.run([os.environ["TACTOGRAPH"], *arguments], stdout=its, check=True, timeout=30)
    os.close(its)
    shown = os.read(ours, 65536).decode()
    screens = shown.replace("\r", "").split("\033[H\033[2J")[1:]
    return bool(screens) and all(len(s.split("\n")) <= rows and max(map(len, s.split("\n"))) <= columns for s in screens)


def a_path_that_ends_where_it_began_is_a_loop():
    """Up in 0.3 s, back in 0.9 s, repeated; played back and forth, every other pass up would be slow."""
    prepare_files()
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.3,0.034\n1.2,0.004\n")
    with daemon():
        shown = tacto.run("ctl", "top", "--time", "0.2s", "--socket", "control")[0]
        assert "idle" in shown and "finger" in shown and "\033" not in shown, shown
        assert terminal_shows(5, 20, "ctl", "top", "--time", "0.2s", "--socket", "control"), "a small terminal"
        for ignored in (["arm", "--gain", "1mm/N"], ["play", "--at", "3mm"], ["gain", "50%", "--inverse", "gain"], ["stop", "--save"],
                        ["status", "--time", "1s"], ["top", "--time", "-1s"]):
            error = tacto.error_of("ctl", *ignored, "--socket", "control", code=2)
            assert error["where"] == "command line" and f"'{ignored[0]}'" in error["what"], (ignored, error)
        client = Client()
        session = begin(client)
        time.sleep(3.6)
        client.must(request="disarm")
    ticks = ticks_of(session)
    speed_mps = np.diff(ticks["position_m"][::100]) / np.diff(ticks["time_s"][::100])
    up, down = speed_mps[speed_mps > 0.001], speed_mps[speed_mps < -0.001]
    assert np.mean(up) > 2 * np.mean(-down) and np.sum(up > 0.05) < 0.5 * len(speed_mps), (np.mean(up), np.mean(down))


def what_was_chosen_is_told():
    """The configuration's choices; a scene overrides them, a request overrides both; an impossible choice is refused,
    and the rest continues to play."""
    prepare_files(playback={"interpolation": "linear", "inverse": "gain", "contact_on_n": 0.6, "energy_rms_v": 5})
    layer = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.0005}
    scene = {"kind": "scene", "version": "1.0", "layers": [layer], "playback": {"inverse": "magnitude", "contact_on_n": 0.2}}
    pathlib.Path("s.scene.json").write_text(json.dumps(scene))
    with daemon():
        client = Client()
        answer = client.must(request="load", file="oak", gain_m_per_n=0.0005)
        assert (answer["interpolation"], answer["inverse"], answer["contact_on_n"], answer["energy_rms_v"]) == ("linear", "gain", 0.6, 5), answer
        client.must(request="arm")
        client.must(request="play")
        time.sleep(0.5)
        status = client.must(request="status")  # the emulated finger presses with 0.5 N
        assert status["gated_ticks"] > 100 and status["drive_peak_v"] == 0, status
        client.must(request="disarm")
        answer = client.must(request="load", file="s", playback={"interpolation": "sinc"}, x_trial=3)
        assert (answer["interpolation"], answer["inverse"], answer["contact_on_n"]) == ("sinc", "magnitude", 0.2), answer
        for misplaced in ({"request": "arm", "playback": {"energy_rms_v": 0.1}}, {"request": "gain", "gain": 1, "playback": {}},
                          {"request": "load", "file": "s", "gain": 0.5}, {"request": "play", "gain": 0.01}, {"request": "status", "save": True}):
            refused = client.ask(**misplaced)
            assert not refused["ok"] and refused["error"]["fault"] == MALFORMED and refused["error"]["where"].split("#/")[-1] in misplaced, refused
        session = client.must(request="arm")["session"]
        client.must(request="play")
        time.sleep(0.7)
        assert client.must(request="status")["drive_peak_v"] > 0.01
        answer = client.ask(request="load", file="s", playback={"contact_on_n": 0.25})
        assert not answer["ok"] and "limits" in answer["error"]["what"] and "disarm" in answer["error"]["remedy"], answer
        answer = client.ask(request="load", file="s", playback={"interpolaton": "sinc"})
        assert not answer["ok"] and "'interpolation'" in answer["error"]["remedy"], answer
        for request, nearest in (({"request": "load", "file": "oak", "gain_m_per_N": 1e-5}, "gain_m_per_n"), ({"request": "status", "sav": True}, "save"),
                                 ({"request": "arm", "while_conected": True}, "while_connected")):
            error = client.ask(**request)["error"]
            assert error["fault"] == 3 and error["where"] == f"request#/{list(request)[-1]}" and f"'{nearest}'" in error["remedy"], error
        assert client.must(request="status")["state"] == "playing"
        answer = client.ask(request="load", file="s", playback={"contact_on_n": -1})
        assert not answer["ok"] and "from 0 to 100" in answer["error"]["remedy"], answer
        out, _ = tacto.run("ctl", "load", "s", "--interpolation", "nearest", "--json", "--socket", "control")
        assert json.loads(out)["interpolation"] == "nearest" and json.loads(out)["changed"], out
        client.must(request="disarm")
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    prepare_files(playback={"interpolations": "linear"})
    refused = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert refused.returncode == 4 and "#/playback" in refused.stderr, refused


def a_promise_in_the_configuration():
    """A loaded texture keeps the promise; if it cannot, it is refused with the best possible one; a change keeps the
    playing filter."""
    prepare_files(max_error=0.002, max_tick_ns=10000, undo_hysteresis=False)
    write_texture("cork", 0.01 * np.sin(2 * np.pi * 1700 * np.arange(4000) * 10e-6))
    with daemon():
        client = Client()
        answer = client.must(request="load", file="oak", gain_m_per_n=0.0005)
        assert answer["guaranteed_error"] <= 0.002 and 0 < answer["tick_s"] <= 1e-5, answer
        assert answer["inverse_error_db"] <= 20 * np.log10(answer["guaranteed_error"]) and "requested: 0.2 %" in answer["why_1"], answer
        client.must(request="arm")
        client.must(request="play")
        changed = client.must(request="load", file="cork", gain_m_per_n=0.0005)
        assert changed["changed"] and changed["guaranteed_error"] <= 0.002, changed
        assert changed["chosen"].split(", ")[2:] == answer["chosen"].split(", ")[2:], (changed, answer)
        client.must(request="disarm")
    prepare_files(quality="balanced", max_tick_ns=1)
    with daemon():
        answer = Client().ask(request="load", file="oak")
        assert not answer["ok"] and answer["error"]["fault"] == UNSUITABLE, answer
    prepare_files(quality="balanced", max_error=0.01)
    refused = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert refused.returncode == 4, refused


def a_load_holds_up_nobody():
    """A load that takes seconds delays neither `stop` nor SIGTERM; a `stop` behind it on its own connection cancels
    it."""
    prepare_files()
    write_texture("long", np.zeros(4_000_000))  # 40 m
    with daemon() as process:
        client, other = Client(), Client()
        begin(client)
        client.socket.sendall(b'{"request":"load","file":"long"}\n')
        time.sleep(0.1)
        assert other.must(request="stop")["state"] == "armed"
        for request in ({"request": "load", "file": "oak"}, {"request": "arm"}):
            answer = other.ask(**request)
            assert not answer["ok"] and answer["error"]["fault"] == USAGE, answer
        assert not select.select([client.socket], [], [], 0)[0], "the load was answered before"
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=1 * SLOW)
        assert not pathlib.Path("control").exists()
    with daemon():
        client = Client()
        session = begin(client)
        client.socket.sendall(b'{"request":"load","file":"long"}\n{"request":"status"}\n{"request":"stop"}\n')
        answers = [json.loads(client.lines.readline()) for _ in range(3)]
        assert not answers[0]["ok"] and "cancelled" in answers[0]["error"]["what"], answers
        assert answers[1]["state"] == "playing" and answers[2]["state"] == "armed", answers
        # The thread of the long load continues alone and blocks nothing.
        assert client.must(request="load", file="oak", gain_m_per_n=0.0005)["changed"]
    assert tacto.run_json("replay", session)["same_to_the_bit"]


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


def files_that_nobody_can_play():
    """A pipe is not opened, and a file that would need all memory is refused before it is read; playback continues."""
    prepare_files()
    os.mkfifo("pipe.texture.json")
    layer = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}
    pathlib.Path("far.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": [layer, {**layer, "at_m": 900}]}))
    with daemon():
        client = Client()
        begin(client)
        for file, words in (("pipe", "is not a regular file"), ("far", "far.scene.json#/layers/1/at_m")):
            answer = client.ask(request="load", file=file)
            assert not answer["ok"] and words in json.dumps(answer["error"]), answer
        assert client.must(request="status")["state"] == "playing"


def write_token(text, mode=0o600):
    pathlib.Path("token").write_text(text)
    os.chmod("token", mode)


def by_tcp_with_a_token():
    """127.0.0.1 only; without the token nothing, not even a second request; unauthenticated clients cannot take all
    places."""
    token = "0123456789abcdef"
    prepare_files(tcp_port=0, tcp_token_file="token", most_clients=8, files=".")
    write_token(token + "\n")
    with daemon() as process:
        port = int(process.ready.rsplit(":", 1)[1])
        newer = Client(greet=False, port=port).ask(request="hello", version="2.0")
        assert not newer["ok"] and newer["error"]["fault"] == 5 and "2.0" in newer["error"]["what"] and "token" not in json.dumps(newer), newer
        for first in ({"request": "status"}, {"request": "hello", "version": "1.0"},
                      {"request": "hello", "version": "1.0", "token": token[:-1]},
                      {"request": "hello", "version": "1.0", "token": token + "0"}):
            stranger = Client(greet=False, port=port)
            answer = stranger.ask(**first)
            assert not answer["ok"] and "tcp_token_file" in answer["error"]["remedy"], answer
            assert stranger.lines.readline() == "", "hung up on"
        browser = Client(greet=False, port=port)
        browser.socket.sendall(b'POST / HTTP/1.1\r\nHost: localhost\r\n\r\n{"request":"stop"}\n')
        assert not json.loads(browser.lines.readline())["ok"]
        with contextlib.suppress(ConnectionResetError):
            assert browser.lines.readline() == "", "hung up on at the first line"
        client = Client(port=port, token=token)
        begin(client)
        # `client` has half of 8; two keep a place for `stop`.
        silent = [Client(greet=False, port=port) for _ in range(5)]
        assert Client().must(request="status")["state"] == "playing"
        said = [json.loads(one.lines.readline())["error"]["fault"] for one in silent]
        assert set(said) <= {USAGE, UNSUITABLE} and said[0] == USAGE, said  # no hello came; too many clients
        assert client.wait_for("playing"), "who says nothing goes after 5 s"
        client.must(request="disarm")
        addresses = subprocess.run(["ss", "-Hltn", f"sport = :{port}"], capture_output=True, text=True) if shutil.which("ss") else None
        assert addresses is None or f"127.0.0.1:{port}" in addresses.stdout and "0.0.0.0:%d" % port not in addresses.stdout, addresses
        second = subprocess.run([DAEMON, "--config", other_config(socket="other", tcp_port=port)], capture_output=True, text=True, timeout=20)
        assert second.returncode == 5 and f"tcp_port {port}" in second.stderr, second
    for text, mode, words in ((token, 0o644, "chmod 600"), ("short", 0o600, "/dev/urandom"), (None, 0, "/dev/urandom")):
        pathlib.Path("token").unlink(missing_ok=True)
        if text is not None:
            write_token(text, mode)
        second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
        assert second.returncode != 0 and words in second.stderr, second
    prepare_files(tcp_port=0)
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 4 and "tcp_token_file" in second.stderr, second


def silent_clients_do_not_keep_stop_out():
    """Clients that send nothing, or only hello, take all sixteen places: `stop` is accepted nevertheless."""
    prepare_files()
    for greets in (False, True):
        with daemon():
            client = Client()
            begin(client)
            crowd = [Client(greet=greets) for _ in range(15 + 10)]
            assert "armed" in tacto.run("ctl", "stop", "--socket", "control")[0]
            client.wait_for("armed")
            assert "idle" in tacto.run("ctl", "disarm", "--socket", "control")[0]
            assert client.must(request="status")["state"] == "idle"
            del crowd


def expect_a_soft_fall(session, why):
    """The session is closed with the reason; its drive ends at zero, with no step above the transducer's slew limit."""
    assert tacto.run_json("info", session)["ending"] == "closed"
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    said = json.dumps(tacto.run_json("info", session))
    assert f"armed: {why}" in said and f"idle: {why}" in said, said
    drive = ticks_of(session)["drive_v"]
    assert np.max(np.abs(drive)) > 0.05 and drive[-1] == 0, drive[-50:]
    assert np.max(np.abs(np.diff(drive))) <= 15708 / 2000 * (1 + 1e-6), "V/s over ticks a second"


CLOSED, SILENT = "the client that armed has closed its connection", "no line came from the client that armed"


def arm_while_connected(client, **members):
    client.must(request="load", file="oak", gain_m_per_n=0.0005)
    session = client.must(request="arm", while_connected=True, **members)["session"]
    client.must(request="play")
    client.wait_for("playing")
    return session


def whoever_armed_goes_away():
    """By closing the socket, by Unix and TCP: the drive falls, states and status have the reason, the session is
    closed, and the next client may arm. If another client leaves, nothing changes."""
    prepare_files(tcp_port=0, tcp_token_file="token", files=".")
    write_token("0123456789abcdef")
    with daemon() as process:
        port = int(process.ready.rsplit(":", 1)[1])
        other, watcher = Client(), Client()
        watcher.must(request="watch")
        for how in ({}, {"port": port, "token": "0123456789abcdef"}):
            client, passing = Client(**how), Client()
            session = arm_while_connected(client)
            assert other.must(request="status")["while_connected"]
            passing.must(request="gain", gain=0.9)
            passing.socket.close()
            passing.lines.close()
            time.sleep(0.5)
            assert other.must(request="status")["state"] == "playing"
            client.socket.close()
            client.lines.close()
            assert other.wait_for("idle")["why"] == CLOSED
            expect_a_soft_fall(session, CLOSED)
        states = [(e["state"], e["why"]) for e in watcher.rest_of_events() if e["event"] == "state"]
        assert states == 2 * [("armed", ""), ("playing", ""), ("armed", CLOSED), ("idle", CLOSED)], states
        client = Client()
        begin(client)
        client.socket.close()
        client.lines.close()
        time.sleep(0.5)
        assert other.must(request="status")["state"] == "playing", "without while_connected it goes on"
        other.must(request="disarm")


def whoever_armed_is_silent():
    """dead_man_s: the shorter one of request and configuration applies. Any line of the client that armed resets it;
    without while_connected a line of any client."""
    prepare_files(dead_man_s=1)
    with daemon():
        client, other = Client(), Client()
        session = arm_while_connected(client, dead_man_s=30)
        assert other.must(request="status")["dead_man_s"] == 1
        for _ in range(20):
            client.ask(request="nonsense")
            time.sleep(0.1)
        assert other.must(request="status")["state"] == "playing"
        assert SILENT in other.wait_for("idle")["why"], "others' lines do not count"
        expect_a_soft_fall(session, SILENT)
        session = begin(client)
        for _ in range(20):
            other.must(request="status")
            time.sleep(0.1)
        assert other.must(request="status")["state"] == "playing"
        time.sleep(1.5 * SLOW)
        assert " 1 s" in other.wait_for("idle")["why"]
        expect_a_soft_fall(session, "no line came from any client")


def play_that_is_watched():
    """`ctl play --watch` plays as long as it runs: Ctrl-C, SIGKILL and SIGSTOP each end it, and so does its time."""
    prepare_files()
    command = [tacto.COMMAND, "ctl", "play", "--watch", "--socket", "control"]
    with daemon():
        client = Client()
        client.must(request="load", file="oak", gain_m_per_n=0.0005)
        for how, why in ((signal.SIGKILL, CLOSED), (signal.SIGSTOP, SILENT), (signal.SIGINT, ""), (None, "")):
            more = ["--json"] if how else ["--json", "--time", "1s"]
            play = subprocess.Popen([*command, *more], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            status = client.wait_for("playing")
            assert status["while_connected"] and status["dead_man_s"] == 2, status
            time.sleep(0.5)
            if how:
                play.send_signal(how)
            status = client.wait_for("idle", seconds=10)
            assert status.get("why", "").startswith(why) and ("why" in status) == bool(why), status
            if how == signal.SIGSTOP:
                play.send_signal(signal.SIGCONT)
            out, said = play.communicate(timeout=20)
            assert play.returncode == (-signal.SIGKILL if how == signal.SIGKILL else 0), (play.returncode, out, said)
            if how != signal.SIGKILL:
                assert json.loads(out)["state"] == "idle" and json.loads(out)["played_s"] > 0.3, out
            if why:
                expect_a_soft_fall(status["session"], why)
        session = begin(client)
        play = subprocess.run(command, capture_output=True, text=True, timeout=20)
        assert play.returncode == 2 and "playing" in play.stderr, play
        assert client.must(request="status")["session"] == session
        client.must(request="disarm")


TESTS = [from_load_to_a_session_that_replays, what_the_limits_took_is_found, kill_9_in_mid_play, sigstop_of_200_ms, encoder_jump_of_10_mm,
         garbage_and_endless_lines, many_requests_at_once, a_thousand_clients, permissions, full_disk_for_the_log,
         the_loop_closed_on_the_host, the_service_manager_is_told, a_band_that_the_rate_cuts_is_told,
         late_ticks_beyond_a_limit_are_a_fault,
         a_texture_changed_in_mid_play,
         a_path_that_ends_where_it_began_is_a_loop, what_was_chosen_is_told, a_promise_in_the_configuration, a_load_holds_up_nobody, the_terminal_goes_away,
         files_that_nobody_can_play, by_tcp_with_a_token, silent_clients_do_not_keep_stop_out,
         whoever_armed_goes_away, whoever_armed_is_silent, play_that_is_watched]

if __name__ == "__main__":
    for test in TESTS:
        if len(sys.argv) < 2 or test.__name__ in sys.argv[1:]:
            tacto.in_folder(test)
