#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipe for MATLAB and Octave: example.m runs as its comment says, and read_tactograph.m gives the numbers of the
Python package."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/end-to-end"), str(ROOT / "data-schema/python")]

import tacto
import tactograph

RECIPE = ROOT / "data-schema/octave"


def octave(script):
    return subprocess.run(["octave", "--no-gui", "--no-window-system", "--quiet", "--no-init-file", "--eval",
                           f"addpath('{RECIPE}'); {script}"], capture_output=True, text=True)


def read_by_octave(file, *names):
    """Each field, in Octave's order (columns)."""
    saved = "".join(f"f = fopen('{name}.bin', 'w'); fwrite(f, double(d.{name}), 'double'); fclose(f);" for name in names)
    done = octave(f"d = read_tactograph('{file}'); {saved} printf('all written');")
    assert "all written" in done.stdout, done
    return [np.fromfile(f"{name}.bin") for name in names]


def make_files():
    environment = {**os.environ, "PATH": f"{pathlib.Path(tacto.COMMAND).parent}:{os.environ['PATH']}"}
    lines = [line[4:] for line in (RECIPE / "example.m").read_text().split("\n") if line.startswith("%   ")]
    assert len(lines) == 4, lines
    subprocess.run(["bash", "-ec", "\n".join(lines)], check=True, capture_output=True, env=environment)


DRAWING = ("figure", "subplot", "plot", "imagesc", "axis", "xlabel", "ylabel", "title", "print")


def drawn(script):
    """The printed drawing. Debian's Octave without its recommended packages cannot draw, so functions that print their
    arguments replace those that draw."""
    pathlib.Path("drawing").mkdir()
    for name in DRAWING:
        pathlib.Path(f"drawing/{name}.m").write_text(
            f"function varargout = {name}(varargin)\n"
            f"  printf('{name}'); cellfun(@(a) printf(' [%s]', disp_of(a)), varargin); printf('\\n'); varargout = {{}};\nend\n"
            "function text = disp_of(a)\n"
            "  if ischar(a) text = a; else text = sprintf('%d from %.9g to %.9g', numel(a), min(a(:)), max(a(:))); end\nend\n")
    done = octave(f"warning('off', 'Octave:shadowed-function'); addpath('drawing'); {script}; disp('end of the example')")
    assert "end of the example" in done.stdout, done
    return done.stdout.split("\n")


def the_example_plots_values_with_units():
    make_files()
    lines = drawn("example")
    texture = tactograph.read_texture("E")
    force, position = texture.tangential_force.values, texture.position.values
    wanted = [f"plot [{len(force)} from 0 to {position[-1]:.9g}] [{len(force)} from {force.min():.9g} to {force.max():.9g}]",
              "xlabel [position (m)]", "ylabel [tangential force (N)]", "ylabel [spatial frequency (1/m)]", "ylabel [drive (V)]"]
    missing = [line for line in wanted if line not in lines]
    assert not missing, (missing, lines)


def the_readme_plots_force_over_position():
    make_files()
    block = [line.strip() for line in (ROOT / "README.md").read_text(encoding="utf-8").split("\n")]
    at = next(i for i, line in enumerate(block) if "read_tactograph(" in line and "E.texture.json" in line)
    lines = drawn(" ".join(block[at:at + 2]))
    texture = tactograph.read_texture("E")
    force, position = 1e3 * texture.tangential_force.values, 1e3 * texture.position.values
    assert f"plot [{len(force)} from 0 to {position[-1]:.9g}] [{len(force)} from {force.min():.9g} to {force.max():.9g}]" in lines, lines
    assert "xlabel [position (mm)]" in lines and "ylabel [tangential force (mN)]" in lines, lines


def numbers_are_those_of_python():
    make_files()
    recording = tactograph.read_recording("E")
    for name in ("time", "tangential_force", "position", "normal_force"):
        assert np.array_equal(read_by_octave("E.json", name)[0], recording[name].values), name
    texture = tactograph.read_texture("E")
    position, force = read_by_octave("E.texture.json", "position", "tangential_force")
    assert np.array_equal(position, texture.position) and np.array_equal(force, texture.tangential_force)
    session = tactograph.read_session("first")
    for name in ("position", "drive", "gain"):
        assert np.allclose(read_by_octave("first.nc", name)[0], session[name], rtol=1e-6, atol=1e-12), name  # float32
    spectrogram = tactograph.read_spectrogram("E")
    position, frequency, density = read_by_octave("E.nc", "position", "spatial_frequency", "density")
    assert np.allclose(position, spectrogram.position, rtol=1e-6) and np.allclose(frequency, spectrogram.spatial_frequency, rtol=1e-6)
    density = density.reshape(spectrogram.density.shape, order="F")
    assert np.allclose(density, spectrogram.density, rtol=1e-6, atol=0, equal_nan=True)  # float32 in the file


def gaps_are_counted():
    make_files()
    document = json.loads(pathlib.Path("E.json").read_text())
    document["data"].pop("numbers_sha256")
    document["gaps"] = [{"frame": 100, "device_sequence": 105, "count": 5}, {"frame": 200, "device_sequence": 208, "count": 3}]
    pathlib.Path("E.json").write_text(json.dumps(document))
    assert np.array_equal(read_by_octave("E.json", "time")[0], tactograph.read_recording("E").time)


def another_kind_is_refused():
    pathlib.Path("a.json").write_text('{"kind": "results", "data": {"file": "a"}}')
    done = octave("read_tactograph('a.json');")
    assert done.returncode != 0 and "results" in done.stderr, done


if __name__ == "__main__":
    for test in (the_example_plots_values_with_units, the_readme_plots_force_over_position, numbers_are_those_of_python, gaps_are_counted, another_kind_is_refused):
        tacto.in_folder(test)
