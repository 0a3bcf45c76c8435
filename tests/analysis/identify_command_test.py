#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`identify` by command, on emulated devices and on tables; SciPy's least_squares is the oracle of the fit."""
import json
import os
import pathlib
import re
import signal
import subprocess
import time

import numpy as np
from scipy import optimize

import tacto
from measured import key_part, measured

RNG = np.random.default_rng(5)
SWEEP = ["--frequencies", "24", "--low", "20Hz"]


def response(f, gain=20e-6, resonance=547.7, damping=0.096, pole=143.0):
    """Wiertlewski 2011, equations (5), (6), in the four numbers that determine a response."""
    r = f / resonance
    return gain / ((1 + 1j * f / pole) * (1 - r**2 + 2j * damping * r))


def write_table(name, f, h, noise=None, amplitude="amplitude_um_per_v", times=1e6, phase="phase_deg"):
    angle = np.unwrap(np.angle(h)) * (180 / np.pi if phase.endswith("deg") else 1)
    columns = [f, np.abs(h) * times, angle] + ([] if noise is None else [np.full(len(f), noise * times)])
    head = ["frequency_hz", amplitude, phase] + ([] if noise is None else ["noise_um_per_v"])
    np.savetxt(name, np.column_stack(columns), delimiter=",", header=",".join(head), comments="", fmt="%.12g")


def values(report):
    return {row["parameter"]: row for row in report["parameters"]}


def table_one_comes_back():
    """A sweep of the emulated device gives Table I, and every other verb accepts the file."""
    said = tacto.run_json("identify", "-d", "sim:tray_sensor=on", "-o", "bench", "--start-from", "wiertlewski2011", "--picture", "bench.svg", "--results", "bench.results.json")
    assert "fits" == said["verdict"], said
    for key, truth, tolerance in [("mass_kg", 6.8e-3, 2e-3), ("damping_n_s_per_m", 4.49, 5e-3),
                                  ("amplifier_resistance_ohm", 680, 5e-3)]:
        assert abs(said[key] / truth - 1) < tolerance, (key, said[key])
    found = values(said)
    # Of Table I: k_r + k_p = 80,520 N/m, m = 6.8 g, b_r = 4.49 N s/m, 2 R_a C_p = 1.11248 ms.
    for key, truth in [("resonance_hz", 547.66824), ("damping_ratio", 0.0959423), ("pole_hz", 143.06319),
                       ("gain_m_per_v", 20e-6)]:
        row = found[key]
        # Five times as wide as the 95 % interval: with four parameters a miss in a million.
        half = 2.6 * (row["high_of_95"] - row["low_of_95"]) / 2 + 1e-4 * truth
        assert abs(row["value"] - truth) < half, (key, row)
    figures = {row["figure"]: row for row in said["paper_against_itself"]}
    assert figures["resonance_hz"]["reported"] == 500 and abs(figures["resonance_hz"]["by_table_i"] - 547.7) < 0.1
    for key, reported, by_table, within in [("r_squared_actuator", 0.85, 0.99, 0.02), ("r_squared_sensor", 0.91, 0.99, 0.02), ("finger_at_resonance_db", -3, -2.9, 0.1),
                                            ("reconstruction_filter_at_500hz_db", -3, -1.25, 0.01), ("stretch_factors", 6, 8, 0)]:
        assert figures[key]["reported"] == reported and abs(figures[key]["by_table_i"] - by_table) <= within, figures[key]
    assert figures["r_squared_actuator"]["identified"] == said["r_squared"] and "identified" not in figures["r_squared_sensor"], figures
    assert said["next"].endswith("--transducer bench.transducer.json"), said["next"]
    assert "simulated" in said and "SIMULATED" in pathlib.Path("bench.svg").read_text()
    by = json.loads(pathlib.Path("bench.transducer.json").read_text())["identification"]["simulated"]
    assert "emulated device" in by and "surface" not in by and "finger" not in by and "grating" not in by, by
    assert json.load(open("bench.transducer.json"))["identification"]["misfit"] is False
    assert tacto.run_json("info", "bench.transducer.json")["identification_usable"] is True
    assert tacto.run_json("validate", "bench.transducer.json")["valid"] is True
    results_hold_what_was_found(said)


def interval_is_visible(words, row):
    """Value, low and high are exact to a twentieth of half the interval: two digits of it."""
    printed = [float(word) for word in re.fullmatch(r"(\S+) \((\S+) to (\S+)\)", words).groups()]
    half = (row["high_of_95"] - row["low_of_95"]) / 2
    for number, key in zip(printed, ("value", "low_of_95", "high_of_95")):
        assert abs(number - row[key]) <= half / 20, (words, row)


def results_hold_what_was_found(said):
    """The results contain figures and curves, and `report` draws them."""
    assert tacto.run_json("validate", "bench.results.json")["valid"] is True
    stored = json.load(open("bench.results.json"))
    figures = {row["name"]: row["value"] for row in stored["figures"]}
    found = values(said)["resonance_hz"]
    interval_is_visible(figures["resonance (Hz), 95 %"], found)
    assert not any("_" in name or "paper" in name for name in figures), figures
    assert "not separately identifiable" in figures and "condition number" in figures and stored["details"]["parameters"] == said["parameters"]
    curves = {picture["title"]: [curve["name"] for curve in picture["curves"]] for picture in stored["pictures"]}
    assert curves == {"Amplitude": ["data", "model", "95 % band", "", "inverse"], "Phase": ["data", "model", "inverse"],
                      "Residuals": ["amplitude", "phase"]}, curves
    tacto.run("report", ".", "-o", "page.html")
    page = pathlib.Path("page.html").read_text()
    assert "not separately identifiable" in page
    for beside, name in ((["--results", "tray.results.json"], "tray"), (["--picture", "plots/tray.svg"], "plots/tray"), ([], "NAME")):
        words = tacto.run("identify", "-d", "sim:tray_sensor=on", *beside, code=2)[1]
        assert f"add -o {name} for {name}.transducer.json" in words and " ".join(beside) in words and not pathlib.Path("tray.results.json").exists(), words
    for wrong, words in (("bench.txt", "results.json"), ("bench.transducer.json", "bench.transducer.json"), ("./never.transducer.json", "is named twice")):
        assert words in tacto.run("identify", "-d", "sim:tray_sensor=on", "-o", "never", "--results", wrong, code=2)[1]


def quick_methods_agree():
    for method in ("multisine", "chirp"):
        said = tacto.run_json("identify", "-d", "sim:tray_sensor=on,seed=3", "--method", method, "-o", method)
        assert said["verdict"] == "fits" and "third_harmonic_percent" not in said, said
        assert abs(values(said)["resonance_hz"]["value"] / 547.73 - 1) < 2e-3
        for has, code in (("hysteresis=0.16", 5), ("second_mode=850Hz", 0)):
            said = json.loads(tacto.run("identify", "-d", f"sim:tray_sensor=on,seed=3,{has}", "--method", method, "-o", f"{method}-{code}", "--json", code=code)[0])
            assert said["verdict"].startswith("MISFIT" if code else "fits") and (said["model"] == "second mode") == (code == 0) and said["r_squared"] > 0.9, said
    slow = tacto.run_json("identify", "-d", "sim:tray_sensor=on,rate=2kHz", "--method", "multisine", "-o", "slow")
    assert abs(values(slow)["resonance_hz"]["value"] / 547.73 - 1) < 2e-3
    assert json.loads(pathlib.Path("slow.transducer.json").read_text())["identification"]["high_hz"] <= 900  # 0.45 of the rate


def scipy_finds_the_same():
    f = np.geomspace(10, 1000, 50)
    noise = 2e-8
    h = response(f, 17e-6, 470, 0.13, 190) + noise * (RNG.standard_normal(50) + 1j * RNG.standard_normal(50))
    write_table("mine.csv", f, h, noise)

    def residuals(p):
        left = (h - response(f, *np.exp(p))) / noise
        return np.concatenate([left.real, left.imag])

    oracle = optimize.least_squares(residuals, np.log([20e-6, 500, 0.1, 143]), xtol=1e-14, ftol=1e-14)
    errors = np.sqrt(np.diag(np.linalg.inv(oracle.jac.T @ oracle.jac)))
    found = values(tacto.run_json("identify", "mine.csv", "-o", "mine"))
    for i, key in enumerate(["gain_m_per_v", "resonance_hz", "damping_ratio", "pole_hz"]):
        row, value = found[key], np.exp(oracle.x[i])
        assert abs(row["value"] / value - 1) < 1e-6, (key, row["value"], value)
        # The table has 12 digits; SciPy's Jacobian uses two points.
        assert abs(np.log(row["high_of_95"] / row["low_of_95"]) / (2 * 1.959964 * errors[i]) - 1) < 1e-3, key


def a_misfit_is_refused_unless_forced():
    said = json.loads(tacto.run("identify", "-d", "sim:tray_sensor=on,hysteresis=0.16", "--method", "sweep", "--amplitude", "2V",
                                *SWEEP, "-o", "wrong", "--json", code=5)[0])
    assert said["verdict"].startswith("MISFIT") and said["r_squared"] > 0.99 and {"next", "paper_against_itself"}.isdisjoint(said)
    assert "--method joint" in said["because"] and "second mode" not in said["model"] and all(row["misfit"] for row in said["tried"] if row["converged"]), said
    followed = json.loads(tacto.run("identify", "-d", "sim:tray_sensor=on,hysteresis=0.16", "--method", "sweep", "--second-mode", "-o", "two",
                                    "--json", code=5)[0])
    assert followed["verdict"].startswith("DID NOT") and "second_mode_zero" in followed["because"], followed["because"]
    assert all(np.isnan(row["low_of_95"]) if row["low_of_95"] is not None else True for row in said["parameters"])
    tacto.run("record", "-d", "sim:surface=C,strokes=1", "-o", "c", "--time", "1.5s")
    tacto.run("spatial", "c", "-o", "c")
    texture = sorted(pathlib.Path(".").glob("c*.texture.json"))[0]
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.005\n0.5,0.02\n")
    render = ["render", texture, "--finger-path", "path.csv", "--transducer", "wrong", "-o", "drive.wav", "--over-limit", "clip"]
    out, err = tacto.run(*render, code=5)
    assert "--unfit-transducer" in err, err
    tacto.run(*render, "--unfit-transducer")
    play = ["play", texture, "-d", "sim:", "--transducer", "wrong", "-o", "s", "--time", "0.2s"]
    assert "--unfit-transducer" in tacto.run(*play, code=5)[1]
    tacto.run(*play, "--unfit-transducer")


def hysteresis_is_written():
    said = tacto.run_json("identify", "-d", "sim:tray_sensor=on,hysteresis=0.16", "--method", "loop", "-o", "loop")
    assert abs(said["loop_opening_percent"] - 16) < 0.3 and abs(said["lag_degrees"] - 7.7) < 0.3, said
    stored = json.load(open("loop.transducer.json"))
    limit, operator = stored["drive_limit_v"], stored["hysteresis"]
    kept = sum(w * (limit - r) for r, w in zip(operator["thresholds_v"], operator["weights"]))
    assert abs(kept / limit - 1) < 1e-9
    linear = tacto.run_json("identify", "-d", "sim:tray_sensor=on", "--method", "loop", "-o", "linear")
    weights = json.load(open("linear.transducer.json"))["hysteresis"]["weights"]
    assert all(row["weight"] for row in linear["operator"]) and linear["further_weights_of_0"] == weights.count(0) > 0, linear


def loop_table(name, drive, times=1.0):
    """Displacement by an operator of three play operators, 20 um/V, 2 nm of noise."""
    x = np.zeros(len(drive))
    for weight, r in [(0.8, 0), (0.15, 1), (0.1, 2)]:
        y = 0.0
        for i, v in enumerate(drive):
            y = max(v - r, min(v + r, y))
            x[i] += weight * y
    x = times * (20e-6 * x + 2e-9 * RNG.standard_normal(len(drive)))
    np.savetxt(name, np.column_stack([np.arange(len(drive)) / 1e3, drive, x * 1e6]), delimiter=",", comments="",
               header="time_s,drive_v,displacement_um")


def loops_are_held_to_what_a_sweep_is():
    drive = 5 * np.sin(2 * np.pi * np.arange(3000) / 1e3)
    loop_table("loop.csv", drive)
    said = tacto.run_json("identify", "loop.csv", "--method", "loop", "-o", "loop", "--picture", "loop.svg", "--results", "loop.results.json")
    assert "% open" in json.load(open("loop.results.json"))["figures"][5]["value"]
    assert said["verdict"] == "fits" and "<svg" in pathlib.Path("loop.svg").read_text(), said
    assert json.load(open("loop.transducer.json"))["identification"]["high_hz"] < 1.1  # loops of 1 Hz determine no more
    kept = pathlib.Path("loop.transducer.json").read_bytes()
    for again in (["-o", "loop"], ["-o", "other", "--picture", "loop.svg"]):
        assert "--force" in tacto.run("identify", "loop.csv", "--method", "loop", *again, code=2)[1]
    assert pathlib.Path("loop.transducer.json").read_bytes() == kept and not pathlib.Path("other.transducer.json").exists()
    tacto.run("identify", "loop.csv", "--method", "loop", "-o", "loop", "--force")
    loop_table("thousand.csv", drive, 1e3)
    assert "unit" in tacto.run("identify", "thousand.csv", "--method", "loop", "-o", "bad", code=5)[1]
    loop_table("down.csv", drive, -1)
    assert "--invert" in tacto.run("identify", "down.csv", "--method", "loop", "-o", "bad", code=5)[1]
    tacto.run("identify", "down.csv", "--method", "loop", "-o", "turned", "--invert")
    loop_table("fast.csv", 5 * np.sin(2 * np.pi * 249 * np.arange(3000) / 1e3))
    assert tacto.error_of("identify", "fast.csv", "--method", "loop", "-o", "bad", code=5)["where"]
    assert not pathlib.Path("bad.transducer.json").exists()
    # The doubts about the linear model remain, whatever the loops show.
    f = np.geomspace(10, 1000, 40)
    h = response(f) * np.exp(-0.1j)
    write_table("lag.csv", f, h, 1e-9)
    said = tacto.run_json("identify", "lag.csv", "-o", "lag")
    assert said["model"] == "lag" and abs(values(said)["lag_rad"]["value"] - 0.1) < 1e-3 and "--method joint" in said["because"], said
    write_table("lag.csv", f, h * (1 + 0.1 * np.exp(-1j * f / 30)), 1e-9)  # an echo that no model has
    tacto.run("identify", "lag.csv", "-o", "wrong", code=5)
    said = json.loads(tacto.run("identify", "loop.csv", "--method", "loop", "--start-from", "wrong", "-o", "still", "--json",
                                code=5)[0])
    about = json.load(open("still.transducer.json"))["identification"]
    assert about["misfit"] and "'wrong'" in said["because"] and abs(about["high_hz"] - 1000) < 1, said
    assert "--picture" in tacto.run("identify", "taps.csv", "--method", "taps", "--rate", "100kHz", "-o", "t", "--picture",
                                    "t.svg", code=2)[1]


def stopped_leaving_nothing(*arguments):
    """A signal during the measurement: the process ends by it and leaves no file."""
    scratch = pathlib.Path("scratch")
    scratch.mkdir(exist_ok=True)
    work = subprocess.Popen([tacto.COMMAND, *arguments], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
                            env={**os.environ, "TMPDIR": str(scratch.resolve())})
    while not list(scratch.iterdir()) and arguments[0] == "fidelity":
        assert work.poll() is None, work.communicate()
        time.sleep(0.02)
    if arguments[0] == "identify":
        work.stderr.readline()  # waits for its first progress
    work.send_signal(signal.SIGTERM)
    said = work.communicate()[1]
    assert work.returncode == -signal.SIGINT and "stopped" in said, (work.returncode, said)
    assert not list(scratch.iterdir()), list(scratch.iterdir())


def a_model_can_be_requested():
    args = ["identify", "-d", "sim:tray_sensor=on,second_mode=800Hz", *SWEEP]
    two = tacto.run_json(*args, "--second-mode", "-o", "two")
    assert two["verdict"] == "fits" and two["model"] == "second mode" and "tried" not in two, two
    chosen = tacto.run_json(*args, "-o", "chosen")
    assert chosen["model"] == "second mode" and len(chosen["tried"]) == 8, chosen
    for name, row in values(two).items():
        assert abs(values(chosen)[name]["value"] / row["value"] - 1) < 1e-4, (name, row)
    assert json.load(open("two.transducer.json"))["second_mode"].keys() == json.load(open("chosen.transducer.json"))["second_mode"].keys()


def bad_input_is_one_clear_error():
    f = np.geomspace(10, 1000, 40)
    h = response(f)

    def refused(words, *options, name="bad.csv", code=5):
        err = tacto.run("identify", name, "-o", "bad", *options, code=code)[1]
        assert words in err and not pathlib.Path("bad.transducer.json").exists(), err

    write_table("bad.csv", f[:5], h[:5])
    refused("too few")
    write_table("bad.csv", f, RNG.standard_normal(40) + 1j * RNG.standard_normal(40))
    refused("noise")
    write_table("bad.csv", f, np.conj(h))
    refused("--phase-sign")
    tacto.run("identify", "bad.csv", "-o", "turned", "--phase-sign", "-1")
    for turn, given, advice in [(h, ["--phase-sign", "-1"], "omit --phase-sign"), (h, ["--invert"], "omit --invert"),
                                (h, ["--phase-sign", "-1", "--invert"], "omit --phase-sign and --invert"),
                                (-np.conj(h), [], "give --phase-sign -1 and --invert"),
                                (-np.conj(h), ["--invert"], "give --phase-sign -1"),
                                (-np.conj(h), ["--phase-sign", "-1"], "give --invert"),
                                (-h, ["--phase-sign", "-1"], "omit --phase-sign, and give --invert"), (-h, [], "give --invert")]:
        write_table("bad.csv", f, turn)
        refused(advice, *given)
    write_table("bad.csv", f, -np.conj(h))
    tacto.run("identify", "bad.csv", "-o", "both", "--phase-sign", "-1", "--invert")
    write_table("bad.csv", f, h * np.where(np.arange(40) > 17, -1, 1))
    refused("unwrapped wrongly")
    write_table("bad.csv", f, h, times=1e9)  # the values are nanometres, the header says micrometres
    refused("unit")
    tacto.run("identify", "bad.csv", "-o", "thousand", "--implausible")
    write_table("bad.csv", f / 1e3, h)
    refused("kHz")
    write_table("bad.csv", f * 2 * np.pi, h)
    refused("rad/s")
    for unit in ("khz", "rad_per_s"):
        write_table("unit.csv", f / 1e3 if unit == "khz" else f * 2 * np.pi, h)
        pathlib.Path("unit.csv").write_text(pathlib.Path("unit.csv").read_text().replace("frequency_hz", "frequency_" + unit))
        found = values(tacto.run_json("identify", "unit.csv", "-o", "unit-" + unit))
        assert abs(found["resonance_hz"]["value"] / 547.7 - 1) < 1e-6
    write_table("bad.csv", f, np.where(np.arange(40) == 22, 1000, 1) * h)
    said = json.loads(tacto.run("identify", "bad.csv", "-o", "off", "--json", code=5)[0])
    assert "frequency 23 (" in said["because"] and all(row["low_of_95"] is None or np.isnan(row["low_of_95"])
                                                     for row in said["parameters"]), said
    write_table("bad.csv", f, h, amplitude="amplitude")
    refused("unit", code=2)
    tacto.run("identify", "bad.csv", "-o", "named", "--amplitude-unit", "um/V")
    text = pathlib.Path("bad.csv").read_text().splitlines()
    text[7] = text[7].replace(text[7].split(",")[2], "nan")
    pathlib.Path("bad.csv").write_text("\n".join(text))
    refused("line 8", code=4)
    err = tacto.run("identify", "-d", "sim:", "-o", "bad", code=5)[1]
    assert "tray_sensor=on" in err, err
    tacto.run("identify", "-d", "sim:tray_sensor=on", "-o", "bad", "--method", "multisine", "--amplitude", "1uV", code=5)  # only noise
    for words, *options in (["--low", "--low", "100Hz", "--high", "50Hz"], ["--amplitude", "--amplitude", "0V"],
                            ["--frequencies", "--frequencies", "100000"]):
        assert words in tacto.run("identify", "-d", "sim:tray_sensor=on", "-o", "bad", *options, code=2)[1]
    # 6 periods at each of 60 frequencies from 1 mHz on, evenly by octaves, plus 0.05 s each: 28,746 s.
    endless = tacto.run("identify", "-d", "sim:tray_sensor=on", "-o", "bad", "--low", "1mHz", code=5)[1]
    assert "2.87e+04 s" in endless, endless
    assert tacto.error_of("identify", "-d", "sim:tray_sensor=on", "-o", "bad", "--high", "5kHz", code=5)["where"] == "--high"
    for band in ("--low", "950Hz"), ("--high", "950Hz"):  # the rate allows 900 Hz
        assert tacto.error_of("identify", "-d", "sim:tray_sensor=on,rate=2kHz", "-o", "bad", *band, code=5)["where"] == band[0]
    # Additional whole turns do no harm: values are complex.
    write_table("turns.csv", f, h)
    table = np.loadtxt("turns.csv", delimiter=",", skiprows=1)
    table[20:, 2] += 360
    np.savetxt("turns.csv", table, delimiter=",", header="frequency_hz,amplitude_um_per_v,phase_deg", comments="", fmt="%.12g")
    found = values(tacto.run_json("identify", "turns.csv", "-o", "turns"))
    assert abs(found["resonance_hz"]["value"] / 547.7 - 1) < 1e-6


def intervals_are_printed_with_digits_that_show_them():
    f, random = np.geomspace(10, 1000, 60), np.random.default_rng(3)
    for noise, narrow in [(1e-6, True), (1e-9, True), (0.05, False)]:
        h = response(f) + 20e-6 * noise * (random.standard_normal(60) + 1j * random.standard_normal(60))
        write_table("t.csv", f, h)
        said = tacto.run_json("identify", "t.csv", "-o", f"t{noise}")
        assert all(("in_full" in row) is narrow for row in said["parameters"]), said["parameters"]
        for row in said["parameters"]:
            if narrow:
                interval_is_visible(row["in_full"], row)


def another_unit_is_named_with_its_option():
    """If header and numbers disagree: the message has the likely unit and its option, and that option helps."""
    f, random = np.geomspace(10, 2000, 40), np.random.default_rng(7)
    noisy = response(f, damping=0.3) * (1 + 1e-6 * (random.standard_normal(40) + 1j * random.standard_normal(40)))

    def as_table(name, h, amplitude, phase, head):
        rows = np.column_stack([f, amplitude(np.abs(h)), phase(np.unwrap(np.angle(h)))])
        np.savetxt(name, rows, delimiter=",", header=head, comments="", fmt="%.12g")

    def decibels(re):
        return lambda size: 20 * np.log10(size / re)

    loud = noisy * 100  # 66 dB re 1 um/V: above 0 dB everywhere
    for h, head, amplitude, phase, words, option in [
            (noisy, "amplitude_um_per_v", lambda size: size * 1e6, lambda rad: rad, "radians", ["--phase-unit", "rad"]),
            (noisy, "amplitude_m_per_v", decibels(1), np.degrees, "as in 40 of 40 lines: these are probably decibels", ["--amplitude-unit", "dB m/V"]),
            (noisy, "amplitude_um_per_v", decibels(1e-6), np.degrees, "these are probably decibels", ["--amplitude-unit", "dB um/V"]),
            (loud, "amplitude_um_per_v", decibels(1e-6), np.degrees, "these are probably decibels", ["--amplitude-unit", "dB um/V"])]:
        as_table("unit.csv", h, amplitude, phase, f"frequency_hz,{head},phase_deg")
        err = tacto.run("identify", "unit.csv", "-o", "unit", code=5)[1]
        assert words in err and option[0] in err and option[1] in err and not pathlib.Path("unit.transducer.json").exists(), err
        found = values(tacto.run_json("identify", "unit.csv", "-o", "unit", *option))
        # Noise of 1e-6, five standard errors of a fit whose condition number is below 20.
        assert all(abs(found[key]["value"] / truth - 1) < 1e-4 for key, truth in [("resonance_hz", 547.7), ("gain_m_per_v", 2e-3 if h is loud else 20e-6), ("damping_ratio", 0.3)]), found
        pathlib.Path("unit.transducer.json").unlink()
    write_table("one.csv", f, response(f))
    lines = pathlib.Path("one.csv").read_text().splitlines()
    cells = lines[7].split(",")
    lines[7] = ",".join([cells[0], "-" + cells[1], cells[2]])
    pathlib.Path("one.csv").write_text("# by a lock-in\n" + "\n".join(lines))
    err = tacto.run("identify", "one.csv", "-o", "one", code=5)[1]
    assert "one.csv, line 9" in err and "decibels" not in err, err


def what_is_identified_is_undone():
    """From slow loops to a finger on the texture: the operator is fitted, stored, inverted and played."""
    tacto.run("identify", "-d", "sim:hysteresis=0.16,tray_sensor=on", "--method", "loop", "-o", "bench")
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "2s", "-o", "c")
    tacto.run("spatial", "c", "-o", "c")
    errors = {}
    for transducer in ("wiertlewski2011", "bench"):
        rows = tacto.run_json("fidelity", "c-01", "--transducer", transducer, "--speed", "51.7mm/s")["fidelity"]
        for row in rows:
            measured(f"identify_command.{transducer}.{key_part(row['tray'])}_db", row["error_db"])
        errors[transducer] = {row["tray"]: row["error_db"] for row in rows}
    tray = "hysteresis 16 %"
    print(f"{tray}: {errors['wiertlewski2011'][tray]:.1f} dB as it is, {errors['bench'][tray]:.1f} dB undone")
    assert errors["wiertlewski2011"][tray] > -15 and errors["bench"][tray] < -40, errors
    assert errors["bench"]["all three"] < errors["wiertlewski2011"]["all three"] - 10, errors
    assert errors["bench"]["ideal"] > -15, errors  # inverting a hysteresis that the tray does not have
    stopped_leaving_nothing("fidelity", "c-01", "--speed", "10mm/s,11mm/s,12mm/s")
    stopped_leaving_nothing("identify", "-d", "sim:tray_sensor=on,paced=1", "-o", "never", "--progress")
    assert not pathlib.Path("never.transducer.json").exists()
    assert "speed" in tacto.run("fidelity", "c-01", "--speed", "1e9mm/s", code=2)[1]
    assert "tactograph: warning: " in tacto.run("fidelity", "c-01", "-d", "sim:hysteresis=0.1", "--speed", "1.2mm/s")[1]


def a_sensor_by_a_known_force():
    """Table I's sensor from a recording of a known force, by tones and by a chirp; 25.23 V/N is the gain of the
    stiffnesses. Clipped recordings are refused, and the slow load cell is not accepted as the force."""
    channels = ["--input", "applied_force", "--output-channel", "tangential_force"]
    ways = {"tones": "multisine,force_low=10Hz,force_high=1kHz,force_tones=60,force_amplitude=3mN",
            "chirp": "chirp,force_low=10Hz,force_high=900Hz,force_amplitude=30mN"}
    for name, force in ways.items():
        tacto.run("record", "-d", f"sim:force={force}", "-o", name, "--time", "8s")
        said = tacto.run_json("identify", name, *channels, "-o", f"{name}-sensor")
        assert said["verdict"] == "fits" and "simulated" in said, said
        found = values(said)
        for key, truth in [("gain_v_per_n", 25.232), ("resonance_hz", 547.73), ("damping_ratio", 0.09596), ("pole_hz", 8.1069)]:
            row = found[key]
            half = 2.6 * (row["high_of_95"] - row["low_of_95"]) / 2 + 1e-4 * truth  # a miss in a million, as above
            assert abs(row["value"] - truth) < half, (key, row)
        assert found["gain_v_per_n"]["high_of_95"] / found["gain_v_per_n"]["low_of_95"] < 1.005, found
    tacto.run("record", "-d", "sim:force=chirp,force_amplitude=0.3N,force_high=900Hz", "-o", "loud", "--time", "2s")
    _, err = tacto.run("identify", "loud", *channels, "-o", "none", code=5)
    assert "tangential_force" in err, err
    tacto.run("identify", "tones", "--input", "net_force", "--output-channel", "tangential_force", "-o", "slow", code=5)


def taps_on_a_surface():
    """--method contact: NumPy's least squares and its errors without each tap; a bounce of a force over time."""
    v, a, grip = -RNG.uniform(0.03, 0.25, 40), RNG.uniform(-6, 2, 40), RNG.uniform(0.5, 4, 40)
    peak = 0.1 - 42 * v - 0.33 * a + 0.05 * grip + RNG.normal(0, 0.02, 40)
    np.savetxt("peaks.csv", np.column_stack([v, a, grip, peak]), delimiter=",", comments="", fmt="%.17g",
               header="velocity_mps,acceleration_mps2,grip_n,peak_n")
    said = tacto.run_json("identify", "peaks.csv", "--method", "contact")
    columns = np.column_stack([np.ones(40), -v, -a, grip])
    by_numpy = np.linalg.lstsq(columns, peak, rcond=None)[0]
    rows = [row for row in said["fits"] if row["inputs"] == said["best_inputs"]]
    assert np.allclose([row["value"] for row in rows], by_numpy, rtol=1e-9), (rows, by_numpy)
    left_out = []
    for i in range(40):
        others = np.arange(40) != i
        left_out.append(peak[i] - columns[i] @ np.linalg.lstsq(columns[others], peak[others], rcond=None)[0])
    assert abs(rows[0]["left_out_rms_n"] / np.sqrt(np.mean(np.square(left_out))) - 1) < 1e-9, rows[0]
    # Half sines of 1 ms at 20 kHz; tap 7 comes down twice.
    t = np.arange(400) / 20e3 - 5e-3
    with open("force.csv", "w") as out:
        out.write("tap,force_n\n")
        for tap in range(1, 13):
            pulse = tap * np.where((t > 0) & (t < 1e-3), np.sin(np.pi * t / 1e-3), 0)
            if tap == 7:
                pulse += np.where((t > 0.9e-3) & (t < 2.4e-3), 0.5, 0)
            out.writelines(f"{tap},{value:.9g}\n" for value in pulse)
    said = tacto.run_json("identify", "force.csv", "--method", "contact", "--rate", "20kHz")
    assert said["double_taps"] == "7" and abs(said["shape_factor"] / (np.pi / 2) - 1) < 0.02, said
    tacto.run("identify", "force.csv", "--method", "contact", code=2)
    tacto.run("identify", "peaks.csv", "--method", "contact", "-o", "none", code=2)
    tacto.run("identify", "peaks.csv", "--method", "contact", "--rate", "1kHz", code=2)
    # An acceleration of the other sign gives a negative mass, with a warning; without it the model has none.
    np.savetxt("signs.csv", np.column_stack([v, -a, peak]), delimiter=",", comments="", fmt="%.17g", header="velocity_mps,acceleration_mps2,peak_n")
    assert "negative" in tacto.run("identify", "signs.csv", "--method", "contact")[1]
    np.savetxt("plain.csv", np.column_stack([v, peak]), delimiter=",", comments="", fmt="%.17g", header="velocity_mps,peak_n")
    assert "acceleration x" not in tacto.run_json("identify", "plain.csv", "--method", "contact")["model"]
    tacto.run("identify", "-d", "sim:", "--method", "contact", code=2)
    for unused in (["--picture", "x.svg"], ["--results", "x.results.json"], ["--amplitude", "1V"], ["--second-mode"], ["--start-from", "wiertlewski2011"],
                   ["--phase-sign", "-1"], ["--invert"], ["--input", "drive"], ["--frequencies", "40"], ["--implausible"], ["--force"]):
        error = tacto.error_of("identify", "peaks.csv", "--method", "contact", *unused, code=2)
        assert error["where"] == unused[0], error
    # One grip for all taps: the fits without it remain.
    np.savetxt("grip.csv", np.column_stack([v, a, np.full(40, 2.0), peak]), delimiter=",", comments="", fmt="%.17g",
               header="velocity_mps,acceleration_mps2,grip_n,peak_n")
    said = tacto.run_json("identify", "grip.csv", "--method", "contact")
    assert said["columns_not_fitted"] == ["grip_n"] and {row["inputs"] for row in said["fits"]} == {"velocity", "velocity, acceleration"}, said


for test in (table_one_comes_back, quick_methods_agree, scipy_finds_the_same, a_misfit_is_refused_unless_forced,
             hysteresis_is_written, loops_are_held_to_what_a_sweep_is, what_is_identified_is_undone, a_sensor_by_a_known_force, a_model_can_be_requested,
             another_unit_is_named_with_its_option, intervals_are_printed_with_digits_that_show_them, bad_input_is_one_clear_error, taps_on_a_surface):
    tacto.in_folder(test)
