#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph trade` and the verbs that choose by its table: files, calibration, promises, errors."""
import csv
import hashlib
import json
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import soundfile

import tacto

os.environ["XDG_CONFIG_HOME"] = tempfile.mkdtemp()


def make_texture(folder):
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=79", "--strokes", "1", "-o", "C", "--no-calibration", cwd=folder)
    tacto.run("spatial", "C", "-o", "C", cwd=folder)


def check_trade(folder):
    done = tacto.run_json("trade", "C", "-o", "t.html", "-o", "t.csv", "-o", "t.svg", "-o", "t.results.json", cwd=folder)
    rows = list(csv.DictReader((folder / "t.csv").open()))
    assert len(rows) == len(done["choices"]) > 60
    assert {row["half"] for row in rows} == {"offline", "real time"}
    for half in ("offline", "real time"):
        assert sum(row["knee"] == "true" for row in rows if row["half"] == half) >= 3, half
    loops = [row for row in done["choices"] if row["choice_of"] == "loop"]
    assert len(loops) == 2 and all(row["worth_it"] == "not judged" and row["latency_s"] > 0 for row in loops), loops
    answers = {answer["choice_of"]: answer for answer in done["answers"]}
    assert "not measured" in answers["loop"]["knee"] and "one choice" in answers["stored"]["knee"], answers
    for row in rows:
        if row["knob"] == "loop":
            assert (row["error"], row["on_front"], row["knee"], row["beaten_by"]) == ("", "false", "false", ""), row
            continue
        assert 0 <= float(row["error"]) < 10, row
        assert (row["on_front"] == "true") != bool(row["beaten_by"]), row
    assert all(answer["knee"] and answer["never_worth_it"] for answer in done["answers"])
    check_words(folder, done)
    check_speeds(rows, done, answers)
    page = (folder / "t.html").read_text()
    assert "Simulated" in page
    check_page(page, rows, answers)
    assert (folder / "t.svg").read_text().startswith("<?xml")
    tacto.run("validate", "t.results.json", cwd=folder)
    assert "real time" in tacto.run("info", "t.results.json", cwd=folder)[0]
    # A file of another kind is not replaced.
    (folder / "mine.csv").write_text("a,b\n1,2\n")
    assert "mine.csv" in tacto.run("trade", "C", "-o", "mine.csv", cwd=folder, code=2)[1]


def check_page(page, rows, answers):
    """The answer comes first, then a picture for each choice, each with one unit of cost; the long tables are
    folded."""
    knobs = {}
    for row in rows:
        if row["cost_ns"] and float(row["cost_ns"]) > 0 and 0 < float(row["error"] or 0) < 1:
            knobs.setdefault((row["half"], row["knob"]), []).append(row["per"])
    assert page.count("<img") == sum(len(units) > 1 for units in knobs.values()) > 10, page.count("<img")
    assert all(len(set(units)) == 1 for units in knobs.values()), knobs
    assert page.index("best for its cost") < page.index("<img") < page.index("<details>") < re.search("worth it</th><th[^>]*>note", page).start()
    first = page[: page.index("<img")]
    assert first.count("<tr") == len(answers) + 2 and all(answer in first for answer in answers), first
    assert page.count("<details>") == 2 and "ns per frame, sample, tick" not in page


def check_words(folder, done):
    """The best of each choice comes first. Into a pipe every choice follows, and each has a verdict."""
    lines = tacto.run("trade", "C", "--half", "offline", cwd=folder)[0].splitlines()
    assert any(line.startswith("best offline") for line in lines[: lines.index("answers")]), lines
    offline = [row for row in done["choices"] if row["half"] == "offline"]
    rows = lines[lines.index("choices") + 2 :]
    assert len(rows) == len(offline), lines
    assert all(row["choice_of"] in line and row["choice"] in line for row, line in zip(offline, rows)), lines


def check_speeds(rows, done, answers):
    """Real-time errors are the worst of three fingers, and each of the three is reported; the interacting pairs
    exist."""
    speeds = ("25", "100", "200")
    for row in rows:
        by_speed = [float(row[f"error_at_{speed}mmps"] or "nan") for speed in speeds]
        if row["half"] == "offline" or row["knob"] in ("loop", "between counts", "pyramid") or row["note"].startswith("refused"):
            assert np.all(np.isnan(by_speed)), row
            continue
        assert float(row["error"]) == np.nanmax(by_speed), row
        assert 1e3 * float(row["worst_speed_mps"]) == float(speeds[int(np.nanargmax(by_speed))]), row
    assert {"window x hop", "window x padding", "tick rate x delay compensation", "tick rate x inverse"} <= set(answers), answers.keys()
    full = next(row for row in done["choices"] if (row["choice_of"], row["choice"]) == ("inverse", "full"))
    assert full["error_percent"] == max(full[f"error_at_{speed}mmps_percent"] for speed in speeds), full
    late = [row for row in done["choices"] if row["choice_of"] == "tick rate x delay compensation" and row["choice"].endswith("off")]
    assert len(late) == 5 and all(row["error_percent"] > 50 and row["latency_s"] > 1e-3 for row in late), late
    assert "25, 100, 200 mm/s" in answers["inverse"]["knee"] and "mm/s" not in answers["filter"]["knee"], answers


def check_scene(folder):
    """A choice has to serve each texture of a scene: its error is the worst of theirs, its memory the sum.

    This runs the real-time half three times. Under the sanitizers only the scene runs, and its figures are not judged.
    """
    tacto.run("record", "-d", "sim:surface=E,speed=50mm/s,seed=5", "--strokes", "1", "-o", "E", "--no-calibration", cwd=folder)
    tacto.run("spatial", "E", "-o", "E", cwd=folder)
    layers = [{"type": "texture", "texture": name, "at_m": at, "gain_m_per_n": 0.001} for name, at in (("C", 0), ("E", 0.2), ("C", 0.4))]
    (folder / "bench.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": layers}))

    def measured(name):
        done = tacto.run_json("trade", name, "--half", "realtime", cwd=folder)
        return done["texture"], {(row["choice_of"], row["choice"]): row for row in done["choices"]}

    name, scene = measured("bench.scene.json")
    assert " 2 textures" in name, name
    if tacto.SANITIZED:
        return
    (_, c), (_, e) = measured("C"), measured("E")
    c, e = ({key: row for key, row in rows.items() if key[0] != "loop"} for rows in (c, e))
    scene = {key: row for key, row in scene.items() if key[0] != "loop"}
    assert scene.keys() == c.keys() == e.keys()
    for key, row in scene.items():
        worst = max(c[key]["error_percent"], e[key]["error_percent"])
        assert abs(row["error_percent"] - worst) <= 1e-9 + 1e-6 * worst, (key, row["error_percent"], worst)
        assert abs(row["memory_kib"] - c[key]["memory_kib"] - e[key]["memory_kib"]) < 1e-6, key
    assert any(c[key]["error_percent"] != e[key]["error_percent"] for key in c)


def check_budgets(folder):
    fast = tacto.run_json("spatial", "C", "-o", "fast", "--quality", "fast", "--explain", cwd=folder)
    chosen = fast["chosen"][0]
    assert "shipped" in chosen["by_table"] and chosen["guaranteed_error_percent"] <= 1
    taken = [row for row in chosen["tried"] if row["taken"]]
    assert len(taken) == 1 and taken[0]["method"] == chosen["method"]
    exact_enough = [row["cost_us_per_mm"] for row in chosen["tried"] if row["error_percent"] <= 1]
    assert taken[0]["cost_us_per_mm"] == min(exact_enough)
    # Against the most exact choice: within the promise, and a percent of the RMS apart.
    tacto.run("spatial", "C", "-o", "exact", "--quality", "exact", cwd=folder)
    x, values, side = tacto.texture(folder / "fast")
    xe, best, best_side = tacto.texture(folder / "exact")
    at = x + side["source_origin_m"] - best_side["source_origin_m"]
    inside = (at > 3e-3) & (at < xe[-1] - 3e-3)
    read = np.interp(at[inside], xe, best)
    error = np.sqrt(np.mean((values[inside] - read) ** 2) / np.mean(read**2))
    print(f"fast against exact: {100 * error:.3f} % of the RMS, promised {chosen['guaranteed_error_percent']:.3f} %")
    assert error < 0.01
    assert "%" in tacto.error_of("spatial", "C", "-o", "no", "--max-error", "0.00001ppm", cwd=folder, code=5)["what"]
    assert not (folder / "no.texture.json").exists()
    assert "'0.1'" in tacto.error_of("spatial", "C", "-o", "no", "--max-error", "0.1", cwd=folder, code=2)["what"]
    assert "--explain" in tacto.error_of("spatial", "C", "-o", "no", "--explain", cwd=folder, code=2)["where"]
    assert tacto.error_of("spatial", "C", "-o", "no", "--quality", "fast", "--band", "off", cwd=folder, code=2)["where"] == "--quality"
    cells = tacto.run_json("spectrogram", "C", "-o", "C.nc", "--quality", "exact", "--explain", cwd=folder)
    assert cells["samples_used"] == "all" and len(cells["chosen"][0]["tried"]) == 2


def check_calibration(folder):
    done = tacto.run_json("trade", "--calibrate", cwd=folder)
    own = pathlib.Path(done["written"])
    assert own.is_relative_to(os.environ["XDG_CONFIG_HOME"])
    table = json.loads(own.read_text())
    assert table["kind"] == "trade" and {c["stage"] for c in table["choices"]} >= {"resampling", "grid", "spectrogram", "reading", "inverse"}
    again = tacto.run_json("spatial", "C", "-o", "own", "--quality", "balanced", "--explain", cwd=folder)
    assert str(own) in again["chosen"][0]["by_table"]
    tacto.run("trade", "--calibrate", "-o", "here.trade.json", cwd=folder)
    tacto.run("validate", "here.trade.json", cwd=folder)
    assert "resampling" in tacto.run("info", "here.trade.json", cwd=folder)[0]
    assert tacto.error_of("trade", "--calibrate", "-o", "here.csv", cwd=folder, code=2)["where"] == "here.csv"
    assert tacto.error_of("trade", "C", "--calibrate", cwd=folder, code=2)["where"] == "C"
    assert "--half" in tacto.run("trade", "--calibrate", "--half", "offline", cwd=folder, code=2)[1]
    table["machine"] = "Cray-1, f77"
    own.write_text(json.dumps(table))
    by = tacto.run_json("spatial", "C", "-o", "foreign", "--quality", "balanced", "--explain", cwd=folder)["chosen"][0]["by_table"]
    assert "Cray-1" in by, by
    for choice in table["choices"]:  # a table without errors promises nothing
        choice["errors"] = []
    own.write_text(json.dumps(table))
    assert "--calibrate" in tacto.error_of("spatial", "C", "-o", "no", "--quality", "fast", cwd=folder, code=5)["remedy"]
    for content in ("{}", '{"kind": "trade", "version'):
        own.write_text(content)
        _, said = tacto.run("spatial", "C", "-o", "no", "--quality", "fast", cwd=folder, code=4)
        assert str(own) in said and "--calibrate" in said, said
    own.unlink()
    own.mkdir()  # a folder where a table is expected: probably a mistake of the user
    assert "--calibrate" in tacto.run("spatial", "C", "-o", "no", "--quality", "fast", cwd=folder, code=3)[1]
    own.rmdir()
    homeless = {key: value for key, value in os.environ.items() if key not in ("HOME", "XDG_CONFIG_HOME")}
    done = subprocess.run([tacto.COMMAND, "trade", "--calibrate"], env=homeless, capture_output=True, text=True, timeout=60)
    assert done.returncode == 3 and "calibrating" not in done.stderr, done


def check_refusals(folder):
    """A transducer that does not fit is refused, one that was measured elsewhere warned of; nothing to feel is no trade; a percentage beyond a tenth no promise; an output is named once."""
    side = json.loads((folder / "C.texture.json").read_text())
    wav = folder / "even.texture.wav"
    soundfile.write(wav, np.full(side["data"]["samples"], 0.5, np.float32), soundfile.info(folder / "C.texture.wav").samplerate, subtype="FLOAT")
    side["data"] |= {"file": wav.name, "sha256": hashlib.sha256(wav.read_bytes()).hexdigest()}
    (folder / "even.texture.json").write_text(json.dumps(side))
    preset = json.loads((pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json").read_text())
    about = {"date": "2026-01-01T00:00:00Z", "conditions": "bench", "source": "sim:", "converged": True, "misfit": True, "words": "waves",
             "r_squared": 0.99, "low_hz": 100, "high_hz": 300}
    (folder / "hys.transducer.json").write_text(json.dumps(preset | {"name": "hys", "identification": about}))
    realtime = ["trade", "C", "--transducer", "hys", "--half", "realtime"]
    assert "--unfit-transducer" in tacto.run(*realtime, cwd=folder, code=5)[1]
    assert "100 to 300 Hz" in tacto.run(*realtime, "--unfit-transducer", "-o", "again.csv", cwd=folder)[1]
    tacto.run("trade", "even", "-o", "no.html", cwd=folder, code=5)
    assert not (folder / "no.html").exists()
    assert "a.csv" in tacto.error_of("trade", "C", "-o", "a.csv", "-o", "./a.csv", cwd=folder, code=2)["where"]
    assert tacto.error_of("spatial", "C", "-o", "no", "--max-error", "1000%", cwd=folder, code=2)["where"] == "--max-error"


def the_trade_and_what_chooses_by_it():
    folder = pathlib.Path.cwd()
    make_texture(folder)
    check_trade(folder)
    check_scene(folder)
    check_budgets(folder)
    check_calibration(folder)
    check_refusals(folder)
    tacto.error_of("trade", code=2)


if __name__ == "__main__":
    tacto.in_folder(the_trade_and_what_chooses_by_it)
