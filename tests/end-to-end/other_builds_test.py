#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A module of another build is refused with its file and both builds; a file of a newer minor version is used with one
warning, by each verb that reads it."""
import hashlib
import json
import os
import pathlib
import re
import shutil

import tacto

INTERNAL = 1
MODULES = pathlib.Path(tacto.COMMAND).parent / "lib" / "tactograph"
BUILD = rb"\d+\.\d+\.\d+-[0-9a-f]{12}\0"


def another_build_of(module):
    """A copy whose word of the build has another last digit; returns both words."""
    code = (MODULES / module).read_bytes()
    found = set(re.findall(BUILD, code))
    assert len(found) == 1, (module, found)
    ours = found.pop()
    theirs = ours[:-2] + (b"1" if ours[-2:-1] == b"0" else b"0") + b"\0"
    pathlib.Path("other").mkdir(exist_ok=True)
    pathlib.Path("other", module).write_bytes(code.replace(ours, theirs))
    return ours[:-1].decode(), theirs[:-1].decode()


def a_module_of_another_build_is_refused():
    """LD_LIBRARY_PATH comes before the program's RUNPATH."""
    tacto.run("record", "-d", "sim:surface=E,speed=50mm/s,seed=1", "--time", "1s", "-o", "E")
    tacto.run("spatial", "E", "-o", "E", "--stroke", "1")
    uses = {"tactograph-netcdf.so": ["spectrogram", "E.texture.json", "-o", "E.nc"],
            "tactograph-pictures.so": ["spectrogram", "E.texture.json", "-o", "E.png"],
            "tactograph-matio.so": ["export", "E.json", "-o", "E.mat"],
            "tactograph-web.so": ["live", "."],
            "tactograph-zip.so": ["import", "E.x3p", "-o", "profile"],
            "tactograph-assimp.so": ["import", "E.stl", "--unit", "mm", "-o", "part"]}
    pathlib.Path("E.x3p").write_bytes(b"PK\x03\x04")
    pathlib.Path("E.stl").write_text("solid E\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {corner}\n" for corner in facet) + "endloop\nendfacet\n"
        for facet in (("0 0 0", "0 1 0", "1 0 0"), ("0 0 0", "1 0 0", "0 0 1"), ("0 0 0", "0 0 1", "0 1 0"), ("1 0 0", "0 1 0", "0 0 1"))) + "endsolid E\n")
    present = {path.name for path in MODULES.glob("*.so")}  # without libwebsockets there is no page
    assert present <= set(uses) and len(present) >= 3, present
    for module in sorted(present):
        ours, theirs = another_build_of(module)
        os.environ["LD_LIBRARY_PATH"] = str(pathlib.Path("other").resolve())
        said = tacto.error_of(*uses[module], code=INTERNAL)
        del os.environ["LD_LIBRARY_PATH"]
        assert ours in said["what"] and theirs in said["what"] and said["where"].endswith(f"other/{module}"), said
        shutil.rmtree("other")
        if module not in ("tactograph-web.so", "tactograph-zip.so"):
            tacto.run(*uses[module])  # the right one


def with_version(path, version):
    text = pathlib.Path(path).read_text()
    pathlib.Path(path).write_text(re.sub(r'"version": ?"1\.\d+"', f'"version": "{version}"', text, count=1))


def with_journal_version(path, version):
    """The first line's check is made again."""
    first, rest = pathlib.Path(path).read_text().split("\n", 1)
    body = re.sub(r'"version":"1\.\d+"', f'"version":"{version}"', first[:first.index(',"check"')]) + "}"
    check = hashlib.sha256(body.encode()).hexdigest()[:16]
    pathlib.Path(path).write_text(f'{body[:-1]},"check":"{check}"}}\n{rest}')


def newer_files_are_used_with_a_warning():
    """Each file, the verb that uses it, and how its version is changed."""
    tacto.run("record", "-d", "sim:surface=E,speed=50mm/s,seed=1", "--time", "1s", "-o", "E")
    tacto.run("spatial", "E", "-o", "E", "--stroke", "1")
    tacto.run("calibrate", "tare", "-d", "sim:finger=up,seed=3", "--calibration", "c.calibration.json", "--time", "1s")
    tacto.run("corpus", "init", "study", "--recordings", "E.json")
    tacto.run("experiment", "new", "stretch", "-o", "s")
    protocol = json.loads(pathlib.Path("s.protocol.json").read_text())
    pathlib.Path("s.protocol.json").write_text(json.dumps({**protocol, "repetitions": 1, "most_attempts": 20}))
    tacto.run("experiment", "run", "s", "-d", "sim:", "--participant", "P01", "--observer", "weber=25%")
    uses = {"E.json": ["spatial", "E", "--list"],
            "E.texture.json": ["describe", "E.texture.json"],
            "c.calibration.json": ["record", "-d", "sim:surface=E,speed=50mm/s,seed=3", "--time", "1s", "-o", "again", "--calibration", "c.calibration.json"],
            "study/plan.corpus.json": ["corpus", "workflow", "study", "--engine", "slurm", "-o", "job"],
            "s-P01.trials.jsonl": ["experiment", "prove", "s-P01"],
            "s.protocol.json": ["experiment", "check", "s"]}
    for file, verb in uses.items():
        change = with_journal_version if file.endswith(".jsonl") else with_version
        before = pathlib.Path(file).read_text()
        change(file, "1.73")
        said = tacto.run(*verb)[1]
        stem = file.split(".")[0]  # a verb may name the file by it
        assert sum(stem in line and "1.73" in line for line in said.splitlines()) == 1, (file, said)
        for output in ("again.json", "again.wav", "job"):
            pathlib.Path(output).unlink(missing_ok=True)
        change(file, "1.0")
        assert "1.73" not in tacto.run(*verb)[1], file
        for output in ("again.json", "again.wav", "job"):
            pathlib.Path(output).unlink(missing_ok=True)
        pathlib.Path(file).write_text(before)


if __name__ == "__main__":
    import sys
    import tempfile
    for test in (a_module_of_another_build_is_refused, newer_files_are_used_with_a_warning):
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            test()
            os.chdir("/")
            print(f"{test.__name__}: ok", file=sys.stderr)
