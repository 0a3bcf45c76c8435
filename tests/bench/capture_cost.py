#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What capture costs, and that it loses nothing: `tactograph record` of the emulated device's counter, paced.

usage: capture_cost.py TACTOGRAPH [--time 60] [--no-clock] [--link-s 1]

The device ticks in real time and, as a real one does, loses frames that neither its ring (256 frames) nor the link can
hold. Frames contain their number, so that lost and doubled ones are found. --no-clock asserts on losses and memory
only, for shared machines. A link that holds less than the longest stall of the machine (on a busy one an idle loop
stopped for 0.2 to 0.8 s) loses frames, and the recording reports which. CPU time is that of the whole process with
device and start; memory is the peak above `--version`.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np
import soundfile

sys.path.append(os.path.join(os.path.dirname(__file__), "../end-to-end"))  # where ctest has it in PYTHONPATH
from machine_stops import MachineStops
from measured import measured

MOST_MEMORY_MB, MOST_CPU = 32, 0.03
SANITIZED = "TACTO_SANITIZED" in os.environ


# In a process of its own: a child's peak includes the memory of its parent at the fork, and NumPy is large.
MEASURE = """import os, sys
pid = os.spawnvp(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(pid, 0)
print(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status))"""


def cost_of(command):
    """(CPU seconds, peak MB) of a command that must succeed."""
    done = subprocess.run([sys.executable, "-S", "-c", MEASURE, *command], capture_output=True, text=True, check=True)
    cpu_s, peak_mb, code = done.stdout.split("\n")[-2].split()
    assert code == "0", f"{' '.join(command)}\nexit {code}\n{done.stderr}"
    return float(cpu_s), float(peak_mb)


def check_every_sample(path, frames, channels):
    """The code of channel c in frame i is 16 i + c."""
    first = 0
    with soundfile.SoundFile(path) as wav:
        for codes in wav.blocks(1 << 18, dtype="int32", always_2d=True):
            count = np.arange(first, first + len(codes), dtype=np.int64)[:, None] * 16 + np.arange(channels)
            wrong = np.flatnonzero((codes != count.astype(np.int32)).any(axis=1))
            assert not len(wrong), f"frame {first + wrong[0]} is {codes[wrong[0]]}"
            first += len(codes)
    assert first == frames, f"{first} frames of {frames}"


def capture(command, rate_khz, channels, time_s, link_s):
    with tempfile.TemporaryDirectory(prefix="tacto-") as folder:
        device = f"sim:source=counter,channels={channels},rate={rate_khz}kHz,paced=1,link_buffer={link_s:g}s"
        with MachineStops() as stops:
            cpu_s, peak_mb = cost_of([command, "record", "-d", device, "-o", f"{folder}/c", "--time", f"{time_s:g}s", "--allow-gaps"])
        if stops.allow(0.5 * link_s, "that no frame was lost"):
            check_every_sample(f"{folder}/c.wav", round(rate_khz * 1000 * time_s), channels)
        return cpu_s, peak_mb


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tactograph")
    parser.add_argument("--time", type=float, default=60)
    parser.add_argument("--no-clock", action="store_true")
    parser.add_argument("--link-s", type=float, default=1)
    options = parser.parse_args()
    start_s, idle_mb = cost_of([options.tactograph, "--version"])
    print("simulated, all of it")
    for rate_khz, channels, most_cpu in ((10, 4, MOST_CPU), (100, 8, None)):
        cpu_s, peak_mb = capture(options.tactograph, rate_khz, channels, options.time, options.link_s)
        share, above_mb = cpu_s / options.time, peak_mb - idle_mb
        print(f"{rate_khz} kHz x {channels}, {options.time:g} s: no sample lost or doubled, {above_mb:.1f} MB above an idle "
              f"process, {100 * share:.2f} % of one core (start: {start_s:.2f} s)", flush=True)
        measured(f"capture_cost.{rate_khz}khz_x_{channels}_above_idle_mb", above_mb)
        assert SANITIZED or above_mb < MOST_MEMORY_MB, above_mb  # a sanitizer keeps freed memory
        assert options.no_clock or most_cpu is None or share < most_cpu, share
    return 0


if __name__ == "__main__":
    sys.exit(main())
