# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `render` as a command: its refusals, in one line and without incomplete files, and its report."""
import pathlib
import tempfile

import numpy as np

import made_files as made

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE, CANNOT_WRITE = 2, 3, 4, 5, 7


def files_in(folder):
    return sorted(path.name for path in folder.iterdir())


def expect_refusal(folder, code, said, **changed):
    arguments = {"texture": folder / "t", "--finger-path": folder / "path.csv", "--transducer": "wiertlewski2011", "-o": folder / "drive.wav"}
    arguments |= {("--" + key if len(key) > 1 else "-" + key) if key != "texture" else key: value for key, value in changed.items()}
    texture = arguments.pop("texture")
    before = files_in(folder)
    done = made.run("render", texture, *[str(part) for pair in arguments.items() for part in pair])
    assert done.returncode == code, (code, done.returncode, done.stderr)
    lines = [line for line in done.stderr.splitlines() if "warning" not in line]
    assert len(lines) == 1 and said in lines[0], done.stderr
    assert done.stdout == "" and files_in(folder) == before, files_in(folder)


def check_refusals(folder):
    expect_refusal(folder, NOT_FOUND, "wiertlewski2011-as-printed", transducer="nobody2012")
    expect_refusal(folder, NOT_FOUND, "absent", texture=folder / "absent")
    expect_refusal(folder, NOT_FOUND, "absent.csv", **{"finger-path": folder / "absent.csv"})
    expect_refusal(folder, CANNOT_WRITE, "path.csv", o=folder / "path.csv" / "drive.wav")
    expect_refusal(folder, USAGE, "recording or texture", o=folder / "t.texture.wav")
    expect_refusal(folder, USAGE, "two outputs", target=folder / "drive.wav")
    expect_refusal(folder, USAGE, "mm/N", gain="1")
    expect_refusal(folder, USAGE, "1000Hz", rate="1kHz")
    expect_refusal(folder, USAGE, "--inverse", inverse="phase")
    expect_refusal(folder, UNSUITABLE, "outside the texture", at="1m")
    expect_refusal(folder, UNSUITABLE, "largest gain that fits", gain="100mm/N")
    (folder / "bad.csv").write_text("time_s,position_m\n0,0\n1,x\n")
    expect_refusal(folder, MALFORMED, "line 3, column 2", **{"finger-path": folder / "bad.csv"})
    (folder / "bad.csv").unlink()


def check_clipping(folder):
    drive = folder / "clipped.wav"
    done = made.run("render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", drive, "--gain", "20mm/N", "--over-limit", "clip")
    assert done.returncode == 0, done.stderr
    assert "clipped" in done.stderr and "dB" in done.stderr, done.stderr
    assert abs(np.abs(made.samples(drive)).max() - 5) < 1e-6
    assert "clipped removed" in done.stdout, done.stdout


def check_report(folder):
    report = made.report_of("render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", folder / "drive.wav")
    drive = made.samples(folder / "drive.wav")
    assert abs(report["drive_peak_v"] - np.abs(drive).max()) < 1e-9
    assert abs(report["drive_rms_v"] - np.sqrt(np.mean(drive**2))) < 1e-9
    assert abs(report["duration_s"] - len(drive) / 10e3) < 1e-9
    assert report["samples_outside_texture"] == 0 and report["delay_s"] == 0
    assert abs(report["highest_passed_at_max_speed_per_m"] - 500 / report["max_speed_mps"]) < 1e-6
    # The same input gives the same file.
    first = (folder / "drive.wav").read_bytes()
    made.report_of("render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", folder / "drive.wav")
    assert (folder / "drive.wav").read_bytes() == first


def check_kernel(folder):
    report = made.report_of("render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", folder / "kernel.wav",
                            "--engine", "kernel", "--encoder-step", "0.5um", "--hold", "zero-order")
    assert report["displacement_error_db"] < -30 and report["delay_s"] == 0, report  # includes the path's rests
    kernel = ["render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", folder / "kernel.wav", "--hold", "zero-order",
              "--engine", "kernel"]
    free = made.report_of(*kernel)
    rms = lambda: np.sqrt(np.mean(made.samples(folder / "kernel.wav")[5000:10000] ** 2))
    limit = 0.5 * rms()
    limited = made.report_of(*kernel, "--energy-limit", f"{limit}V", "--energy-window", "0.1s")
    assert free["energy_limited_samples"] == 0 < limited["energy_limited_samples"] and limited["limits_removed_db"] > -12, limited
    assert 0.9 * limit < rms() < 1.02 * limit, (rms(), limit)
    errors = [made.report_of(*kernel, "--interpolation", word)["displacement_error_db"] for word in ("nearest", "sinc")]
    # 64 points per period for nearest.
    assert abs(errors[1] - free["displacement_error_db"]) < 1 and errors[0] < -20, errors
    assert "limits_removed_db" not in free and free["limits_removed"] == "none", free
    for unknown, value in (("energy-limit", "1V"), ("encoder-step", "1um"), ("interpolation", "sinc")):
        for engine in ({}, {"engine": "reference"}):
            expect_refusal(folder, USAGE, f"--{unknown} requires --engine kernel", **engine, **{unknown: value})
    expect_refusal(folder, UNSUITABLE, "largest gain that fits", gain="100mm/N", engine="kernel")


def check_interior(folder):
    """A finger that moves at both ends: onset and ends are most of the error; away from them it is the kernel's.

    Compared with its own files: 15-500 Hz of the signal between the ends, with a Hann window.
    """
    made.write_path(folder / "moves.csv", [0, 3], [0.002, 0.048])
    base = ["render", folder / "t", "--finger-path", folder / "moves.csv", "--transducer", "wiertlewski2011", "-o", folder / "m.wav"]
    report = made.report_of(*base, "--engine", "kernel", "--hold", "zero-order", "--displacement", folder / "moved.wav", "--target", folder / "wanted.wav")
    keys = list(report)
    assert keys.index("interior_displacement_error_db") < keys.index("left_out_at_each_end_s") < keys.index("displacement_error_db"), keys
    assert abs(report["left_out_at_each_end_s"] - 0.75) < 1e-3, report  # 1 s, but at most a quarter of the path
    moved, wanted = made.samples(folder / "moved.wav"), made.samples(folder / "wanted.wav")

    def in_band(values):
        inside = values[len(values) // 4 : -(len(values) // 4)]
        hz = np.fft.rfftfreq(len(inside), 1e-4)
        return np.sum(np.abs(np.fft.rfft(inside * np.hanning(len(inside))))[(hz >= 15) & (hz <= 500)] ** 2)

    interior_db = 10 * np.log10(in_band(moved - wanted) / in_band(wanted))
    # The window emphasises the middle, and the error need not be uniform: 2 dB.
    assert abs(interior_db - report["interior_displacement_error_db"]) < 2, (interior_db, report)
    assert report["interior_displacement_error_db"] < report["displacement_error_db"] - 20, report
    text = made.run(*base, "--engine", "kernel", "--hold", "zero-order", "--force").stdout
    assert text.index("interior displacement error") < text.index("left out at each end") < text.index("\ndisplacement error", text.index("left out")), text


def check_budget(folder):
    """A requested error is kept between the path's ends; a time limit alone promises nothing; impossible requests are
    refused."""
    made.write_path(folder / "through.csv", [0, 1.5], [0.002, 0.048])  # moves at both ends
    base = ["render", folder / "t", "--finger-path", folder / "through.csv", "--transducer", "wiertlewski2011", "-o", folder / "b.wav"]
    kept = made.report_of(*base, "--max-error", "10ppm")
    # The ends are reported, not judged.
    assert kept["engine"] == "reference" and kept["displacement_error_db"] > -95, kept
    timed = made.report_of(*base, "--max-tick", "1us")
    assert timed["engine"] == "kernel" and "guaranteed_error_percent" not in timed and timed["least_error_percent"] < 0.1, timed
    assert made.report_of(*base, "--engine", "kernel", "--max-error", "5%", "--encoder-step", "10nm")["engine"] == "kernel"
    # Both steps are too coarse; the value for a tenth of them in the message was measured.
    for step, said in (("5um", "use --encoder-step 0.5um"), ("40um", "with a tenth of --encoder-step")):
        expect_refusal(folder, UNSUITABLE, said, **{"finger-path": folder / "through.csv", "engine": "kernel", "max-error": "0.1%", "encoder-step": step})
    # A count of 1 nm is a small part of a sample: its rounding by the wire must not accumulate along the texture.
    for step in ("100nm", "10nm", "1nm", "0.3nm"):
        fine = made.report_of(*base, "--engine", "kernel", "--max-error", "0.1%", "--encoder-step", step)
        assert fine["engine"] == "kernel" and fine["guaranteed_error_percent"] <= 0.1, (step, fine)
    expect_refusal(folder, UNSUITABLE, "2^29", **{"finger-path": folder / "through.csv", "engine": "kernel", "encoder-step": "0.08nm"})
    # With 8 samples per count (5 um over 0.62 um) the kernel reads up to 2^29 / 9 counts = 298.3 m, and is silent
    # beyond.
    made.write_texture(folder / "fine", 0.01 * np.sin(2 * np.pi * 1e5 * np.arange(50_000) * made.PITCH_M))
    far = {"texture": folder / "fine", "ends": "loop", "engine": "kernel", "encoder-step": "5um", "gain": "0.1mm/N"}
    for from_m, beyond in ((298.35, True), (298.2, False)):
        made.write_path(folder / "far.csv", [0, 1], [from_m, from_m + 0.03])
        if beyond:
            expect_refusal(folder, UNSUITABLE, "up to 298.3 m", **{"finger-path": folder / "far.csv"}, **far)
        else:
            made.report_of("render", folder / "fine", "--finger-path", folder / "far.csv", "--transducer", "wiertlewski2011", "-o", folder / "far.wav",
                           *[part for key, value in far.items() if key != "texture" for part in ("--" + key, value)])
    made.write_texture(folder / "nothing", np.zeros(50_001))
    expect_refusal(folder, UNSUITABLE, "there is no error to measure", texture=folder / "nothing", quality="balanced")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made.write_texture(folder / "t", 0.01 * np.sin(2 * np.pi * 3e3 * np.arange(50_001) * made.PITCH_M))
        made.write_path(folder / "path.csv", [0, 0.1, 1.1, 1.2], [0.002, 0.002, 0.04, 0.04])
        check_refusals(folder)
        check_clipping(folder)
        check_kernel(folder)
        check_interior(folder)
        check_budget(folder)
        check_report(folder)


if __name__ == "__main__":
    main()
