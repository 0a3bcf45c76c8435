#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""identify over the kernel's USB finds the parameters of the emulated transducer."""
import json
import math
import os
import pathlib
import sys

import tacto
import virtual_machine

# Table I of the paper, from which `wiertlewski2011` is made.
M_KG, K_N_PER_M, B_NS_PER_M = 6.8e-3, 4.05e3 + 7.647e4, 4.49


def identified_over_usb():
    results = pathlib.Path("results")
    results.mkdir()
    print(virtual_machine.run("identify.sh", results.resolve(), timeout_s=600, TACTOGRAPH=tacto.COMMAND, GADGET=os.environ["GADGET"]))
    found = json.loads((results / "identify.out").read_text())
    assert found["verdict"] == "fits" and "emulated" in found["simulated"] and found["source"] == "usb:serial=I1", found
    resonance_hz = math.sqrt(K_N_PER_M / M_KG) / (2 * math.pi)
    wanted = {"resonance_hz": resonance_hz, "damping_ratio": B_NS_PER_M / (2 * math.sqrt(K_N_PER_M * M_KG)), "gain_m_per_v": 2e-5}
    for parameter in found["parameters"]:
        name, value = parameter["parameter"], parameter["value"]
        print(f"{name}: {value:.6g}, wanted {wanted.get(name, math.nan):.6g}")
        # A true value is outside of a 95 % interval once in twenty, and more than three half widths away once in 2e8.
        width = parameter["high_of_95"] - parameter["low_of_95"]
        assert name not in wanted or abs(value - wanted[name]) < 1.5 * width, (parameter, wanted[name])
    assert {p["parameter"] for p in found["parameters"]} >= set(wanted)
    tacto.run("validate", results / "found.transducer.json")


if __name__ == "__main__":
    try:
        tacto.in_folder(identified_over_usb)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
