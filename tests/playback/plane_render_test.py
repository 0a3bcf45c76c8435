#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`render` and `explain` with --device on the command line: forces against NumPy and SciPy, what is refused, what is warned of."""
import json
import pathlib
import sys

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import cont2discrete

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "end-to-end"))
import tacto
from tacto import run, run_json

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
STEP_M, RATE_HZ = 1e-5, 4000  # of sandpaper-1990
KNOTS = {"time_s": np.linspace(0, 2, 21)}
KNOTS["x_m"] = 0.04 * np.sin(2 * np.pi * 0.7 * KNOTS["time_s"])
KNOTS["y_m"] = 0.03 * np.cos(2 * np.pi * 0.5 * KNOTS["time_s"])


def patch(name="a", x_m=0.0, y_m=0.0, width_m=0.2, height_m=0.2, layers=(), **members):
    return {"name": name, "place": {"x_m": x_m, "y_m": y_m}, "size": {"width_m": width_m, "height_m": height_m}, "layers": list(layers), **members}


def spring(stiffness, x_m=0.0, y_m=0.0):
    return {"type": "spring", "stiffness_n_per_m": stiffness, "centre_x_m": x_m, "centre_y_m": y_m}


def damper(damping):
    return {"type": "damper", "damping_n_s_per_m": damping}


def body(mass, stiffness, damping, **friction):
    return {"type": "body", "mass_kg": mass, "stiffness_n_per_m": stiffness, "damping_n_s_per_m": damping, **friction}


def lasso(mass, stiffness, length, damping):
    return {"type": "lasso", "mass_kg": mass, "stiffness_n_per_m": stiffness, "length_m": length, "damping_n_s_per_m": damping}


def grooves(profile, period, depth, kappa, **members):
    return {"type": "grooves", "profile": profile, "period_m": period, "depth_m": depth, "kappa_n": kappa, **members}


def noise(period, depth, kappa, **members):
    return {"type": "noise", "period_m": period, "depth_m": depth, "kappa_n": kappa, **members}


def write_scene(name, *patches, **members):
    pathlib.Path(f"{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "patches": list(patches), **members}))


def write_path(name, columns):
    rows = np.column_stack(list(columns.values()))
    np.savetxt(name, rows, delimiter=",", header=",".join(columns), comments="")


def render(scene, *options, **how):
    return run("render", scene, "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "f.csv", "--force", *options, **how)


def forces():
    table = np.genfromtxt("f.csv", delimiter=",", names=True)
    assert table.dtype.names == ("time_s", "x_m", "y_m", "force_x_n", "force_y_n"), table.dtype.names
    return table


def counted(place):
    return np.rint(place / STEP_M) * STEP_M


def springs_are_numpys():
    angle = np.deg2rad(30)
    write_scene("bench", patch(x_m=0.01, angle_deg=30, layers=[spring(50, 0.02, -0.01), spring(15)]))
    write_path("path.csv", KNOTS)
    report = json.loads(render("bench.scene.json", "--json")[0])
    table = forces()
    assert len(table) == report["ticks"] == 2 * RATE_HZ + 1
    for axis in "xy":
        # The path between its knots is SciPy's PCHIP: 1e-12 is rounding of 0.05 m.
        along = PchipInterpolator(KNOTS["time_s"], KNOTS[f"{axis}_m"])(table["time_s"])
        assert np.abs(along - table[f"{axis}_m"]).max() < 1e-12
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    place = np.array([counted(table["x_m"]), counted(table["y_m"])])
    local = turn.T @ (place - np.array([[0.01], [0]]))
    force = turn @ (-50 * (local - np.array([[0.02], [-0.01]])) - 15 * local)
    found = np.array([table["force_x_n"], table["force_y_n"]])
    worst = np.abs(force - found).max()
    print(f"  springs: within {worst:.2g} N of NumPy's, of {np.abs(force).max():.3g} N")
    assert worst < 65 * 0.15 * 3e-7, worst  # of the sum of the absolute forces, as SceneKernel states
    assert report["peak_limited_ticks"] == report["slew_limited_ticks"] == report["rms_limited_ticks"] == 0, report
    assert report["largest_rounding_n"] < 65 * 0.15 * 3e-7, report


def sine_grooves_are_their_derivative():
    write_scene("waves", patch(x_m=0.01, angle_deg=15, layers=[grooves("sine", 0.004, 3e-4, 2, direction_deg=20)]))
    slow = {**KNOTS, "x_m": 0.1 * KNOTS["x_m"], "y_m": 0.1 * KNOTS["y_m"]}
    write_path("path.csv", slow)
    report = json.loads(render("waves.scene.json", "--json")[0])
    table, angle, turn = forces(), np.deg2rad(35), 2 * np.pi / 0.004
    across = np.cos(angle) * (counted(table["x_m"]) - 0.01) + np.sin(angle) * counted(table["y_m"])
    slope = -0.5 * 3e-4 * turn * np.sin(turn * across)
    force = np.array([np.cos(angle), np.sin(angle)])[:, None] * (-2 * slope)
    worst = np.abs(force - np.array([table["force_x_n"], table["force_y_n"]])).max()
    print(f"  sine grooves: within {worst:.2g} N of the derivative, of {np.abs(force).max():.3g} N")
    # The hand passes 0.006 periods per tick at most: the whole sine is played. The rounding of single precision.
    assert worst < 3e-7 * np.abs(force).max() and report["largest_rounding_n"] < 3e-7 * np.abs(force).max(), (worst, report)


def a_field_is_the_direct_sum_of_its_atoms():
    random = np.random.default_rng(9)
    atoms = np.column_stack([random.uniform(-2e-9, 2e-9, (60, 2)), random.uniform(-5e-10, 5e-10, 60),
                             random.uniform(2.5e-10, 3.5e-10, 60), random.uniform(1e-22, 1e-21, 60), random.uniform(-1e-20, 1e-20, 60)])
    header = "x_m,y_m,z_m,sigma_m,epsilon_j,charge_c"
    np.savetxt("atoms.csv", atoms, delimiter=",", header=header, comments="", fmt="%.17g")
    layer = {"type": "field", "file": "atoms.csv", "length_scale": 1.5e7, "force_scale": 5e8, "z_m": 0.002, "core": 0.9, "probe_charge_c": 1.602176634e-19}
    write_scene("docking", patch(x_m=0.01, angle_deg=30, width_m=0.2, height_m=0.2, layers=[layer]))
    write_path("path.csv", {"time_s": [0, 1, 2, 3], "x_m": [-0.02, 0.04, 0.0, 0.03], "y_m": [0.0, 0.01, -0.03, 0.03]})
    report = json.loads(render("docking.scene.json", "--json")[0])
    table, angle = forces(), np.deg2rad(30)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    place = turn.T @ np.array([counted(table["x_m"]) - 0.01, counted(table["y_m"])])
    way = np.vstack([place, np.full(len(table), 0.002)])[:, :, None] / 1.5e7 - atoms[:, :3].T[:, None, :]
    sigma, epsilon, charge = atoms[:, 3:].T
    r = np.sqrt((way**2).sum(axis=0))
    held = np.maximum(r, 0.9 * sigma)
    lennard_jones = 24 * epsilon / held * (2 * (sigma / held)**12 - (sigma / held)**6)
    coulomb = charge * 1.602176634e-19 / (4 * np.pi * 8.8541878188e-12 * held**2)
    force = 5e8 * turn @ ((lennard_jones + coulomb) * way[:2] / held).sum(axis=2)
    worst = np.abs(force - np.array([table["force_x_n"], table["force_y_n"]])).max()
    print(f"  a field of 60 atoms: within {worst:.2g} N of the direct sum, of {np.abs(force).max():.3g} N")
    assert report["peak_limited_ticks"] == report["slew_limited_ticks"] == report["rms_limited_ticks"] == 0, report
    # Single precision: up to 35 roundings of s^7, and units of the place.
    assert worst < 3e-6 * np.abs(force).max() and report["largest_rounding_n"] < 3e-6 * np.abs(force).max(), (worst, report)
    explained = run_json("explain", "docking.scene.json", "--device", "sandpaper-1990")["layers"][0]
    step, change = np.hypot(*np.diff(place)), np.hypot(*np.diff(force))
    steepest = (change[step > 0] / step[step > 0]).max()
    # No change along the path is steeper; 5 %: its search takes places around each core and a grid.
    assert explained["atoms"] == 60 and explained["stiffness_n_per_m"] > 0.95 * steepest, (explained, steepest)
    for text, words in (("0,0,0,nan,1,0", "line 2"), ("0,0,0,1e-10,1e-21", "line 2")):
        pathlib.Path("atoms.csv").write_text(f"{header}\n{text}\n")
        error = render("docking.scene.json", code=MALFORMED)[1]
        assert "atoms.csv" in error and words in error, error
    write_scene("unscaled", patch(layers=[{"type": "field", "file": "atoms.csv", "force_scale": 1}]))
    assert "length_scale" in render("unscaled.scene.json", code=MALFORMED)[1]


def a_filtered_step_rests_and_a_steeper_one_swings():
    # At x = -sigma on a rising step the curvature is the largest. A soft hand far away (0.1 N/m) pushes with the force that balances it there.
    rate, kappa, depth, period, mass, viscous = 1000, 2.0, 1e-4, 0.01, 0.1, 1.17
    write_line("free", mass=mass - 1e-4, viscous=viscous, rate=rate, travel=10)
    write_hand("push", 1e-4, 0, 0.1)
    e, a = np.exp(-viscous / rate / mass), viscous / mass
    p, q = (1 / rate / a - (1 - e) / a**2) / mass, (1 - e)**2 / (a**2 * mass) - (1 / rate / a - (1 - e) / a**2) / mass * e
    limit = min((1 - e) / q, 2 * (1 + e) / (p - q) if p > q else np.inf)
    bare = np.sqrt(0.242 * kappa * depth / limit)

    def swing(margin, device="free", hand="push", hand_stiffness=0.1, kappa=kappa, at=0.0):
        """RMS of the last quarter, m, and sigma. The highest place is at the centre of the patch, so a step rises a quarter of a period before it: at `at`, m."""
        write_scene("step", patch(x_m=at + period / 4, width_m=0.1, layers=[grooves("square", period, depth, kappa, filter_margin=margin)]))
        # The soft hand's mass of 1e-4 kg is not in the limit of the free device.
        printed = run_json("explain", "step.scene.json", "--device", device, *(("--hand", hand) if hand != "push" else ()))
        sigma = printed["layers"][0]["filter_m"]
        assert abs(sigma / (margin * np.sqrt(0.242 * kappa * depth / printed["stiffness_limit_n_per_m"])) - 1) < 1e-5, printed
        push = kappa * depth * np.exp(-0.5) / (np.sqrt(2 * np.pi) * sigma)
        write_path("push.csv", {"time_s": [0, 0.001, 40], "x_m": [at - sigma, at - sigma + push / hand_stiffness, at - sigma + push / hand_stiffness]})
        run("render", "step.scene.json", "--finger-path", "push.csv", "--device", device, "--hand", hand, "-o", "step.csv", "--force")
        place = np.genfromtxt("step.csv", delimiter=",", names=True)["x_m"]
        return np.std(place[3 * len(place) // 4:]), sigma, printed["stiffness_limit_n_per_m"]

    swings = {}
    for margin in (1.03, 0.97):
        rms, sigma, printed = swing(margin)
        assert abs(printed / limit - 1) < 1e-5 and abs(sigma / (margin * bare) - 1) < 1e-5, (printed, limit)
        swings[margin] = rms / sigma
    print(f"  a step with sigma 1.03 and 0.97 times the limit: RMS swing {swings[1.03]:.2g} and {swings[0.97]:.2g} sigma")
    # At rest a motion of the beginning has become smaller by e^(-0.35 * 30): its damping is 6 % of 1.17 N s/m on 0.1 kg. The swing is the issue's.
    assert swings[1.03] < 1e-4 and abs(swings[0.97] - 0.35) < 0.05, swings
    # The rounding of an encoder of 10 um moves it at the bare limit, and not with the margin of 1.5: the figures of the issue, RMS. How much depends on
    # where between two counts the place of rest is, so the median of many places is the figure. Over 64 of them, at 1.03, the same loop iterated in NumPy
    # (the plant's zero-order hold, the step as a Gaussian, rounded places) finds 0.46 to 1.28 counts, half of them within 0.15 of 0.95.
    write_line("coarse", mass=mass - 1e-4, viscous=viscous, rate=rate, travel=10, step=1e-5)
    counts = {margin: sorted(swing(margin, "coarse", at=1e-5 * place / places)[0] / 1e-5 for place in range(places))
              for margin, places in ((1.03, 32), (0.97, 8), (1.5, 8))}
    for margin, found in counts.items():
        print(f"  with an encoder of 10 um, sigma {margin} times the limit: {found[0]:.2g} to {found[-1]:.2g}, median {np.median(found):.2g} counts RMS")
    assert abs(np.median(counts[1.03]) - 0.9) < 0.15 and 4 <= np.median(counts[0.97]) <= 11 and counts[1.5][-1] < 0.5, counts
    # In a hand, with its own limit, the boundary is the same; the surface is steeper, because no filter is below a 76th of the period.
    write_hand("firm", 0.4, 2, 100)
    held = {margin: swing(margin, "free", "firm", 100, 4 * kappa) for margin in (1.03, 0.97)}
    print(f"  in a hand, limit {held[1.03][2]:.4g} N/m: {held[1.03][0] / held[1.03][1]:.2g} and {held[0.97][0] / held[0.97][1]:.2g} sigma")
    assert held[1.03][2] > 1.2 * limit and held[1.03][0] < 1e-3 * held[1.03][1] and abs(held[0.97][0] / held[0.97][1] - 0.35) < 0.05, held


def dampers_follow_the_path():
    write_scene("soup", patch(layers=[damper(20)]))
    write_path("path.csv", KNOTS)
    render("soup.scene.json")
    table = forces()
    for axis in "xy":
        speed = PchipInterpolator(KNOTS["time_s"], KNOTS[f"{axis}_m"]).derivative()(table["time_s"])
        force = table[f"force_{axis}_n"][40:]
        error = np.abs(force + 20 * speed[40:])
        plain = np.abs(-20 * np.diff(counted(table[f"{axis}_m"])) * RATE_HZ + 20 * speed[1:])
        # One count per tick is 0.04 m/s: 0.8 N. The window of 16 edges leaves a tenth of it.
        print(f"  damper along {axis}: RMS error {np.sqrt(np.mean(error**2)):.2g} N, of a difference of two ticks {np.sqrt(np.mean(plain**2)):.2g} N")
        assert np.sqrt(np.mean(error**2)) < 0.25 * np.sqrt(np.mean(plain**2))


def what_a_device_cannot_do_is_warned_of():
    write_path("path.csv", KNOTS)
    write_scene("far", patch(x_m=0.1, width_m=0.1, layers=[damper(1)]))
    assert "travel" in render("far.scene.json")[1]
    write_scene("stiff", patch(layers=[spring(5000)]))
    out, err = render("stiff.scene.json")
    assert "peak" in err and "%" in err, err
    table = forces()
    assert np.hypot(table["force_x_n"], table["force_y_n"]).max() <= 20 * (1 + 1e-6)
    write_scene("both", patch(layers=[damper(1)]), layers=[{"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}])
    assert "left out" in render("both.scene.json")[1]


def wrong_uses_are_refused():
    write_path("path.csv", KNOTS)
    write_scene("bench", patch(layers=[spring(10)]))
    write_scene("heavy", patch(layers=[spring(10), {"type": "mass", "mass_kg": 1}]))
    tray = {"kind": "scene", "version": "1.0", "layers": [{"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}]}
    pathlib.Path("tray.scene.json").write_text(json.dumps(tray))
    arguments = {"scene": "bench.scene.json", "--finger-path": "path.csv", "--device": "sandpaper-1990", "-o": "out.csv"}

    def refused(code, *words, **changed):
        given = {**arguments, **{("scene" if key == "scene" else f"--{key.replace('_', '-')}"): value for key, value in changed.items()}}
        options = [part for pair in list(given.items())[1:] if pair[1] is not None for part in pair]
        _, err = run("render", given["scene"], *options, code=code)
        assert all(word in err for word in words) and not pathlib.Path("out.csv").exists(), (words, err)

    refused(UNSUITABLE, "heavy.scene.json#/patches/0/layers/1/type", "spring", "damper", scene="heavy.scene.json")
    refused(UNSUITABLE, "no force patches", scene="tray.scene.json")
    refused(UNSUITABLE, "texture", scene="oak")
    refused(NOT_FOUND, "sandpaper-1990", device="nobody")
    refused(UNSUITABLE, "--rate", "4000", rate="333Hz")
    refused(USAGE, "--gain", gain="1mm/N")
    refused(USAGE, "--transducer", transducer="wiertlewski2011")
    refused(USAGE, "--transducer or --device", device=None)
    refused(USAGE, "--hand", device=None, transducer="wiertlewski2011", hand="minsky-radial")
    refused(NOT_FOUND, "minsky-radial", hand="nobody")
    write_path("line.csv", {"time_s": KNOTS["time_s"], "x_m": KNOTS["x_m"]})
    refused(MALFORMED, "'y'", finger_path="line.csv")
    write_path("wide.csv", {**KNOTS, "x_m": 10 * KNOTS["x_m"]})
    refused(UNSUITABLE, "travel", finger_path="wide.csv")
    pathlib.Path("mine.csv").write_text("name,age\n")
    run("render", "bench.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "mine.csv", "--force", code=USAGE)
    assert pathlib.Path("mine.csv").read_text() == "name,age\n"


def explain_lists_what_is_built():
    write_scene("one", patch(layers=[spring(10)]))
    one = run_json("explain", "one.scene.json", "--device", "sandpaper-1990")
    assert one["fits"] is True and [row["type"] for row in one["layers"]] == ["spring"], one
    assert one["block_bytes"] + one["kernel_bytes"] < 4096 and one["layers"][0]["force_limit_at_displacement_m"] == 2, one
    # A spring has no table: 8 bytes and three numbers, behind a header of 20 bytes and a patch of 32.
    assert one["layers"][0]["bytes"] == 8 + 12 and one["block_bytes"] == 20 + 32 + 20, one
    assert [row["part"] for row in one["left_out"]] == ["speed of the hand"], one
    write_scene("three", patch(layers=[spring(10), grooves("square", 0.001, 1e-4, 1)]))
    row = run_json("explain", "three.scene.json", "--device", "sandpaper-1990")["layers"][1]
    # 3/8 and 1/2 of the rate: of the last harmonic, and of the first.
    assert abs(row["whole_to_mps"] - 0.375 * 4000 * 0.001 / row["harmonics"]) < 1e-9 and row["zero_from_mps"] == 2, row
    assert row["bytes"] == 8 + 8 + 44 + 4 * row["harmonics"], row
    write_scene("four", patch(layers=[noise(0.002, 1e-4, 1, octaves=3)]))
    row = run_json("explain", "four.scene.json", "--device", "sandpaper-1990")["layers"][0]
    # An octave has up to 2 cycles a period.
    assert abs(row["whole_to_mps"] - 0.375 * 4000 * 0.001 / 4) < 1e-9 and abs(row["zero_from_mps"] - 2) < 1e-9 and row["bytes"] == 8 + 8 + 328 + 12, row
    write_scene("two", patch(layers=[spring(10), damper(4)]))
    two = run_json("explain", "two.scene.json", "--device", "sandpaper-1990", "--rate", "250Hz")
    assert two["rate_hz"] == 250 and "left_out" not in two and two["layers"][1]["force_limit_at_speed_mps"] == 5, two
    assert two["block_bytes"] == one["block_bytes"] + two["layers"][1]["bytes"], (one, two)
    assert run_json("explain", "two.scene.json", "--device", "sandpaper-1990", "--device-memory", "10")["fits"] is False
    # A board's room is what its core offers for a scene: 12,000 words, less 1696 for what changes of the largest one.
    board = run_json("explain", "two.scene.json", "--device", "sandpaper-1990", "--board", "stm32f405")
    assert board["fits"] is True and board["device_bytes"] == 4 * (12_000 - 1696) and board["board_tick_cycles"] > 3000, board
    write_scene("dear", patch(layers=100 * [noise(0.002, 1e-4, 1, octaves=8)]))
    dear = run_json("explain", "dear.scene.json", "--device", "sandpaper-1990", "--board", "stm32f405")
    assert dear["fits"] is False and dear["board_tick_cycles"] * 4000 > 168e6 and dear["largest_rate_hz"] < 4000, dear
    # With a slider at its upper end.
    twice = lambda value: {"value": value, "slider": {"from": value, "to": 2 * value}}
    body = {"type": "body", "mass_kg": 0.3, "stiffness_n_per_m": twice(10), "damping_n_s_per_m": 4}
    mover = {"type": "mover", "speed_mps": 0.1, "damping_n_s_per_m": twice(4)}
    write_scene("slid", patch(layers=[body, mover, {**spring(0), "stiffness_n_per_m": twice(10)}, {**damper(0), "damping_n_s_per_m": twice(4)}]))
    slid = run_json("explain", "slid.scene.json", "--device", "sandpaper-1990")["layers"]
    assert [slid[i]["force_limit_at_displacement_m"] for i in (0, 2)] == [1, 1] and [slid[i]["force_limit_at_speed_mps"] for i in (1, 3)] == [2.5, 2.5], slid


def a_device_of_one_axis_moves_on_a_line():
    axis = {"name": "x", "mass_kg": 0.1, "viscous_n_s_per_m": 1, "coulomb_n": 0, "encoder_step_m": STEP_M, "travel_m": [-0.1, 0.1], "peak_force_n": 20, "continuous_force_n": 20}
    made = {"kind": "device", "version": "1.0", "name": "line", "axes": [axis], "peak_force_n": 20, "continuous_force_n": 20, "slew_n_per_s": 20000,
            "delay_s": 0, "rates_hz": [1000]}
    pathlib.Path("line.device.json").write_text(json.dumps(made))
    pathlib.Path("up.device.json").write_text(json.dumps({**made, "axes": [{**axis, "name": "z"}]}))
    write_scene("bench", patch(angle_deg=45, layers=[spring(100, 0.01, 0)]))
    write_path("line.csv", {"time_s": KNOTS["time_s"], "x_m": KNOTS["x_m"]})
    _, err = run("render", "bench.scene.json", "--finger-path", "line.csv", "--device", "line", "-o", "line_f.csv")
    assert "axis" in err, err
    table = np.genfromtxt("line_f.csv", delimiter=",", names=True)
    assert table.dtype.names == ("time_s", "x_m", "force_x_n")
    assert np.abs(table["force_x_n"] + 100 * (counted(table["x_m"]) - 0.01 * np.sqrt(0.5))).max() < 1e-5
    _, err = run("render", "bench.scene.json", "--finger-path", "line.csv", "--device", "up", "-o", "up.csv", code=UNSUITABLE)
    assert "axis" in err, err


def write_line(name, mass=0.1, viscous=1.17, coulomb=0.0, step=1e-9, rate=1000, delay=0.0, travel=0.1):
    """A device of one axis that no limit disturbs."""
    axis = {"name": "x", "mass_kg": mass, "viscous_n_s_per_m": viscous, "coulomb_n": coulomb, "encoder_step_m": step, "travel_m": [-travel, travel],
            "peak_force_n": 200, "continuous_force_n": 200}
    made = {"kind": "device", "version": "1.0", "name": name, "axes": [axis], "peak_force_n": 200, "continuous_force_n": 200, "slew_n_per_s": 1e6,
            "delay_s": delay, "rates_hz": [rate]}
    pathlib.Path(f"{name}.device.json").write_text(json.dumps(made))


def write_hand(name, mass, damping, stiffness):
    pathlib.Path(f"{name}.hand.json").write_text(json.dumps({"kind": "hand", "version": "1.0", "name": name, "mass_kg": mass, "damping_n_s_per_m": damping,
                                                             "stiffness_n_per_m": stiffness, "source": "test"}))


def sampled_loop(place, rate, mass, viscous, stiffness, spring_k, damper_b, late_ticks):
    """The same loop by scipy.signal.cont2discrete: x, v and the hand's place, which moves evenly between ticks."""
    # State x, v, p; inputs force and p'. Zero-order hold of both is exact.
    a = np.array([[0, 1, 0], [-stiffness / mass, -viscous / mass, stiffness / mass], [0, 0, 0]])
    b = np.array([[0, 0], [1 / mass, 0], [0, 1]])
    ad, bd, *_ = cont2discrete((a, b, np.eye(3), np.zeros((3, 2))), 1 / rate, method="zoh")
    state, before, found = np.array([place[0], 0, place[0]]), place[0], []
    forces = [0.0] * late_ticks
    for now, following in zip(place, np.append(place[1:], place[-1])):
        x = state[0]
        found.append(x)
        forces.append(-spring_k * x - damper_b * (x - before) * rate)
        before = x
        state = ad @ state + bd @ np.array([forces[-1 - late_ticks], (following - now) * rate])
    return np.array(found)


def a_hand_on_a_spring_and_a_damper_is_scipys_loop():
    rate, knots = 1000, {"time_s": np.linspace(0, 3, 13)}
    knots["x_m"] = np.array([0.02, 0.02, -0.02, 0.02, -0.02, -0.02, 0.02, 0.01, -0.01, 0.02, 0.02, -0.02, 0.0])
    write_path("swing.csv", knots)
    write_hand("mine", 0.8, 3, 400)
    write_scene("bench", patch(layers=[spring(300), damper(2)]))
    for late_ticks in (0, 1):
        write_line("line", delay=late_ticks / rate)
        run("render", "bench.scene.json", "--finger-path", "swing.csv", "--device", "line", "--hand", "mine", "-o", f"swing{late_ticks}.csv")
        table = np.genfromtxt(f"swing{late_ticks}.csv", delimiter=",", names=True)
        found = sampled_loop(table["hand_x_m"], rate, 0.9, 4.17, 400, 300, 2, late_ticks)
        worst, swing = np.abs(found - table["x_m"]).max(), np.ptp(table["x_m"])
        print(f"  a hand on a spring and a damper, {late_ticks} ticks late: within {worst:.2g} m of SciPy's loop, of a swing of {1e3 * swing:.3g} mm")
        # 1e-6 of 20 mm: the encoder's step is 5e-8 of it, single precision 6e-8 of each force.
        assert swing > 0.02 and worst < 1e-6 * 0.02, (worst, swing)


def brick_loop(place, rate, mass, viscous, stiffness, brick_kg, spring_k, damper_b):
    """The hand's x, v and place p, and the brick's y, w, under the force of the coupling, which is held for both."""
    a, b = np.zeros((5, 5)), np.zeros((5, 2))
    a[0, 1], a[1, :3], a[3, 4] = 1, [-stiffness / mass, -viscous / mass, stiffness / mass], 1
    b[1, 0], b[2, 1], b[4, 0] = 1 / mass, 1, -1 / brick_kg
    ad, bd, *_ = cont2discrete((a, b, np.eye(5), np.zeros((5, 2))), 1 / rate, method="zoh")
    state, before, found = np.array([place[0], 0, place[0], place[0], 0]), place[0], []
    for now, following in zip(place, np.append(place[1:], place[-1])):
        x = state[0]
        found.append(x)
        force = spring_k * (state[3] - x) + damper_b * (state[4] - (x - before) * rate)
        before = x
        state = ad @ state + bd @ np.array([force, (following - now) * rate])
    return np.array(found)


def a_brick_in_a_hand_is_scipys_loop():
    knots = {"time_s": np.linspace(0, 3, 13)}
    knots["x_m"] = np.array([0.02, 0.02, -0.02, 0.02, -0.02, -0.02, 0.02, 0.01, -0.01, 0.02, 0.02, -0.02, 0.0])
    write_path("swing.csv", knots)
    write_hand("mine", 0.8, 3, 400)
    write_line("line")
    write_scene("brick", patch(layers=[body(0.2, 300, 2)]))
    run("render", "brick.scene.json", "--finger-path", "swing.csv", "--device", "line", "--hand", "mine", "-o", "brick.csv")
    table = np.genfromtxt("brick.csv", delimiter=",", names=True)
    found = brick_loop(table["hand_x_m"], 1000, 0.9, 4.17, 400, 0.2, 300, 2)
    worst, swing = np.abs(found - table["x_m"]).max(), np.ptp(table["x_m"])
    print(f"  a brick on a spring in a hand: within {worst:.2g} m of SciPy's loop, of a swing of {1e3 * swing:.3g} mm")
    # As for the spring; without the brick the hand is elsewhere.
    alone = sampled_loop(table["hand_x_m"], 1000, 0.9, 4.17, 400, 0, 0, 0)
    assert swing > 0.02 and worst < 1e-6 * 0.02 and np.abs(alone - table["x_m"]).max() > 1e-3, (worst, swing)


def bodies_that_are_too_stiff_are_refused():
    write_path("path.csv", KNOTS)
    rate = RATE_HZ

    def limit(layer, stiffness, fits):
        write_scene("stiff", patch(layers=[{**layer, "stiffness_n_per_m": stiffness}]))
        _, err = render("stiff.scene.json", code=0 if fits else UNSUITABLE)
        assert fits or "stiff.scene.json#/patches/0/layers/0/stiffness_n_per_m" in err, err

    limit(body(0.2, 0, 2), 2 * 2 * rate * 1.001, False)  # 2 B / T
    limit(body(0.2, 0, 2), 2 * 2 * rate * 0.999, True)
    limit(body(0.2, 0, 0), 1, False)
    limit(body(1e-4, 0, 2), 1, False)  # B < 2 m / T = 0.8
    # A lasso by the exact discretisation: the zeros of z^2 - (1 + e - K p) z + e + K q are in the unit circle, e = e^(-b T / m).
    mass, damping = 0.05, 3
    a, e, period = damping / mass, np.exp(-damping / mass / rate), 1 / rate
    p, q = (period / a - (1 - e) / a**2) / mass, (1 - e)**2 / (a**2 * mass) - (period / a - (1 - e) / a**2) / mass * e
    largest = min((1 - e) / q, 2 * (1 + e) / (p - q) if p > q else np.inf)
    limit(lasso(mass, 0, 0.01, damping), 1.001 * largest, False)
    limit(lasso(mass, 0, 0.01, damping), 0.999 * largest, True)
    printed = run_json("explain", "stiff.scene.json", "--device", "sandpaper-1990")["layers"][0]
    # 8 bytes, two numbers and nine of the state, a table of 16.
    assert abs(printed["stiffest_coupling_n_per_m"] / largest - 1) < 1e-9 and printed["bytes"] == 8 + 44 + 16, printed


def a_stiff_spring_is_stable_at_1_khz_and_not_at_100_hz():
    # Minsky 1990: 2773 N/m with 1.17 + 5 N s/m. With the hand's own spring continuous, the greatest period is 4.48 ms.
    write_path("still.csv", {"time_s": [0, 2, 4], "x_m": [0.001, 0.001, 0.001]})
    write_hand("mine", 0.7, 5, 400)
    write_scene("bench", patch(layers=[spring(2773)]))
    swings = {}
    for rate in (1000, 100):
        write_line("line", step=1e-7, rate=rate)
        run("render", "bench.scene.json", "--finger-path", "still.csv", "--device", "line", "--hand", "mine", "-o", f"at{rate}.csv")
        place = np.genfromtxt(f"at{rate}.csv", delimiter=",", names=True)["x_m"]
        swings[rate] = np.ptp(place[len(place) // 2:])
    # At 1 kHz 6.2 N s/m less K T / 2 are left on 0.8 kg: e^(-3 t), 2.5 um after 2 s.
    assert swings[1000] < 1e-5 and swings[100] > 0.01, swings


def coulomb_friction_holds_the_hand():
    write_path("pull.csv", {"time_s": [0, 1, 2], "x_m": [0, 0, 0.01]})
    write_hand("mine", 0.5, 3, 400)
    write_scene("bench", patch(layers=[damper(1)]))
    write_line("rough", coulomb=2, step=1e-6)
    run("render", "bench.scene.json", "--finger-path", "pull.csv", "--device", "rough", "--hand", "mine", "-o", "pull.csv.out")
    table = np.genfromtxt("pull.csv.out", delimiter=",", names=True)
    # 400 N/m and 2 N: it moves when the hand is 5 mm away, and never comes nearer than that on the way.
    assert np.all(table["x_m"][table["hand_x_m"] < 0.00499] == 0) and table["x_m"][-1] > 0.002


if __name__ == "__main__":
    for test in (springs_are_numpys, sine_grooves_are_their_derivative, a_field_is_the_direct_sum_of_its_atoms, a_filtered_step_rests_and_a_steeper_one_swings, dampers_follow_the_path, what_a_device_cannot_do_is_warned_of, wrong_uses_are_refused, explain_lists_what_is_built,
                 a_device_of_one_axis_moves_on_a_line, a_hand_on_a_spring_and_a_damper_is_scipys_loop, a_brick_in_a_hand_is_scipys_loop,
                 bodies_that_are_too_stiff_are_refused, a_stiff_spring_is_stable_at_1_khz_and_not_at_100_hz,
                 coulomb_friction_holds_the_hand):
        tacto.in_folder(test)
