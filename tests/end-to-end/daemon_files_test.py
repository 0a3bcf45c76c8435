#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactographd and files: which it loads, whose gain it keeps with them, and who may name them. Nothing is played here, so
that nothing depends on real time; what does is in run_daemon.py."""
import json
import os
import pathlib
import pwd
import shutil
import socket
import subprocess

import numpy as np

import tacto
from run_daemon import Client, DAEMON, daemon, prepare_files, write_texture, write_token


def a_texture_with_nan():
    prepare_files()
    force = np.sin(np.arange(4000) / 10)
    force[1234] = np.nan
    write_texture("bad", force)
    with daemon():
        answer = Client().ask(request="load", file="bad")
        assert not answer["ok"] and "1234" in json.dumps(answer["error"]), answer


def second_daemon():
    prepare_files()
    with daemon():
        second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
        assert second.returncode == 5 and "control" in second.stderr, second
        config = json.loads(pathlib.Path("tactographd.json").read_text())
        pathlib.Path("other.json").write_text(json.dumps({**config, "socket": "other"}))
        tacto.run("play", "oak", "-d", "sim:", "--time", "0.1s", "-o", "beside")  # each process has its own emulation
        pathlib.Path("taken").write_text("of somebody")
        pathlib.Path("other.json").write_text(json.dumps({**config, "socket": "taken"}))
        second = subprocess.run([DAEMON, "--config", "other.json"], capture_output=True, text=True, timeout=20)
        assert second.returncode != 0 and "taken" in second.stderr, second
        pathlib.Path("other.json").write_text(json.dumps({**config, "socket": "other", "files": "nowhere"}))
        second = subprocess.run([DAEMON, "--config", "other.json"], capture_output=True, text=True, timeout=20)
        assert second.returncode == 3 and "nowhere" in second.stderr, second
        assert Client().must(request="status")["state"] == "idle"


def gain_saved_in_the_scene():
    prepare_files()
    layer = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}
    pathlib.Path("s.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": [layer]}))
    with daemon():
        client = Client()
        client.must(request="load", file="s")
        assert client.must(request="gain", gain=-1)["inverts_texture"] and client.must(request="status")["inverts_texture"]
        assert "inverts_texture" not in client.must(request="gain", gain=1) | client.must(request="status")
        client.must(request="gain", gain=2, save=True)
        client.must(request="gain", gain=0.5, save=True)  # relative to the loaded gain, not to the saved one
        answer = client.ask(request="gain", gain=0, save=True)
        assert not answer["ok"] and "recovered" in answer["error"]["what"], answer
        assert client.must(request="status")["gain"] == 0.5  # a refused request changes nothing
        answer = client.ask(request="gain", gain=900, save=True)
        assert not answer["ok"] and "100 um" in answer["error"]["what"], answer
        as_it_was = pathlib.Path("s.scene.json").read_bytes()
        os.chmod("s.scene.json", 0o444)
        answer = client.ask(request="gain", gain=0.25, save=True)
        assert not answer["ok"] and answer["error"]["fault"] == 6, answer
        assert client.must(request="status")["gain"] == 0.5 and pathlib.Path("s.scene.json").read_bytes() == as_it_was
    saved = json.loads(pathlib.Path("s.scene.json").read_text())["layers"][0]
    assert saved["gain_m_per_n"] == 0.0005 and saved["gain_set_on"]
    assert saved["gain_set_by"] == pwd.getpwuid(os.geteuid()).pw_name, saved


def gains_are_factors_of_the_default_or_displacement_for_force():
    """ctl load and ctl gain accept the same forms as play and render. A factor refers to the default of the texture or
    scene, also after a load with another gain; `gain` of the protocol refers to the loaded gain."""
    prepare_files()
    layers = [{"type": "texture", "texture": "oak", "at_m": at_m, "gain_m_per_n": gain} for at_m, gain in ((0, 4e-4), (0.05, -2e-4))]
    pathlib.Path("s.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": layers}))
    ctl = lambda *arguments: json.loads(tacto.run("ctl", *arguments, "--socket", "control", "--json")[0])
    refused = lambda *arguments: json.loads(tacto.run("ctl", *arguments, "--socket", "control", "--json", code=2)[1])
    with daemon():
        client = Client()
        error = client.ask(request="gain", times_default=0.5)["error"]
        assert error["fault"] == 1, error
        loaded = ctl("load", "oak", "--gain", "50%")
        assert (loaded["gain_m_per_n"], loaded["default_gain_m_per_n"]) == (5e-4, 1e-3), loaded
        for text, gain_m_per_n in (("0.25x", 2.5e-4), ("100%", 1e-3), ("0.1mm/N", 1e-4), ("-20%", -2e-4)):
            answer = ctl("gain", text)
            assert np.isclose(answer["gain_m_per_n"], gain_m_per_n, rtol=1e-12) and answer.get("inverts_texture", False) == (gain_m_per_n < 0), answer
            assert client.must(request="status")["gain_m_per_n"] == answer["gain_m_per_n"], text
        assert np.isclose(client.must(request="gain", gain=0.5)["gain_m_per_n"], 2.5e-4, rtol=1e-12)
        for bare in ("0.5", "0.5N", "x", ""):
            assert "mm/N" in refused("gain", bare)["remedy"], bare
        for request in ({"request": "load", "file": "oak", "gain_m_per_n": 1e-4, "times_default": 1}, {"request": "gain", "gain": 1, "times_default": 1},
                        {"request": "gain", "save": True}, {"request": "arm", "times_default": 1}):
            assert client.ask(**request)["error"]["fault"] == 3, request
        assert refused("load", "s", "--gain", "1mm/N")["remedy"].endswith("as in 2x")
        assert ctl("load", "s", "--gain", "50%")["gain_m_per_n"] == 2e-4
        assert refused("gain", "1mm/N")["remedy"].endswith("as in 2x")
        ctl("gain", "2x", "--save")
        assert [layer["gain_m_per_n"] for layer in json.loads(pathlib.Path("s.scene.json").read_text())["layers"]] == [8e-4, -4e-4]
        assert np.isclose(ctl("gain", "0.5x", "--save")["gain_m_per_n"], 2e-4, rtol=1e-12)  # of the default when it was loaded
        assert np.allclose([layer["gain_m_per_n"] for layer in json.loads(pathlib.Path("s.scene.json").read_text())["layers"]], [2e-4, -1e-4], rtol=1e-12)


def gain_kept_with_the_texture():
    """One client saves a gain; the next load has it, with author and time; the rest of the sidecar and the WAV do not
    change."""
    prepare_files()
    sidecar, wav = pathlib.Path("oak.texture.json"), pathlib.Path("oak.texture.wav")
    sidecar.write_text(json.dumps({**json.loads(sidecar.read_text()), "from_tomorrow": {"kept": [1, 2.5]}}))
    before, samples = json.loads(sidecar.read_text()), wav.read_bytes()
    me = pwd.getpwuid(os.geteuid()).pw_name
    pathlib.Path("token").write_text("c0ffee" * 4)
    os.chmod("token", 0o600)
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    config = json.loads(pathlib.Path("tactographd.json").read_text())
    pathlib.Path("tactographd.json").write_text(json.dumps({**config, "tcp_port": port, "tcp_token_file": "token", "files": "."}))
    with daemon():
        first = Client()
        assert first.ask(request="gain", gain=0.5, save=True)["error"]["fault"] == 1
        loaded = first.must(request="load", file="oak")
        assert loaded["gain_m_per_n"] == 1e-3 and "gain_set_by" not in loaded, loaded
        first.must(request="gain", gain=2, save=True)
        first.must(request="gain", gain=0.5, save=True)  # relative to the loaded gain, not to the saved one
        second = Client()
        loaded = second.must(request="load", file="oak")
        assert loaded["gain_m_per_n"] == 5e-4 and loaded["gain_set_by"] == me and loaded["gain_set_on"].endswith("Z"), loaded
        assert second.must(request="status")["gain"] == 1
        named = second.must(request="load", file="oak", gain_m_per_n=2e-4)
        assert named["gain_m_per_n"] == 2e-4 and "gain_set_by" not in named, named
        os.chmod(sidecar, 0o444)
        as_it_was = sidecar.read_bytes()
        answer = second.ask(request="gain", gain=0.5, save=True)
        assert not answer["ok"] and answer["error"]["fault"] == 6 and "chmod" in answer["error"]["remedy"], answer
        assert second.must(request="status")["gain"] == 1 and sidecar.read_bytes() == as_it_was
        os.chmod(sidecar, 0o644)
        after = json.loads(sidecar.read_text())
        assert after.pop("playback_gain") == {"gain_m_per_n": 5e-4, "who": me, "when": loaded["gain_set_on"]}, after
        assert after["data"].pop("numbers_sha256")  # written with the file; `validate`, below, compares it with the numbers
        assert after == before and list(after) == list(before), (before, after)
        assert wav.read_bytes() == samples
        with socket.create_connection(("127.0.0.1", port), timeout=10) as other:
            lines = other.makefile("rw")
            for request in ({"request": "hello", "version": "1.0", "token": "c0ffee" * 4}, {"request": "load", "file": "oak"},
                            {"request": "gain", "gain": 0.8, "save": True}):
                lines.write(json.dumps(request) + "\n")
                lines.flush()
                answer = json.loads(lines.readline())
                assert answer["ok"], answer
    tacto.run("validate", "oak")
    printed = tacto.run_json("info", "oak")
    assert abs(printed["playback_gain_m_per_n"] - 4e-4) < 1e-12 and printed["gain_set_by"] == "token", printed
    played = tacto.run_json("play", "oak", "-d", "sim:", "--time", "0.2s", "-o", "kept")
    assert abs(played["gain_m_per_n"] - 4e-4) < 1e-12 and played["gain_set_by"] == "token", played
    assert tacto.run_json("play", "oak", "-d", "sim:", "--time", "0.2s", "--gain", "0.1mm/N", "-o", "named")["gain_m_per_n"] == 1e-4
    assert tacto.run_json("explain", "oak")["gain_set_by"] == "token"
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.002\n0.5,0.02\n")
    rendered = tacto.run_json("render", "oak", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "drive.wav")
    assert abs(rendered["gain_m_per_n"] - 4e-4) < 1e-12 and rendered["gain_set_by"] == "token", rendered


def what_clients_over_tcp_load():
    """Files from the configured folder only; the error reveals nothing about other files. Clients of the Unix socket
    may load any file."""
    pathlib.Path("served").mkdir()
    prepare_files(tcp_port=0, tcp_token_file="token", files="served")
    write_token("0123456789abcdef")
    for file in pathlib.Path(".").glob("oak.texture.*"):
        shutil.copy(file, "served")
        os.symlink(file.absolute(), f"served/{file.name.replace('oak', 'link')}")
    with daemon() as process:
        remote = Client(port=int(process.ready.rsplit(":", 1)[1]), token="0123456789abcdef")
        remote.must(request="load", file="oak", gain_m_per_n=0.0005)
        answers = set()
        for file in (os.path.abspath("oak"), os.path.abspath("elm"), "../oak", "../elm", "elm", "link", "/etc/passwd"):
            error = remote.ask(request="load", file=file)["error"]
            assert error["where"] == file, error
            answers.add((error["what"], error["remedy"]))
        assert len(answers) == 1, answers
        Client().must(request="load", file="../oak", gain_m_per_n=0.0005)
        refused = Client().ask(request="gain", gain=1)
        assert refused["ok"], refused
        local = Client()
        local.socket.sendall(b'{"request":"gain","gain":0.5,"gain":2}\n')
        refused = json.loads(local.lines.readline())
        assert not refused["ok"] and "'gain'" in refused["error"]["what"] and local.must(request="status")["gain"] == 1, refused


if __name__ == "__main__":
    for test in [a_texture_with_nan, second_daemon, gain_saved_in_the_scene,
                 gains_are_factors_of_the_default_or_displacement_for_force, gain_kept_with_the_texture, what_clients_over_tcp_load]:
        tacto.in_folder(test)
