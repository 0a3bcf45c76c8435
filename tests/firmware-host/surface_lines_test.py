#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of the surfaces A to E under the simulated finger: where they stay (1/mm) and where they move (Hz).

Prints the table of tests/MEASURED.md. The spectrum along position is of what `spatial` made of a recording, the one in
time of the recording as it is; both here, by NumPy, with a Hann window over 28 mm."""
import json

import numpy as np
import soundfile

import tacto
from measured import measured

SPEEDS_MM = (20, 40, 60, 80, 100)
# Of B, C and E from Table II: harmonics of 1.5, 3 and 0.5 mm. Of A and D, which are random, what seed 1 drew.
LINES = {"A": (0.38,), "B": (4 / 3, 8 / 3), "C": (1 / 3, 8 / 3), "D": (2.42,), "E": (2.0,)}
FROM_MM, TO_MM = 6, 34
RESOLUTION = 2 / (TO_MM - FROM_MM)  # per mm: half of the Hann window's main lobe
STAYS = 0.3 * RESOLUTION


def power(at, places, values):
    """|sum of values w e^(-2 pi i nu x)|^2, w Hann over the places."""
    part = (places - places[0]) / (places[-1] - places[0])
    weighted = values * (1 - np.cos(2 * np.pi * part))
    return np.abs(np.exp(-2j * np.pi * np.outer(at, places)) @ weighted) ** 2


def peak(places, values, near, reach, step):
    """The strongest frequency within `reach`, and its dB above the median of what lies around."""
    at = np.arange(near - reach, near + reach + step / 2, step)
    around = np.concatenate([np.arange(1.2, 4, 0.2), -np.arange(1.2, 4, 0.2)]) * reach + near
    found = power(at, places, values)
    floor = np.median(power(around[around > reach], places, values))
    return at[found.argmax()], 10 * np.log10(found.max() / floor)


def stroke(surface, speed_mm):
    device = f"sim:surface={surface},speed={speed_mm}mm/s,strokes=1,wander=0,seed=1"
    name = f"{surface}{speed_mm}"
    tacto.run("record", "-d", device, "-o", name, "--time", f"{0.3 + 40 / speed_mm:.2f}s")
    tacto.run("spatial", name, "-o", name, "--band", "3Hz..1000Hz")
    x, force, side = tacto.texture(name)
    x_mm = 1e3 * (x + side["source_origin_m"])
    inside = (x_mm > FROM_MM) & (x_mm < TO_MM)
    codes, rate = soundfile.read(f"{name}.wav", dtype="int32")
    at_mm = codes[:, 1] * 1e3 * json.load(open(f"{name}.json"))["channels"][1]["scale"]
    during = (at_mm > FROM_MM) & (at_mm < TO_MM)
    return (x_mm[inside][::20], force[inside][::20]), (np.flatnonzero(during) / rate, codes[during, 0] / 2.0**31)


def lines_stay_in_space_and_move_in_time():
    cells = {}
    for surface, lines in LINES.items():
        for speed_mm in SPEEDS_MM:
            space, time = stroke(surface, speed_mm)
            for line in lines:
                per_mm, stands_db = peak(*space, line, RESOLUTION, 0.002)
                hertz, _ = peak(*time, line * speed_mm, RESOLUTION * speed_mm, 0.002 * speed_mm)
                cells[surface, line, speed_mm] = per_mm, hertz, stands_db
    print("| surface, line | " + " | ".join(f"{speed} mm/s" for speed in SPEEDS_MM) + " |")
    print("|---|" + "---|" * len(SPEEDS_MM))
    for surface, line in ((surface, line) for surface, lines in LINES.items() for line in lines):
        row = [cells[surface, line, speed] for speed in SPEEDS_MM]
        print(f"| {surface}, {line:.2f} /mm | " + " | ".join(f"{per_mm:.2f} /mm, {hz:.1f} Hz" for per_mm, hz, _ in row) + " |")
    for (surface, line, speed), (per_mm, hertz, stands_db) in cells.items():
        where = f"{surface} {line:.2f} /mm at {speed} mm/s: {per_mm:.3f} /mm, {hertz:.1f} Hz, {stands_db:.1f} dB"
        key = f"surface_lines.{surface.lower()}_{100 * line:.0f}.at_{speed}_mm_per_s"
        measured(f"{key}_per_mm", per_mm)
        measured(f"{key}_hz", hertz)
        assert abs(per_mm - line) < STAYS, where
        assert abs(hertz - line * speed) < STAYS * speed, where
        assert stands_db > 5, where
    print(f"the weakest stands {min(stands for _, _, stands in cells.values()):.1f} dB above what lies around it")


tacto.in_folder(lines_stay_in_space_and_move_in_time)
