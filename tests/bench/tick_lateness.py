#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How late the daemon's clock wakes, beside cyclictest (rt-tests) on the same core, by turns.

usage: tick_lateness.py TICK_LATENESS [--rate 2000] [--rounds 10] [--seconds 5] [--priority 50] [--core 0]

Shared machines stall for tens of milliseconds, so only the ratio of medians over the rounds is meaningful, not a single
figure. The daemon's clock spins during the last 50 us; cyclictest only sleeps, as a daemon without spinning would. Both
keep the cores out of deep idle states (/dev/cpu_dma_latency) if they have the right.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys

PARTS = {"p50": 0.5, "p99": 0.99, "p99.9": 0.999}
MOST_US = 20000
MOST_RATIO = 1.1  # of p99; printed, not asserted, because a shared machine cannot meet it reliably


def printed(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"tick_lateness: '{' '.join(words)}' failed with {done.returncode}: {done.stderr.strip() or 'it said nothing'}")
    return done.stdout


def ours(program, o):
    words = [program, str(o.rate), str(o.seconds), str(o.priority)]
    said = json.loads(printed(["taskset", "-c", str(o.core), *words]))
    return {name: 1e6 * said[key] for name, key in (("p50", "p50_s"), ("p99", "p99_s"), ("p99.9", "p999_s"))}, said


def quantiles(lines):
    """Reads `cyclictest -h`: one line for each microsecond, and the number of values beyond."""
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    counts = [(int(us), int(count)) for us, count in rows]
    beyond = next((int(line.split(":")[1].split()[0]) for line in lines if line.startswith("# Histogram Overflows")), 0)
    total = sum(count for _, count in counts) + beyond

    def at(part):
        below = 0
        for us, count in counts:
            below += count
            if below >= part * total:
                return us + 1.0
        return float(MOST_US)

    return {name: at(part) for name, part in PARTS.items()}


def theirs(o):
    words = ["cyclictest", "-q", "-m", "-t1", "-a", str(o.core), "-i", str(round(1e6 / o.rate)), "-D", str(o.seconds), "-h", str(MOST_US)]
    words += ["-p", str(o.priority)] if o.priority else ["--policy=other"]
    return quantiles(printed(words).splitlines())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--rate", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--seconds", type=int, default=5)
    parser.add_argument("--priority", type=int, default=50)
    parser.add_argument("--core", type=int, default=0)
    o = parser.parse_args()
    if shutil.which("cyclictest") is None:
        parser.error("cyclictest is not installed: ./bootstrap bench installs it (Debian's rt-tests)")
    if not os.access(o.program, os.X_OK):
        parser.error(f"{o.program}: no such program; './bootstrap bench' builds it")
    rounds = []
    for i in range(o.rounds):
        mine, said = ours(o.program, o)
        rounds.append((mine, theirs(o), said))
        print(f"round {i + 1}: ours p99 {mine['p99']:.1f} us, cyclictest {rounds[-1][1]['p99']:.1f} us", flush=True)
    print(f"\n{o.rate} Hz, SCHED_FIFO {'granted' if rounds[0][2]['real_time'] else 'refused'}, deep idle {'kept off' if rounds[0][2]['awake'] else 'allowed'}, medians of {o.rounds} rounds of {o.seconds} s")
    print("| late by, us | daemon's clock | cyclictest | ratio |\n|---|---|---|---|")
    ratios = {}
    for name in PARTS:
        mine, other = (statistics.median(r[k][name] for r in rounds) for k in (0, 1))
        ratios[name] = mine / other
        print(f"| {name} | {mine:.1f} | {other:.1f} | {mine / other:.2f} |")
    work = [statistics.median(r[2][key] for r in rounds) for key in ("work_p50_s", "work_p99_s")]
    print(f"a tick of the kernel after the sleep: p50 {1e6 * work[0]:.2f} us, p99 {1e6 * work[1]:.2f} us; "
          f"missed {sum(r[2]['missed'] for r in rounds)} of {o.rounds * o.seconds * o.rate} ticks")
    print(f"the clock's p99 is {'at most' if ratios['p99'] <= MOST_RATIO else 'NOT within'} {MOST_RATIO} times cyclictest's")


if __name__ == "__main__":
    main()
