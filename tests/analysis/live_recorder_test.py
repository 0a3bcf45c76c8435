#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recorder of tactograph live, without a browser, on the emulated device: its files are those of `record`; marks, silent
channels, names, what is refused, and an end of the server in a recording."""
import pathlib
import subprocess
import sys

import numpy as np
import soundfile
from live_client import live
from tacto import COMMAND, in_folder, run

DEVICE = "sim:surface=C,speed=50mm/s,seed=1,paced=1"
SILENT = "sim:noise=off,finger=up,paced=1"


class Page:
    def __init__(self, server):
        self.socket, self.events = server.page("/recorder"), []
        assert self.socket.status == 101

    def ask(self, line):
        self.socket.send(line)
        while "ok" not in (message := self.socket.receive()):
            self.events.append(message)
        return message

    def must(self, line):
        answer = self.ask(line)
        assert answer["ok"], answer

    def event(self, name, wanted=lambda event: True):
        while True:
            message = self.events.pop(0) if self.events else self.socket.receive()
            if message.get("event") == name and wanted(message):
                return message


def who_may_use_it(server):
    for headers, status in (({"Origin": None}, 403), ({"Origin": "http://evil.example"}, 403), ({"Cookie": None}, 401), ({"Host": "evil.example", "Origin": "http://evil.example"}, 421)):
        assert server.page("/recorder", **headers).status == status, headers
    assert server.ask("/recorder").status == 404


def what_is_refused(server):
    page = Page(server)
    assert page.event("recording")["state"] == "idle"
    for line, fault in (("", 3), ("record", 3), ("record ", 3), ("record " + 300 * "a", 3), ("record a\nb", 3), ("record ../a", 3), ("go", 3), ('{"request":"record"}', 3), ("stop", 4), ("mark a", 4)):
        assert page.ask(line)["error"]["fault"] == fault, line
    page.socket.send(b"record a")
    assert page.socket.receive()["error"]["fault"] == 3


def a_recording_is_that_of_the_verb(server):
    page, other = Page(server), Page(server)
    page.must("record a/oak")
    page.event("recording", lambda event: event["state"] == "recording")
    assert page.ask("record elm")["error"]["fault"] == 4
    page.must("mark rough part")
    mark = page.event("mark")
    assert mark["label"] == "rough part" and mark["time_s"] > 0
    seen = other.event("recording", lambda event: event["state"] == "recording" and event["time_s"] >= 1.5)
    assert [row["quantity"] for row in seen["channels"]].count("position") == 1 and all(row["unchanged_s"] < 1 for row in seen["channels"]), seen
    assert seen["strokes"] >= 1 and seen["lost_frames"] == 0 and seen["late_s"] < 10 and seen["disk_left_bytes"] > 0, seen
    other.must("stop")  # another page may end it
    done = page.event("recorded")
    stem = pathlib.Path(done["name"])
    assert stem.parent == pathlib.Path("folder") and stem.name == "a-oak-1", stem
    assert page.event("recording")["state"] == "idle"
    run("validate", stem)
    assert done["marks"] == 1 and "rough part" in pathlib.Path(f"{stem}.json").read_text() and done["gaps"] == 0, done
    run("record", "-d", DEVICE.replace(",paced=1", ""), "--time", "1s", "-o", "verb")
    ours, theirs = (soundfile.read(f"{name}.wav", dtype="int32")[0] for name in (stem, "verb"))
    assert len(ours) > len(theirs) == 10_000 and np.array_equal(ours[:len(theirs)], theirs)
    page.must("record a/oak")
    page.event("recording", lambda event: event["state"] == "recording")
    page.must("stop")
    assert page.event("recorded")["name"].endswith("oak-2")


def a_silent_channel_is_seen():
    with live("folder", "-d", SILENT) as server:
        page = Page(server)
        page.must("record silent")
        silent = page.event("recording", lambda event: any(row["quantity"] != "position" and row["unchanged_s"] >= 1 for row in event.get("channels", [])))
        assert silent["time_s"] < 1.2, silent  # views come every 0.1 s
        # The server ends: the recording is complete.
    stem, = {path.stem for path in pathlib.Path("folder").glob("*silent*.wav")}
    run("validate", f"folder/{stem}")
    assert not list(pathlib.Path("folder").glob("*.events.jsonl"))


def a_device_that_cannot_be_recorded():
    for device, remedy in (("sim:", "paced=1"), ("sim:surface=none,paced=1", "")):
        with live("folder", "-d", device) as server:
            page = Page(server)
            page.must("record x")
            failed = page.event("failed")
            assert failed["what"] and remedy in failed["remedy"], failed
            assert page.event("recording")["state"] == "idle"
    assert not list(pathlib.Path("folder").glob("x*"))


def live_recorder():
    pathlib.Path("folder").mkdir()
    with live("folder", "-d", DEVICE) as server:
        who_may_use_it(server)
        what_is_refused(server)
        a_recording_is_that_of_the_verb(server)
    a_silent_channel_is_seen()
    a_device_that_cannot_be_recorded()


if __name__ == "__main__":
    refused = subprocess.run([COMMAND, "live", "/nonexistent", "--json"], capture_output=True, text=True)
    if refused.returncode == 5:  # built without libwebsockets, clang-16 or lld-16
        print("skipped: built without the page")
        sys.exit(77)
    in_folder(live_recorder)
