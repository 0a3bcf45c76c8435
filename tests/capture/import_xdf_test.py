#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`import` of XDF files that Python's struct writes (tests/fuzz/xdf_maker.py): numbers to the bit, rates and gaps as made, cuts never silently short.

A second reader, read_with_numpy(), follows the specification on its own and shares no code with the maker. A third one is Debian's libxdf.
"""
import json
import pathlib
import random
import re
import shlex
import struct
import sys
import xml.etree.ElementTree

import numpy as np
import scipy.stats
import tacto

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "fuzz"))
from xdf_maker import boundary, chunk, clock_offset, file_header, footer, header, samples, texts

USAGE, MALFORMED, UNSUITABLE = 2, 4, 5
LIBXDF_SAMPLES = sys.argv[1]  # a program of this build
ROWS = 3000
FORMATS = {"int8": "<i1", "int16": "<i2", "int32": "<i4", "int64": "<i8", "float32": "<f4", "double64": "<f8"}


def read_with_numpy(data, wanted):
    """Times and numbers of a stream whose samples are all numbers."""
    at, times, rows, info = 4, [], [], None

    def length(at):
        width = data[at]
        return int.from_bytes(data[at + 1:at + 1 + width], "little"), at + 1 + width

    while at < len(data):
        size, at = length(at)
        end, tag, at = at + size, int.from_bytes(data[at:at + 2], "little"), at + 2
        if tag in (2, 3) and int.from_bytes(data[at:at + 4], "little") == wanted:
            if tag == 2:
                info = {child.tag: child.text for child in xml.etree.ElementTree.fromstring(data[at + 4:end])}
                kind = np.dtype(FORMATS[info["channel_format"]])
            else:
                count, at = length(at + 4)
                for _ in range(count):
                    stamped, at = data[at] == 8, at + 1
                    times.append(np.frombuffer(data, "<f8", 1, at)[0] if stamped else times[-1] + 1 / float(info["nominal_srate"]))
                    at += 8 * stamped
                    rows.append(np.frombuffer(data, kind, int(info["channel_count"]), at))
                    at += kind.itemsize * int(info["channel_count"])
        at = end
    return np.array(times), np.array(rows)


def stored(name):
    return tacto.soundfile.read(f"{name}.wav", dtype="float64", always_2d=True)[0]


def sidecar(name):
    return json.loads(pathlib.Path(f"{name}.json").read_text())


def imported(data, *more, channel="signal=1", code=0):
    pathlib.Path("trial.xdf").write_bytes(data)
    words = ["import", "trial.xdf", "-o", "x", "--force", "--channel", channel, *more]
    return tacto.run_json(*words) if code == 0 else tacto.error_of(*words, code=code)


def each_type_is_exact():
    rng = np.random.default_rng(1)
    for kind, dtype in FORMATS.items():
        if kind.startswith("int"):
            limit = min(2**53, 2**(8 * np.dtype(dtype).itemsize - 1) - 1)
            values = rng.integers(-limit, limit, (ROWS, 2), endpoint=True).astype(dtype)
            values[0] = [limit, -limit]
        else:
            values = rng.normal(size=(ROWS, 2)).astype(dtype)
        data = file_header() + header(7, "F", 2, 1000, kind) + samples(7, values, 100 + np.arange(ROWS) / 1000, every=250) + footer(7, ROWS)
        printed = imported(data, "--channel", "b:signal=ch2")
        assert np.array_equal(stored("x"), values.astype(float)), kind
        times_s, numbers = read_with_numpy(data, 7)
        assert np.array_equal(stored("x"), numbers.astype(float)), kind
        assert printed["sample_rate_hz"] == round(1 / np.mean(np.diff(times_s)), 6) == 1000 and printed["gaps"] == 0, printed


def counts_above_2_24_and_beyond_2_53():
    counts = 20_000_001 + 2 * np.arange(ROWS).reshape(-1, 1)
    start = file_header() + header(1, "Encoder", 1, 1000, "int64", [("count", "")])
    imported(start + samples(1, counts.astype("<i8"), np.arange(ROWS) / 1000) + footer(1, ROWS), channel="position=count*1um")
    assert stored("x")[0, 0] == 20_000_001 and np.array_equal(stored("x")[:, 0], counts[:, 0])
    counts[1234] = 2**53 + 1
    error = imported(start + samples(1, counts.astype("<i8"), np.arange(ROWS) / 1000) + footer(1, ROWS), channel="position=count*1um", code=UNSUITABLE)
    assert "count" in error["where"] and "1234" in error["where"] and str(2**53 + 1) in error["what"], error
    both = np.column_stack([counts[:, 0], np.arange(ROWS)]).astype("<i8")
    data = file_header() + header(1, "Encoder", 2, 1000, "int64") + samples(1, both, np.arange(ROWS) / 1000) + footer(1, ROWS)
    imported(data, channel="position=ch2*1um")  # a channel that is not requested blocks nothing
    assert np.array_equal(stored("x")[:, 0], np.arange(ROWS))


def read_with_libxdf(stream, channels):
    """Times and numbers (float32) of a stream of trial.xdf."""
    tacto.subprocess.run([LIBXDF_SAMPLES, "trial.xdf", stream, "samples"], check=True, capture_output=True)
    content = pathlib.Path("samples").read_bytes()
    rows = len(content) // (8 + 4 * channels)
    return np.frombuffer(content, "<f8", rows), np.frombuffer(content, "<f4", offset=8 * rows).reshape(channels, rows).T


def libxdf_reads_the_same_numbers_up_to_2_24():
    rng = np.random.default_rng(8)
    for kind, dtype in FORMATS.items():
        values = rng.normal(size=(ROWS, 2)).astype(dtype)
        if kind.startswith("int"):
            limit = min(2**24, 2**(8 * np.dtype(dtype).itemsize - 1) - 1)
            values = rng.integers(-limit, limit, (ROWS, 2), endpoint=True).astype(dtype)
            values[0] = [limit, -limit]
        data = file_header() + header(7, "F", 2, 1000, kind) + samples(7, values, 100 + np.arange(ROWS) / 1000, every=250) + footer(7, ROWS)
        printed = imported(data, "--channel", "b:signal=ch2")
        times_s, numbers = read_with_libxdf("F", 2)
        ours = stored("x")
        assert np.array_equal(ours.astype("<f4") if kind == "double64" else ours, numbers), kind
        # Stamps of 100 s are rounded by 1.4e-14 s, and libxdf adds up 249 periods.
        assert abs(1 / np.mean(np.diff(times_s)) - printed["sample_rate_hz"]) < 1e-6, kind
    values = rng.normal(size=(ROWS, 2)).astype("<f4")
    imported(many_streams(values), "--stream", "Force", channel="normal_force=Fz")
    assert np.array_equal(stored("x")[:, 0], read_with_libxdf("Force", 2)[1][:, 1])


def counts_that_libxdf_rounds_are_kept():
    counts = 20_000_001 + 2 * np.arange(ROWS, dtype="<i4").reshape(-1, 1)
    imported(file_header() + header(1, "Encoder", 1, 1000, "int32", [("count", "")]) + samples(1, counts, np.arange(ROWS) / 1000) + footer(1, ROWS),
             channel="position=count*1um")
    rounded = read_with_libxdf("Encoder", 1)[1]
    assert rounded[0, 0] == 20_000_000 and not np.any(rounded.astype(float) == counts)  # a float above 2^24 is even
    assert np.array_equal(stored("x"), counts)


def many_streams(values):
    times_s = np.arange(ROWS) / 1000
    return (file_header() + header(1, "Markers", 1, 0, "string") + header(2, "Force", 2, 1000, "float32", [("Fx", "N"), ("Fz", "N")]) +
            header(3, "Eye", 1, 250, "double64") + boundary() + samples(2, values, times_s, every=400) + chunk(3, struct.pack("<I", 1) + b"\1\1\x08" +
            struct.pack("<d", 1) + b"\1\5hello") + samples(3, np.zeros((10, 1)), np.arange(10) / 250) + footer(2, ROWS) + footer(3, 10) + footer(1, 1))


def streams_are_listed_and_chosen():
    values = np.random.default_rng(2).normal(size=(ROWS, 2)).astype("<f4")
    pathlib.Path("trial.xdf").write_bytes(many_streams(values))
    printed = tacto.run_json("import", "trial.xdf")
    rows = {row["name"]: row for row in printed["streams"]}
    assert rows["Force"]["channels"] == "Fx, Fz" and rows["Force"]["samples"] == ROWS and rows["Force"]["nominal_rate_hz"] == 1000, rows
    assert rows["Markers"]["not_imported"] and not rows["Eye"]["not_imported"], rows
    tacto.run(*shlex.split(printed["next"])[1:])
    assert np.array_equal(stored("trial")[:, 0], values[:, 0].astype(float))
    assert sidecar("trial")["channels"][0]["scale"] == 1  # the unit is the header's: N
    for name in ("Force", "2"):
        tacto.run("import", "trial.xdf", "-o", "two", "--force", "--stream", name, "--channel", "normal_force=Fz")
        assert np.array_equal(stored("two")[:, 0], values[:, 1].astype(float))
    force = ["--channel", "tangential_force=Fx"]
    assert "Eye" in tacto.error_of("import", "trial.xdf", "-o", "x", *force, code=USAGE)["remedy"]
    assert "Eye" in tacto.error_of("import", "trial.xdf", "-o", "x", "--stream", "Fourse", *force, code=USAGE)["remedy"]
    tacto.error_of("import", "trial.xdf", "-o", "x", "--stream", "Markers", *force, code=UNSUITABLE)
    tacto.run("import", "trial.xdf", "--stream", "Force", code=USAGE)
    pathlib.Path("t.csv").write_text("a,b\n1,2\n3,4\n5,6\n")
    tacto.run("import", "t.csv", "-o", "x", "--rate", "1kHz", "--stream", "Force", "--channel", "signal=a", code=USAGE)
    assert not list(pathlib.Path(".").glob("x.*"))


def one_stream(times_s, nominal, kind="int32", offsets=(), every=250):
    values = np.arange(len(times_s), dtype=FORMATS[kind]).reshape(-1, 1)
    return (file_header() + header(1, "F", 1, nominal, kind) + b"".join(clock_offset(1, *each) for each in offsets) +
            samples(1, values, times_s, every=every) + footer(1, len(times_s)))


def gaps_are_kept():
    kept = np.setdiff1d(np.arange(ROWS), [*range(700, 710), 2000])  # 10 and 1 missing
    printed = imported(one_stream(5000 + kept / 1000, 1000, every=1))
    assert printed["sample_rate_hz"] == 1000 and printed["frames"] == kept.size, printed
    assert [(gap["frame"], gap["count"]) for gap in sidecar("x")["gaps"]] == [(700, 10), (1990, 1)], sidecar("x")["gaps"]
    # An irregular stream has no nominal rate; its times may be even all the same.
    assert imported(one_stream(kept / 1000, 0, every=1))["gaps"] == 2
    uneven_s = np.cumsum(np.random.default_rng(3).uniform(1e-3, 3e-3, ROWS))
    assert "sample" in imported(one_stream(uneven_s, 0, every=1), code=MALFORMED)["where"]
    assert imported(one_stream(uneven_s, 0, every=1), "--rate", "500Hz")["sample_rate_hz"] == 500


def times_that_are_not_stated_do_not_add_up_rounding():
    """Stamps of the Unix clock have steps of 0.24 us: added 30,000 times, periods of 0.1 ms would drift."""
    values = np.arange(30_000, dtype="<i4").reshape(-1, 1)
    data = file_header() + header(1, "F", 1, 10_000, "int32") + samples(1, values, 1.764e9 + np.arange(30_000) / 10_000, every=30_000) + footer(1, 30_000)
    printed = imported(data)
    # The first and last time are rounded by half a step each, in 3 s.
    assert abs(printed["sample_rate_hz"] / 10_000 - 1) < 2.4e-7 / 3 and printed["gaps"] == 0 and "warnings" not in printed, printed


def a_pause_of_any_length_is_a_gap():
    """The rate is that of the even steps: not that of a line through all times."""
    times_s = 1e5 + np.arange(20_000) / 1000
    times_s[10_000:] += 0.1505  # 150.5 periods; the step is 151.5
    times_s[15_000:] += 0.0017
    printed = imported(one_stream(times_s, 1000, every=1))
    gaps = [(gap["frame"], gap["count"]) for gap in sidecar("x")["gaps"]]
    assert printed["sample_rate_hz"] == 1000 and [frame for frame, _ in gaps] == [10_000, 15_000], (printed, gaps)
    assert abs(gaps[0][1] - 150.5) <= 0.5 and gaps[1][1] == 2 and len(printed["warnings"]) == 2, (gaps, printed)  # the pauses, and the gaps
    assert imported(one_stream(times_s, 0, every=1))["sample_rate_hz"] == 1000


def what_a_remedy_names_can_be_typed():
    values = np.zeros((ROWS, 1), "<i4")
    data = file_header() + header(1, "Fo'rce", 1, 1000, "int32")
    for number in (2, 3):
        data += header(number, "Same", 1, 1000, "int32") + samples(number, values + number, np.arange(ROWS) / 1000) + footer(number, ROWS)
    error = imported(data + samples(1, values, np.arange(ROWS) / 1000), code=USAGE)
    choices = [shlex.split(each)[1] for each in error["remedy"].split(": ", 1)[1].split(" or ")]
    assert choices == ["Fo'rce", "2", "3"], error
    for number, choice in enumerate(choices, 1):
        imported(data + samples(1, values + 1, np.arange(ROWS) / 1000), "--stream", choice)
        assert np.all(stored("x") == number)


def the_error_of_a_file_is_not_hidden_without_an_output():
    pathlib.Path("trial.xdf").write_bytes(file_header("2.0") + header(1, "F", 1, 1000, "int32"))
    tacto.error_of("import", "trial.xdf", code=UNSUITABLE)


def a_rate_that_no_wav_stores_is_named():
    for period_s in (10, 1e-10):
        error = imported(one_stream(np.arange(30) * period_s, 0, every=1), code=UNSUITABLE)
        assert error["where"] == "trial.xdf", error
        pathlib.Path("t.csv").write_text("t,f\n" + "".join(f"{i * period_s:.12g},{i}\n" for i in range(30)))
        error = tacto.error_of("import", "t.csv", "-o", "x", "--force", "--time-column", "t*1s", "--channel", "signal=f", code=UNSUITABLE)
        assert error["where"] == "t.csv" and not pathlib.Path("x.wav").exists(), error


def a_jump_beyond_any_file_is_refused():
    for nominal, code in ((1000, UNSUITABLE), (0, MALFORMED)):
        for jump_s in (1e7, 1e18, 1e300):  # 1e10 samples and more
            times_s = 100 + np.arange(ROWS) / 1000
            times_s[1000:] += jump_s
            error = imported(one_stream(times_s[:1001], nominal, every=1), code=code)
            assert "100.999" in error["what"] or "sample 1000" in error["where"], error


def scattered_times_are_fitted():
    """Times of LSL are those at which a program had the samples: here 2 ms (RMS) late or early, five periods, with a gap of 3 s."""
    rng = np.random.default_rng(4)
    rate_hz, rows = 2500.37, 100_000
    sample = np.arange(rows) + np.where(np.arange(rows) >= 40_000, 7501, 0)
    times_s = 1e5 + sample / rate_hz + np.repeat(rng.normal(0, 2e-3, rows // 50), 50)
    data = one_stream(times_s, 2500, every=50)
    printed = imported(data)
    # A slope through n/50 independent errors of 2 ms: relative error 2 ms sqrt(12 / (n/50)) / duration; five times that.
    bound = 5 * 2e-3 * np.sqrt(12 / (rows / 50)) / (rows / rate_hz)
    assert abs(printed["sample_rate_hz"] / rate_hz - 1) < bound, (printed, bound)
    assert [gap["frame"] for gap in sidecar("x")["gaps"]] == [40_000] and abs(sidecar("x")["gaps"][0]["count"] - 7501) <= 2, sidecar("x")["gaps"]
    times_s, numbers = read_with_numpy(data, 1)
    parts = [slice(0, 40_000), slice(40_000, rows)]
    centred = [(np.arange(rows)[part] - np.mean(np.arange(rows)[part]), times_s[part] - times_s[part].mean()) for part in parts]
    slope = sum(np.dot(x, y) for x, y in centred) / sum(np.dot(x, x) for x, _ in centred)
    assert abs(printed["sample_rate_hz"] * slope - 1) < 1e-9, (printed, slope)
    assert np.array_equal(stored("x"), numbers)
    assert any("RMS" in warning for warning in printed["warnings"]), printed


def clock_offsets_give_the_recorders_rate():
    times_s = 500 + np.arange(30_000) / 1000
    offsets = [(t, 17.5 - 40e-6 * (t - 500)) for t in np.arange(500, 530, 5.0)]  # the stream's clock is 40 ppm fast
    printed = imported(one_stream(times_s, 1000, offsets=offsets))
    assert abs(printed["sample_rate_hz"] - 1000 / (1 - 40e-6)) < 1e-6, printed
    assert "faster" in printed["clock"] and " 40 ppm" in printed["clock"], printed
    assert imported(one_stream(times_s, 1000, offsets=offsets[:2]))["sample_rate_hz"] == 1000  # too few to fit


def wrong_offsets_change_no_rate_and_noise_is_no_drift():
    """The median of the slopes, and Sen's interval, also by SciPy."""
    times_s = 500 + np.arange(60_000) / 1000
    rng = np.random.default_rng(6)
    stamps = np.arange(500, 560, 5.0)
    for drift, wrong in ((40e-6, ()), (40e-6, (3,)), (40e-6, (0, 11)), (0, (7,)), (300e-6, (5,))):
        ahead_s = 17.5 - drift * (stamps - 500) + rng.normal(0, 2e-5, stamps.size)
        ahead_s[list(wrong)] += 0.7
        printed = imported(one_stream(times_s, 1000, offsets=list(zip(stamps, ahead_s))))
        host_s = stamps + ahead_s
        slope, _, low, high = scipy.stats.theilslopes(stamps - host_s, host_s, 0.95)
        expected = 1000 * (1 + slope) if low * high > 0 else 1000
        assert abs(printed["sample_rate_hz"] / expected - 1) < 1e-9, (drift, wrong, printed, expected)
        # 20 us at each end of 55 s: 0.5 ppm; with two of 12 offsets wrong the median shifts by less than 2 ppm.
        assert abs(printed["sample_rate_hz"] / 1000 - 1 - drift) < 3e-6, (drift, wrong, printed)
        assert bool(printed.get("warnings")) == (drift > 100e-6), printed
    three = [(500, 17.5), (506, 17.501), (512, 17.503)]
    assert imported(one_stream(times_s, 1000, offsets=three))["sample_rate_hz"] == 1000
    noise = list(zip(stamps, 17.5 + rng.normal(0, 1e-3, stamps.size)))
    printed = imported(one_stream(times_s, 1000, offsets=noise))
    assert printed["sample_rate_hz"] == 1000 and "warnings" not in printed, printed
    many = np.arange(500, 560, 0.02)  # 3,000 offsets are reduced to medians
    printed = imported(one_stream(times_s, 1000, offsets=list(zip(many, 17.5 - 40e-6 * (many - 500)))))
    assert abs(printed["sample_rate_hz"] - 1000 / (1 - 40e-6)) < 1e-6, printed


def a_reset_clock_is_refused_with_its_time():
    times_s = 500 + np.arange(30_000) / 1000
    jumped = [(t, 17.5 if t < 515 else -400) for t in np.arange(500, 530, 5.0)]
    assert "515.0" in imported(one_stream(times_s, 1000, offsets=jumped), code=UNSUITABLE)["what"]
    back = [(500, 1), (505, 1), (3, 503)]
    assert "3.0" in imported(one_stream(times_s, 1000, offsets=back), code=UNSUITABLE)["what"]
    times_s[20_000:] -= 510
    assert "519.999" in imported(one_stream(times_s, 1000, every=1), code=UNSUITABLE)["what"]
    assert imported(one_stream(times_s, 1000, every=1), "--rate", "1kHz")["frames"] == 30_000


def markers_become_marks_by_the_recorders_clock():
    """Truth: three clocks with known offsets and rates; a marker belongs to the frame nearest to it by the recorder's clock."""
    drift, other = 40e-6, -150e-6  # of the clocks of samples and markers against the recorder's
    recorder_s = 2000 + np.arange(30_000) / 1000
    own_s, markers_s = 500 + (recorder_s - 2000) * (1 + drift), lambda t: 9000 + (t - 2000) * (1 + other)
    at_s = np.array([2000.0002, 2003.4567, 2011.9996, 2029.9991])
    labels = [b"begin", "Stütze links".encode(), "Stütze rechts".encode("latin-1"), b""]
    offsets = [(t, t) for t in np.arange(2000, 2030, 5.0)]
    data = (file_header() + header(1, "F", 1, 1000, "int32") + header(2, "Markers", 1, 0, "string") +
            b"".join(clock_offset(1, 500 + (t - 2000) * (1 + drift), t - 500 - (t - 2000) * (1 + drift)) for t, _ in offsets) +
            b"".join(clock_offset(2, markers_s(t), t - markers_s(t)) for t, _ in offsets) +
            texts(2, [[labels[1]], [labels[0]]], markers_s(at_s[[1, 0]])) + samples(1, np.arange(30_000, dtype="<i4").reshape(-1, 1), own_s) +
            texts(2, [[label] for label in labels[2:]], markers_s(at_s[2:])) + footer(1, 30_000) + footer(2, 4))
    printed = imported(data)
    expected = [(round((t - 2000) * 1000), label) for t, label in zip(at_s, ["begin", "Stütze links", "Stütze rechts", ""])]
    assert [(mark["frame"], mark["label"]) for mark in sidecar("x")["marks"]] == expected, (sidecar("x")["marks"], expected)
    assert printed["marks"] == 4 and "warnings" not in printed, printed
    rows = {row["name"]: row["not_imported"] for row in tacto.run_json("import", "trial.xdf")["streams"]}
    assert "marks" in rows["Markers"] and not rows["F"], rows
    printed = imported(data, "--rate", "1kHz")
    assert "marks" not in printed and any("markers" in warning for warning in printed["warnings"]), printed
    tacto.run("validate", "x")


def marks_beside_gaps_and_outside():
    kept = np.setdiff1d(np.arange(ROWS), np.arange(700, 710))
    values = np.arange(kept.size, dtype="<i4").reshape(-1, 1)
    values[1500] = 2_000_000_000  # sample 1510 of the stream's clock
    head = (file_header() + header(1, "F", 1, 1000, "int32") + header(2, "A", 2, 0, "string") + header(3, "B", 1, 0, "string") +
            samples(1, values, 50 + kept / 1000, every=1))
    at_s = 50 + np.array([-0.0006, -0.0004, 0.6994, 0.705, 0.7095, 1.5, 2.9994, 2.9996])
    printed = imported(head + texts(2, [[b"x", b"%d" % i] for i in range(at_s.size)], at_s) + texts(3, [[b"y"]], [51.5]) + footer(1, kept.size))
    marks = [(mark["frame"], mark["label"]) for mark in sidecar("x")["marks"]]
    assert marks == [(0, "A: x 1"), (699, "A: x 2"), (700, "A: x 3"), (700, "A: x 4"), (1490, "A: x 5"), (1490, "B: y"), (2989, "A: x 6")], marks
    assert sum("2 markers" in warning for warning in printed["warnings"]) == 1, printed
    assert sum("clock offsets" in warning for warning in printed["warnings"]) == 2, printed
    imported(head + texts(2, [[b"x", b"end"]], [52.0]) + footer(1, kept.size), "--mask-outliers")
    document = sidecar("x")
    frame = document["marks"][0]["frame"]  # time is kept, with one frame fewer before it
    assert frame == 1989 and frame + sum(gap["count"] for gap in document["gaps"] if gap["frame"] <= frame) == 2000, document


def damaged_markers_are_refused():
    start = file_header() + header(1, "F", 1, 1000, "int32") + header(2, "M", 1, 0, "string")
    end = samples(1, np.arange(ROWS, dtype="<i4").reshape(-1, 1), np.arange(ROWS) / 1000) + footer(1, ROWS)
    head = struct.pack("<I", 2) + b"\1\1"
    for content in (head + b"\x08" + bytes(8) + b"\1\7hello", head + b"\x08" + bytes(8) + b"\1\4hello", head + b"\0\1\5hello",
                    head + b"\x08" + b"\xff" * 8 + b"\1\5hello", head + b"\x08" + bytes(8) + b"\x08" + b"\xff" * 8 + b"hello"):
        assert imported(start + chunk(3, content) + end, code=MALFORMED)["where"].startswith("trial.xdf")
        assert not pathlib.Path("x.wav").exists()
    reset = clock_offset(2, 0, 5) + clock_offset(2, 5, -400)
    printed = imported(start + reset + texts(2, [[b"hello"]], [1]) + end)
    assert "marks" not in printed and any("reset" in warning for warning in printed["warnings"]), printed
    imported(file_header() + header(2, "M", 0, 0, "string") + header(1, "F", 1, 1000, "int32") + end)


def a_cut_file_is_read_to_its_last_whole_chunk_and_says_so():
    values = np.arange(ROWS).reshape(-1, 1)
    times_s = np.arange(ROWS) / 1000
    whole = file_header() + header(1, "F", 1, 1000, "int32") + samples(1, values.astype("<i4"), times_s, every=150) + footer(1, ROWS)
    assert "warnings" not in imported(whole)
    ends = [m.start() for m in re.finditer(re.escape(struct.pack("<HI", 3, 1)), whole)]
    rng = random.Random(5)
    for size in rng.sample(range(len(whole)), 200):
        pathlib.Path("cut.xdf").write_bytes(whole[:size])
        words = ["import", "cut.xdf", "-o", "c", "--force", "--channel", "signal=1", "--json"]
        done = tacto.subprocess.run([tacto.COMMAND, *words], capture_output=True, text=True)
        complete = max(0, sum(end < size for end in ends) - 1)
        if done.returncode == 0:
            printed = json.loads(done.stdout)
            assert printed["frames"] in (150 * complete, 150 * (complete + 1)) and printed["warnings"], (size, printed)
            assert np.array_equal(stored("c"), values[:printed["frames"]])
        else:
            # Shorter than "XDF:" it is a table; without a header or samples there is nothing to import.
            assert done.returncode in (USAGE, MALFORMED) and complete == 0, (size, done)


def damaged_files_are_refused():
    good = one_stream(np.arange(ROWS) / 1000, 1000)
    head = file_header() + header(1, "F", 1, 1000, "int32")
    one = struct.pack("<I", 1)
    for data in (head + chunk(3, one + b"\1\2\x08" + bytes(12)),                       # two samples in the space of one
                 head + chunk(3, one + b"\x08" + b"\xff" * 8),                          # 2^64 samples
                 head + chunk(3, one + b"\1\1\x08" + bytes(13)),                        # a byte too many
                 head + chunk(3, one + b"\1\1\x04" + bytes(8)),                         # a time of four bytes
                 head + chunk(3, one + b"\1\1\x00" + bytes(4)),                         # the first sample without a time
                 head + chunk(3, struct.pack("<I", 9) + b"\1\0"),                       # a stream without a header
                 head + header(1, "F", 1, 1000, "int32"),                               # two headers
                 file_header() + chunk(2, one + b"<info><name>"), file_header() + chunk(5, bytes(16)), good + b"\2", b"XDF:"):
        assert imported(data, code=MALFORMED)["where"].startswith("trial.xdf")
    for odd in (header(9, "O", 5000, 1000, "int32"), header(9, "O", 0, 1000, "int32"), header(9, "O", 1, -3, "int32")):
        imported(file_header() + odd, code=UNSUITABLE)
        assert imported(good + odd)["frames"] == ROWS  # the other streams can be read
        rows = {row["name"]: row["not_imported"] for row in tacto.run_json("import", "trial.xdf")["streams"]}
        assert rows["O"] and not rows["F"], rows
    imported(file_header("2.0") + header(1, "F", 1, 1000, "int32"), code=UNSUITABLE)
    assert imported(good + chunk(99, b"later"))["frames"] == ROWS  # the specification: unknown chunks are skipped
    holes = np.zeros((ROWS, 1), "<f4")
    holes[17] = np.nan
    data = file_header() + header(1, "F", 1, 1000, "float32") + samples(1, holes, np.arange(ROWS) / 1000) + footer(1, ROWS)
    assert "sample 17" in imported(data, code=MALFORMED)["where"]
    assert imported(data, "--mask-outliers")["gaps"] == 1


if __name__ == "__main__":
    for test in (each_type_is_exact, counts_above_2_24_and_beyond_2_53, libxdf_reads_the_same_numbers_up_to_2_24, counts_that_libxdf_rounds_are_kept,
                 streams_are_listed_and_chosen, gaps_are_kept, times_that_are_not_stated_do_not_add_up_rounding, a_pause_of_any_length_is_a_gap, a_jump_beyond_any_file_is_refused, what_a_remedy_names_can_be_typed,
                 the_error_of_a_file_is_not_hidden_without_an_output, a_rate_that_no_wav_stores_is_named, scattered_times_are_fitted,
                 clock_offsets_give_the_recorders_rate, wrong_offsets_change_no_rate_and_noise_is_no_drift, a_reset_clock_is_refused_with_its_time,
                 markers_become_marks_by_the_recorders_clock, marks_beside_gaps_and_outside, damaged_markers_are_refused,
                 a_cut_file_is_read_to_its_last_whole_chunk_and_says_so, damaged_files_are_refused):
        tacto.in_folder(test)
