#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph report`: a project with every kind of file, some of them broken, on one page."""
import hashlib
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess

import tacto

KINDS = {"recording", "texture", "transducer", "spectrogram", "formants", "descriptions", "scene", "session", "results",
         "session_table"}


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.pictures, self.rows, self.tags = [], [], 0, set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.tags.add(tag)
        self.rows += tag == "tr"
        if tag == "img":
            self.pictures.append(values["src"])
        self.links += [v for k, v in attributes if k in ("src", "href", "srcset", "data", "action") and not v.startswith(("data:", "#"))]


def make_project(folder):
    root = pathlib.Path(folder)
    root.mkdir()
    (root / "more").mkdir()
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=79", "--strokes", "1", "-o", root / "C", "--no-calibration")
    tacto.run("spatial", root / "C", "-o", root / "C")
    tacto.run("spectrogram", root / "C", "-o", root / "C.nc", "-o", root / "C.png")
    tacto.run("describe", root / "C", "-o", root / "C")
    tacto.run("formants", root / "C", "-o", root / "C")
    (root / "path.csv").write_text("time_s,position_m\n0,0\n0.7,0.035\n")
    tacto.run("play", root / "C", "-d", "sim:seed=79", "--finger-path", root / "path.csv", "--gain", "0.3mm/N", "-o", root / "more/first")
    tacto.run("session", root / "more/first", "-o", root / "more/first.nc")
    tacto.run("compare", root / "C", root / "C", "-o", root / "more/CC.results.json")
    tacto.run("fidelity", root / "C", "-d", "sim:seed=79,hysteresis=0.1", "-o", root / "more/fidelity.results.json")
    (root / "both.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": [
        {"type": "texture", "texture": "C", "at_m": 0, "gain_m_per_n": 1e-3, "ends": "stop"}]}))
    preset = pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json"
    shutil.copy(preset, root / "bench.transducer.json")
    return root


def a_project_on_one_page():
    root = make_project("study")
    out, said = tacto.run("report", root, "-o", "study/study.html", "--json")
    report = json.loads(out)
    assert {row["kind"] for row in report["files"]} == KINDS, report["files"]
    text = pathlib.Path("study/study.html").read_text()
    page = Page(text)
    assert not page.links and "http" not in text and "script" not in page.tags
    assert len(page.pictures) >= 10 and all(src.startswith("data:image/svg+xml,") for src in page.pictures)
    assert tacto.run_json("validate", root / "more/first.nc")["valid"] and tacto.run_json("validate", root / "more/first")
    assert tacto.run_json("info", root / "more/first.nc")["kind"] == "session_table"
    for row in report["files"]:
        assert pathlib.Path(row["file"]).name in text and row["sha256"] in text
        if row["kind"] in ("recording", "texture"):
            data = pathlib.Path(row["file"]).with_suffix(".wav").read_bytes()
            assert hashlib.sha256(data).hexdigest().startswith(row["sha256"])
    simulated = sum(row["simulated"] for row in report["files"])
    assert simulated >= 6 and text.count('class="simulated"') == 1, "one box"
    sections = re.split(r'<h2 id="file-', text)[1:]
    assert len(sections) == len(report["files"]), len(sections)
    origins = [len(re.findall(r">simulated</td>", section)) for section in sections]
    assert origins == [int(row["simulated"]) for row in report["files"]], "and each file the origin of its own"
    assert "path.csv" in said and "C.png" in said, "other programs' files are named"
    again = ["report", root, "-o", "study/study.html"]
    assert "--force" in tacto.run(*again, code=2)[1]  # --force replaces the page, which is no file of the project
    assert "study.html" not in tacto.run(*again, "--force")[1]


def a_session_of_forces_is_listed():
    root = pathlib.Path("bench")
    root.mkdir()
    (root / "bench.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "patches": [
        {"name": "a", "place": {"x_m": 0.01, "y_m": 0}, "size": {"width_m": 0.1, "height_m": 0.1}, "layers": [{"type": "spring", "stiffness_n_per_m": 10, "centre_x_m": 0, "centre_y_m": 0}]}]}))
    tacto.run("play", root / "bench.scene.json", "-d", "sim:planar", "--time", "0.5s", "-o", root / "held")
    report = tacto.run_json("report", root, "-o", "bench.html")
    assert {(row["kind"], row["simulated"]) for row in report["files"]} == {("scene", False), ("session", True)}, report
    page = Page(pathlib.Path("bench.html").read_text())
    assert len(page.pictures) == 4, page.pictures  # place and force of two axes


def broken_files_do_not_stop_the_rest():
    root = make_project("study")
    odd = '<img src=x onerror=alert(1)> & "odd".json'
    (root / odd).write_text('{"kind": "recording"')
    (root / "future.json").write_text('{"kind": "oracle", "version": "1.0"}')
    (root / "more/unclosed.events.jsonl").write_text("{}\n")
    pathlib.Path(os.fsdecode(b"study/two\nlines\xff.json")).write_text("{")
    samples = (root / "C.texture.wav").read_bytes()
    shutil.copy(root / "C.texture.json", root / "more/torn.texture.json")
    (root / "more/C.texture.wav").write_bytes(samples[:3000])
    done = subprocess.run([tacto.COMMAND, "report", root, "-o", "page.html", "--json"], capture_output=True)
    assert done.returncode == 4
    report, said = json.loads(done.stdout), tacto.unwrapped(done.stderr.decode(errors="replace"))
    assert all(line.startswith("tactograph: warning:") for line in said.splitlines() if " %" not in line and not line.startswith("==")), said
    assert len(report["broken"]) == 5 and {row["kind"] for row in report["files"]} == KINDS
    text = pathlib.Path("page.html").read_text()
    assert "<img src=x" not in text and "&lt;img src=x" in text
    for name in ("onerror", "future.json", "unclosed.events.jsonl", "torn.texture.json"):
        assert name in text, name
        assert name in said or name == "torn.texture.json" and "C.texture.wav" in said, (name, said)


def a_torn_curve_leaves_out_its_file_only():
    """Points without a partner: `validate` names the place, `report` goes on without the file."""
    make_project("study")
    torn = pathlib.Path("study/more/CC.results.json")
    body = json.loads(torn.read_text())
    body["pictures"][0]["curves"][0]["x"].pop()
    torn.write_text(json.dumps(body))
    out, said = tacto.run("validate", torn, "--json", code=4)
    assert "#/pictures/0/curves/0" in out + said, (out, said)
    out, said = tacto.run("report", "study", "-o", "page.html", "--json", code=4)
    report, page = json.loads(out), pathlib.Path("page.html").read_text()
    assert [row["file"] for row in report["broken"]] == [str(torn)] and "CC.results.json" in said, report["broken"]
    assert "more/CC.results.json" in page and "fidelity.results.json" in page and len(Page(page).pictures) >= 5


def samples_are_those_that_the_sidecar_names():
    """The samples have another name than the sidecar. A file at the default name does not belong to it."""
    make_project("study")
    root = pathlib.Path("study")
    for stem in ("C", "C.texture"):
        side = json.loads((root / f"{stem}.json").read_text())
        side["data"]["file"] = f"samples of {stem}.wav"
        (root / f"{stem}.json").write_text(json.dumps(side))
        (root / f"{stem}.wav").rename(root / side["data"]["file"])
    (root / "C.wav").write_bytes(b"no samples of C")
    out, said = tacto.run("report", root, "-o", "page.html", "--json")
    rows = {row["file"]: row for row in json.loads(out)["files"]}
    for stem in ("C", "C.texture"):
        data = (root / f"samples of {stem}.wav").read_bytes()
        assert hashlib.sha256(data).hexdigest()[:12] == rows[f"study/{stem}.json"]["sha256"] in pathlib.Path("page.html").read_text(), rows
    assert "study/C.wav" in said, said


def what_is_no_file_is_named():
    make_project("study")
    root = pathlib.Path("study")
    os.mkfifo(root / "pipe.json")
    os.mkfifo(root / "pipe")
    (root / "gone.texture.json").symlink_to("nowhere")
    (root / "link.json").symlink_to("C.json")
    done = subprocess.run([tacto.COMMAND, "report", root, "-o", "page.html", "--json"], capture_output=True, text=True, timeout=60)
    done.stderr = tacto.unwrapped(done.stderr)
    report, text = json.loads(done.stdout), pathlib.Path("page.html").read_text()
    assert done.returncode == 3, (done.returncode, done.stderr)  # the exit code is that of the first by name: the link
    faults = {row["file"]: row["fault"] for row in report["broken"]}
    assert faults.keys() == {"study/pipe.json", "study/pipe", "study/gone.texture.json"}, faults
    assert "broken link" in faults["study/gone.texture.json"] and "pipe" in faults["study/pipe.json"]
    assert all(pathlib.Path(name).name in text and name in done.stderr for name in faults)
    assert "study/link.json" in {row["file"] for row in report["files"]}


def sixty_files_make_a_small_page():
    """Each texture has a raster picture; long tables and the files' sections are folded."""
    root = pathlib.Path("many")
    root.mkdir()
    tacto.run("record", "-d", "sim:surface=D,speed=50mm/s,seed=1,strokes=60,length=20mm", "--time", "35s", "-o", root / "D")
    tacto.run("spatial", root / "D", "-o", root / "D")
    files = tacto.run_json("report", root, "-o", "many.html")["files"]
    text = pathlib.Path("many.html").read_text()
    print(f"{len(files)} files: {len(text) / 1e6:.1f} MB")
    assert len(files) >= 60 and len(text) < 10e6, (len(files), len(text))
    assert text.count("<details>") == len(files) + 1 and text.index('class="answer"') < text.index("<table")


def a_speed_that_is_missing_is_named():
    for speeds in ("50mm/s,,", "50mm/s,,25mm/s", ",50mm/s"):
        said = tacto.run("fidelity", "absent", "--speed", speeds, code=2)[1]
        assert "--speed" in said, (speeds, said)


def folders_that_are_none_are_refused():
    pathlib.Path("empty").mkdir()
    assert tacto.error_of("report", "empty", code=5)["where"] == "empty"
    tacto.run("report", "absent", code=3)
    tacto.run("report", "empty", "-o", "page.pdf", code=2)
    assert not list(pathlib.Path(".").glob("*.html"))


if __name__ == "__main__":
    for test in (a_project_on_one_page, a_session_of_forces_is_listed, broken_files_do_not_stop_the_rest, a_torn_curve_leaves_out_its_file_only, samples_are_those_that_the_sidecar_names, what_is_no_file_is_named,
                 sixty_files_make_a_small_page, a_speed_that_is_missing_is_named, folders_that_are_none_are_refused):
        tacto.in_folder(test)
