#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`calibrate`, `doctor` and the use of a calibration in `record`, by command, against the emulated device's true
values."""
import json
import os
import pathlib
import subprocess

import soundfile

import tacto

# The true values of the emulated bench that differ from the device's description.
TRUTH = "cell_gain=1.04,cell_zero=0.05N,sensor_gain=0.93,encoder_gain=1.003,seed=7"
FILE = "config/tactograph/calibrations/sim-7.calibration.json"


def bench(keys):
    return f"sim:{keys},{TRUTH}"


def record(name, keys, time="1s"):
    tacto.run("record", "-d", bench(keys), "-o", name, "--time", time, "--no-calibration")


def entries():
    return json.loads(pathlib.Path(FILE).read_text())["entries"]


def expect_scale(report, truth):
    """`truth` as a factor on the device's own scale; it must be within the stated interval."""
    off = 100 * abs(report["of_the_devices_own"] / truth - 1)
    assert off <= report["interval_of_95_percent"], (report, off)
    print(f"{report['channel']}: {off:.4f} % off, stated {report['interval_of_95_percent']:.4f} %")


def tare():
    report = tacto.run_json("calibrate", "tare", "-d", bench("finger=up,mains=20mV"), "--time", "2s")
    rows = {row["channel"]: row for row in report["channels"]}
    for name in ("normal_force", "net_force"):
        assert abs(rows[name]["offset_n"] - 0.05) < 3 * rows[name]["offset_uncertainty_n"], rows[name]
    assert "50 Hz" in rows["tangential_force"]["mains"] and "150 Hz" in rows["tangential_force"]["mains"], rows
    assert rows["net_force"]["mains"] == "none"
    assert "by tactograph" in report["simulated"] and report["serial"] == "sim-7"
    assert len(entries()) == 3 and report["file"].endswith(FILE)


def a_finger_is_refused():
    error = tacto.error_of("calibrate", "tare", "-d", bench("surface=flat,strokes=9"), "--time", "2s", code=5)
    assert "--anyway" in error["remedy"], error
    assert len(entries()) == 3
    _, error = tacto.run("calibrate", "tare", "-d", bench("surface=flat,strokes=9"), "--time", "2s", "--anyway", "--dry-run")
    assert "warning" in error and len(entries()) == 3, error


def weights():
    for k, force in enumerate((0, 0.5, 1)):
        record(f"w{k}", f"finger=up,weight={force}N")
        record(f"p{k}", f"finger=up,pull={force}N")
    report = tacto.run_json("calibrate", "force", "--mass", "0N=w0@0.1s..0.9s", "--mass", "0.5N=w1@0.1s..1s", "--mass", "1N=w2@0.1s..1s")
    expect_scale(report, 1 / 1.04)
    report = tacto.run_json("calibrate", "force", "--channel", "net_force", "--mass", "0N=p0@0.1s..1s",
                            "--mass", "0.5N=p1@0.1s..1s", "--mass", "1N=p2@0.1s..1s")
    expect_scale(report, 1 / 1.04)
    # Masses depend on the local gravity, which is uncertain by 0.15 % unless it is given.
    masses = ["--mass", "0g=w0@0.1s..1s", "--mass", "101.9716g=w2@0.1s..1s", "--dry-run"]
    vague = tacto.run_json("calibrate", "force", *masses)
    sharp = tacto.run_json("calibrate", "force", *masses, "--gravity", "9.80665m/s^2")
    assert vague["standard_uncertainty_percent"] > 0.15 > sharp["standard_uncertainty_percent"], (vague, sharp)
    _, error = tacto.run("calibrate", "force", "--channel", "tangential_force", "--mass", "0g=w0", "--mass", "1N=w2", code=5)
    assert "--reference" in error, error


def weights_hung_when_asked_for():
    """The device is read again for each weight; here it always has 1 N on it, and the command reports that."""
    done = subprocess.run([tacto.COMMAND, "calibrate", "force", "-d", bench("finger=up,weight=1N"), "--mass", "0g",
                           "--mass", "1N", "--time", "0.3s"], input="\n\n", capture_output=True, text=True, timeout=60)
    assert done.returncode == 5 and "1N" in done.stderr and done.stderr.count("normal_force") >= 2, done
    done = subprocess.run([tacto.COMMAND, "calibrate", "force", "-d", bench("finger=up"), "--mass", "0g", "--mass", "1N"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "Enter" in done.stderr, done


def against_the_reference():
    report = tacto.run_json("calibrate", "force", "--reference", "net_force", "-d", bench("surface=C,strokes=30"), "--time", "10s")
    expect_scale(report, 1 / 0.93)


def released_weights():
    """Five threads are cut at different times with different weights: the piezo's scale, within the stated
    uncertainty."""
    for k in range(5):
        record(f"r{k}", f"force=release,force_amplitude={0.05 + 0.02 * k}N,force_sweep={0.5 + 0.037 * k}s", time="1.3s")
    cut = [f"--release={0.05 + 0.02 * k}N=r{k}" for k in range(5)]
    report = tacto.run_json("calibrate", "force", *cut)
    assert report["channel"] == "tangential_force" and report["releases"] == 5, report
    expect_scale(report, 1 / 0.93)
    assert report["interval_of_95_percent"] < 3, report
    assert entries()[-1]["method"] == "released weight"
    # No thread was cut; a weight is missing; both options at once.
    _, error = tacto.run("calibrate", "force", "--release", "0.05N=r0@0s..0.4s", code=5)
    assert "release" in error, error
    tacto.error_of("calibrate", "force", "--release", "0.05N=r0", "--reference", "net_force", code=2)


def travel():
    for k in range(3):
        record(f"t{k}", f"surface=flat,strokes={k % 2 + 1}", "1.3s" if k % 2 == 0 else "2.5s")
    report = tacto.run_json("calibrate", "encoder", "--travel", "35mm", "--from", "t0", "--from", "t2")
    assert report["travels"] == 2 and report["first_travel"] == "counts up", report
    expect_scale(report, 1 / 1.003)
    tacto.error_of("calibrate", "encoder", "--travel", "35mm", "--from", "t1", code=5)  # back and forth
    done = subprocess.run([tacto.COMMAND, "calibrate", "encoder", "--travel", "35mm", "-d", bench("surface=flat,paced=1")],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "mark" in done.stderr, done


def what_cannot_be_right_is_refused():
    before = len(entries())
    swapped = ["calibrate", "force", "--mass", "0N=w0@0.1s..0.9s", "--mass", "1N=w1@0.1s..0.9s", "--mass", "0.5N=w2@0.1s..0.9s"]
    _, error = tacto.run(*swapped, code=5)
    assert "%" in error and "--anyway" in error and "--dry-run" in error, error
    output, error = tacto.run(*swapped, "--dry-run", "--json")
    assert json.loads(output)["interval_of_95_percent"] > 20 and "warning" in error and "%" in error, error
    error = tacto.error_of("calibrate", "encoder", "--travel", "35m", "--from", "t0", "--from", "t2", code=5)
    assert "--anyway" in error["remedy"], error
    _, error = tacto.run("calibrate", "force", "--mass", "0N=w0@0.1s..9s", "--mass", "1N=w2", code=5)
    assert "w0" in error and "9 s" in error, error
    assert len(entries()) == before
    tacto.run("calibrate", "encoder", "--travel", "35m", "--from", "t0", "--from", "t2", "--anyway", "--calibration", "absurd.json")
    assert len(json.loads(pathlib.Path("absurd.json").read_text())["entries"]) == 1


def a_recording_takes_it_along():
    tacto.run("record", "-d", bench("finger=up,weight=0.8N,pull=0.3N"), "-o", "known", "--time", "1s")
    side = json.loads(pathlib.Path("known.json").read_text())
    codes, _ = soundfile.read("known.wav", dtype="int32", always_2d=True)
    for channel, (number, truth) in {"normal_force": (2, 0.8), "net_force": (3, 0.3)}.items():
        printed = side["channels"][number]
        assert printed["name"] == channel and printed["calibration"]["scale_method"] == "weights", printed
        force = codes[1000:, number].mean() * printed["scale"] + printed["offset"]
        assert abs(force - truth) < 1e-3, (channel, force)
    assert side["channels"][0]["calibration"]["scale_method"] == "released weight"
    assert side["channels"][1]["calibration"]["scale_method"] == "travel"
    assert side["serial"] == "sim-7" and "warnings" not in side, side.get("warnings")
    shown = tacto.run_json("info", "known")
    assert shown["serial"] == "sim-7" and shown["channels"][2]["calibrated"] == side["channels"][2]["calibrated"]
    assert shown["channels"][2]["scale_uncertainty_percent"] > 0
    tacto.run("validate", "known")
    # A replay is the same device, so it keeps the calibration of its recording.
    _, error = tacto.run("record", "-d", "replay:known", "-o", "again")
    again = json.loads(pathlib.Path("again.json").read_text())
    assert "warning" not in error and again["serial"] == "sim-7" and again["channels"] == side["channels"], (error, again)
    assert again["firmware"] == side["firmware"]
    tacto.run("record", "-d", bench("finger=up"), "-o", "plain", "--time", "0.2s", "--no-calibration")
    assert "calibration" not in pathlib.Path("plain.json").read_text()


def a_stale_one_is_warned_of():
    later = {**os.environ, "SOURCE_DATE_EPOCH": str(4102444800)}  # 2100
    done = subprocess.run([tacto.COMMAND, "record", "-d", bench("finger=up"), "-o", "late", "--time", "0.2s"],
                          env=later, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stderr.count("stale") >= 4, done
    assert any("stale" in warning for warning in json.loads(pathlib.Path("late.json").read_text())["warnings"])
    done = subprocess.run([tacto.COMMAND, "record", "-d", bench("finger=up"), "-o", "patient", "--time", "0.2s",
                           "--stale-after", "100000days"], env=later, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "stale" not in done.stderr, done


def another_devices_is_refused():
    _, error = tacto.run("record", "-d", "sim:finger=up,seed=8", "-o", "other", "--time", "0.2s", "--calibration", FILE, code=5)
    assert "'sim-7'" in error and "'sim-8'" in error, error
    assert not pathlib.Path("other.wav").exists()
    _, error = tacto.run("record", "-d", "sim:finger=up,seed=8", "-o", "other", "--time", "0.2s", "--calibration", "none.json", code=3)
    tacto.run("record", "-d", "sim:finger=up,seed=8", "-o", "other", "--time", "0.2s")  # not calibrated


def the_file_is_one_of_ours():
    tacto.run("validate", FILE)
    report = tacto.run_json("info", FILE)
    assert report["serial"] == "sim-7" and len(report["entries"]) == len(entries()) >= 7
    # A zero is stored as a code; its value in newtons is stored beside it.
    for printed, kept in zip(report["entries"], entries(), strict=True):
        if "zero" in kept:
            assert printed["zero_as_stored"] == kept["zero"] and "zero" not in printed, printed
            newtons = kept["zero"] * kept.get("scale", kept["nominal_scale"])
            assert abs(printed["zero_n"] - newtons) < 1e-12 and printed["zero_uncertainty_n"] < 0.1, printed
    first = entries()[0]
    assert first["method"] == "tare" and first["degrees_of_freedom"] == 19


def wrong_words():
    for arguments in (["calibrate"], ["calibrate", "moon"], ["calibrate", "force"], ["calibrate", "encoder"],
                      ["calibrate", "force", "--mass", "100"], ["calibrate", "force", "--mass", "3mm", "--mass", "0g"],
                      ["calibrate", "tare", "-d", "sim:finger=up", "--time", "20"],
                      ["calibrate", "force", "--mass", "0g=w0@1s", "--mass", "1N=w2"]):
        _, error = tacto.run(*arguments, code=2)
        assert len(error.strip().splitlines()) == 1, error


def doctor():
    report = tacto.run_json("doctor", "-d", bench("finger=up"))
    states = {row["check"]: row for row in report["checks"]}
    assert list(states) == ["device", "permission", "firmware", "round trip", "real time", "disk",
                            "temporary files", "calibration"]
    assert report["can_record"] and states["calibration"]["state"] == "works", report
    assert "sim-7" in states["device"]["found"] and "emulated" in states["device"]["found"]
    assert "tactograph record -d" in report["next"] and report["next"].endswith("-o oak --time 2s"), report
    missing = json.loads(tacto.run("doctor", "-d", "sim:finger=up", "-o", "no/such/folder", "--json", code=7)[0])
    assert not missing["can_record"]
    absent = json.loads(tacto.run("doctor", "-d", "usb:serial=no-such-device", "--json", code=8)[0])
    assert absent["checks"][0]["state"] == "FAILS" and "sim:surface=C" in absent["next"], absent
    assert {row["check"] for row in absent["checks"] if row["state"] == "skipped"} == {"firmware", "round trip", "calibration"}
    text, _ = tacto.run("doctor", "-d", bench("finger=up"))
    print(text)


def test():
    os.environ["XDG_CONFIG_HOME"] = str(pathlib.Path("config").absolute())
    for step in (tare, a_finger_is_refused, weights, weights_hung_when_asked_for, against_the_reference, released_weights, travel,
                 what_cannot_be_right_is_refused, a_recording_takes_it_along, a_stale_one_is_warned_of, another_devices_is_refused,
                 the_file_is_one_of_ours, wrong_words, doctor):
        step()


tacto.in_folder(test)
