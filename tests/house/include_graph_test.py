#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The include table of the house: which folder may include which, which library lies behind which wall.

Also: every source file names its licence, no file of the libraries outgrows 400 lines, and the root keeps to its
folders. The test first proves on an invented tree that it can fail.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Longest prefix first: firmware-host/core is stricter than firmware-host.
MAY_INCLUDE = {
    "firmware-host/core": [],
    "firmware-host": ["firmware-host/core", "data-schema"],
    "data-schema": [],
    "capture": ["data-schema", "firmware-host"],
    "spatial": ["data-schema"],
    "playback": ["data-schema", "firmware-host", "firmware-host/core", "spatial"],
    "analysis": ["data-schema", "firmware-host", "capture", "spatial", "playback"],
}

# Header (as a pattern on what stands between the brackets) -> the only places it may be included.
WALLS = {
    r"libusb": ["firmware-host/usb"],
    r"fftw3": ["spatial/dsp"],
    r"sndfile": ["data-schema"],
    r"nlohmann/|valijson/|netcdf|H5": ["data-schema"],
    r"nettle/": ["data-schema", "analysis"],
    r"opencv2/|cairo|pango": ["spatial/picture"],
    r"pugixml": ["capture"],
    r"Eigen/|unsupported/Eigen": ["analysis/identify"],
    r"CLI/": ["data-schema/cli"],
}

# JSON and netCDF readers must not leak into the verbs: only the report printer shares the JSON wall.
CLI_JSON_EXCEPTION = "data-schema/cli/report.cpp"

# What runs on a device has no hosted library behind it.
C_HEADERS = {"firmware-host/core": ["stdint.h", "stddef.h"]}

FOLDERS = ["analysis", "capture", "data-schema", "firmware-host", "playback", "spatial", "tests", "cmake", "LICENSES", ".ci"]
FILES = ["CMakeLists.txt", "README.md", "tactograph.cpp", "LICENSE", "CONTRIBUTING.md", "CHANGELOG.md", "bootstrap",
         "packages.txt", "CMakePresets.json", ".gitignore", ".clang-format", ".clang-tidy"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]', re.M)
SPDX = {"firmware-host/core": "Apache-2.0"}


def room_of(path):
    """The row of the table a file or include belongs to, or None."""
    rooms = sorted(MAY_INCLUDE, key=len, reverse=True)
    return next((room for room in rooms if path.startswith(room + "/")), None)


def arrow_faults(name, text):
    room = room_of(name)
    for quote, target in INCLUDE.findall(text):
        other = room_of(target)
        if quote == '"' and other is None and target != "data-schema/version.hpp":
            yield f'{name}: "{target}" is not written from the root'
        if room and other and other != room and other not in MAY_INCLUDE[room]:
            yield f"{name}: {room} may not include {other} ({target})"


def wall_faults(name, text):
    for quote, target in INCLUDE.findall(text):
        for pattern, places in WALLS.items():
            if quote == "<" and re.match(pattern, target):
                if not any(name.startswith(place + "/") for place in places):
                    yield f"{name}: <{target}> belongs only in {', '.join(places)}"
        if re.match(r"nlohmann/|netcdf|valijson/", target) and "/cli/" in name and name != CLI_JSON_EXCEPTION:
            yield f"{name}: <{target}> does not belong in a verb"


def freestanding_faults(name, text):
    allowed = C_HEADERS.get(room_of(name))
    for quote, target in INCLUDE.findall(text):
        if allowed and quote == "<" and target not in allowed:
            yield f"{name}: <{target}> is not among {', '.join(allowed)}: the core is freestanding"


def form_faults(name, text):
    licence = next((l for room, l in SPDX.items() if name.startswith(room + "/")), "GPL-3.0-or-later")
    if f"SPDX-License-Identifier: {licence}" not in "\n".join(text.split("\n")[:2]):
        yield f"{name}: its first lines don't say SPDX-License-Identifier: {licence}"
    if text.count("\n") > 400 and not name.startswith("tests/"):
        yield f"{name}: {text.count(chr(10))} lines; files of the house stay under 400"


def faults_of(name, text):
    faults = list(form_faults(name, text))
    if not name.startswith("tests/") and name != "tactograph.cpp":
        faults += arrow_faults(name, text)
        faults += wall_faults(name, text)
        faults += freestanding_faults(name, text)
    return faults


def sources(root):
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root,
                            capture_output=True, text=True)
    names = listed.stdout.split("\n") if listed.returncode == 0 else [
        str(p.relative_to(root)) for p in root.rglob("*") if "build" not in p.parts]
    return [n for n in names if n.endswith((".cpp", ".hpp", ".h")) and (root / n).exists()]


def root_faults(root):
    ignored = subprocess.run(["git", "check-ignore"] + [p.name for p in root.iterdir()], cwd=root,
                             capture_output=True, text=True).stdout.split()
    for path in root.iterdir():
        if path.name not in FOLDERS + FILES + [".git"] + ignored:
            yield f"{path.name}: the root holds only its folders and the files every project has"


def prove_it_can_fail():
    spdx = "// SPDX-License-Identifier: GPL-3.0-or-later\n"
    bad = {
        "spatial/a.cpp": spdx + '#include "playback/render.hpp"\n',
        "firmware-host/core/a.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include \"data-schema/error.hpp\"\n",
        "firmware-host/core/b.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include <vector>\n",
        "firmware-host/core/wire/c.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include <cstdint>\n",
        "capture/a.cpp": spdx + "#include <fftw3.h>\n",
        "spatial/b.cpp": spdx + "#include <pugixml.hpp>\n",
        "spatial/dsp/a.cpp": spdx + "#include <opencv2/core.hpp>\n",
        "data-schema/cli/a.cpp": spdx + "#include <nlohmann/json.hpp>\n",
        "analysis/a.cpp": "int x;\n",
        "analysis/b.cpp": spdx + "\n" * 500,
        "analysis/c.cpp": spdx + '#include "render.hpp"\n',
    }
    for name, text in bad.items():
        assert faults_of(name, text), f"the check does not see what is wrong with {name}"
    assert not faults_of("playback/a.cpp", spdx + '#include "spatial/dsp/fft.hpp"\n#include <vector>\n')
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "surprise").touch()
        assert list(root_faults(pathlib.Path(folder)))


def main():
    prove_it_can_fail()
    names = sources(ROOT)
    assert len(names) > 20, f"only {len(names)} sources found under {ROOT}"
    faults = [fault for name in names for fault in faults_of(name, (ROOT / name).read_text())] + list(root_faults(ROOT))
    print("\n".join(faults) or f"{len(names)} files keep to the include table")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
