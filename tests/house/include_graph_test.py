#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The include table of the house (include_table.py): which folder may include which, which library is included where.

Also: the table has no cycle, every source file names its licence, every room's CMakeLists.txt lists its sources by
tacto_sources(), links in Markdown lead to files, and the root has no other folders. It reads the files that git tracks.
The test first shows on an invented tree that it can fail. With --dot it draws the table instead:

    python3 tests/house/include_graph_test.py --dot | dot -Tsvg -o house.svg        # package graphviz
    python3 tests/house/include_graph_test.py --dot playback | dot -Tsvg -o playback.svg
"""
import graphlib
import pathlib
import re
import subprocess
import sys

from include_table import MAY_INCLUDE as TABLE

ROOT = pathlib.Path(__file__).resolve().parents[2]

ROOMS = ["analysis", "capture", "data-schema", "firmware-host", "playback", "spatial"]

# Header (a regular expression for the text between the brackets) -> the only places that may include it.
WALLS = {
    r"libusb": ["firmware-host/usb"],
    r"comedi(lib)?\.h": ["firmware-host/comedi"],
    r"termios": ["firmware-host/tty", "data-schema/command", "firmware-host/examples"],
    r"fftw3": ["spatial/dsp"],
    r"sndfile": ["data-schema/wav"],
    r"nlohmann/|valijson/": ["data-schema"],
    r"netcdf": ["data-schema/netcdf"],
    r"H5": ["data-schema/netcdf", "data-schema/exchange"],
    r"matio|zlib": ["data-schema/exchange"],
    r"zip\.h": ["data-schema/exchange/zip"],
    r"assimp/": ["data-schema/exchange/assimp"],
    r"nettle/": ["data-schema/base"],
    r"opencv2/|cairo|pango": ["spatial/picture/engine"],
    r"png\.h": ["spatial/picture/engine", "capture/import"],
    r"pugixml": ["capture/import", "data-schema/exchange"],
    r"Eigen/|unsupported/Eigen": ["analysis/compare", "analysis/identify", "analysis/psychometrics", "playback/prepare"],
    r"boost/": ["analysis/psychometrics", "data-schema/base"],
    r"CLI/": ["data-schema/command"],
    r"libwebsockets": ["analysis/live/server"],
}

# JSON and netCDF readers must not be used by verbs; only the report printer also uses JSON.
VERBS = r"(.*/)?cli/|data-schema/(command|report)/|spatial/job/"
CLI_JSON_EXCEPTION = "data-schema/report/report.cpp"

# Code that runs on a device uses no hosted library.
C_HEADERS = {"firmware-host/core": ["stdint.h", "stddef.h"], "firmware-host/boards": ["stdint.h", "stddef.h"], "playback/wasm": ["stdint.h", "stddef.h"]}

FOLDERS = ["analysis", "capture", "data-schema", "firmware-host", "playback", "spatial", "tests", "cmake", "LICENSES", ".ci"]
FILES = ["CMakeLists.txt", "README.md", "tactograph.cpp", "LICENSE", "CONTRIBUTING.md", "CHANGELOG.md", "bootstrap",
         "packages.txt", "CMakePresets.json", ".gitignore", ".clang-format", ".clang-tidy"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]', re.M)
SPDX = {"firmware-host/core": "Apache-2.0", "firmware-host/boards": "Apache-2.0", "firmware-host/examples": "Apache-2.0"}


def spelled_out(row):
    """"room/{a b} other/c" as ["room/a", "room/b", "other/c"]; "room/." is the room itself."""
    for prefix, names, single in re.findall(r"(\S+)/\{([^}]*)\}|(\S+)", row):
        yield from [f"{prefix}/{name}".removesuffix("/.") for name in names.split()] if prefix else [single]


MAY_INCLUDE = {folder: set(spelled_out(row)) for folder, row in TABLE.items()}


def folder_of(path):
    return path.rpartition("/")[0]


def arrow_faults(name, text):
    folder = folder_of(name)
    if folder not in MAY_INCLUDE:
        yield f"{name}: the folder {folder} is not in include_table.py"
        return
    for quote, target in INCLUDE.findall(text):
        other = folder_of(target)
        if quote == "<" or target == "data-schema/version.hpp":
            continue
        if other not in MAY_INCLUDE:
            yield f'{name}: "{target}" is not written from the root'
        elif other != folder and other not in MAY_INCLUDE[folder]:
            yield f"{name}: {folder} may not include {other} ({target})"


def wall_faults(name, text):
    for quote, target in INCLUDE.findall(text):
        for pattern, places in WALLS.items():
            if quote == "<" and re.match(pattern, target):
                if not any(name.startswith(place + "/") for place in places):
                    yield f"{name}: <{target}> belongs only in {', '.join(places)}"
        if re.match(r"nlohmann/|netcdf|valijson/", target) and re.match(VERBS, name) and name != CLI_JSON_EXCEPTION:
            yield f"{name}: <{target}> does not belong in a verb"


def freestanding_faults(name, text):
    allowed = next((headers for room, headers in C_HEADERS.items() if name.startswith(room + "/")), None)
    for quote, target in INCLUDE.findall(text):
        if allowed and quote == "<" and target not in allowed:
            yield f"{name}: <{target}> is not among {', '.join(allowed)}: the core is freestanding"


def form_faults(name, text):
    licence = next((l for room, l in SPDX.items() if name.startswith(room + "/")), "GPL-3.0-or-later")
    if f"SPDX-License-Identifier: {licence}" not in "\n".join(text.split("\n")[:2]):
        yield f"{name}: its first lines don't say SPDX-License-Identifier: {licence}"


def faults_of(name, text):
    faults = list(form_faults(name, text))
    if not name.startswith("tests/") and name != "tactograph.cpp":
        faults += arrow_faults(name, text)
        faults += wall_faults(name, text)
        faults += freestanding_faults(name, text)
    return faults


def table_faults(table):
    for folder, others in table.items():
        for other in sorted(others - table.keys()):
            yield f"include_table.py: {folder} may include {other}, which is no folder of the table"
    try:
        graphlib.TopologicalSorter(table).prepare()
    except graphlib.CycleError as cycle:
        yield "include_table.py: a cycle: " + " -> ".join(cycle.args[1])


def unused_rows(names, texts):
    """Arrows that no source uses must be removed from the table, so that the includes cannot come back unnoticed."""
    used = {folder: set() for folder in MAY_INCLUDE}
    for name in names:
        for quote, target in INCLUDE.findall(texts[name]):
            used.get(folder_of(name), set()).add(folder_of(target))
    for folder, others in MAY_INCLUDE.items():
        for other in sorted(others - used[folder]):
            yield f"include_table.py: {folder} includes nothing of {other}"


def dot_of(table, room):
    """The table for Graphviz: all of it, or the arrows from and to one room's folders."""
    shown = {f: others for f, others in table.items() if not room or f.startswith(room) or any(o.startswith(room) for o in others)}
    rooms = sorted({folder.split("/")[0] for folder in table})
    lines = ["digraph house {", "  rankdir=BT; node [shape=box, fontname=sans, fontsize=11]; edge [color=gray50];"]
    for name in rooms:
        inside = " ".join(f'"{folder}";' for folder in table if folder.split("/")[0] == name)
        lines.append(f'  subgraph "cluster_{name}" {{ label="{name}"; fontname=sans; {inside} }}')
    for folder, others in shown.items():
        lines += [f'  "{folder}" -> "{other}";' for other in sorted(others)
                  if not room or folder.startswith(room) or other.startswith(room)]
    return "\n".join(lines + ["}"])


def markdown_faults(root, name, text):
    for number, line in enumerate(text.split("\n"), 1):
        for link in re.findall(r"\]\(([^)#\s]+)", line):
            if "://" not in link and not (root / name).parent.joinpath(link).exists():
                yield f"{name}:{number}: the link leads to no file: {link}"


def listing_faults(name, text):
    for line in re.findall(r"^\s*file\(GLOB[^)]*\.cpp|^\s*\S+\.cpp\b", text, re.M):
        if "embedded_files" not in line:
            yield f"{name}: {line.strip()}: sources are listed by tacto_sources()"


def tracked_files():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")
    return [name for name in listed if name and (ROOT / name).exists()]


def root_faults(names):
    for name in sorted({name.split("/")[0] for name in names}):
        if name not in FOLDERS + FILES:
            yield f"{name}: the root has only its folders and the files that every project has"


def prove_it_can_fail():
    spdx = "// SPDX-License-Identifier: GPL-3.0-or-later\n"
    bad = {
        "spatial/texture/a.cpp": spdx + '#include "playback/render/render.hpp"\n',
        "spatial/features/a.cpp": spdx + '#include "spatial/certificate/certificate.hpp"\n',
        "spatial/surprise/a.cpp": spdx,
        "firmware-host/core/kernel/a.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include \"data-schema/base/error.hpp\"\n",
        "firmware-host/core/kernel/b.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include <vector>\n",
        "firmware-host/core/wire/c.hpp": "// SPDX-License-Identifier: Apache-2.0\n#include <cstdint>\n",
        "capture/record/a.cpp": spdx + "#include <fftw3.h>\n",
        "spatial/texture/b.cpp": spdx + "#include <pugixml.hpp>\n",
        "spatial/dsp/filter/a.cpp": spdx + "#include <opencv2/core.hpp>\n",
        "data-schema/cli/a.cpp": spdx + "#include <nlohmann/json.hpp>\n",
        "data-schema/command/a.cpp": spdx + "#include <nlohmann/json.hpp>\n",
        "analysis/scene/a.cpp": "int x;\n",
        "analysis/scene/c.cpp": spdx + '#include "scene.hpp"\n',
    }
    for name, text in bad.items():
        assert faults_of(name, text), f"the check does not see what is wrong with {name}"
    assert not faults_of("playback/model/a.cpp", spdx + '#include "spatial/dsp/fourier/fft.hpp"\n#include <vector>\n')
    assert list(table_faults({"a": {"b"}, "b": {"c"}, "c": {"a"}})) and list(table_faults({"a": {"b"}}))
    assert list(unused_rows([], {}))
    assert list(markdown_faults(ROOT, "a.md", "[a](b/none.md)"))
    assert not list(markdown_faults(ROOT, "a.md", "[a](README.md#verbs) [b](https://debian.org)"))
    assert list(listing_faults("a", "file(GLOB sources *.cpp)")) and list(listing_faults("a", "  render.cpp"))
    assert list(root_faults(["surprise/a.cpp"])) and not list(root_faults(["README.md", "tests/README.md"]))


def main():
    if sys.argv[1:2] == ["--dot"]:
        print(dot_of(MAY_INCLUDE, "".join(sys.argv[2:3])))
        return 0
    prove_it_can_fail()
    tracked = tracked_files()
    names = [name for name in tracked if name.endswith((".cpp", ".hpp", ".h"))]
    assert len(names) > 20, f"only {len(names)} sources found under {ROOT}"
    texts = {name: (ROOT / name).read_text() for name in names}
    house = [name for name in names if not name.startswith("tests/") and name != "tactograph.cpp"]
    faults = [fault for name in names for fault in faults_of(name, texts[name])]
    faults += [*table_faults(MAY_INCLUDE), *unused_rows(house, texts), *root_faults(tracked)]
    for name in (name for name in tracked if name.endswith(".md")):
        faults += markdown_faults(ROOT, name, (ROOT / name).read_text())
    for room in ROOMS:
        faults += listing_faults(f"{room}/CMakeLists.txt", (ROOT / room / "CMakeLists.txt").read_text())
    print("\n".join(faults) or f"{len(names)} files keep to the include table")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
