#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`trade SCENE --device`: errors against series and springs by NumPy, limits against `design` and their closed form, the
chosen scene against its original by `render`, and what it refuses."""
import csv
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "end-to-end"))
import tacto
from tacto import run, run_json

USAGE, NOT_FOUND, UNSUITABLE = 2, 3, 5
PERIOD, DEPTH, KAPPA, SIGMA = 8e-3, 2e-4, 4.0, 2e-4
MASS, VISCOUS, STEP = 0.1, 5.0, 1e-6  # so viscous that the walls of the grooves are stable


def patch(*layers, name="a", x_m=0.0, y_m=0.0, width_m=0.1, height_m=0.1, **members):
    return {"name": name, "place": {"x_m": x_m, "y_m": y_m}, "size": {"width_m": width_m, "height_m": height_m}, "layers": list(layers), **members}


def grooves(sigma=SIGMA, **members):
    return {"type": "grooves", "profile": "square", "period_m": PERIOD, "depth_m": DEPTH, "kappa_n": KAPPA, "filter_m": sigma, **members}


def noise(**members):
    return {"type": "noise", "period_m": 6e-3, "octaves": 5, "depth_m": 3e-4, "kappa_n": 4, **members}


def write_scene(*patches, name="s"):
    pathlib.Path(f"{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "patches": list(patches)}))


def write_device(*rates, name="d", delay_s=0, **members):
    axis = {"mass_kg": MASS, "viscous_n_s_per_m": VISCOUS, "coulomb_n": 0, "encoder_step_m": STEP, "travel_m": [-0.1, 0.1],
            "peak_force_n": 100, "continuous_force_n": 100, **members}
    pathlib.Path(f"{name}.device.json").write_text(json.dumps(
        {"kind": "device", "version": "1.0", "name": name, "axes": [{"name": each, **axis} for each in "xy"], "peak_force_n": 100,
         "continuous_force_n": 100, "slew_n_per_s": 1e6, "delay_s": delay_s, "rates_hz": list(rates)}))


def write_path(*rows):
    pathlib.Path("path.csv").write_text("time_s,x_mm,y_mm\n" + "".join(f"{t},{x},{y}\n" for t, x, y in rows))


def trade(*options):
    return run_json("trade", "s", "--device", "d", *options)


def refused(code, *options, scene="s"):
    run("trade", scene, "--device", "d", *options, code=code)


def close(value, expected, relative):
    assert abs(value / expected - 1) < relative, (value, expected)


def groove_force(x, sigma):
    """-kappa h' of the series of a square wave of depth 1 with its top at 0, after a Gaussian filter."""
    n = np.arange(1, 65, 2)
    amplitude = 2 / (np.pi * n) * np.where(n % 4 == 1, 1, -1) * np.exp(-((2 * np.pi * sigma / PERIOD * n) ** 2) / 2)
    turn = 2 * np.pi * n / PERIOD
    return KAPPA * DEPTH * (amplitude * turn * np.sin(turn * x[:, None])).sum(axis=1)


def errors_of_grooves_are_those_of_the_series():
    """Along x at 10 mm/s no harmonic is faster than 3/8 of the rate. At a quarter of the period all harmonics add, so the
    error along the path is nearly the promised one."""
    write_device(1000)
    write_scene(patch(grooves()))
    write_path((0, -20, 0), (4, 20, 0))
    report = trade("--finger-path", "path.csv")
    rows = [row for row in report["choices"] if row["choice_of"] == "filter of grooves 0 of 'a'"]
    assert len(rows) > 4 and len(rows) == len(report["choices"]), report["choices"]
    x = np.round((-0.02 + 0.01 * np.arange(4001) / 1000) / STEP) * STEP
    whole = groove_force(x, SIGMA)
    close(report["largest_force_n"], np.abs(whole).max(), 1e-5)  # harmonics below 1e-6 of the first are left out
    assert rows[0]["error_n"] <= rows[0]["promised_n"] == report["rounding_n"] < 1e-4
    for row in rows[1:]:
        value, unit = row["choice"].removeprefix("filter ").split()
        stated = float(value) * {"mm": 1e-3, "um": 1e-6, "µm": 1e-6}[unit]
        sigma = min((PERIOD / part for part in (64, 48, 32, 24, 16, 12, 8, 6, 4)), key=lambda each: abs(each - stated))
        close(sigma, stated, 1e-3)
        expected = np.abs(groove_force(x, sigma) - whole).max()
        assert abs(row["error_n"] - expected) < report["rounding_n"], (row, expected)
        assert row["error_n"] <= row["promised_n"], row
        close(row["promised_n"] - report["rounding_n"], expected, 1e-3)  # the path passes the quarter exactly
        write_scene(patch(grooves(sigma)), name="filtered")
        judged = run_json("design", "filtered", "--device", "d")["layers"][0]
        close(row["stiffness_n_per_m"], judged["total_stiffness_n_per_m"], 1e-9)
        close(row["limit_n_per_m"], judged["free_limit_n_per_m"], 1e-9)
    assert [row["error_n"] for row in rows] == sorted(row["error_n"] for row in rows)
    assert all(earlier["memory_kib"] > later["memory_kib"] for earlier, later in zip(rows, rows[1:]))


def free_limit(rate):
    """The exact discretisation of a mass with a damper (issue 33)."""
    period, a = 1 / rate, VISCOUS / MASS
    e = np.exp(-a * period)
    p = (period / a - (1 - e) / a**2) / MASS
    q = (1 - e) ** 2 / (a**2 * MASS) - p * e
    return min((1 - e) / q, 2 * (1 + e) / (p - q) if p > q else np.inf)


def a_lower_rate_holds_its_force():
    """A spring of K at the speed v: the force is late by up to the difference of the periods."""
    stiffness, speed = 200.0, 0.05
    write_device(250, 500, 1000)
    write_scene(patch({"type": "spring", "stiffness_n_per_m": stiffness}))
    write_path((0, -40, 0), (1.6, 40, 0))
    report = trade("--finger-path", "path.csv")
    rows = [row for row in report["choices"] if row["choice_of"] == "rate"]
    assert len(rows) == len(report["choices"]) == 3 and report["without_choice"] == "spring 0 of 'a'", report
    for row, rate in zip(rows, (250, 500, 1000)):
        expected = stiffness * speed * (1 / rate - 1 / 1000)
        assert abs(row["error_n"] - expected) < stiffness * STEP + report["rounding_n"], (row, expected)  # two half counts
        close(row["limit_n_per_m"], free_limit(rate), 1e-6)
        assert row["stiffness_n_per_m"] == stiffness and row["per"] == "ms" and row["cost_ns"] > 0, row
        assert "promised_n" not in row, row
    assert report["not_promised"] == 3


def forces(scene):
    run("render", scene, "--device", "d", "--finger-path", "path.csv", "-o", "f.csv", "--force")
    with open("f.csv") as file:
        rows = list(csv.DictReader(file))
    return np.array([[float(row["force_x_n"]), float(row["force_y_n"])] for row in rows])


def the_chosen_scene_keeps_the_error():
    """Rendered by the other verb along a path that trade does not know."""
    write_device(1000)
    write_scene(patch(noise(depth_m={"value": 3e-4, "slider": {"from": 1e-4, "to": 4e-4}}), name="sand"),
                patch(grooves(), {"type": "damper", "damping_n_s_per_m": 0.5}, name="grid", combine="add", order=1, width_m=0.06, angle_deg=20))
    write_path((0, -45, -40), (1, 45, 40), (1.5, 40, -40), (6, -30, 30))
    whole = forces("s")
    changed = []
    # The bounds: 0.19 N for each octave, from 0.3 to 1.5 N for the filters. So nothing, one octave, and all of both.
    for error in (0.02, 0.2, 4):
        report = trade("--max-error", f"{1e3 * error}mN", "-o", f"chosen{error}.scene.json")
        assert 0 < report["promised_n"] <= error and report["error_n"] <= report["promised_n"], report
        run("validate", f"chosen{error}.scene.json")
        off = np.hypot(*(forces(f"chosen{error}") - whole).T).max()
        print(f"  asked {error} N: {report['changed']}, promised {report['promised_n']:.4f} N, on a path {off:.4f} N")
        assert off <= report["promised_n"] + report["rounding_n"], (off, report["promised_n"])  # both are in single precision
        changed.append(len(report["changed"]))
        layer = json.loads(pathlib.Path(f"chosen{error}.scene.json").read_text())["patches"][1]["layers"][1]
        assert layer["type"] == "damper" and layer["damping_n_s_per_m"] == 0.5
    assert changed == [0, 1, 2], changed
    # A chosen scene is replaced with --force only; a file that is no scene, and the scene itself, never.
    before = pathlib.Path("chosen0.2.scene.json").read_text()
    refused(USAGE, "--max-error", "4N", "-o", "chosen0.2.scene.json")
    assert pathlib.Path("chosen0.2.scene.json").read_text() == before
    trade("--max-error", "4N", "-o", "chosen0.2.scene.json", "--force")
    assert pathlib.Path("chosen0.2.scene.json").read_text() != before
    run("validate", "chosen0.2.scene.json")
    pathlib.Path("other.scene.json").write_text('{"kind": "device"}')
    for kept in ("other.scene.json", "s.scene.json"):
        before = pathlib.Path(kept).read_text()
        refused(USAGE, "--max-error", "4N", "-o", kept, "--force")
        assert pathlib.Path(kept).read_text() == before
    # Both at once: with time enough the scene stays as it is; nothing is as fast as this.
    assert trade("--max-tick", "1s")["changed"] == []
    refused(UNSUITABLE, "--max-tick", "0.001us")
    refused(UNSUITABLE, "--max-tick", "0.001us", "--max-error", "10mN")


def a_softer_layer_keeps_its_added_damper():
    """Without the octave, a damper of 4 N s/m would be enough in the place of 10 N s/m, but the force would differ by 3.6 N."""
    write_device(1000, viscous_n_s_per_m=1, coulomb_n=1)
    write_scene(patch(noise(kappa_n=20, adaptive=True)))
    write_path((0, -45, -40), (0.3, 45, 40), (0.8, 40, -40))
    added = run_json("explain", "s.scene.json", "--device", "d")["layers"][1]["added_damping_n_s_per_m"]
    report = trade("--max-error", "1.2N", "-o", "soft.scene.json")
    run("validate", "soft.scene.json")
    soft, damper = json.loads(pathlib.Path("soft.scene.json").read_text())["patches"][0]["layers"]
    assert soft["octaves"] < 5 and not soft.get("adaptive", False), soft
    assert damper == {"type": "damper", "damping_n_s_per_m": added, "two_ticks": True}, (damper, added)
    off = np.hypot(*(forces("soft") - forces("s")).T).max()
    assert off <= report["promised_n"] + report["rounding_n"], (off, report)
    assert len(report["changed"]) == 2 and "without_choice" not in report, report  # the octaves, the damper
    # A scene that stays as it is keeps its adaptive layer.
    assert trade("--max-error", "10mN", "-o", "same.scene.json")["changed"] == []
    (layer,) = json.loads(pathlib.Path("same.scene.json").read_text())["patches"][0]["layers"]
    assert layer["adaptive"] is True, layer


def rates_at_which_the_scene_cannot_be_played_are_rows():
    """At 100 Hz no damper is enough; at 10 kHz the counts of the encoder would change the force by more than the friction."""
    write_device(100, 1000, 10000, delay_s=5e-4, viscous_n_s_per_m=1, coulomb_n=0.05)
    write_scene(patch(noise(kappa_n=20, adaptive=True)))
    for rate in (100, 10000):
        refused(UNSUITABLE, "--rate", f"{rate}Hz")
    report = trade("--rate", "1kHz", "-o", "t.csv", "-o", "t.html")
    rows = report["choices"]
    assert [row["choice_of"] for row in rows[5:]] == ["rate"] * 3 and len(rows) == 8, rows
    for row in (rows[5], rows[7]):
        assert row["stability"] == "not known" and row["worth_it"] == "not judged" and row["note"], row
        assert not {"error_n", "cost_ns", "memory_kib", "limit_n_per_m"} & row.keys(), row
    for row in rows[:5] + [rows[6]]:
        assert row["cost_ns"] > 0 and row["stability"] != "not known", row
    assert rows[6]["error_n"] <= report["rounding_n"], rows[6]  # it is its own reference
    with open("t.csv") as file:
        assert [row["error_n"] == "" for row in csv.DictReader(file)] == [False] * 5 + [True, False, True]


def unstable_choices_are_never_the_best():
    """The free limit at 1 kHz is 2 kN/m; five octaves have 6.7 kN/m, three 1.5 kN/m."""
    write_device(1000, viscous_n_s_per_m=1)
    write_scene(patch(noise(kappa_n=8)))
    report = trade()
    verdicts = {row["choice"]: row["stability"] for row in report["choices"]}
    assert set(verdicts.values()) == {"stable", "unstable"}, verdicts
    for row in report["choices"]:
        if row["stability"] == "unstable":
            assert row["worth_it"].startswith("never") and row["choice"] in report["answers"][0]["never_worth_it"], row
    assert verdicts.get(report["answers"][0]["knee"], "stable") == "stable", report["answers"]
    write_scene(patch(noise(kappa_n=1000)))
    report = trade()
    assert all(row["stability"] == "unstable" and row["worth_it"].startswith("never") for row in report["choices"]), report["choices"]
    assert report["answers"][0]["knee"] == "no best choice" == report["answer"].removeprefix("best for its cost: ")


def what_was_assumed_is_named():
    write_device(1000)
    write_scene(patch(grooves(), name="grid"))
    write_path((0, -20, 0), (1, 20, 0))
    report = trade("--finger-path", "path.csv", "--max-error", "10mN")
    assert "assumed" not in report and "chosen_for" not in report and "hand" in report, report
    assert report["timed_along"] == trade()["timed_along"] and report["paths"] != trade()["paths"]
    write_scene(patch(grooves(), name="grid"), patch(noise(), name="sand", x_m=0.04))
    report = trade("--hand", "minsky-radial", "--max-error", "5N", "-o", "t.html")
    assert report["hand"] == "minsky-radial" and "move" in report["assumed"] and "chosen_for" in report, report
    page = pathlib.Path("t.html").read_text()
    assert "minsky-radial" in page and report["assumed"].split(";")[0] in page
    for options in ((), ("--hand", "minsky-radial")):
        explained = run_json("explain", "s.scene.json", "--device", "d", *options)
        assert (explained["hand"] == "minsky-radial") == bool(options), explained["hand"]


def a_path_beside_all_patches_is_warned_of():
    write_device(1000)
    write_scene(patch(noise(), width_m=0.02, height_m=0.02))
    for y, warned in ((0, False), (40, True)):
        write_path((0, -20, y), (1, 20, y))
        out, err = run("trade", "s", "--device", "d", "--finger-path", "path.csv", "--json")
        assert ("path.csv" in err) == warned == (json.loads(out)["largest_force_n"] == 0), (y, err)


def files_are_written_and_valid():
    write_device(500, 1000)
    write_scene(patch(noise()))
    report = trade("-o", "t.html", "-o", "t.csv", "-o", "t.results.json")
    with open("t.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(report["choices"]) == 7, rows  # five octaves, two rates
    for row, printed in zip(rows, report["choices"]):
        assert (row["choice_of"], row["choice"]) == (printed["choice_of"], printed["choice"])
        close(float(row["limit_n_per_m"]), printed["limit_n_per_m"], 1e-8)
        assert float(row["error_n"]) <= float(row["promised_n"] or "inf"), row
        assert row["worth_it"] and row["stability"] in ("stable", "unstable"), row
    page = pathlib.Path("t.html").read_text()
    assert page.count("<img") == 2 and "prefers-color-scheme" in page
    run("validate", "t.results.json")
    pictures = json.loads(pathlib.Path("t.results.json").read_text())["pictures"]
    assert len(pictures) == 2
    # A knee is behind its line, so that it gets its colour.
    knees = 0
    for picture in pictures:
        for curve in picture["curves"]:
            if not curve.get("marks"):
                line = list(zip(curve["x"], curve["y"]))
                continue
            assert (curve["x"][0], curve["y"][0]) in line, (curve, line)
            knees += 1
    assert knees == sum(row["worth_it"] == "the knee" for row in report["choices"]), (knees, report)
    pathlib.Path("mine.csv").write_text("a,b\n1,2\n")
    refused(USAGE, "-o", "mine.csv")
    refused(USAGE, "-o", "mine.csv", "--force")


def wrong_uses_are_refused():
    write_device(500, 1000)
    write_scene(patch(noise()))
    refused(UNSUITABLE, "--max-error", "0.001uN")  # below the rounding of single precision
    refused(USAGE, "--max-error", "0N")
    refused(USAGE, "--max-error", "5mm")
    refused(USAGE, "--transducer", "wiertlewski2011")
    refused(USAGE, "--half", "offline")
    refused(UNSUITABLE, "--rate", "700Hz")
    refused(NOT_FOUND, "--finger-path", "none.csv")
    refused(USAGE, "-o", "c.scene.json")  # nothing is chosen
    pathlib.Path("elsewhere").mkdir()
    refused(USAGE, "--max-error", "5mN", "-o", "elsewhere/c.scene.json")
    refused(USAGE, "--max-error", "5mN", "-o", "s.scene.json")
    write_path((0, -200, 0), (1, 40, 0))
    refused(UNSUITABLE, "--finger-path", "path.csv")
    run("trade", "s", code=UNSUITABLE)  # a tray has no force patches
    run("trade", "s", "--max-error", "5mN", code=USAGE)
    run("trade", "--device", "d", code=USAGE)
    write_scene(patch({"type": "mass", "mass_kg": 0.1}))
    refused(UNSUITABLE)
    pathlib.Path("tray.scene.json").write_text(json.dumps(
        {"kind": "scene", "version": "1.0", "layers": [{"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}]}))
    refused(UNSUITABLE, scene="tray")


def a_field_has_no_choice():
    """Beside it the rows are those of the other layers."""
    pathlib.Path("atoms.csv").write_text("x_m,y_m,z_m,sigma_m,epsilon_j,charge_c\n0,0,0,3e-10,1e-21,0\n")
    field = {"type": "field", "file": "atoms.csv", "length_scale": 1e7, "force_scale": 1e8, "z_m": 0}
    write_device(4000)
    write_scene(patch(field, noise()))
    knobs = {row["choice_of"] for row in trade()["choices"]}
    write_scene(patch({"type": "spring", "stiffness_n_per_m": 1}, noise()))
    assert knobs == {row["choice_of"] for row in trade()["choices"]} and knobs, knobs


if __name__ == "__main__":
    for test in (a_field_has_no_choice, errors_of_grooves_are_those_of_the_series, a_lower_rate_holds_its_force, the_chosen_scene_keeps_the_error,
                 a_softer_layer_keeps_its_added_damper, rates_at_which_the_scene_cannot_be_played_are_rows,
                 unstable_choices_are_never_the_best, what_was_assumed_is_named, a_path_beside_all_patches_is_warned_of, files_are_written_and_valid,
                 wrong_uses_are_refused):
        tacto.in_folder(test)
