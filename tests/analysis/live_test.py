#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactograph live, without a browser: who may use it, what it serves, bad input; and the page's device in node, whose
sessions `tactograph replay` computes again natively, to the bit.
"""
import contextlib
import hashlib
import json
import pathlib
import random
import re
import shutil
import socket
import struct
import subprocess
import sys

import netCDF4
import numpy as np
import scipy.signal
import soundfile
from live_client import TickFrame, fetch_page, live
from tacto import COMMAND, in_folder, run, run_json

ODD_NAME = "<img src=x onerror=alert(1)>"
HERE = pathlib.Path(__file__).resolve().parent


def make_textures():
    """C of the emulated device; a texture with an odd name; one that can't be read."""
    run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "rec")
    run("spatial", "rec", "-o", "folder/C", "--stroke", "1")
    for ending in (".texture.wav", ".texture.json"):
        shutil.copy(f"folder/C{ending}", f"folder/{ODD_NAME}{ending}")
    side = json.loads(pathlib.Path("folder/C.texture.json").read_text())
    pathlib.Path(f"folder/{ODD_NAME}.texture.json").write_text(json.dumps(side))
    pathlib.Path("folder/broken.texture.json").write_text("{")
    pathlib.Path("folder/alone.texture.wav").write_bytes(b"RIFF")
    for ending in (".wav", ".json"):
        shutil.copy(f"rec{ending}", f"folder/rec{ending}")
    pathlib.Path("folder/lonely.wav").write_bytes(b"RIFF")
    # A sine of 1 mm and 5 mN.
    wav = pathlib.Path("folder/sine.texture.wav")
    soundfile.write(wav, 0.005 * np.sin(2 * np.pi * np.arange(side["data"]["samples"]) / 1000), 1_000_000, subtype="FLOAT")
    side["data"].update(file=wav.name, sha256=hashlib.sha256(wav.read_bytes()).hexdigest())
    pathlib.Path("folder/sine.texture.json").write_text(json.dumps(side))


def check_access(server):
    for host in ("evil.example", f"127.0.0.1.evil.example:{server.port}", "localhost:", "127.0.0.1:7230x", None):
        assert server.ask("/", Host=host).status in ((421,) if host else (400, 421)), host
    for host in (f"localhost:{server.port}", "localhost:9999", "[::1]:80", "127.0.0.1"):
        assert server.ask("/", Host=host).status == 200, host
    assert server.ask("/", Origin="http://evil.example").status == 403
    assert server.ask("/", Origin="null").status == 403
    assert server.ask("/", Origin=f"http://127.0.0.1:{server.port}").status == 200
    assert server.ask("/", method="POST", Content_Length="0").status == 405
    for path in ("/", "/page.js", "/textures", "/upload/0", "/?token=", "/?token=" + "0" * 32, "/page.js?token=" + server.token):
        assert server.ask(path, cookie=False).status == 401, path
    assert server.ask("/", cookie=False, Cookie=f"tactograph-{server.port}={server.token[:-1]}").status == 401
    entered = server.ask("/?token=" + server.token, cookie=False)
    assert entered.status == 200 and entered.body.startswith(b"<!doctype html>")
    cookie = entered.headers["set-cookie"]
    assert cookie.startswith(server.cookie + ";") and "HttpOnly" in cookie and "SameSite=Strict" in cookie, cookie
    for path in ("/../../etc/passwd", "/..%2f..%2fetc/passwd", "/etc/passwd", "/folder/C.texture.json", "/texture/x", "/texture/0/wav", "/texture/", "/upload/0", "/session"):
        assert server.ask(path).status == 404, path
    assert server.ask("/texture/999").status == 404
    for size, status in ((256, 404), (257, 414), (5000, 414), (30_000, 414)):
        assert server.ask("/" + (size - 1) * "a").status == status, size
    assert server.ask("/" + 5000 * "a", cookie=False).status == 401
    try:  # 127.0.0.1 only: another address of this computer does not answer
        socket.create_connection(("127.0.0.2", server.port), timeout=10).close()
        raise AssertionError("the server listens on more than 127.0.0.1")
    except ConnectionRefusedError:
        pass


def check_sizes(server):
    """Each page with all that it loads, but for data: at most 400 KB."""
    for page in ("index.html", "scene.html", "explorer.html", "daemon.html", "jobs.html"):
        sizes, wanted = {}, [page]
        while wanted:
            name = wanted.pop()
            if name in sizes:
                continue
            answer = server.ask("/" + name)
            assert answer.status == 200, (page, name)
            sizes[name], text = len(answer.body), answer.body.decode(errors="replace")
            if name.endswith((".html", ".js")):
                wanted += re.findall(r"""(?:src=|<link[^>]* href=|from |addModule\(|get\()["']\.?/?([a-z_]+\.(?:js|css|svg|wasm))["']""", text)
        assert "style.css" in sizes and ("core.wasm" in sizes) == (page in ("index.html", "scene.html")), (page, sizes)
        print(f"{page}: {sum(sizes.values())} bytes in {len(sizes)} files")
        assert sum(sizes.values()) <= 400_000, (page, sizes)


def check_headers(server):
    for answer in (server.ask("/"), server.ask("/page.js"), server.ask("/textures"), server.ask("/none"), server.ask("/", cookie=False)):
        policy = dict(part.strip().split(" ", 1) for part in answer.headers["content-security-policy"].split(";"))
        assert policy["default-src"] == "'none'" and "unsafe-inline" not in str(policy) and "'unsafe-eval'" not in str(policy), policy
        assert policy["script-src"] == "'self' 'wasm-unsafe-eval'" and policy["frame-ancestors"] == "'none'", policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["cross-origin-opener-policy"] == "same-origin"
        assert answer.headers["cross-origin-embedder-policy"] == "require-corp"
    types = {name: server.ask(name).headers["content-type"] for name in ("/", "/page.js", "/style.css", "/core.wasm")}
    assert types == {"/": "text/html; charset=utf-8", "/page.js": "text/javascript; charset=utf-8",
                     "/style.css": "text/css; charset=utf-8", "/core.wasm": "application/wasm"}, types
    page = server.ask("/").body.decode()
    assert "<script>" not in page and "onclick" not in page and " style=" not in page


def check_textures(server):
    rows = {row["name"]: row for row in server.json("/textures")["textures"]}
    assert set(rows) == {"C", ODD_NAME, "alone", "broken", "sine"}, rows
    assert "reason" in rows["broken"] and "reason" in rows["alone"] and abs(rows["C"]["length_m"] - 0.035) < 0.002, rows
    figures = server.json(f"/texture/{rows['C']['index']}")
    assert figures["rate_hz"] == 16000 and figures["gain_m_per_n"] > 0 and figures["transducer"] == "wiertlewski2011", figures
    bad = server.ask(f"/texture/{rows['broken']['index']}")
    assert bad.status == 422 and json.loads(bad.body)["error"]["fault"] == 3, bad.body
    map_ = server.ask(f"/map/{figures['made']}").body
    values = struct.unpack(f"<{len(map_) // 4}f", map_)
    assert len(values) == 4000 and all(least <= most for least, most in zip(values[::2], values[1::2]))
    check_tray(np.frombuffer(server.ask(f"/tray/{figures['made']}").body, "<f4"))
    check_list(server, rows)
    odd = server.json(f"/texture/{rows[ODD_NAME]['index']}")
    assert odd["made"] != figures["made"] and odd["name"] == ODD_NAME
    return figures["made"], odd["made"]


def check_list(server, rows):
    sine = rows["sine"]
    assert abs(sine["rms"] / (0.005 / np.sqrt(2)) - 1) < 1e-3 and sine["unit"] == "N" and sine["surface"] == rows["C"]["surface"], sine
    assert abs(sine["changed_s"] - pathlib.Path("folder/sine.texture.json").stat().st_mtime) < 1e-3, sine
    small = np.frombuffer(server.ask(f"/thumbnail/{sine['index']}").body, "<f4").reshape(-1, 2)
    assert len(small) == 96 and np.all(small[:, 0] <= small[:, 1]) and abs(small.max() / 0.005 - 1) < 1e-3
    assert server.ask(f"/thumbnail/{rows['broken']['index']}").status == 404 and server.ask("/thumbnail/99").status == 404
    # A file that changes is read again, one that is removed is not listed any more; the others keep their index.
    broken = pathlib.Path("folder/broken.texture.json")
    broken.write_text(pathlib.Path("folder/sine.texture.json").read_text())
    again = {row["name"]: row for row in server.json("/textures")["textures"]}
    assert again["broken"]["rms"] == sine["rms"] and "reason" not in again["broken"] and again["sine"] == sine, again
    broken.unlink()
    assert "broken" not in {row["name"] for row in server.json("/textures")["textures"]}
    broken.write_text("{")
    assert {row["name"]: row["index"] for row in server.json("/textures")["textures"]} == {name: row["index"] for name, row in rows.items()}


def check_recordings(server):
    rows = {row["name"]: row for row in server.json("/textures")["recordings"]}
    assert set(rows) == {"rec", "lonely"} and "reason" in rows["lonely"], rows
    info = run_json("info", "rec")
    assert abs(rows["rec"]["duration_s"] - 2) < 0.01 and rows["rec"]["channels"] == [channel["name"] for channel in info["channels"]], (rows, info)
    small = np.frombuffer(server.ask(f"/thumbnail/{rows['rec']['index']}").body, "<f4").reshape(-1, 2)
    force = next(channel for channel in info["channels"] if channel["quantity"] == "tangential_force")
    stored = soundfile.read("rec.wav", dtype="int32", always_2d=True)[0][:, rows["rec"]["channels"].index(force["name"])]
    side = next(channel for channel in json.loads(pathlib.Path("rec.json").read_text())["channels"] if channel["name"] == force["name"])
    values = stored * side["scale"] + side.get("offset", 0)
    assert len(small) == 96 and np.allclose([small.min(), small.max()], [values.min(), values.max()], rtol=1e-5), small
    assert server.ask(f"/thumbnail/{rows['lonely']['index']}").status == 404
    assert server.ask(f"/texture/{rows['rec']['index']}").status == 422  # it is no texture
    return rows["rec"]["index"]


class Jobs:
    def __init__(self, server):
        self.socket, self.jobs = server.page("/jobs"), {}
        assert self.socket.status == 101

    def hear(self):
        message = self.socket.receive()
        if message.get("event") == "jobs":
            self.jobs = {job["number"]: job for job in message["jobs"]}
        return message

    def ask(self, **request):
        self.socket.send(json.dumps(request))
        while "ok" not in (message := self.hear()):
            pass
        return message

    def until(self, number, *states):
        while self.jobs.get(number, {}).get("state") not in states:
            self.hear()
        return self.jobs[number]


def check_jobs(server, rec):
    for wrong, status in (({"Origin": None}, 403), ({"Origin": "http://evil.example"}, 403), ({"Cookie": None}, 401)):
        assert server.page("/jobs", **wrong).status == status
    assert server.ask("/jobs").status == 404 and server.ask("/result/0").status == 404 and server.ask("/result/0", cookie=False).status == 401
    jobs = Jobs(server)
    for wrong in ({"verb": "play", "files": []}, {"verb": "report", "files": ["/etc/passwd"]}, {"verb": "compare", "files": [0, 1, 2]}, {"verb": "report"}, {"files": []}):
        assert jobs.ask(request="run", **wrong)["error"]["fault"] == 3, wrong
    assert jobs.ask(request="run", verb="compare", files=[rec])["error"]["fault"] == 1
    assert jobs.ask(request="run", verb="fidelity", files=[999])["error"]["fault"] == 2
    assert jobs.ask(request="cancel", job=99)["error"]["fault"] == 2 and jobs.ask(request="keep")["error"]["fault"] == 1
    indices = {row["name"]: row["index"] for row in server.json("/textures")["textures"]}
    first = jobs.ask(request="run", verb="compare", files=[indices["C"], indices[ODD_NAME]])["job"]
    done = jobs.until(first, "done", "failed", "cancelled")
    page = pathlib.Path(f"folder/C-{ODD_NAME}-compare.html")
    assert done["state"] == "done" and pathlib.Path(done["page"]) == page, done
    run("compare", "folder/C.texture.json", f"folder/{ODD_NAME}.texture.json", "-o", "own.html")
    assert page.read_text() == pathlib.Path("own.html").read_text()
    own = run("compare", "folder/C.texture.json", f"folder/{ODD_NAME}.texture.json")[0]
    assert done["printed"].startswith(own.splitlines()[0]) and done["command"].startswith("tactograph compare folder/C.texture.json "), (done, own)
    shown = server.ask(f"/result/{first}")
    policy = shown.headers["content-security-policy"]
    assert shown.body == page.read_bytes() and policy.startswith("sandbox;") and "script-src" not in policy and "default-src 'none'" in policy, policy
    # One at a time, in order; a cancelled one leaves nothing.
    slow = jobs.ask(request="run", verb="trade", files=[indices["C"]])["job"]
    waiting = [jobs.ask(request="run", verb="report", files=[])["job"] for _ in range(2)]
    jobs.until(slow, "running")
    jobs.until(waiting[1], "waiting")
    assert [jobs.jobs[number]["state"] for number in waiting] == ["waiting", "waiting"], jobs.jobs
    assert jobs.ask(request="cancel", job=waiting[0])["ok"] and jobs.until(waiting[0], "cancelled")
    assert jobs.ask(request="cancel", job=slow)["ok"]
    assert "page" not in jobs.until(slow, "cancelled", "done", "failed") and jobs.jobs[slow]["state"] == "cancelled"
    report = jobs.until(waiting[1], "done", "failed")
    assert report["state"] == "done" and report["page"].endswith("report-2.html"), report  # the cancelled one had the first name
    failed = jobs.until(jobs.ask(request="run", verb="fidelity", files=[indices["broken"]])["job"], "done", "failed")
    assert failed["state"] == "failed" and "broken" in failed["said"] and "page" not in failed, failed
    left = sorted(path.name for path in pathlib.Path("folder").iterdir() if path.suffix == ".html" or path.name.startswith(".") and not path.name.startswith(".tactograph-live-"))
    assert left == sorted([page.name, "report-2.html"]), left
    # It ends with the server: the test's end looks for it.
    last = jobs.ask(request="run", verb="trade", files=[rec])["job"]
    jobs.until(last, "running")


def processes_with(text):
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):
            if text.encode() in path.read_bytes():
                found.append(path)
    return found


def shaped(server, source, **numbers):
    query = "&".join(f"{name}={value!r}" for name, value in numbers.items())
    answer = server.ask(f"/shape/{source}?{query}")
    assert answer.status == 200, answer.body
    return json.loads(answer.body)


def saved(server, shape):
    jobs = Jobs(server)
    answer = jobs.ask(request="save", texture=shape["index"])
    assert answer["ok"], answer
    side = pathlib.Path(answer["saved"])
    run("validate", side)
    return json.loads(side.read_text()), soundfile.read(str(side).replace(".json", ".wav"), dtype="float32")[0]


def check_shapes(server, made):
    """Stretched and filtered textures are the verb's; computed ones are a closed form, or within their depth."""
    c = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "C")
    for path, status, fault in ((f"{c}?x=1", 422, 1), (f"{c}?stretch=abc", 422, 1), (f"{c}?stretch=100", 422, 1), (f"{c}?low_per_m=900&high_per_m=100", 422, 4),
                                ("grating?duty=0", 422, 1), ("99?stretch=1.3", 404, 2), ("wood", 404, 2), ("../folder/C", 404, 2), ("", 404, 2)):
        refused = server.ask(f"/shape/{path}")
        assert refused.status == status and (status == 404 or json.loads(refused.body)["error"]["fault"] == fault), (path, refused.status, refused.body)
    assert not [path for path in pathlib.Path("folder").iterdir() if path.name.startswith(".tactograph")]  # nothing until it is needed
    shape = shaped(server, c, stretch=1.3, keep_slope=1, low_per_m=500, high_per_m=5000)
    assert shape["factor"] == 1.3 and shape["low_per_m"] == 500 and shape["name"] == "C-band-stretched", shape
    side, values = saved(server, shape)
    run("transform", "folder/C", "-o", "own", "--band", "0.5/mm..5/mm", "--stretch", "1.3x", "--keep-slope")
    own = json.loads(pathlib.Path("own.texture.json").read_text())
    assert side["transform"] == own["transform"] and side["data"]["sha256"] == own["data"]["sha256"], (side["transform"], own["transform"])
    assert server.ask(f"/shape/{shape['index']}?stretch=1.1").status == 404  # of a shape: its sidecar would name a file that is not kept
    again, _ = saved(server, shape)
    assert again["data"]["file"] == "C-band-stretched-2.texture.wav"
    names = {row["name"] for row in server.json("/textures")["textures"]}
    assert {"C-band-stretched", "C-band-stretched-2"} <= names and len(names) == 7, names  # the shape itself is not listed
    # Under the pointer: prepared, changed to while another one plays, kept beside the others.
    number = server.json(f"/texture/{shape['index']}")["made"]
    for _ in range(10):  # what is in use stays
        server.json(f"/texture/{c}")
        assert server.ask(f"/change/{number}/{made}/1").status == 200
    log = device_log(server, made, 5, 3, "change", [(number, 1), (made, 1), (number, 0.7)])
    answer = kept(server, made, log, json.loads(pathlib.Path("log.changes").read_text()))
    assert run_json("replay", answer["kept"])["same_to_the_bit"]
    own_log = device_log(server, number, 6, 2)
    answer = kept(server, number, own_log)
    assert pathlib.Path(answer["kept"]).parent == pathlib.Path("folder").resolve() and pathlib.Path(answer["kept"]).name.startswith("C-band-stretched-"), answer
    assert run_json("replay", answer["kept"])["same_to_the_bit"]
    filtered = server.json(f"/texture/{c}?inverse=gain")["made"]  # another filter is another device: not while it plays
    assert server.ask(f"/upload/{filtered}").body != server.ask(f"/upload/{made}").body and server.ask(f"/change/{filtered}/{made}/1").status == 422
    assert server.ask(f"/texture/{c}?inverse=best").status == 422
    check_computed(server)
    last = [shaped(server, "noise", seed=i) for i in range(9)]
    assert server.ask(f"/texture/{last[0]['index']}").status == 404 and server.ask(f"/texture/{last[1]['index']}").status == 200


def check_computed(server):
    for duty in (0.5, 0.2):
        shape = shaped(server, "grating", period_m=3e-3, depth_m=20e-6, duty=duty, smooth_m=1e-4)
        side, values = saved(server, shape)
        x = side["pitch_m"] * np.arange(len(values))
        bells = [np.exp(-((x - 3e-3 * (k + way * duty / 2)) / 1e-4) ** 2 / 2) * -way for k in range(-1, 16) for way in (-1, 1)]
        exact = 0.5 * 20e-6 * sum(bells) / (np.sqrt(2 * np.pi) * 1e-4)
        # Harmonics below 1e-6 of the first are left out; their slopes are n times as large, n up to 26. Single precision: 2e-7 of
        # the sum of n amplitude, some 10 peaks.
        assert np.max(np.abs(values - exact)) < 1e-4 * np.max(exact) and side["surface"] and "20" in side["notes"], (duty, np.max(np.abs(values - exact)), np.max(exact))
    heights = {}
    for slope, seed in ((-6, 1), (-6, 2), (-20, 1)):
        side, values = saved(server, shaped(server, "noise", period_m=4e-3, depth_m=50e-6, slope_db=slope, seed=seed))
        heights[slope, seed] = np.cumsum(values.astype(float)) * side["pitch_m"] / 0.5
        assert 5e-6 < np.ptp(heights[slope, seed]) < 50e-6
    assert np.array_equal(saved(server, shaped(server, "noise", period_m=4e-3, depth_m=50e-6, slope_db=-6, seed=1))[1], saved(server, shaped(server, "noise", period_m=4e-3, depth_m=50e-6, slope_db=-6, seed=1))[1])
    def fine(h):  # share of periods below 1 mm
        power = np.abs(np.fft.rfft((h - h.mean()) * np.hanning(len(h)))) ** 2
        return power[40:].sum() / power.sum()
    assert np.corrcoef(heights[-6, 1], heights[-6, 2])[0, 1] < 0.7 and fine(heights[-6, 1]) > 10 * fine(heights[-20, 1])


def check_changes(server, made, odd_made):
    assert server.ask(f"/change/{odd_made}/{made}/1").body != server.ask(f"/change/{odd_made}/{made}/0.5").body
    for path in (f"{made}/{made}", f"{made}/{made}/1/", f"{made}/{made}/nan", f"{made}/{made}/1e9", f"{made}/-1/1", f"999/{made}/1", f"{made}/999/1", "", "x"):
        assert server.ask(f"/change/{path}").status == 404, path


def check_tray(taps):
    """The impulse response against SciPy's zero-order hold of the equation of motion (Wiertlewski 2011, 5 and 6)."""
    t = json.loads((HERE.parents[1] / "data-schema/presets/wiertlewski2011.transducer.json").read_text())
    stiffness = t["flexure_stiffness_n_per_m"] + t["bender_stiffness_n_per_m"]
    size = t["deflection_m"] / t["max_voltage_v"] * t["bender_stiffness_n_per_m"] * t["amplifier_gain"] * t["actuator_scale"]
    poles = np.polymul([t["mass_kg"], t["damping_n_s_per_m"], stiffness], [2 * t["amplifier_resistance_ohm"] * t["capacitance_f"], 1])
    numerator, denominator, _ = scipy.signal.cont2discrete(([size], poles), 1 / 16000, method="zoh")
    w = 2 * np.pi * np.array([0, 15, 50, 100, 200, 350, 500]) / 16000
    exact = scipy.signal.freqz(numerator.ravel(), denominator, w)[1]
    ours = scipy.signal.freqz(taps.astype(float), 1, w)[1]
    # Beyond 32 ms: -92 dB; images above 8 kHz, which the page leaves out: (547 / 15500)^2 / 31 = -88 dB at 500 Hz.
    assert np.max(np.abs(ours / exact - 1)) < 1e-4, ours / exact


def check_protocol(server, made):
    assert server.page(Origin=None).status == 403
    assert server.page(Origin="http://evil.example").status == 403
    assert server.page(Cookie=None).status == 401
    assert server.page(Host="evil.example", Origin="http://evil.example").status == 421
    assert server.page("/other").status == 404
    page = server.page()
    assert page.status == 101
    for text in ("", "[]", "{", '{"request":"format"}', '{"request":"begin"}', '{"request":"keep","path":"/etc/x"}',
                 '{"request":"begin","made":-1}', '{"request":"begin","made":"C"}', '{"request":"keep","request":"keep"}',
                 "[" * 1000, "\x00"):
        page.send(text)
        answer = page.receive()
        assert answer["ok"] is False and answer["error"]["fault"] == 3, (text, answer)
    assert page.ask(request="begin", made=999)["error"]["fault"] == 2
    assert page.ask(request="keep")["error"]["fault"] == 4
    assert page.ask(request="change", made=made, playing=made, times=1)["error"]["fault"] == 4
    assert page.ask(request="change", made=999, playing=made, times=1)["error"]["fault"] == 2
    for lacking in ({"made": made, "playing": made}, {"made": made, "times": 1}, {"made": made, "playing": made, "times": 1e7}):
        assert page.ask(request="change", **lacking)["error"]["fault"] == 3, lacking
    assert page.ask(request="begin", made=made)["ok"]
    assert page.ask(request="keep")["error"]["fault"] == 4  # no tick
    page.ask(request="begin", made=made)
    page.send(b"no frames at all")
    page.send(b"x" * 64)
    assert page.receive()["error"]["fault"] == 3
    page.send("x" * 16384)
    assert page.receive()["error"]["fault"] == 3
    page.send("x" * 16385)
    assert page.receive() == ("closed", 1009)
    assert not list(pathlib.Path("folder").glob("*.session"))


def device_log(server, made, seed, seconds, kind="", changes=()):
    """`changes`: (number of another prepared texture, factor of its samples)."""
    for part in ("upload", "tray"):
        pathlib.Path(part).write_bytes(server.ask(f"/{part}/{made}").body)
    rows = []
    for i, (other, times) in enumerate(changes):
        pathlib.Path(f"change{i}").write_bytes(server.ask(f"/change/{other}/{made}/{times}").body)
        rows.append({"frames": f"change{i}", "note": {"made": other, "playing": made, "times": times}})
    pathlib.Path("changes.json").write_text(json.dumps(rows))
    done = subprocess.run(["node", "page/live_device.mjs", "page/core.wasm", "upload", "tray", str(seed), str(seconds), kind, "log", "changes.json"],
                          capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr.decode()
    print(f"seed {seed}: {done.stderr.decode().strip()}")
    return pathlib.Path("log").read_bytes()


def kept(server, made, log, changes=()):
    page = server.page()
    assert page.ask(request="begin", made=made)["ok"]
    ends = [*(change["at"] for change in changes), len(log)]
    for begin, end, change in zip([0, *ends], ends, [*changes, None]):
        for at in range(begin, end, 5000):
            page.send(log[at:min(at + 5000, end)])
        if change:
            assert page.ask(request="change", **change["note"])["ok"]
    answer = page.ask(request="keep")
    if answer.get("event") == "fault":
        assert answer["what"] and answer["remedy"], answer
        answer = page.receive()
    assert answer["ok"], answer
    return answer


def check_spectrogram(server):
    """The cells are those of the verb's file, the page says the same number, and exports are the verb's files."""
    index = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "C")
    about = server.json(f"/spectrogram/{index}")
    number = about["made"]
    run("spectrogram", "folder/C", *(part for form in ("nc", "png", "svg", "csv") for part in ("-o", f"C.{form}")))
    with netCDF4.Dataset("C.nc") as file:
        density, positions = np.array(file["density"]), np.array(file["position"])
        frequencies, known = np.array(file["spatial_frequency"]), np.array([file["known_from"], file["known_to"]]).T
        assert file["density"].units == about["cell_unit"], about
    for part in ("cells", "known"):
        pathlib.Path(part).write_bytes(server.ask(f"/{part}/{number}").body)
    cells = np.fromfile("cells", "<f4").reshape(about["rows"], about["bins"])
    assert np.array_equal(cells, density)
    assert np.allclose(1e3 * (about["first_position_m"] + about["hop_m"] * np.arange(about["rows"])), positions, rtol=0, atol=1e-9)
    assert np.allclose(1e-3 * about["frequency_step_per_m"] * np.arange(about["bins"]), frequencies, rtol=1e-12, atol=0)
    assert np.allclose(1e-3 * np.fromfile("known", "<f4").reshape(-1, 2), known, rtol=1e-6, atol=0)  # float32
    # Hover a cell: the same number.
    draw = np.random.default_rng(34)
    places = np.stack([draw.uniform(0, 0.035, 50), draw.uniform(0, 15e3, 50)], 1)
    pathlib.Path("hover.json").write_text(json.dumps({"about": about, "cells": "cells", "known": "known", "places": places.tolist()}))
    said = subprocess.run(["node", "page/live_pages.mjs", "hover.json"], capture_output=True, text=True, timeout=60)
    assert said.returncode == 0, said.stderr
    for (position_m, per_m), words in zip(places, json.loads(said.stdout)):
        cell = np.abs(positions - 1e3 * position_m).argmin(), np.abs(frequencies - 1e-3 * per_m).argmin()
        assert np.float32(words.split("; ")[-2 if "not measured" in words else -1].split()[0]) == density[cell], (words, density[cell])
    check_exports(server, number, density, positions, frequencies)


def check_exports(server, number, density, positions, frequencies):
    for form in ("nc", "png", "svg", "csv"):
        assert server.ask(f"/export/{number}/{form}?range_db=60").body == pathlib.Path(f"C.{form}").read_bytes(), form
    run("spectrogram", "folder/C", "-o", "other.png", "--formants", "--dynamic-range", "40dB", "--min-frequency", "0.2/mm")
    answer = server.ask(f"/export/{number}/png?range_db=40&formants=1&low_per_m=200")
    assert answer.body == pathlib.Path("other.png").read_bytes() and answer.headers["content-disposition"] == "attachment"
    # A selection: the same cells, fewer of them.
    selection = "from_m=0.0101&to_m=0.02&high_per_m=2000"
    rows, bins = (positions >= 10.1 - 1e-9) & (positions <= 20 + 1e-9), frequencies <= 2 + 1e-9
    pathlib.Path("part.nc").write_bytes(server.ask(f"/export/{number}/nc?{selection}").body)
    with netCDF4.Dataset("part.nc") as file:
        assert np.array_equal(np.array(file["density"]), density[rows][:, bins]) and np.array_equal(np.array(file["position"]), positions[rows])
    run("validate", "part.nc")
    table = server.ask(f"/export/{number}/csv?{selection}").body.decode().splitlines()
    assert len(table) == 1 + rows.sum() and len(table[1].split(",")) == 3 + bins.sum()
    picture = server.ask(f"/export/{number}/png?{selection}&low_per_m=100").body
    assert picture.startswith(b"\x89PNG") and picture != pathlib.Path("C.png").read_bytes()
    for query, status, fault in (("from_m=1", 422, 4), ("from_m=0.02&to_m=0.01", 422, 4), ("from_m=x", 422, 1), ("from_m=nan", 422, 1), ("path=1", 422, 1),
                                 ("range_db=-1", 422, 1), ("low_per_m=9000&high_per_m=9001", 422, 4), ("range_db", 422, 1)):
        refused = server.ask(f"/export/{number}/png?{query}")
        assert refused.status == status and json.loads(refused.body)["error"]["fault"] == fault, (query, refused.body)
    for path in (f"{number}/wav", f"{number}/", f"{number}", "99/png", "x/png", f"{number}/../png"):
        assert server.ask(f"/export/{path}").status == 404, path
    assert server.ask("/spectrogram/99").status == 404 and server.ask("/cells/99").status == 404
    broken = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "broken")
    assert server.ask(f"/spectrogram/{broken}").status == 422


def check_bits(server, made, odd_made):
    for seed, which, fault in ((1, made, ""), (2, odd_made, ""), (3, made, "fault")):
        log = device_log(server, which, seed, 6, fault)
        answer = kept(server, which, log)
        report = run_json("replay", answer["kept"])
        assert report["same_to_the_bit"] and report["ticks_compared"] == answer["ticks"] > 90_000, report
        assert "lost_ticks" not in report
        run("validate", answer["kept"])
        info = run_json("info", answer["kept"])
        assert "simulated" in json.dumps(info) and "browser" in json.dumps(info), info
    # The texture changes while it plays, with a factor of its samples.
    change_log = device_log(server, made, 4, 6, "change", [(odd_made, 0.25), (made, 1), (odd_made, -1.3)])
    changes = json.loads(pathlib.Path("log.changes").read_text())
    answer = kept(server, made, change_log, changes)
    report = run_json("replay", answer["kept"])
    assert report["same_to_the_bit"] and report["ticks_compared"] == answer["ticks"] > 90_000, report
    wrong = [{**change, "note": {**change["note"], "times": 0.26}} for change in changes]
    assert not run_json("replay", kept(server, made, change_log, wrong)["kept"], code=5)["same_to_the_bit"]
    # One bit of one drive: the comparison is able to fail.
    frame = TickFrame(log, 0x86)
    check_damaged_logs(server, made, log)
    assert not run_json("replay", kept(server, made, frame.with_one_bit_changed(20 + 4))["kept"], code=5)["same_to_the_bit"]
    # A part of the log that is missing is a loss in the session.
    assert run_json("replay", kept(server, made, frame.left_out())["kept"], code=5)["lost_ticks"] == 64


def check_sound(server):
    """The whole chain against a closed form: 5 um at 50 and 100 Hz, and as velocity times f / 200 Hz."""
    index = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "sine")
    made = server.json(f"/texture/{index}")["made"]
    for kind, changes in (("tone", ()), ("velocity", ()), ("tone", [(made, 0.5)])):
        sounds = np.frombuffer(device_log(server, made, 1, 1, kind, changes), "<f4").reshape(2, -1)
        for part, hz, times in zip(sounds, (50, 100), (1, changes[0][1] if changes else 1)):
            steady = part[int(0.16 * 16000):int(0.3 * 16000)]  # whole periods
            t = np.arange(len(steady)) / 16000
            amplitude = 2 * abs(np.mean(steady * np.exp(-2j * np.pi * hz * t)))
            # 5 um of full 10 um, through the Butterworth filters of 15 and 500 Hz.
            filters = 1 / np.sqrt((1 + (15 / hz) ** 4) * (1 + (hz / 500) ** 4))
            expected = times * 0.5 * filters * (hz / 200 if kind == "velocity" else 1)
            # The onset of 20 ms through the high-pass has decayed to exp(-2 pi 15 0.71 0.14) = 1e-4; the inverse's error
            # is -72 dB, that of the modelled tray 1e-4.
            assert abs(amplitude / expected - 1) < 1e-3, (kind, hz, amplitude, expected)
            rest = steady - 2 * np.real(np.mean(steady * np.exp(-2j * np.pi * hz * t)) * np.exp(2j * np.pi * hz * t))
            print(f"{kind} {hz} Hz: amplitude {amplitude / expected:.4f} of the exact one, rest {20 * np.log10(np.std(rest) / amplitude):.0f} dB")


def check_damaged_logs(server, made, log):
    """Any log is an error or a session; afterwards the server serves."""
    draw = random.Random(34)
    for _ in range(40):
        damaged = bytearray(log[:draw.randrange(1, 20_000)])
        for _ in range(draw.choice((0, 1, 20))):
            damaged[draw.randrange(len(damaged))] = draw.randrange(256)
        page = server.page()
        assert page.ask(request="begin", made=made)["ok"]
        page.send(damaged[:16384])
        answer = page.ask(request="keep")
        assert answer["ok"] or answer["error"]["fault"] in (3, 4), answer
        if answer["ok"]:
            run("validate", answer["kept"])
    assert server.ask("/").status == 200


def check_command():
    run("live", "nowhere", code=3)
    run("live", "folder", "--transducer", "nothing", code=3)
    run("live", "folder", "--port", "70000", code=2)


def live_page():
    make_textures()
    check_command()
    with live("folder") as server:
        run("live", "folder", "--port", server.port, code=5)  # taken
        with live("folder") as second:
            assert second.port != server.port and second.token != server.token
        check_access(server)
        check_headers(server)
        check_sizes(server)
        made, odd_made = check_textures(server)
        check_protocol(server, made)
        check_changes(server, made, odd_made)
        fetch_page(server, ("answers.js", "cells.js", "compare.js", "core.js", "engine.js", "finger.js", "library.js", "shape.js", "strip.js", "core.wasm"),
                   ("live_device.mjs", "live_draws.mjs", "live_pages.mjs"))
        check_spectrogram(server)
        check_bits(server, made, odd_made)
        check_sound(server)
        rec = check_recordings(server)
        check_shapes(server, server.json(f"/texture/{next(row['index'] for row in server.json('/textures')['textures'] if row['name'] == 'C')}")["made"])
        check_jobs(server, rec)
    assert not processes_with("rec-trade.html"), "a job goes on"
    assert not [path for path in pathlib.Path("folder").iterdir() if path.name.startswith(".")], "temporary files stay"


if __name__ == "__main__":
    refused = subprocess.run([COMMAND, "live", "/nonexistent", "--json"], capture_output=True, text=True)
    if refused.returncode == 5:  # built without libwebsockets, clang-16 or lld-16
        assert "libwebsockets-dev" in refused.stdout + refused.stderr, refused
        print("skipped: built without the page")
        sys.exit(77)
    in_folder(live_page)
