#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The names in anonymous namespaces of a test folder are unique, because its test programs are built in groups of files.

Without this check a collision appears only when another new file changes the groups. Functions may have equal names with
different parameters.
"""
import collections
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
ANONYMOUS = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)[^;(]*\{", re.M)
CONSTANT = re.compile(r"^(?:inline |static )?(?:constexpr|const) [^=({;]*?[ *&](\w+)(?:\[\w*\])?\s*[={]", re.M)
FUNCTION = re.compile(r"^(?=\w)(?!return|using|struct|class|enum|constexpr|const |[A-Z_]+\()[\w:<>,*& ]*[ *&](\w+)\(([^;{}]*?)\)(?: const)?(?: noexcept)? \{", re.M)


def types_of(parameters):
    """The parameters without their names and defaults."""
    parts = re.split(r",(?![^<]*>)", re.sub(r"\s+", " ", parameters))
    return tuple(re.sub(r"(?<=[ *&])\w+$", "", part.split("=")[0].strip()).strip() for part in parts)


def names_in(text):
    for body in ANONYMOUS.findall(text):
        yield from TYPE.findall(body)
        yield from CONSTANT.findall(body)
        yield from (f"{name}({', '.join(types_of(parameters))})" for name, parameters in FUNCTION.findall(body))


def collisions(files):
    """`files`: path -> text, of one folder."""
    places = collections.defaultdict(set)
    for path, text in files.items():
        for name in names_in(text):
            places[name].add(path)
    return {name: sorted(paths) for name, paths in places.items() if len(paths) > 1}


def in_namespace(text):
    return "namespace {\n" + text + "}  // namespace\n"


assert collisions({"a": in_namespace("int f(int x) {\n}\n"), "b": in_namespace("int f(int y) {\n}\n")}) == {"f(int)": ["a", "b"]}
assert collisions({"a": in_namespace("constexpr double kA = 1;\nstruct S {\n};\n"), "b": in_namespace("constexpr int kA = 2;\nclass S {\n};\n")}).keys() == {"kA", "S"}
assert not collisions({"a": in_namespace("int f(int x) {\n}\n"), "b": in_namespace("int f(double x) {\n}\n") + "int g(int x) {\n}\n"})

found, checked = {}, 0
for folder in {path.parent for path in (ROOT / "tests").glob("*/*_test.cpp")}:
    files = {str(path.relative_to(ROOT)): path.read_text() for path in folder.glob("*_test.cpp")}
    checked += len(files)
    found.update(collisions(files))
assert checked > 100 and not found, "rename one of each:\n" + "\n".join(f"{name}: {', '.join(paths)}" for name, paths in found.items())
print(f"{checked} test files have names of their own")
