#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: one clear line on stderr, the exit code of its kind, and nothing half-written."""
import json
import os
import pathlib
import subprocess

import numpy as np

import tacto

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE, VERSION, CANNOT_WRITE = 2, 3, 4, 5, 6, 7
TWO = ["--rate", "1kHz", "--channel", "tangential_force=f*1N", "--channel", "position=x*1mm"]


def refused(*arguments, code, says, leaves=None):
    """The run must fail with `code` and print all of `says` in one line; the folder must not change."""
    before = sorted(os.listdir("."))
    out, err = tacto.run(*arguments, code=code)
    lines = [line for line in err.strip().split("\n") if "warning:" not in line]
    assert len(lines) == 1, f"not one line: {err!r}"
    for word in says:
        assert word in err, f"{arguments}: {word!r} is not in {err!r}"
    assert out == "", out
    assert sorted(os.listdir(".")) == before, f"{arguments} left {set(os.listdir('.')) - set(before)}"


def csv(text, name="in.csv"):
    pathlib.Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return name


def import_refuses():
    rows = "".join(f"{np.sin(i):.4f},{i * 0.05:.3f}\n" for i in range(100))
    good = csv("f,x\n" + rows, "good.csv")
    tail = ["-o", "out", *TWO]
    refused("import", "absent.csv", *tail, code=NOT_FOUND, says=["absent.csv"])
    refused("import", csv("", "empty.csv"), *tail, code=MALFORMED, says=["empty.csv", "empty"])
    refused("import", csv("f,x\n", "header.csv"), *tail, code=MALFORMED, says=["header.csv"])
    refused("import", csv("f,x\n1,2\n3\n", "ragged.csv"), *tail, code=MALFORMED, says=["ragged.csv", "3"])
    refused("import", csv("f,x\n1,2\n3,four\n", "text.csv"), *tail, code=MALFORMED, says=["text.csv", "3", "four", "x"])
    refused("import", csv("f,x\n1,2\nnan,4\n", "nan.csv"), *tail, code=MALFORMED, says=["nan.csv", "3", "f"])
    refused("import", csv("f,x\n1,2\n3,inf\n", "inf.csv"), *tail, code=MALFORMED, says=["inf.csv", "3", "x"])
    refused("import", good, "-o", "out", "--rate", "1kHz", "--channel", "position=y*1mm", code=USAGE, says=["y", "f", "x"])
    refused("import", good, "-o", "out", "--rate", "0Hz", *TWO[2:], code=USAGE, says=["rate"])
    refused("import", good, "-o", "out", "--rate", "1000", *TWO[2:], code=USAGE, says=["1000", "Hz", "kHz"])
    refused("import", good, "-o", "out", "--rate", "1parsec", *TWO[2:], code=USAGE, says=["parsec", "Hz"])
    refused("import", good, "-o", "out", "--rate", "1kHz", "--channel", "position=x*1furlong", code=USAGE, says=["furlong"])
    refused("import", good, "-o", f"{good}/out", *TWO, code=CANNOT_WRITE, says=[str(good)])
    refused("import", good, "-o", "/proc/out", *TWO, code=CANNOT_WRITE, says=["/proc"])
    for name in ("", ".", "..", "/tmp"):
        refused("import", good, "-o", name, *TWO, code=USAGE, says=["name"])
    tacto.run("import", good, "-o", "kept", *TWO)
    refused("import", good, "-o", "kept", *TWO, code=USAGE, says=["kept"])


def spatial_refuses():
    still = csv("f,x\n" + "".join(f"{np.sin(i):.4f},1.0\n" for i in range(2000)), "still.csv")
    short = csv("f,x\n" + "".join(f"{np.sin(i):.4f},{min(max(i - 500, 0), 40) * 0.05:.3f}\n" for i in range(1000)), "short.csv")
    for name in (still, short):
        tacto.run("import", name, "-o", name[:-4], *TWO)
    refused("spatial", "still", "-o", "t", code=UNSUITABLE, says=["still", "position"])
    refused("spatial", "short", "-o", "t", "--from", "0.505s", "--to", "0.535s", "--high", "400Hz", code=UNSUITABLE, says=["short", "15"])
    refused("spatial", "short", "-o", "t", "--from", "0.4s", "--to", "9s", code=UNSUITABLE, says=["9"])
    refused("spatial", "short", "-o", "t", "--from", "1", "--to", "2s", code=USAGE, says=["ms"])
    refused("spatial", "absent", "-o", "t", code=NOT_FOUND, says=["absent"])


def repeated_times_have_a_remedy():
    csv("t,f\n0,1\n0.001,2\n0.001,3\n0.002,4\n", "twice.csv")
    refused("import", "twice.csv", "-o", "twice", "--time-column", "t*1s", "--channel", "tangential_force=f*1N", code=MALFORMED,
            says=["line 4", "--rate"])


def a_file_from_the_future_is_refused():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    side = json.loads(pathlib.Path("oak.json").read_text())
    side["version"] = "2.0"
    pathlib.Path("oak.json").write_text(json.dumps(side))
    refused("info", "oak", code=VERSION, says=["oak.json", "2.0", "1.x"])
    refused("spatial", "oak", "-o", "t", code=VERSION, says=["2.0"])
    side["version"] = "1.9"
    side["aroma"] = "pine"
    pathlib.Path("oak.json").write_text(json.dumps(side))
    _, err = tacto.run("info", "oak")
    assert "warning" in err and "1.9" in err, err


def validate_finds_damage():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    tacto.run("validate", "oak")
    whole = pathlib.Path("oak.wav").read_bytes()
    pathlib.Path("oak.wav").write_bytes(whole[:-1000] + bytes([whole[-1000] ^ 1]) + whole[-999:])
    out, _ = tacto.run("validate", "oak", code=MALFORMED)
    assert "checksum" in out and "oak.wav" in out, out
    pathlib.Path("oak.wav").write_bytes(whole[:len(whole) // 2])
    out, _ = tacto.run("validate", "oak", code=MALFORMED)
    assert "truncated" in out, out
    pathlib.Path("oak.wav").write_bytes(whole)
    side = json.loads(pathlib.Path("oak.json").read_text())
    side["sample_rate_hz"] = "fast"
    pathlib.Path("oak.json").write_text(json.dumps(side))
    out, _ = tacto.run("validate", "oak", code=MALFORMED)
    assert "/sample_rate_hz" in out, out
    # A member that a transducer's reader refuses is a fault, and not also a warning that it is ignored.
    tray = json.loads((pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json").read_text())
    pathlib.Path("typo.transducer.json").write_text(json.dumps({**tray, "pole_hx": 3}))
    report = tacto.run_json("validate", "typo.transducer.json", code=MALFORMED)
    assert [fault["where"] for fault in report["faults"]] == ["typo.transducer.json#/pole_hx"] and "warnings" not in report, report


def the_rest_refuses():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    tacto.run("spatial", "oak", "-o", "oak", "--stroke", "1")
    csv("time_s,position_m\n0,0\n0.5,0.02\n1,0.04\n", "path.csv")
    csv("time_s,position_m\n0,0\n0.5,0.02\n0.4,0.04\n", "back.csv")
    csv("time_s,place\n0,0\n", "named.csv")
    render = ["render", "oak", "-o", "drive.wav", "--transducer"]
    refused("record", "-d", "sim:surface=C", "--time", "1s", "-o", "oak", code=USAGE, says=["oak"])
    refused("record", "-d", "sim:magic=C", "--time", "1s", "-o", "new", code=USAGE, says=["magic", "help sim"])
    refused("record", "-d", "sim:surfice=C", "--time", "1s", "-o", "new", code=USAGE, says=["surfice", "surface"])
    refused("record", "-d", "usb:speed=3", "-o", "new", code=USAGE, says=["speed=3", "usb:serial=XYZ"])
    refused("record", "-d", "usb:serial=none-such", "-o", "new", code=NOT_FOUND, says=["on USB"])
    refused("spectrogram", "oak", "-o", "x.jpg", code=USAGE, says=["jpg", "png"])
    refused("spectrogram", "oak", "-o", "x.png", "--window", "10", code=USAGE, says=["mm"])
    refused("spectrogram", "oak", "-o", "x.png", "--window", "10m", code=UNSUITABLE, says=["window"])
    refused("spectrogram", "nothing", "-o", "x.png", code=NOT_FOUND, says=["nothing"])
    refused("spectrogram", "oak", "-o", "oak.texture.json/x.png", code=CANNOT_WRITE, says=["oak.texture.json"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--gain", "1e300m/N", code=USAGE, says=["gain"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--gain", "0x", code=UNSUITABLE, says=["--gain"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--rate", "1e12Hz", code=UNSUITABLE, says=["--rate"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--at", "1e9m", code=UNSUITABLE, says=["1e+09 m", "--at"])
    refused(*render, "wiertlewski2011", "--finger-path", "oak.texture.wav", code=MALFORMED, says=["binary"])
    refused("carve", code=USAGE, says=["carve", "spatial"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--inverse", "banana", code=USAGE, says=["banana", "magnitude"])
    refused(*render, "wiertlewski2011", "--finger-path", "path.csv", "--cutoff", "500Hz", code=USAGE, says=["--reconstruction"])
    play = ("play", "oak", "-d", "sim:", "--time", "0.1s", "-o", "silent")
    refused(*play, "--cutoff", "500Hz", code=USAGE, says=["--cutoff", "--reconstruction butterworth3"])
    refused(*play, "--cutoff", "500Hz", "--reconstruction", "none", code=USAGE, says=["--cutoff"])
    refused(*play, "--energy-window", "1s", code=USAGE, says=["--energy-limit"])
    refused(*play, "--contact-off", "0.1N", code=USAGE, says=["--contact;"])
    refused("explain", "oak", "--cutoff", "500Hz", code=USAGE, says=["--reconstruction butterworth3"])
    refused(*render, "acme", "--finger-path", "path.csv", code=NOT_FOUND, says=["acme", "wiertlewski2011"])
    refused(*render, "wiertlewski2011", "--finger-path", "absent.csv", code=NOT_FOUND, says=["absent.csv"])
    refused(*render, "wiertlewski2011", "--finger-path", "back.csv", code=MALFORMED, says=["back.csv", "4"])
    refused(*render, "wiertlewski2011", "--finger-path", "named.csv", code=MALFORMED, says=["named.csv", "position_m"])


def record_says_which_option_and_what_to_do():
    refused("record", "-d", "sim:", "-o", "x", "--strokes", "0", code=USAGE, says=["--strokes", "'0'"])
    refused("record", "-d", "sim:", "-o", "x", "--time", "1e9days", code=CANNOT_WRITE, says=["GB"])
    assert not list(pathlib.Path(".").glob("x.*"))
    pathlib.Path("file").touch()
    refused("record", "-d", "sim:", "-o", "file/x", "--time", "1s", code=CANNOT_WRITE, says=["file"])
    refused("record", "-d", "sim:", "-o", "x", code=USAGE, says=["--time 2s", "--strokes 2", "paced=1"])
    refused("record", "-d", "sim:strokes=2", "-o", "x", "--strokes", "3", code=USAGE, says=["2", "--time"])
    refused("record", "-d", "sim:source=counter", "-o", "x", "--strokes", "1", code=USAGE, says=["0"])
    for option, more in (("--subject", ["-o", "x"]), ("-o", [])):
        done = subprocess.run([tacto.COMMAND, "record", "-d", "sim:", "--time", "1s", option, b"caf\xe9", *more], capture_output=True)
        assert done.returncode == USAGE and f"{option}: is not UTF-8".encode() in done.stderr, done
    tacto.run("record", "-d", "sim:", "-o", "loud", "--time", "0.1s", "--notes", "red \x1b[31m and \x9b on, \u00e9\nsecond line")
    shown, _ = tacto.run("info", "loud")
    assert "red \\x1b[31m and \\x9b on, \u00e9\nsecond line" in shown and "\x1b" not in shown, shown
    side = json.loads(pathlib.Path("loud.json").read_text())
    side["channels"][0]["scale"] = 0
    pathlib.Path("loud.json").write_text(json.dumps(side))
    refused("info", "loud", code=MALFORMED, says=["/channels/0/scale", "0"])


def dirty_file_warns():
    dirty = tacto.DATA / "dirty" / "T1.csv"
    if not dirty.exists():
        print("skipped: no real data")
        return
    _, err = tacto.run("import", dirty, "-o", "t1", "--rate", "1kHz", "--channel", "acceleration=acc*1m/s^2",
                       "--channel", "normal_force=normal_force_N*1N", "--channel", "speed=speed_mm_s*1mm/s")
    assert "warning" in err and "line 4229" in err and "speed" in err, err
    kept = json.loads(pathlib.Path("t1.json").read_text())["warnings"]
    assert any("4229" in line for line in kept), kept


if __name__ == "__main__":
    for test in (import_refuses, spatial_refuses, repeated_times_have_a_remedy, a_file_from_the_future_is_refused, validate_finds_damage,
                 the_rest_refuses, record_says_which_option_and_what_to_do, dirty_file_warns):
        tacto.in_folder(test)
