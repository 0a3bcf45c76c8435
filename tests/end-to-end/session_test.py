#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told of a session: one time in all its tables, places, notes of what was not felt, damage."""
import pathlib
import sys

import numpy as np
import xarray

import tacto
from play_test import write_grating


def all_tables_share_one_time():
    """Seconds since the first tick in CSV, netCDF and strokes; the device's clock, which began before, beside them."""
    write_grating()
    pathlib.Path("strokes.csv").write_text("time_s,position_m\n0,0.004\n0.8,0.034\n1,0.034\n1.8,0.004\n2,0.004\n")
    tacto.run("play", "oak", "-d", "sim:paced=1,rate=2kHz", "--loop", "host", "--finger-path", "strokes.csv", "--gain", "0.5mm/N", "-o", "timed")
    strokes = tacto.run_json("session", "timed", "-o", "timed.csv", "-o", "timed.nc")["strokes"]
    table = np.genfromtxt("timed.csv", delimiter=",", names=True)
    nc = xarray.open_dataset("timed.nc")
    assert table["time_s"][0] == 0 and table["device_time_s"][0] > 0, table[0]
    printed_s = 1e-9  # the table's last digit
    np.testing.assert_allclose(table["device_time_s"] - table["time_s"], table["device_time_s"][0], atol=2 * printed_s)
    for column, variable in (("time_s", "time"), ("device_time_s", "device_time"), ("gain", "gain")):
        np.testing.assert_allclose(table[column], nc[variable], rtol=0, atol=printed_s)
    assert nc.time.attrs["units"] == nc.device_time.attrs["units"] == "s"
    assert len(strokes) >= 2, strokes
    for stroke in strokes:
        for end in ("from", "to"):
            row = np.argmin(np.abs(table["time_s"] - stroke[f"{end}_s"]))
            assert abs(table["time_s"][row] - stroke[f"{end}_s"]) <= printed_s, stroke
            assert abs(table["position_m"][row] - stroke[f"{end}_m"]) < 1e-9, (stroke, table[row])


def a_counter_that_passes_2_to_the_31_goes_on():
    """At 1 um a count of 2^31 is 2147.48 m: the finger's way over it is one stroke, in the tables too."""
    write_grating()
    pathlib.Path("far.csv").write_text("time_s,position_m\n0,2147.47\n0.1,2147.47\n0.9,2147.5\n1,2147.5\n")
    tacto.run("play", "oak", "--ends", "loop", "-d", "sim:", "--finger-path", "far.csv", "--gain", "0.5mm/N", "-o", "far")
    strokes = tacto.run_json("session", "far", "-o", "over.csv")["strokes"]
    assert len(strokes) == 1 and abs(strokes[0]["to_m"] - 2147.5) < 2e-6 and abs(strokes[0]["from_m"] - 2147.47) < 2e-6, strokes
    table = np.genfromtxt("over.csv", delimiter=",", names=True)
    assert np.any(np.diff(table["encoder_count"]) < -2**31) and np.max(np.abs(np.diff(table["position_m"]))) < 1e-3


if __name__ == "__main__":
    for test in (all_tables_share_one_time, a_counter_that_passes_2_to_the_31_goes_on):
        if len(sys.argv) > 1 and test.__name__ not in sys.argv[1:]:
            continue
        tacto.in_folder(test)
