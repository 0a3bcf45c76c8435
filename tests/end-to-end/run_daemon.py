# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tactographd on the emulated device, and is its client, for the tests of the daemon."""
import contextlib
import hashlib
import json
import os
import pathlib
import signal
import socket
import subprocess
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
    """A daemon that is ready; at the end it is asked to stop, and must exit with `code`."""
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


def write_token(text, mode=0o600):
    pathlib.Path("token").write_text(text)
    os.chmod("token", mode)


def expect_a_soft_fall(session, why):
    """The session is closed with the reason; its drive ends at zero, with no step above the transducer's slew limit."""
    assert tacto.run_json("info", session)["ending"] == "closed"
    assert tacto.run_json("replay", session)["same_to_the_bit"]
    said = json.dumps(tacto.run_json("info", session))
    assert f"armed: {why}" in said and f"idle: {why}" in said, said
    drive = ticks_of(session)["drive_v"]
    assert np.max(np.abs(drive)) > 0.05 and drive[-1] == 0, drive[-50:]
    assert np.max(np.abs(np.diff(drive))) <= 15708 / 2000 * (1 + 1e-6), "V/s over ticks a second"
