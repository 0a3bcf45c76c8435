#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The daemon's side of tactograph live, without a browser: tactographd on an emulated device that does not keep real time.
Pages come, steer, take over and leave; the daemon ends and comes back. The page's pure parts in node, against NumPy."""
import base64
import json
import pathlib
import struct
import subprocess
import sys
import time

import numpy as np
from live_client import fetch_page, live
from run_daemon import Client, daemon, prepare_files
from tacto import COMMAND, in_folder

WAIT_S = 60  # until a test fails, not a time that is judged


class Page:
    """The WebSocket of a page of the device."""

    def __init__(self, server):
        self.socket, self.numbers = server.page("/daemon"), 0
        self.kept = []  # what came before an answer
        assert self.socket.status == 101

    def next(self):
        return self.kept.pop(0) if self.kept else self.socket.receive()

    def event(self, name, wanted=lambda event: True):
        until = time.monotonic() + WAIT_S
        while True:
            message = self.next()
            if message.get("event") == name and wanted(message):
                return message
            assert time.monotonic() < until, (name, message)

    def first_of(self, *names):
        first = {}
        while len(first) < len(names):
            message = self.next()
            if message.get("event") in names:
                first.setdefault(message["event"], message)
        return first

    def ask(self, request, **members):
        self.numbers += 1
        self.socket.send(json.dumps({"request": request, "id": self.numbers, **members}))
        while True:
            message = self.socket.receive()
            if message.get("id") == self.numbers:
                return message
            self.kept.append(message)

    def must(self, request, **members):
        answer = self.ask(request, **members)
        assert answer["ok"], answer
        return answer

    def close(self):
        self.socket.connection.close()


def index_of(server, name):
    return next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == name)


def wait_until(client, wanted):
    until = time.monotonic() + WAIT_S
    while not wanted(status := client.must(request="status")):
        assert time.monotonic() < until, status
        time.sleep(0.02)
    return status


def who_may_use_it(server):
    assert server.page("/daemon", Origin=None).status == 403
    assert server.page("/daemon", Origin="http://evil.example").status == 403
    assert server.page("/daemon", Cookie=None).status == 401
    assert server.page("/daemon", Host="evil.example", Origin="http://evil.example").status == 421
    assert server.ask("/loaded", cookie=False).status == 401
    assert server.ask("/loaded").status == 404  # nothing is loaded
    assert server.ask("/daemon").status == 404


def wrong_requests(server):
    page = Page(server)
    page.event("steering")
    for text in ("", "[]", '{"request":"save"}', '{"request":"gain"}', '{"request":"load"}', '{"request":"load","texture":-1}', '{"request":"load","texture":0,"inverse":"best"}', '{"request":"run","verb":"report","files":["x"]}', '{"request":"load","file":"/etc/passwd","texture":0}',
                 '{"request":"gain","times_default":1e9}', '{"request":"arm","dead_man_s":3600}', '{"request":"play","id":"a"}'):
        page.socket.send(text)
        while "ok" not in (answer := page.socket.receive()):
            pass
        assert answer["ok"] is False and answer["error"]["fault"] == 3, (text, answer)
    assert page.ask("load", texture=999)["error"]["fault"] == 2
    for other in ({"request": "begin", "made": 0}, {"request": "keep"}):
        assert page.ask(**other)["error"]["fault"] == 1
    page.socket.send("x" * 16385)
    while isinstance(closed := page.socket.receive(), dict):
        pass
    assert closed == ("closed", 1009)


def a_page_plays(server):
    oak, client = index_of(server, "oak"), Client()
    page = Page(server)
    first = page.first_of("daemon", "steering")  # in any order: the daemon may be known already
    assert first["daemon"]["here"] and first["daemon"]["version"] == "1.0" and first["daemon"]["device"].startswith("sim:"), first
    assert first["steering"]["here"], first
    assert page.ask("play")["error"]["fault"] == 1
    loaded = page.must("load", texture=oak)
    path = str(pathlib.Path("oak.texture.json").resolve())
    status = page.event("status", lambda event: event.get("loaded") == path)  # in idle
    assert status["length_m"] == loaded["length_m"], status
    columns = np.frombuffer(server.ask("/loaded").body, "<f4").reshape(-1, 2)
    assert len(columns) == 2000 and columns.min() == -columns.max() and abs(columns.max() - 0.02) < 1e-4
    armed = page.must("arm")
    assert armed["while_connected"] is True and armed["dead_man_s"] == 2, armed
    page.must("play")
    page.event("state", lambda event: event["state"] == "playing")
    ticks = page.event("ticks", lambda event: any(row[2] for row in rows_of(event)))
    assert ticks["block"] == 1
    gain = page.must("gain", times_default=0.5)
    assert gain["gain_times_default"] == 0.5 and abs(gain["gain_m_per_n"] - 0.5 * loaded["default_gain_m_per_n"]) < 1e-12, gain
    assert wait_until(client, lambda status: True)["gain_times_default"] == 0.5
    shape = server.json(f"/shape/{oak}?stretch=1.5")
    changed = page.must("load", texture=shape["index"])  # while it plays
    assert changed["changed"] and page.must("status")["gain_times_default"] == 0.5 and changed["file"].endswith("/oak-stretched.texture.json"), changed
    page.event("status", lambda event: event.get("loaded") == changed["file"])
    assert server.ask("/loaded").status == 200
    assert page.ask("load", texture=oak, inverse="gain")["error"]["fault"] == 4  # another filter: not while it plays
    refused = page.ask("gain", times_default=1000)["error"]
    assert refused["fault"] == 4 and refused["remedy"], refused
    return page, client


def rows_of(event):
    payload = base64.b64decode(event["ticks"])
    return [struct.unpack_from("<IifIi", payload, at) for at in range(20, len(payload), 20)]


def one_page_steers(server):
    page, client = a_page_plays(server)
    other = Page(server)
    assert other.event("status")["loaded"]  # a new page gets the newest status
    taken = other.event("steering")
    assert not taken["here"] and taken["taken"], taken
    assert other.ask("gain", times_default=1)["error"]["fault"] == 1
    other.must("stop")  # for every page
    page.event("state", lambda event: event["state"] == "armed")
    page.must("play")
    other.socket.send('{"request":"steer"}')
    assert other.event("steering", lambda event: event["here"])
    assert not page.event("steering", lambda event: not event["here"])["here"]
    assert page.ask("gain", times_default=1)["error"]["fault"] == 1
    page.close()  # it does not steer any more
    other.must("gain", times_default=0.25)
    assert client.must(request="status")["state"] == "playing"
    other.close()
    gone = wait_until(client, lambda status: status["state"] == "idle")
    assert gone["why"] == "the client that armed has closed its connection", gone


def a_page_that_played_leaves_the_device_armed(server):
    client = Client()
    client.must(request="load", file="oak")  # relative to the daemon's folder
    assert client.must(request="status")["loaded"] == str(pathlib.Path("oak").resolve())
    client.must(request="arm")
    page = Page(server)
    page.event("steering", lambda event: event["here"])
    page.event("daemon", lambda event: event["here"])
    page.must("play")
    page.event("state", lambda event: event["state"] == "playing")
    assert len(server.ask("/loaded").body) == 2000 * 2 * 4
    page.close()
    wait_until(client, lambda status: status["state"] == "armed")
    client.must(request="disarm")


def a_page_that_says_nothing(server):
    page, client = a_page_plays(server)
    gone = wait_until(client, lambda status: status["state"] == "idle")
    assert "no line came from the client that armed" in gone["why"], gone
    page.close()


def the_daemon_ends_and_comes_back(server):
    page = Page(server)
    missing = page.event("daemon")
    assert not missing["here"] and missing["what"] and missing["remedy"] and missing["where"] == "control", missing
    assert page.ask("arm")["error"]["fault"] == 2
    for _ in range(2):
        with daemon():
            page.event("daemon", lambda event: event["here"])
            page.must("load", texture=index_of(server, "oak"))
        assert page.event("daemon")["remedy"]


def the_pictures_of_node():
    """Random drives, at 2 kHz in full and at 20 kHz reduced, as the daemon reduces them."""
    draw = np.random.default_rng(34)
    streams, expected = [], []
    for rate_hz, per_cell in ((2000, None), (20000, 10)):
        n = 1200 * (per_cell or 1)
        drive = draw.normal(size=n).astype("<f4")
        events, numbers = [], []
        for first in range(0, n, 40 * (per_cell or 1)):
            kept = range(first, first + 40)
            if per_cell:
                cells = np.arange(first, first + 400).reshape(-1, 10)
                kept = np.sort(np.stack([cells[range(40), drive[cells].argmin(1)], cells[range(40), drive[cells].argmax(1)]], 1)).ravel()
            times = [round(1e9 * k / rate_hz) for k in kept]
            payload = struct.pack("<QqI", kept[0], 7_000_000_000 + times[0], len(kept))
            payload += b"".join(struct.pack("<IifIi", t - times[0], 5 * k, drive[k], 2, -2**31) for t, k in zip(times, kept))
            events.append({"block": 1, "ticks": base64.b64encode(payload).decode(), **({"cell_ticks": per_cell} if per_cell else {})})
            numbers += [int(k) for k in kept]
        streams.append({"events": events, "period_s": 1 / rate_hz})
        expected.append((drive, numbers))
    pathlib.Path("streams.json").write_text(json.dumps({"streams": streams}))
    done = subprocess.run(["node", "page/live_ticks.mjs", "streams.json"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    for seen, (drive, numbers), per_cell in zip(json.loads(done.stdout), expected, (1, 10)):
        rows = seen["rows"]
        assert [row["number"] for row in rows] == numbers and seen["step"] == per_cell
        assert [row["count"] for row in rows] == [5 * k for k in numbers] and {row["flags"] for row in rows} == {2}
        assert np.array_equal(np.array([row["value"] for row in rows], "<f4"), drive[numbers])
        values = drive.astype(float) if per_cell == 1 else (lambda c: (c.min(1) + c.max(1)) / 2)(drive.reshape(-1, 10).astype(float))
        part = values[-1024:] * (0.5 - 0.5 * np.cos(2 * np.pi * np.arange(1024) / 1024))
        exact = np.abs(np.fft.fft(part))[:512] * 4 / 1024
        exact[0] /= 2
        assert np.max(np.abs(np.array(seen["amplitudes"]) - exact)) < 1e-12 * 1024, "rounding of a sum of 1024 doubles"
        cells = np.array(seen["cells"]).reshape(-1, 2)  # of 2 ms: 4 ticks of 0.5 ms
        whole = values.reshape(-1, 4) if per_cell == 1 else drive.reshape(-1, 40).astype(float)
        assert len(cells) == 299 and np.array_equal(cells, np.stack([whole.min(1), whole.max(1)], 1)[:299])  # the last one is open


def live_daemon():
    prepare_files(device="sim:paced=0")
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.5,0.034\n1,0.004\n")  # repeated without a jump
    with live(".", "--socket", "control") as server:
        fetch_page(server, ("ticks.js",), ("live_ticks.mjs",))
        the_pictures_of_node()
        who_may_use_it(server)
        the_daemon_ends_and_comes_back(server)
        with daemon():
            wrong_requests(server)
            one_page_steers(server)
            a_page_that_played_leaves_the_device_armed(server)
            a_page_that_says_nothing(server)


if __name__ == "__main__":
    refused = subprocess.run([COMMAND, "live", "/nonexistent", "--json"], capture_output=True, text=True)
    if refused.returncode == 5:  # built without libwebsockets, clang-16 or lld-16
        print("skipped: built without the page")
        sys.exit(77)
    in_folder(live_daemon)
