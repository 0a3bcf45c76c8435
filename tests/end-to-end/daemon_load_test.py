#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What tactographd loads: changes of texture during playback, choices and promises, and what is refused."""
import fcntl
import json
import os
import pathlib
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time

import numpy as np

import tacto
from run_daemon import begin, Client, daemon, DAEMON, MALFORMED, prepare_files, SLOW, ticks_of, UNSUITABLE, USAGE, write_texture


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
    printed = tacto.run_json("info", "changed.nc")["changes"]
    again = info["changes"][1]["tick"]
    after = next(i + 1 for i, s in enumerate(described["strokes"]) if s["from_s"] > (changed + 500) / 2000 and s["to_s"] < again / 2000)
    found = tacto.run_json("compare", session, "cork", "--stroke-a", str(after))
    assert abs(found["gain"] - 1) < 0.1, found
    tacto.error_of("compare", session, "oak", "--stroke-a", str(after), code=5)
    assert len(printed) == 2 and printed[0].endswith("cork.texture.json") and "over 0.1 s: " in printed[0], printed
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


TESTS = [a_band_that_the_rate_cuts_is_told, a_texture_changed_in_mid_play, a_path_that_ends_where_it_began_is_a_loop,
         what_was_chosen_is_told, a_promise_in_the_configuration, a_load_holds_up_nobody, files_that_nobody_can_play]

if __name__ == "__main__":
    for test in TESTS:
        if len(sys.argv) < 2 or test.__name__ in sys.argv[1:]:
            tacto.in_folder(test)
