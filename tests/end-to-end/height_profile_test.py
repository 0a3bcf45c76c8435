#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured height profile through import, info, validate and spectrogram, against ElementTree and SciPy."""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import scipy.signal
import xarray

import tacto

EDM = tacto.DATA / "profiles" / "edm.xml"


def heights_m():
    data = ElementTree.parse(EDM).getroot().find("DATAFILE")
    assert data.findtext("UNITS") == "um" and data.findtext("SPACING") == "0.25"
    return np.array(data.findtext("DATA_POINT_VALUES").split(), dtype=float) * 1e-6


def the_profile_becomes_a_texture():
    wanted = heights_m()
    report = tacto.run_json("import", EDM, "-o", "edm")
    assert report["samples"] == len(wanted) == 22401 and report["pitch_m"] == 0.25e-6, report
    x, values, side = tacto.texture("edm")
    assert np.allclose(values, wanted, rtol=6e-8, atol=0), "32-bit floats: half a unit in the last place"
    assert (side["quantity"], side["unit"], side["direction"], side["surface"]) == ("height", "m", 1, "EDM"), side
    assert "National Physical Laboratory" in side["notes"] and "edm.xml" in side["notes"], side["notes"]
    assert side["valid_band"][1]["high_per_m"] == 2e6, side["valid_band"]
    tacto.run("validate", "edm")
    info = tacto.run_json("info", "edm")
    assert "height" in str(info), info


def its_spectrogram_is_scipys():
    tacto.run("import", EDM, "-o", "edm")
    tacto.run("spectrogram", "edm", "-o", "edm.nc", "--window", "1mm")
    made = xarray.open_dataset("edm.nc")
    density = made["density"].squeeze()
    frequency = made["spatial_frequency"].values
    hop = int(round(float(np.diff(made["position"].values[:2])[0]) / 0.25e-3))
    padded = int(round(1 / (0.25e-3 * (frequency[1] - frequency[0]))))
    values = tacto.texture("edm")[1]
    _, _, wanted = scipy.signal.spectrogram(values, fs=4000, window="blackman", nperseg=4000, noverlap=4000 - hop,
                                            nfft=padded, detrend="constant", scaling="density", mode="psd")
    wanted = wanted[:len(frequency)].T
    got = density.values.reshape(-1, len(frequency))
    assert got.shape == wanted.shape, (got.shape, wanted.shape)
    strong = wanted > 1e-6 * wanted.max()
    worst = np.max(np.abs(got[strong] / wanted[strong] - 1))
    print(f"spectrogram of edm.xml against SciPy: {worst:.1e} relative where above -60 dB")
    assert worst < 1e-4, worst  # single precision, and netCDF in 32-bit floats


def tables_give_the_same():
    wanted = heights_m()
    rows = "".join(f"{0.00025 * i:.5f};{1e6 * h:.9f}\n".replace(".", ",") for i, h in enumerate(wanted))
    pathlib.Path("p.csv").write_text("x/mm;z/um\n" + rows)
    tacto.run("import", "p.csv", "-o", "both", "--channel", "position=x/mm*1mm", "--channel", "height=z/um*1um")
    tacto.run("import", "p.csv", "-o", "alone", "--pitch", "0.25um", "--channel", "height=z/um*1um")
    for name in ("both", "alone"):
        _, values, side = tacto.texture(name)
        assert np.allclose(values, wanted, rtol=1e-7, atol=1e-15), name
        assert abs(side["pitch_m"] - 0.25e-6) < 1e-15, side["pitch_m"]


def profiles_measured_backwards_are_turned():
    pathlib.Path("b.csv").write_text("x,z\n4,1\n3,2\n2,4\n1,8\n")
    tacto.run("import", "b.csv", "-o", "b", "--channel", "position=x*1um", "--channel", "height=z*1um")
    _, values, side = tacto.texture("b")
    assert np.allclose(values, [8e-6, 4e-6, 2e-6, 1e-6]) and side["direction"] == -1, (values, side)
    assert abs(side["source_origin_m"] - 1e-6) < 1e-18


def what_is_no_profile_is_refused():
    def refused(code, words, *arguments):
        err = tacto.run("import", *arguments, code=code)[1]
        assert words in err and len(err.strip().split("\n")) == 1, err
    pathlib.Path("u.csv").write_text("x,z\n0,1\n1,2\n2.4,4\n3,8\n4,9\n")
    channels = ["--channel", "position=x*1um", "--channel", "height=z*1um"]
    refused(5, "u.csv: line 4: the position of 0.0024 mm deviates by 0.4 um", "u.csv", "-o", "u", *channels)
    refused(2, "both --pitch and a position", "u.csv", "-o", "u", *channels, "--pitch", "1um")
    refused(2, "a profile cannot contain speed", "u.csv", "-o", "u", "--pitch", "1um", "--channel", "speed=x*1mm/s")
    good = "<DATA><DATAFILE><UNITS>um</UNITS><NUMPOINTS>2</NUMPOINTS><SPACING>1</SPACING><DATA_POINT_VALUES>1\n2</DATA_POINT_VALUES></DATAFILE></DATA>"
    for old, new, words in (("um", "kg", "'kg' is not a unit of length"), ("<NUMPOINTS>2", "<NUMPOINTS>3", "2 values, but NUMPOINTS is 3"),
                            ("1\n2", "1\ntwo", "value 2, 'two', is not a number"), (">1</SP", ">0</SP", "a spacing must be above 0"),
                            ("</DATA>", "", "is not XML"), ("DATAFILE", "FILE", "there is no DATA/DATAFILE")):
        pathlib.Path("bad.xml").write_text(good.replace(old, new))
        refused(4, words, "bad.xml", "-o", "bad")
    pathlib.Path("good.xml").write_text(good)
    tacto.run("import", "good.xml", "-o", "good")
    refused(2, "exists already", "good.xml", "-o", "good")
    refused(2, "already contains the channel of its heights", "good.xml", "-o", "good2", "--pitch", "1um")


if __name__ == "__main__":
    profiles = (profiles_measured_backwards_are_turned, what_is_no_profile_is_refused)
    for test in profiles:
        tacto.in_folder(test)
    if not EDM.exists():
        print("skipped: no real data")
        sys.exit(77)
    for test in (the_profile_becomes_a_texture, its_spectrogram_is_scipys, tables_give_the_same):
        tacto.in_folder(test)
