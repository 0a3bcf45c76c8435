#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every header of the libraries includes all that it needs. A build that compiles sources in groups does not detect a
missing include.

One run of clang parses all headers, each as a module of its own, which contains its own includes and nothing from other
headers. So a header costs only its own lines, where a source for each would parse `<string>` 500 times. Takes clang++
and the folders with the headers. The test first proves on an invented tree that it can fail.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ANGLED = re.compile(r"^\s*#\s*include\s*<([^>]+)>", re.M)
QUOTED = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def headers_of(root):
    listed = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True)
    names = listed.stdout.split("\n") if listed.returncode == 0 else [str(p.relative_to(root)) for p in root.rglob("*.hpp")]
    return sorted(n for n in names if n.endswith((".hpp", ".h")) and not n.startswith(("tests/", "build/")) and (root / n).exists())


def searched_folders(compiler):
    said = subprocess.run(compiler + ["-E", "-v", "-x", "c++", "/dev/null"], capture_output=True, text=True, check=True).stderr
    listed = said.split("#include <...> search starts here:\n")[1].split("End of search list.")[0]
    return [pathlib.Path(line.strip()) for line in listed.splitlines()]


def module(name, path, what=""):
    return f'module "{name}" {what} {{ header "{path}" export * }}\n'


# C headers are textual: each includer parses them. The C++ standard headers share text, so they are parts of one
# module.
def map_of(root, names, folders):
    angled = sorted({target for name in names for target in ANGLED.findall((root / name).read_text()) if not target.endswith(".h")})
    found = {target: next((f / target for f in folders if (f / target).is_file()), None) for target in angled}
    standard = [t for t in angled if found[t] and "." not in t and "/" not in t]
    others = [t for t in angled if found[t] and t not in standard]
    return ("module std [system] {\n" + "".join(module(t, found[t]) for t in standard) + "}\n"
            + "".join(module(t, found[t], "[system]") for t in others)
            + "module house {\n" + "".join(module(n, root / n) for n in names) + "}\n")


def faults_of(root, names, compiler):
    """Returns the faults, one line per header; messages of clang about other files are returned unchanged."""
    with tempfile.TemporaryDirectory() as scratch:
        modules = pathlib.Path(scratch) / "modules.map"
        modules.write_text(map_of(root, names, searched_folders(compiler)))
        done = subprocess.run(compiler + [
            f"-I{root}", "-w", "-ferror-limit=0", "-fmodules", f"-fmodules-cache-path={scratch}", f"-fmodule-map-file={modules}",
            "-fmodule-name=house", "-Xclang", "-fmodules-local-submodule-visibility", "-Xclang", "-emit-module",
            "-x", "c++", "-c", str(modules), "-o", f"{scratch}/house.pcm"], capture_output=True, text=True)
    first = {}
    for name, line, words in re.findall(rf"^{re.escape(str(root))}/(\S+?):(\d+):\d+: (?:fatal )?error: (.*)$", done.stderr, re.M):
        first.setdefault(name, f"{name}:{line}: {words}")
    return without_consequences(root, first) or ([done.stderr] if done.returncode else [])


def without_consequences(root, first):
    """A header that includes a faulty header is faulty, too; only the first one is reported."""
    return [fault for name, fault in first.items() if not first.keys() & set(QUOTED.findall((root / name).read_text()))]


def prove_it_can_fail(compiler):
    bad = {
        "whole.hpp": '#pragma once\n#include <vector>\nstruct Whole { std::vector<int> all; };\n',
        "by_whole.hpp": '#pragma once\n#include "whole.hpp"\nstruct ByWhole { Whole one; std::vector<int> more; };\n',
        "lacks_vector.hpp": '#pragma once\nstruct LacksVector { std::vector<int> all; };\n',
        "by_lacks_vector.hpp": '#pragma once\n#include "lacks_vector.hpp"\nstruct ByLacksVector { std::vector<int> all; };\n',
        "lacks_whole.hpp": '#pragma once\nstruct LacksWhole { Whole one; };\n',
        "lacks_word.hpp": '#pragma once\n#include <string>\nstruct LacksWord { std::optional<int> word; };\n',
        "zz_uses.hpp": '#pragma once\n#include <optional>\n#include <vector>\nstruct Uses { std::optional<int> word; };\n',
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        for name, text in bad.items():
            (root / name).write_text(text)
        said = {fault.split(":")[0]: fault for fault in faults_of(root, sorted(bad), compiler)}
    assert said.keys() == {name for name in bad if name.startswith("lacks_")}, said
    assert "whole.hpp" in said["lacks_whole.hpp"], said


def main():
    compiler = [sys.argv[1], "-std=c++20"] + [word for folder in sys.argv[2:] for word in ("-isystem", folder)]
    prove_it_can_fail(compiler)
    names = headers_of(ROOT)
    assert len(names) > 20, f"only {len(names)} headers found under {ROOT}"
    faults = faults_of(ROOT, names, compiler)
    print("\n".join(faults) or f"{len(names)} headers stand alone")
    if faults:
        print("A header includes what it uses: add the #include that is missing (clang names it, or the module it is in: std.vector is "
              "<vector>, house.folder/name.hpp is that file).")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
