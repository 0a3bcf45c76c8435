#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactograph live in Debian's Chromium, by mouse and by keyboard: it plays, sounds, keeps, and the kept session is the
same to the bit; every control has a name, texts have their contrast, the console stays empty.

With --pictures FOLDER it writes screenshots (wide and narrow, light and dark) instead.
"""
import contextlib
import json
import pathlib
import shutil
import sys
import time

import netCDF4
import numpy as np
from chromium import browser
from live_client import live
from run_daemon import Client, daemon, prepare_files
from tacto import in_folder, run, run_json

ODD_NAME = "<img src=x onerror=alert(1)>"

# Least contrast of all texts that are seen, over the nearest opaque ground behind them (WCAG 2.1).
CONTRAST = """(() => {
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const rgba = (text) => { const n = text.match(/[\\d.]+/g).map(Number); return n.length === 3 ? [...n, 1] : n; };
  const ground = (e) => { for (; e; e = e.parentElement) { const c = rgba(getComputedStyle(e).backgroundColor); if (c[3] === 1) return c; } return [255, 255, 255, 1]; };
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  let least = {ratio: 99};
  for (let node; (node = texts.nextNode());) {
    const e = node.parentElement;
    if (node.textContent.trim() === '' || e.getClientRects().length === 0) continue;
    const [a, b] = [light(rgba(getComputedStyle(e).color)), light(ground(e))].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < least.ratio) least = {ratio, text: node.textContent.trim().slice(0, 40)};
  }
  return least;
})()"""


def choose_by_keys(chrome, name):
    chrome.value(f"[...document.querySelectorAll('#textures button')].find((b) => b.firstChild.textContent === {json.dumps(name)}).focus()")
    chrome.key("Enter")
    chrome.wait(f"document.getElementById('strip-title').textContent === {json.dumps(name)}")


def strip_on(chrome):
    """The left end, the middle of the height and the width of the strip's picture, which is scrolled into view."""
    return chrome.value("(() => { const s = document.getElementById('map'); s.scrollIntoView({block: 'center'}); const r = s.getBoundingClientRect(); "
                        "return [r.x, r.y + r.height / 2, r.width]; })()")


def stroke_by_mouse(chrome):
    x, y, width = strip_on(chrome)
    chrome.mouse("mousePressed", x + 0.2 * width, y)
    for i in range(60):
        chrome.mouse("mouseMoved", x + (0.2 + 0.01 * i) * width, y)
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) > 25")  # of 35 mm
    assert chrome.text("state-word") == "playing"
    chrome.mouse("mouseMoved", x + 0.5 * width, y - 400)  # leaving the strip lifts the finger
    chrome.wait("document.getElementById('state-word').textContent === 'playing, finger lifted'")
    chrome.mouse("mouseReleased", x + 0.5 * width, y - 400)


def stroke_by_touch(chrome):
    x, y, width = strip_on(chrome)
    def touch(kind, *at):
        chrome.ask("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": part, "y": y} for part in at])
    touch("touchStart", x + 0.9 * width)
    for i in range(60):
        touch("touchMove", x + (0.9 - 0.01 * i) * width)
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) < 12 && document.getElementById('place').textContent.startsWith('finger touches')")
    touch("touchEnd")
    chrome.wait("document.getElementById('state-word').textContent === 'playing, finger lifted'")


def check_scale(chrome):
    """Millimetres per pixel are shown and set: then the pointer moves the finger by as much."""
    choose_by_keys(chrome, ODD_NAME)
    choose_by_keys(chrome, "C")  # its title appears once it is chosen
    _, _, width = strip_on(chrome)
    shown = chrome.value("Number(document.getElementById('scale').value)")
    length_mm = chrome.value("Number(document.getElementById('strip').ariaValueMax)")
    assert abs(shown * width / length_mm - 1) < 1e-3, (shown, width, length_mm)  # five digits, upwards
    chrome.value("(() => { const s = document.getElementById('scale'); s.value = 0.01; s.dispatchEvent(new Event('input')); })()")
    x, y, width = strip_on(chrome)
    assert abs(chrome.value("Number(document.getElementById('strip').ariaValueMax)") - 0.01 * width) < 0.01
    chrome.mouse("mousePressed", x + 100, y)
    chrome.mouse("mouseMoved", x + 300, y)
    chrome.wait("Math.abs(Number(document.getElementById('strip').ariaValueNow) - 3) < 0.051")  # 300 pixels; shown to 0.1 mm
    chrome.mouse("mouseReleased", x + 300, y)
    chrome.click("stop")
    chrome.wait("document.getElementById('state-word').textContent.startsWith('stopped')")


# Pictures of the tray's trace that are drawn within a second.
PICTURES = """new Promise((done) => {
  const own = CanvasRenderingContext2D.prototype.clearRect;
  let drawn = 0;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) { drawn += this.canvas.id === 'trace'; own.apply(this, box); };
  setTimeout(() => { CanvasRenderingContext2D.prototype.clearRect = own; done(drawn); }, 1000);
})"""


def check_calm(chrome):
    """With prefers-reduced-motion pictures move at most every 250 ms."""
    chrome.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
    assert 1 <= chrome.value(PICTURES) <= 5
    chrome.ask("Emulation.setEmulatedMedia", features=[])
    assert chrome.value(PICTURES) > 5


def keep(chrome, least_ticks):
    chrome.click("keep")
    chrome.wait("document.getElementById('kept').textContent.startsWith('Kept: ')")
    path = chrome.text("kept").removeprefix("Kept: ").split(", ")[0]
    report = run_json("replay", path)
    assert report["same_to_the_bit"] and report["ticks_compared"] > least_ticks and "lost_ticks" not in report, report
    return path


def drive_peak(path):
    run("session", path, "-o", "ticks.csv", "--force")
    lines = pathlib.Path("ticks.csv").read_text().splitlines()
    column = lines[0].split(",").index("drive_v")
    return max(abs(float(line.split(",")[column])) for line in lines[1:])


def check_playing(chrome):
    choose_by_keys(chrome, ODD_NAME)
    choose_by_keys(chrome, "C")
    assert chrome.value("document.querySelectorAll('#textures img, h2 img').length") == 0
    chrome.click("sound")
    assert chrome.value("document.getElementById('sound').getAttribute('aria-pressed')") == "true"
    stroke_by_mouse(chrome)
    # 7 to 25 mm at the fastest, 1 m/s: 18 ms. Volts: a stroke of C needs several.
    assert drive_peak(keep(chrome, 0.018 * 16000)) > 0.1
    stroke_by_touch(chrome)
    chrome.click("stop")
    chrome.wait("document.getElementById('state-word').textContent.startsWith('stopped')")
    # By keys: 50 mm/s to the right end, and back.
    chrome.value("document.getElementById('strip').focus()")
    chrome.key("Home")
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) < 0.2")
    chrome.key("ArrowRight", kinds=("rawKeyDown",))
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) > 10")
    chrome.key("ArrowRight", kinds=("keyUp",))
    chrome.wait("document.getElementById('place').textContent.endsWith(' 0 mm/s')")
    chrome.key("Escape")
    chrome.wait("document.getElementById('state-word').textContent.startsWith('stopped')")
    assert drive_peak(keep(chrome, 0.19 * 16000)) > 0.1  # 0.2 to 10 mm at 50 mm/s
    chrome.value("document.querySelector('#strokes button[data-speed=\"100\"]').click()")
    chrome.wait("document.getElementById('state-word').textContent === 'playing, finger lifted' && Number(document.getElementById('strip').ariaValueNow) > 30")
    chrome.click("stop")
    chrome.wait("document.getElementById('state-word').textContent.startsWith('stopped')")


def check_compare(chrome):
    """A and B by keys while the finger moves; the kept session has both changes."""
    choose_by_keys(chrome, "C")
    chrome.value(f"[...document.querySelectorAll('#textures li')].find((i) => i.querySelector('.texture').firstChild.textContent === {json.dumps(ODD_NAME)}).querySelector('.row button').focus()")
    chrome.key("Enter")
    chrome.wait("!document.getElementById('side-B').disabled && document.getElementById('compare-words').textContent.includes('RMS')")
    chrome.value("document.getElementById('equal').focus()")
    chrome.key(" ")
    assert chrome.value("document.getElementById('equal').checked") and "its default" in chrome.text("compare-words")  # a copy: equal before
    chrome.value("document.getElementById('strip').focus()")
    chrome.key("Home")
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) < 0.2")
    chrome.value("document.getElementById('key-speed').value = '20'")
    chrome.key("ArrowRight", kinds=("rawKeyDown",))
    # The frames of both changes are fetched when it begins to play; a key that comes before its frames waits for them.
    chrome.wait("performance.getEntriesByType('resource').filter((e) => e.name.includes('/change/')).length >= 2")
    for key, other in (("b", "a"), ("a", "b")):
        place = chrome.value("Number(document.getElementById('strip').ariaValueNow)")
        chrome.wait(f"Number(document.getElementById('strip').ariaValueNow) > {place} + 6")  # 300 ms: after the frames' parts and the fade of 50 ms
        chrome.key(key)
        chrome.wait(f"document.getElementById('side-{key.upper()}').ariaPressed === 'true' && document.getElementById('side-{other.upper()}').ariaPressed === 'false'")
    chrome.wait(f"Number(document.getElementById('strip').ariaValueNow) > {place} + 12")
    chrome.key("ArrowRight", kinds=("keyUp",))
    path = keep(chrome, 0.85 * 16000)  # 18 mm at 20 mm/s
    chrome.value("document.getElementById('key-speed').value = '50'")
    events = [row["event"] for row in run_json("session", path)["events"]]
    assert len([event for event in events if event.startswith("texture changed to ")]) == 2, events
    # B at rest: it plays from the next touch on, as the texture of the session.
    chrome.value("document.getElementById('side-B').focus()")
    chrome.key("Enter")
    chrome.wait(f"document.getElementById('strip-title').textContent === {json.dumps(ODD_NAME)}")
    chrome.value("document.getElementById('strip').focus()")
    chrome.key("Home")  # the place before may be beyond 30 mm
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) < 0.2")
    chrome.value("document.querySelector('#strokes button[data-speed=\"100\"]').click()")
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) > 30")
    assert pathlib.Path(keep(chrome, 0.29 * 16000)).name.startswith(ODD_NAME)


def check_shape(chrome):
    """The texture is stretched by keys while the finger moves, kept in a session, saved; and replaced by a computed one."""
    choose_by_keys(chrome, "C")
    assert chrome.value("document.getElementById('shape-save').disabled")
    chrome.value("document.querySelector('#strokes button[data-speed=\"20\"]').click()")
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) > 2")
    chrome.value("document.getElementById('shape-stretch').focus()")
    for _ in range(20):
        chrome.key("ArrowRight")
    assert chrome.value("document.getElementById('shape-stretch').ariaValueText") == "1.15 ×"
    chrome.wait("document.getElementById('shape-plays').textContent.startsWith('Plays: stretch 1.15') && !document.getElementById('shape-plays').textContent.includes('on its way')")
    assert chrome.text("strip-title") == "C-stretched"
    place = chrome.value("Number(document.getElementById('strip').ariaValueNow)")
    chrome.wait(f"Number(document.getElementById('strip').ariaValueNow) > {min(place + 6, 34)}")
    path = keep(chrome, 0.3 * 16000)
    assert any(row["event"].startswith("texture changed to ") for row in run_json("session", path)["events"])
    press(chrome, "shape-save")
    chrome.wait("document.getElementById('shape-saved').textContent.startsWith('Saved: ')")
    file = pathlib.Path(chrome.text("shape-saved").removeprefix("Saved: "))
    assert json.loads(file.read_text())["transform"]["steps"][0]["factor"] == 1.15
    for ending in (".json", ".wav"):
        file.with_suffix(ending).unlink()
    chrome.value("(() => { const k = document.getElementById('shape-kind'); k.value = 'noise'; k.dispatchEvent(new Event('input', {bubbles: true})); })()")
    chrome.wait("document.getElementById('shape-plays').textContent.includes('octave') && document.getElementById('strip-title').textContent === 'noise'")


def check_jobs(chrome, server):
    chrome.ask("Page.navigate", url=server.address.split("?")[0] + "jobs.html")
    chrome.wait("document.getElementById('first')?.options.length === 3 && document.getElementById('now').textContent !== ''")
    chrome.value("document.getElementById('verb').value = 'compare'")
    press(chrome, "run")
    chrome.wait("document.querySelectorAll('#jobs li').length === 1 && document.querySelector('#jobs a').hidden === false")
    assert chrome.value("document.querySelector('#jobs strong').textContent").endswith("done") and chrome.text("message") == ""
    check_names(chrome)
    check_looks(chrome)
    page = server.ask("/" + chrome.value("document.querySelector('#jobs a').getAttribute('href')"))
    assert page.status == 200 and page.headers["content-security-policy"].startswith("sandbox;")
    chrome.ask("Page.navigate", url=server.address.split("?")[0] + "result/0")
    chrome.wait("document.readyState === 'complete' && document.querySelectorAll('h1, h2').length > 0")


def check_list(chrome):
    names = "[...document.querySelectorAll('#textures .texture')].map((b) => b.firstChild.textContent)"
    chrome.value("document.getElementById('search').focus()")
    chrome.ask("Input.insertText", text="onerror")
    chrome.wait(f"{names}.length === 1")
    assert chrome.value(names) == [ODD_NAME] and chrome.text("count").startswith("1 of 2")
    chrome.value("document.getElementById('search').select()")
    chrome.ask("Input.insertText", text="none of them")
    chrome.wait(f"{names}.length === 0")
    chrome.value("document.getElementById('search').select()")
    chrome.ask("Input.insertText", text=" ")
    chrome.wait(f"{names}.length === 2")
    # The picture of each is drawn once it is seen.
    chrome.wait("[...document.querySelectorAll('#textures canvas')].every((c) => c.toDataURL() !== "
                "Object.assign(document.createElement('canvas'), {width: c.width, height: c.height}).toDataURL())")


def check_explorer(chrome, server):
    """The number under the cross-hair is that of the verb's file, by keys and by mouse; zoom; an export."""
    run("spectrogram", "folder/C", "-o", "C.nc")
    with netCDF4.Dataset("C.nc") as file:
        density, positions, frequencies = (np.array(file[name]) for name in ("density", "position", "spatial_frequency"))
    index = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "C")
    chrome.ask("Page.navigate", url=f"{server.address.split('?')[0]}explorer.html#{index}")
    chrome.wait("document.getElementById('cell')?.textContent.startsWith('position')")

    def cell():
        words = chrome.text("cell")
        at = (np.abs(positions - float(words.split()[1])).argmin(), np.abs(frequencies - float(words.split("frequency ")[1].split()[0])).argmin())
        assert np.float32(words.split(" N² mm")[0].split()[-1]) == density[at], (words, density[at])
        return at

    first = cell()
    chrome.value("document.getElementById('plot').focus()")
    for key, step in (("ArrowRight", (1, 0)), ("ArrowUp", (0, 1)), ("ArrowLeft", (-1, 0))):
        before = cell()
        chrome.key(key)
        assert np.array_equal(np.subtract(cell(), before), step), key
    x, y = chrome.value("(() => { const r = document.getElementById('plot').getBoundingClientRect(); return [r.x + 0.4 * r.width, r.y + 0.3 * r.height]; })()")
    chrome.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
    assert cell() != first
    view = "['from', 'to', 'low', 'high'].map((id) => Number(document.getElementById(id).value))"
    whole = chrome.value(view)
    chrome.key("+")
    part = chrome.value(view)
    assert part[0] >= whole[0] and part[1] - part[0] < 0.6 * (whole[1] - whole[0]) and part[3] - part[2] < whole[3] - whole[2], part
    chrome.key("0")
    assert chrome.value(view) == whole
    check_names(chrome)
    check_looks(chrome)
    # Other units and spacings are drawn, too; an error would be in the console.
    pictures = set()
    for name, value in (("unit", "mm"), ("unit", "Hz"), ("spacing", "linear"), ("unit", "1/mm"), ("colours", "grey"), ("range", "30")):
        chrome.value(f"(() => {{ const e = document.getElementById('{name}'); e.value = '{value}'; e.dispatchEvent(new Event('input')); return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))); }})()")
        pictures.add(chrome.value("document.getElementById('heat').toDataURL()"))
    assert len(pictures) == 6, "each changes the picture"
    press(chrome, "part")
    chrome.value("document.querySelector('#exports button[data-form=\"png\"]').click()")
    chrome.wait("document.getElementById('exported').textContent === 'C.png: all'")


def check_without_sound(chrome):
    """Without AudioContext the engine runs on a timer, and the page says so."""
    script = chrome.ask("Page.addScriptToEvaluateOnNewDocument", source="delete window.AudioContext")["identifier"]
    chrome.ask("Page.reload")
    chrome.wait("document.readyState === 'complete' && document.querySelectorAll('#textures li').length > 0")
    choose_by_keys(chrome, "C")
    chrome.value("document.querySelector('#strokes button[data-speed=\"100\"]').click()")
    chrome.wait("Number(document.getElementById('strip').ariaValueNow) > 34.5")
    assert "no sound device" in chrome.text("state-word")
    keep(chrome, 0.34 * 16000)  # 34.5 mm at 100 mm/s
    chrome.ask("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def check_names(chrome):
    roles = ("button", "slider", "checkbox", "combobox", "spinbutton", "image", "link", "textbox")
    for node in chrome.ask("Accessibility.getFullAXTree")["nodes"]:
        if not node["ignored"] and node["role"]["value"] in roles:
            assert node.get("name", {}).get("value"), node
    # Everything is reached by Tab, and the focus is visible.
    chrome.value("document.activeElement.blur()")
    seen = set()
    for _ in range(100):
        chrome.key("Tab")
        where, outline = chrome.value("[document.activeElement.id || document.activeElement.ariaLabel || document.activeElement.textContent, parseFloat(getComputedStyle(document.activeElement).outlineWidth)]")
        if where in seen:
            break
        seen.add(where)
        assert outline >= 2, where
    reachable = chrome.value("[...document.querySelectorAll('button, input, select, [tabindex=\"0\"], summary')].filter((e) => !e.matches(':disabled')).map((e) => e.id || e.ariaLabel || e.textContent)")
    assert set(reachable) <= seen, set(reachable) - seen


def check_looks(chrome):
    for dark in ("dark", "light"):
        chrome.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": dark}])
        least = chrome.value(CONTRAST)
        assert least["ratio"] >= 4.5, least
    chrome.ask("Emulation.setDeviceMetricsOverride", width=400, height=900, deviceScaleFactor=1, mobile=False)
    assert chrome.value("document.documentElement.scrollWidth") <= 400
    # Stop is always visible, also at the end of the page.
    chrome.value("scrollTo(0, document.documentElement.scrollHeight)")
    assert chrome.value("(() => { const e = document.getElementById('stop'); if (e === null) return true; const r = e.getBoundingClientRect(); "
                        "return document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2) === e; })()")
    chrome.ask("Emulation.clearDeviceMetricsOverride")
    chrome.wait("innerWidth > 400")


STROKES = "0,0.004\n0.6,0.034\n1.2,0.004\n"   # repeated without end
JUMP = "0,0.004\n3,0.034\n3.00001,0.004\n"


@contextlib.contextmanager
def device_page(chrome, server, path, **changed):
    """A daemon with a simulated finger, and the page of the device."""
    prepare_files(**{"device": "sim:paced=1", **changed})
    pathlib.Path("path.csv").write_text("time_s,position_m\n" + path)
    with daemon():
        chrome.ask("Page.navigate", url=server.address.split("?")[0] + "daemon.html")
        chrome.wait("document.getElementById('state-word')?.textContent === 'idle' && document.querySelectorAll('#texture option').length > 0")
        yield


def press(chrome, name):
    """By keyboard."""
    chrome.wait(f"!document.getElementById('{name}').disabled")
    chrome.value(f"document.getElementById('{name}').focus()")
    chrome.key("Enter")


def state(chrome, word):
    chrome.wait(f"document.getElementById('state-word').textContent === '{word}' && document.getElementById('state').dataset.state === '{word}'")


def play_on_device(chrome):
    chrome.value("(() => { const t = document.getElementById('texture'); t.value = [...t.options].find((o) => o.text === 'oak').value; })()")
    for name, word in (("load", "idle"), ("arm", "armed"), ("play", "playing")):
        press(chrome, name)
        state(chrome, word)


def check_device(chrome, server):
    with device_page(chrome, server, STROKES):
        play_on_device(chrome)
        assert chrome.text("loaded") == "oak" and "(simulated)" in chrome.text("device"), chrome.text("device")
        chrome.wait("/at [0-9.]+ Hz/.test(document.getElementById('spectrum-words').textContent)")
        places = set()
        while len(places) < 5:  # the finger moves
            places.add(chrome.text("place").split(",")[0])
        client = Client()
        before = client.must(request="status")["gain_times_default"]
        chrome.value("document.getElementById('gain').focus()")
        for _ in range(4):
            chrome.key("ArrowLeft")
        chrome.wait("document.getElementById('gain-words').textContent.startsWith('asked 0.80, effective 0.80')")
        assert before == 1 and abs(client.must(request="status")["gain_times_default"] - 0.8) < 1e-9
        chrome.value("document.getElementById('shape-stretch').focus()")
        for _ in range(10):
            chrome.key("ArrowRight")
        chrome.wait("document.getElementById('shape-plays').textContent.startsWith('Plays: stretch 1.07') && !document.getElementById('shape-plays').textContent.includes('on its way') && document.getElementById('loaded').textContent === 'oak-stretched'")
        assert abs(client.must(request="status")["gain_times_default"] - 0.8) < 1e-9
        check_names(chrome)
        check_looks(chrome)
        press(chrome, "pause")
        shown = chrome.text("place")
        time.sleep(0.5)
        assert chrome.text("place") == shown and chrome.text("state-word") == "playing"
        trace = "document.getElementById('trace').toDataURL()"
        before = chrome.value(trace)
        chrome.value("(() => { const s = document.getElementById('span'); s.value = '0.5'; s.dispatchEvent(new Event('input')); })()")
        assert chrome.text("trace-words").startswith("last 0.5 s before the pause") and chrome.value(trace) != before  # zoom in a pause
        press(chrome, "pause")
        chrome.key("Escape")
        state(chrome, "armed")
        press(chrome, "play")
        state(chrome, "playing")
        chrome.ask("Page.navigate", url="about:blank")  # the page is closed
        assert client.wait_for("idle")["why"] == "the client that armed has closed its connection"
        chrome.ask("Page.navigate", url=server.address.split("?")[0] + "daemon.html")
        chrome.wait("document.getElementById('state-word')?.textContent === 'idle'")
    chrome.wait("document.getElementById('state-word').textContent.startsWith('lost')")
    chrome.wait("document.getElementById('message').textContent.includes('tactographd')")  # after the next try to connect
    with daemon():
        state(chrome, "idle")  # without a reload


def check_recorder(chrome):
    """By keyboard; the sensor is silent."""
    chrome.value("document.getElementById('record-name').value = 'oak'")
    press(chrome, "record-begin")
    chrome.wait("document.getElementById('record-problem').textContent.includes('has not changed')")
    press(chrome, "record-mark")
    chrome.wait("document.getElementById('record-said').textContent.startsWith('mark')")
    check_names(chrome)
    check_looks(chrome)
    press(chrome, "record-end")
    chrome.wait("document.getElementById('record-said').textContent.startsWith('Recorded: ')")
    run("validate", chrome.text("record-said").split(": ")[1].split(".wav")[0])


def check_fault(chrome, server):
    with device_page(chrome, server, JUMP):
        play_on_device(chrome)
        state(chrome, "fault")
        fault = chrome.text("fault")
        assert fault.startswith("fault: the encoder jumped") and "disarm and arm again" in fault, fault
        press(chrome, "disarm")
        state(chrome, "idle")
        assert chrome.text("fault") == ""


def write_scenes(folder):
    spring = {"type": "spring", "stiffness_n_per_m": {"value": 100, "slider": {"from": 0, "to": 200}}, "centre_x_m": 0, "centre_y_m": 0}
    bench = {"name": "bench", "place": {"x_m": 0, "y_m": 0}, "size": {"width_m": 0.19, "height_m": 0.19}, "layers": [spring]}
    ball = {"name": "ball", "shape": "sphere", "place": {"x_m": 0, "y_m": 0, "z_m": 0}, "radius_m": 0.03, "stiffness_n_per_m": 600}
    for name, members in (("bench", {"patches": [bench]}), ("ball", {"pieces": [ball]})):
        pathlib.Path(f"{folder}/{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", **members}))
    axes = [{"name": name, "mass_kg": 0.1, "viscous_n_s_per_m": 1, "coulomb_n": 0, "encoder_step_m": 1e-5, "travel_m": [-0.1, 0.1], "peak_force_n": 5, "continuous_force_n": 5} for name in "xy"]
    pathlib.Path(f"{folder}/own.device.json").write_text(json.dumps({"kind": "device", "version": "1.0", "name": "own", "axes": axes, "peak_force_n": 5,
                                                                     "continuous_force_n": 5, "slew_n_per_s": 5000, "delay_s": 0, "rates_hz": [500]}))


def open_scene(chrome, server, name):
    chrome.ask("Page.navigate", url=server.address.split("?")[0] + "scene.html")
    chrome.wait("document.querySelectorAll('#scenes a canvas').length === 2")  # with their pictures
    chrome.value(f"[...document.querySelectorAll('#scenes a')].find((a) => a.firstChild.textContent === '{name}').focus()")
    chrome.key("Enter")
    chrome.wait(f"document.getElementById('scene-title').textContent === '{name}' && document.getElementById('picture').width > 100")


def force(chrome):
    """Newtons along each axis, as the page shows them."""
    return [float(part.split()[1]) for part in chrome.text("force").split(": ")[1].split(" N;")[0].split(", ")]


def into_the_ball(chrome):
    """From above, in the section from the front; the pointer stays pressed. Returns the box of the picture."""
    box = chrome.value("(() => { const v = document.getElementById('view'); v.scrollIntoView({block: 'center'}); const r = v.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    chrome.mouse("mousePressed", box[0] + 0.5 * box[2], box[1] + 0.1 * box[3])
    for i in range(30):
        chrome.mouse("mouseMoved", box[0] + 0.5 * box[2], box[1] + (0.1 + 0.01 * i) * box[3])
    chrome.wait("/ z [1-9]/.test(document.getElementById('force').textContent)")  # N, upwards
    return box


def check_scenes(chrome, server):
    """By keys, a spring whose slider has moved; by mouse into a ball, outside of which the ghost stays."""
    open_scene(chrome, server, "bench")
    chrome.value("document.getElementById('view').focus()")
    chrome.key("ArrowRight", ["rawKeyDown"])
    chrome.wait("/hand at x [1-9][0-9]/.test(document.getElementById('place').textContent)")  # 10 mm
    chrome.key("ArrowRight", ["keyUp"])
    chrome.value("document.querySelector('#sliders input').focus()")
    for _ in range(5):
        chrome.key("ArrowLeft")
    chrome.wait("document.querySelector('#sliders output').textContent === '95, in effect'")
    chrome.wait("document.getElementById('place').textContent.endsWith(', 0 mm/s')")
    time.sleep(0.6)  # the figures are those of the slider and of the rest
    x_m = 1e-3 * float(chrome.text("place").split("x ")[1].split(",")[0])
    assert abs(force(chrome)[0] + 95 * x_m) < 95 * 1e-5 + 1e-3 and force(chrome)[1] == 0, (chrome.text("force"), x_m)
    check_names(chrome)
    check_looks(chrome)
    keep(chrome, 0.2 * 4000)  # 10 mm at 50 mm/s
    # On the device of the folder.
    chrome.value("(() => { const d = document.getElementById('device'); d.value = [...d.options].find((o) => o.text === 'own').value; d.dispatchEvent(new Event('input')); })()")
    chrome.wait("document.getElementById('notes').textContent.startsWith('Device: own, 500 ticks')")
    chrome.value("document.getElementById('view').focus()")
    chrome.key("ArrowUp", ["rawKeyDown"])
    chrome.wait("/y [1-9][0-9]/.test(document.getElementById('place').textContent)")
    chrome.key("ArrowUp", ["keyUp"])
    keep(chrome, 0.2 * 500)
    open_scene(chrome, server, "ball")
    box = into_the_ball(chrome)
    assert chrome.text("state-word") == "playing" and "0.000 from the hand" not in chrome.text("ghost"), chrome.text("ghost")
    chrome.mouse("mouseReleased", box[0] + 0.5 * box[2], box[1] + 0.5 * box[3])
    chrome.value("document.getElementById('view').focus()")
    chrome.key("PageUp")  # across the section
    check_names(chrome)
    check_looks(chrome)
    chrome.key("Escape")
    chrome.wait("document.getElementById('state-word').textContent === 'stopped'")
    keep(chrome, 100)


def make_textures():
    run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "rec")
    run("spatial", "rec", "-o", "folder/C", "--stroke", "1")
    for ending in (".texture.wav", ".texture.json"):
        shutil.copy(f"folder/C{ending}", f"folder/{ODD_NAME}{ending}")
    for ending in (".wav", ".json"):
        shutil.copy(f"rec{ending}", f"folder/rec{ending}")


def live_in_chromium():
    make_textures()
    write_scenes("folder")
    with live("folder") as server, browser(server.address) as chrome:
        assert chrome.value("location.search") == "", "the token stays out of the address"
        check_playing(chrome)
        check_scale(chrome)
        check_calm(chrome)
        check_compare(chrome)
        check_shape(chrome)
        check_list(chrome)
        check_names(chrome)
        check_looks(chrome)
        check_without_sound(chrome)
        check_explorer(chrome, server)
        check_jobs(chrome, server)
        check_scenes(chrome, server)
        assert chrome.console == [], chrome.console
    prepare_files()
    with live(".", "--socket", "control", "-d", "sim:noise=off,finger=up,paced=1") as server, browser(server.address) as chrome:
        check_device(chrome, server)
        check_recorder(chrome)
        check_fault(chrome, server)
        assert chrome.console == [], chrome.console


def take_pictures(chrome, folder, name):
    """The README of analysis shows two of the four."""
    for width in (1300, 400):
        for dark in (False, True):
            chrome.picture(folder / f"{name}-{width}-{'dark' if dark else 'light'}.webp", width, dark)


def pictures(folder):
    run("demo", "-o", "demo")
    write_scenes("demo")
    with live("demo") as server, browser(server.address) as chrome:
        choose_by_keys(chrome, "C")
        stroke_by_mouse(chrome)
        chrome.value("document.querySelector('#strokes button[data-speed=\"20\"]').click()")
        time.sleep(1)
        take_pictures(chrome, folder, "live")
        index = next(row["index"] for row in server.json("/textures")["textures"] if row["name"] == "C")
        chrome.ask("Page.navigate", url=f"{server.address.split('?')[0]}explorer.html#{index}")
        chrome.wait("document.getElementById('cell')?.textContent.startsWith('position')")
        take_pictures(chrome, folder, "live-explorer")
        chrome.ask("Page.navigate", url=server.address.split("?")[0] + "jobs.html")
        chrome.wait("document.getElementById('first')?.options.length > 2")
        press(chrome, "run")
        chrome.wait("document.querySelector('#jobs a')?.hidden === false")
        take_pictures(chrome, folder, "live-jobs")
        open_scene(chrome, server, "ball")
        into_the_ball(chrome)
        take_pictures(chrome, folder, "live-scene")
    prepare_files()
    on_host = {"loop": "host", "device": "sim:rate=2kHz", "most_late_percent": 100}
    with live(".", "--socket", "control") as server, browser(server.address) as chrome, device_page(chrome, server, STROKES, **on_host):
        play_on_device(chrome)
        time.sleep(2)
        take_pictures(chrome, folder, "live-device")


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--pictures":
        target = pathlib.Path(sys.argv[2]).resolve()
        in_folder(lambda: pictures(target))
    else:
        in_folder(live_in_chromium)
