#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The core on a Cortex-M33 with FPU, that of an RP2350 (QEMU's mps2-an505, counting instructions): the same bits as
here, and each number of the table of costs. Takes kernel_ticks and tick_costs, as cortex_m4_test.py."""
import sys

from cortex_m4_test import check_costs, figures_of, run_on, say_worst


def main():
    program, costs = sys.argv[1:]
    output = run_on("cortex_m33", program)
    figures = figures_of(output)
    assert "same bits" in output and "played" in output, output
    per_count = 10_000 / figures["counts_of_10000_instructions"]
    kernel = figures["kernel_counts"] / figures["kernel_ticks"] * per_count
    tick = figures["firmware_tick_counts"] / figures["firmware_ticks"] * per_count
    poll = figures["firmware_poll_counts"] / figures["firmware_ticks"] * per_count
    change_most = figures["change_most_counts"] * per_count
    say_worst("cortex_m33", tick - kernel + change_most, poll)
    check_costs("cortex_m33", costs, tick - kernel, poll)


if __name__ == "__main__":
    main()
