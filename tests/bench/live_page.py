#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of tactograph live in Debian's Chromium, without a processor for graphics: size, time until a page is ready,
frames of a zoom, how late ticks and sliders are, and the memory that ten minutes take.

usage: live_page.py TACTOGRAPH TACTOGRAPHD [--minutes 10] [--only ready,zoom,ticks,memory]

Figures are printed, not judged: a machine with other work has other ones, so each line says the load. Everything is
simulated: the device, its finger, and the spectrogram of the zoom.
"""
import argparse
import base64
import json
import os
import pathlib
import statistics
import struct
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "analysis"), str(HERE.parent / "end-to-end")]

LOADS, ZOOMS, SLIDES, TICKS_S = 7, 5, 15, 20  # of which the median counts; seconds

# Every page: when it is ready (ms after the navigation began).
READY = {
    "/": "document.querySelectorAll('#textures li').length > 0",
    "scene.html": "document.querySelectorAll('#scenes li').length > 0",
    "explorer.html": "document.getElementById('cell')?.textContent.startsWith('position')",
    "daemon.html": "document.querySelectorAll('#texture option').length > 0",
    "jobs.html": "document.querySelectorAll('#first option').length > 0",
}
WHEN_READY = """(() => {
  const look = () => { if (%s) window.readyAfter_ms = performance.now(); else setTimeout(look, 1); };
  addEventListener('DOMContentLoaded', look);
})()"""

# 1,000 windows of 1,500 frequencies with formants and the limits of a band, in place of the server's answers.
SPECTROGRAM = """(() => {
  const rows = 1000, bins = 1500, own = window.fetch;
  const track = (k) => Array.from({length: 950}, (_, i) => ({position_m: 0.005 + 1e-4 * i, frequency_per_m: 1000 * k + 20 * Math.sin(i / 20)}));
  const about = {name: 'noise', made: 0, simulated: true, first_position_m: 0.005, last_position_m: 0.1049, hop_m: 1e-4, rows, bins, frequency_step_per_m: 10,
    level_decade_db: 10, level_factor: 1000, cell_unit: 'N2 mm', level_unit: '1 N^2 mm', start_m: 0, end_m: 0.11, lowest_per_m: 70, window_m: 0.01, resolution_per_m: 172,
    high_db: 20, low_db: -40, speed_mps: 0.05, formants: [1, 2, 3].map((k) => ({from_m: 0.005, to_m: 0.1, frequency_per_m: 1000 * k, level_db: 0, prominence_db: 20, track: track(k)}))};
  let state = 1;
  const cells = Float32Array.from({length: rows * bins}, () => { state = state * 16807 % 2147483647; return 1e-6 + (state / 2147483647) ** 4; });
  const known = Float32Array.from({length: 2 * rows}, (_, i) => (i % 2 === 0 ? 100 + i / 20 : 12000 - i));
  const answers = {spectrogram: JSON.stringify(about), cells: cells.buffer, known: known.buffer};
  window.fetch = (path, ...rest) => { const answer = answers[String(path).split('/')[0]]; return answer === undefined ? own(path, ...rest) : Promise.resolve(new Response(answer)); };
})()"""

# A turn of the wheel in each frame, 20 inwards, 20 outwards; frames a second.
ZOOM = """new Promise((done) => {
  const plot = document.getElementById('plot'), box = plot.getBoundingClientRect(), times = [], FRAMES = %d;
  plot.focus();
  const step = (now_ms) => {
    times.push(now_ms);
    if (times.length > FRAMES) return done({fps: 1e3 * FRAMES / (times.at(-1) - times[0]), cell: document.getElementById('cell').textContent});
    const deltaY = times.length %% 40 < 20 ? -100 : 100;
    plot.dispatchEvent(new WheelEvent('wheel', {deltaY, clientX: box.x + 0.5 * box.width, clientY: box.y + 0.3 * box.height, bubbles: true, cancelable: true}));
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
})"""

# A further connection of the page to the daemon: for each message with ticks when it came, its first and last number, and the
# largest drive.
TICKS = """import('/ticks.js').then(({decodeTicks}) => {
  window.heard = [];
  const socket = new WebSocket(`ws://${location.host}/daemon`);
  socket.onmessage = ({data}) => {
    const now_ms = performance.now(), message = JSON.parse(data);
    if (message.event !== 'ticks') return;
    const {rows} = decodeTicks(message, 1 / 2000);
    window.heard.push({now_ms, from: rows[0].number, to: rows.at(-1).number, peak: Math.max(...rows.map(({value}) => Math.abs(value)))});
    window.heard.splice(0, window.heard.length - 60000);
  };
})"""

# Until the drive is beyond (or below) a value after a slider has moved; ms.
SLIDE = """new Promise((done) => {
  const slider = document.getElementById('%s'), from_ms = performance.now();
  slider.value = %s;
  slider.dispatchEvent(new Event('input', {bubbles: true}));
  const look = () => {
    const found = window.heard.find(({now_ms, peak}) => now_ms > from_ms && peak %s);
    if (found) done(found.now_ms - from_ms);
    else setTimeout(look, 1);
  };
  look();
})"""


def load():
    return f"load {os.getloadavg()[0]:.1f} of {os.cpu_count()}"


def say(text):
    print(f"{text} ({load()})", flush=True)


def median_and_worst(values):
    return f"median {statistics.median(values):.1f}, {min(values):.1f} to {max(values):.1f}"


def measure_ready(chrome, address):
    for page, ready in READY.items():
        script = chrome.ask("Page.addScriptToEvaluateOnNewDocument", source=WHEN_READY % ready)["identifier"]
        chrome.ask("Network.enable")
        chrome.ask("Network.setCacheDisabled", cacheDisabled=True)
        times = []
        for _ in range(LOADS):
            chrome.ask("Page.navigate", url="about:blank")
            chrome.ask("Page.navigate", url=address + page.lstrip("/"))
            chrome.wait("window.readyAfter_ms !== undefined && document.readyState === 'complete'")
            times.append(chrome.value("window.readyAfter_ms"))
        files = chrome.value("['navigation', 'resource'].flatMap((type) => performance.getEntriesByType(type)).filter(({name}) => /([.](js|css|svg|wasm|html)|[/])(#.*)?$/.test(name)).map(({encodedBodySize}) => encodedBodySize)")
        chrome.ask("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
        say(f"{page}: {sum(files) / 1e3:.0f} KB in {len(files)} files (at most 400); ready after ms: {median_and_worst(times)} (at most 1000)")


def measure_zoom(chrome, address):
    script = chrome.ask("Page.addScriptToEvaluateOnNewDocument", source=SPECTROGRAM)["identifier"]
    chrome.ask("Page.navigate", url=address + "explorer.html")
    chrome.wait(READY["explorer.html"])
    assert "1000 windows of 1500" in chrome.text("method")
    chrome.value(ZOOM % 60)  # compiled
    rates = [chrome.value(ZOOM % 300)["fps"] for _ in range(ZOOMS)]
    chrome.ask("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
    say(f"zoom of 1,000 x 1,500 cells, frames a second: {median_and_worst(rates)} (at least 55)")


def play_device(chrome, address):
    chrome.ask("Page.navigate", url=address + "daemon.html")
    chrome.wait("document.getElementById('state-word')?.textContent === 'idle' && document.querySelectorAll('#texture option').length > 0")
    for name, word in (("load", "idle"), ("arm", "armed"), ("play", "playing")):
        chrome.wait(f"!document.getElementById('{name}').disabled")
        chrome.value(f"document.getElementById('{name}').click()")
        chrome.wait(f"document.getElementById('state-word').textContent === '{word}'")


def page_ahead_s(chrome):
    """The page's clock minus Python's, by the fastest of many questions: within half of its 0.2 ms or so."""
    asked = []
    for _ in range(200):
        before_s = time.monotonic()
        page_s = 1e-3 * chrome.value("performance.now()")
        after_s = time.monotonic()
        asked.append((after_s - before_s, page_s - (before_s + after_s) / 2))
    return min(asked)[1]


def hear_daemon(client, heard, seconds):
    """When each payload of ticks came from the daemon's socket, by its last tick."""
    client.must(request="watch", ticks=True)
    until = time.monotonic() + seconds
    while (now := time.monotonic()) < until:
        message = json.loads(client.lines.readline())
        if message.get("event") == "ticks":
            payload = base64.b64decode(message["ticks"])
            heard[struct.unpack_from("<Q", payload)[0] + struct.unpack_from("<I", payload, 16)[0] - 1] = time.monotonic()


def measure_ticks(chrome, address, client):
    play_device(chrome, address)
    chrome.value(TICKS)
    chrome.wait("window.heard?.length > 20")
    ahead_s, socket = page_ahead_s(chrome), {}
    chrome.value("window.heard.length = 0")
    hear_daemon(client, socket, TICKS_S)
    heard = chrome.value("window.heard")
    lost = sum(after["from"] - before["to"] - 1 for before, after in zip(heard, heard[1:]))
    late = sorted(one["now_ms"] - 1e3 * (socket[one["to"]] + ahead_s) for one in heard if one["to"] in socket)
    assert len(late) > 0.5 * len(heard), "both connections get the same payloads"
    at = lambda part: late[int(part * (len(late) - 1))]
    say(f"ticks at 2 kHz to the page, {heard[-1]['to'] - heard[0]['from'] + 1} of them in {len(heard)} messages: ms after a client of the daemon's socket has them p50 {at(0.5):.1f}, "
        f"p99 {at(0.99):.1f} (at most 2; 20), lost {lost}; the page says: {chrome.text('ticks')}")
    peak = statistics.median(one["peak"] for one in heard)
    gains = [chrome.value(SLIDE % ("gain", *turn)) for _ in range(SLIDES) for turn in (("0", f"< {0.1 * peak}"), ("1", f"> {0.5 * peak}")) if time.sleep(0.5) is None]
    say(f"gain slider until the page has ticks with less or more drive, ms: {median_and_worst(gains)} (at most 50)")
    textures = []
    for i in range(SLIDES):
        time.sleep(1)
        textures.append(chrome.value("""new Promise((done) => {
          const slider = document.getElementById('shape-stretch'), from_ms = performance.now(), before = document.getElementById('shape-plays').textContent;
          slider.value = %d;
          slider.dispatchEvent(new Event('input', {bubbles: true}));
          const look = () => { const now = document.getElementById('shape-plays').textContent; if (now !== before && !now.includes('on its way')) done(performance.now() - from_ms); else setTimeout(look, 1); };
          look();
        })""" % (104 + 4 * i)))  # another factor each time
    say(f"texture slider until the device has faded to it and takes the next one, ms: {median_and_worst(textures)} (at most 500)")


# What people do on a page, again and again: once every 2 s. A computer that stalls may end the playback of the daemon.
ACTIONS = {
    "/": "document.querySelector('#strokes button[data-speed=\"20\"]').click()",
    "scene.html": """(() => { const v = document.getElementById('view'), key = window.turn ? 'ArrowLeft' : 'ArrowRight'; v.focus();
      for (const each of ['ArrowLeft', 'ArrowRight']) v.dispatchEvent(new KeyboardEvent('keyup', {key: each, bubbles: true}));
      v.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true})); window.turn = !window.turn; })()""",
    "explorer.html": f"void {ZOOM % 40}",
    "daemon.html": """(() => { const next = {fault: 'disarm', idle: 'arm', armed: 'play'}[document.getElementById('state-word').textContent];
      if (next) return document.getElementById(next).click();
      const g = document.getElementById('gain'); g.value = window.turn ? 1 : 0.8; window.turn = !window.turn; g.dispatchEvent(new Event('input')); })()""",
    "jobs.html": "(() => { window.turns = (window.turns ?? 0) + 1; if (window.turns % 10 === 1) document.getElementById('run').click(); })()",
}
FRAMES = "window.frames_ = 0; (function count() { ++window.frames_; requestAnimationFrame(count); })()"


def heap_mb(page):
    for _ in range(2):
        page.ask("HeapProfiler.collectGarbage")
    heap = page.ask("Runtime.getHeapUsage")
    return (heap["usedSize"] + heap.get("embedderHeapUsedSize", 0) + heap.get("backingStorageSize", 0)) / 1e6


def server_mb(server):
    words = pathlib.Path(f"/proc/{server.process.pid}/status").read_text().split()
    return int(words[words.index("VmRSS:") + 1]) / 1e3


def open_pages(chrome, address):
    pages = {}
    for page in READY:
        one = chrome.open(address + page.lstrip("/"))
        one.wait(READY[page])
        pages[page] = one
    pages["daemon.html"].wait("!document.getElementById('load').disabled")
    pages["daemon.html"].value("document.getElementById('load').click()")
    pages["/"].ask("Runtime.evaluate", expression="document.querySelector('#textures button').click()", userGesture=True)  # so that sound may start
    pages["/"].wait("document.getElementById('strip-title').textContent !== 'Choose a texture'")
    pages["/"].value("document.getElementById('sound').click()")
    pages["scene.html"].value("document.querySelector('#scenes a').click()")
    pages["scene.html"].wait("document.getElementById('scene-title').textContent === 'ball'")
    for one in pages.values():
        one.value(FRAMES)
    return pages


def act(pages, seconds):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for page, one in pages.items():
            one.value(ACTIONS[page])
        time.sleep(2)


def measure_memory(chrome, address, server, minutes):
    pages = open_pages(chrome, address)
    act(pages, 60)  # code is compiled, lists have their length
    heaps, resident = {page: heap_mb(one) for page, one in pages.items()}, server_mb(server)
    frames = {page: one.value("window.frames_") for page, one in pages.items()}
    began = time.monotonic()
    act(pages, 60 * minutes)
    seconds = time.monotonic() - began
    for page, one in pages.items():
        grown, shown = heap_mb(one) - heaps[page], one.value("window.frames_") - frames[page]
        say(f"{page}: heap {heaps[page]:.1f} MB, {grown:+.2f} MB in {seconds / 60:.1f} min (at most 5), {shown / seconds:.0f} frames a second")
        assert one.console == [], one.console
    say(f"server: {resident:.1f} MB, {server_mb(server) - resident:+.2f} MB (at most 20); ticks: {pages['daemon.html'].text('ticks')}; "
        f"textures: {pages['/'].text('state-word')}; scenes: {pages['scene.html'].text('state-word')}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tactograph")
    parser.add_argument("tactographd")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--only", default="ready,zoom,ticks,memory")
    o = parser.parse_args()
    for name in ("tactograph", "tactographd"):
        program = pathlib.Path(getattr(o, name)).resolve()
        if not os.access(program, os.X_OK):
            parser.error(f"{program}: no such program; './bootstrap bench' builds it")
        os.environ[name.upper()] = str(program)
    from chromium import browser
    from live_client import live
    from run_daemon import Client, daemon, prepare_files
    from tacto import in_folder

    def measure():
        prepare_files(device="sim:rate=2kHz", loop="host", most_late_percent=100)
        pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.004\n0.6,0.034\n1.2,0.004\n")  # 50 mm/s, repeated without end
        ball = {"name": "ball", "shape": "sphere", "place": {"x_m": 0, "y_m": 0, "z_m": 0}, "radius_m": 0.03, "stiffness_n_per_m": 600}
        pathlib.Path("ball.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "pieces": [ball]}))
        with live(".", "--socket", "control") as server, daemon(), browser(server.address) as chrome:
            address, wanted = server.address.split("?")[0], o.only.split(",")
            if "ready" in wanted:
                measure_ready(chrome, address)
            if "zoom" in wanted:
                measure_zoom(chrome, address)
            if "ticks" in wanted:
                measure_ticks(chrome, address, Client())
            chrome.ask("Page.navigate", url="about:blank")
            if "memory" in wanted:
                measure_memory(chrome, address, server, o.minutes)

    in_folder(measure)


if __name__ == "__main__":
    main()
