#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`import` of stylus tables: units of the heading, the preamble in the notes, coarsely printed positions, stated Ra and Rq."""
import json
import pathlib

import numpy as np
import scipy.signal
import tacto

USAGE, UNSUITABLE = 2, 5
ROWS = 4000
PITCH_UM = 0.0333
CHANNELS = ["--channel", "position=Lateral", "--channel", "height=Profile"]


def table(x_um, z_nm, digits=3, unit="nm", preamble="", encoding="utf-8"):
    lines = [f"{x:.{digits}f},{z:.3f}" for x, z in zip(x_um, z_nm)]
    pathlib.Path("p.csv").write_bytes(f"{preamble}Lateral (um),Profile ({unit})\n".encode(encoding) + "\n".join(lines).encode())


def imported(*more, code=0):
    words = ["import", "p.csv", "-o", "p", "--force", *CHANNELS, *more]
    return tacto.run_json(*words) if code == 0 else tacto.error_of(*words, code=code)


def made():
    x_um = 12 + PITCH_UM * np.arange(ROWS)
    return x_um, 40 * np.sin(2 * np.pi * x_um / 7) + np.random.default_rng(1).normal(0, 5, ROWS) + 0.3 * x_um


def coarse_positions_are_fitted():
    x_um, z_nm = made()
    for digits in (4, 2, 1):  # 0.1 um is three pitches
        table(x_um, z_nm, digits)
        stated = imported()
        digit_um = 10.0**-digits
        # The grid and the one that made the positions are both within half a digit of each printed position, the ends included.
        assert abs(stated["pitch_m"] * 1e6 - PITCH_UM) <= 2 * digit_um / (ROWS - 1), (digits, stated)
        assert stated["unevenness_m"] * 1e6 <= digit_um / 2 * (1 + 1e-6), (digits, stated)
        if digits < 4:  # least squares is another fit of the same grid: it is within the same bound
            slope_um = np.polyfit(np.arange(ROWS), np.round(x_um, digits), 1)[0]
            assert abs(stated["pitch_m"] * 1e6 - slope_um) <= 2 * digit_um / (ROWS - 1), (digits, stated, slope_um)
    assert np.array_equal(tacto.soundfile.read("p.texture.wav", dtype="float64")[0], (np.round(z_nm, 3) * 1e-9).astype(np.float32))
    table(x_um[::-1], z_nm[::-1], 2)
    assert imported()["direction"] == -1


def a_missing_row_is_refused_all_the_same():
    x_um, z_nm = made()
    keep = np.arange(ROWS) != 1700
    for digits in (3, 2):
        table(x_um[keep], z_nm[keep], digits)
        assert "line" in imported(code=UNSUITABLE)["where"]
    table(x_um[:30], z_nm[:30], 0)  # 1 um long: ten digits of 0.1 um give no pitch
    imported(code=UNSUITABLE)


def units_of_the_heading_and_the_preamble():
    x_um, z_nm = made()
    preamble = "Dektak XT\nStylus force,3,mg\n\nScan \xb5m,133\n"
    for encoding, sign in (("utf-8", "\xc5"), ("latin-1", "\xc5"), ("utf-8", "\u212b")):
        table(x_um, 10 * z_nm, unit=sign, preamble=preamble, encoding=encoding)
        stated = imported("--notes", "second scan")
        assert abs(stated["highest_m"] - z_nm.max() * 1e-9) < 1e-12, stated
        notes = json.loads(pathlib.Path("p.texture.json").read_text())["notes"]
        assert "Dektak XT; Stylus force,3,mg; Scan \xb5m,133; second scan" in notes and "roughness" not in stated, notes


def stated_roughness_is_compared():
    x_um, z_nm = made()
    straight_nm = scipy.signal.detrend(np.round(z_nm, 3))
    ra_nm, rq_nm = np.mean(np.abs(straight_nm)), np.sqrt(np.mean(straight_nm**2))
    for lines, agree in ((f"Ra,{ra_nm:.1f},nm\nRq,{rq_nm:.1f},nm\n", (True, True)), (f"Ra (um): {ra_nm / 1000:.4f}\nRq = {1.2 * rq_nm:.1f} nm\n", (True, False)),
                         (f"Ra;{ra_nm:.1f}".replace(".", ",") + ";nm\nRq;x;nm\n", (True,)), ("Ra,5\nRa,,nm\nRate,3,nm\n", ())):
        table(x_um, z_nm, preamble="Instrument A\n" + lines)
        rows = imported().get("roughness", [])
        assert tuple(row["agrees"] for row in rows) == agree, (lines, rows)
        for row in rows:
            assert abs(row["computed_m"] * 1e9 / {"Ra": ra_nm, "Rq": rq_nm}[row["name"]] - 1) < 1e-9, row


def a_profile_of_matlab():
    import scipy.io
    x_um, z_nm = made()
    scipy.io.savemat("p.mat", {"x": x_um, "z": z_nm})
    stated = tacto.run_json("import", "p.mat", "-o", "m", "--channel", "position=x*1um", "--channel", "height=z*1nm")
    assert abs(stated["pitch_m"] * 1e6 / PITCH_UM - 1) < 1e-9, stated
    scipy.io.savemat("p.mat", {"x": x_um**2, "z": z_nm})
    assert "sample" in tacto.error_of("import", "p.mat", "-o", "n", "--channel", "position=x*1um", "--channel", "height=z*1nm", code=UNSUITABLE)["where"]


if __name__ == "__main__":
    for test in (coarse_positions_are_fitted, a_missing_row_is_refused_all_the_same, units_of_the_heading_and_the_preamble, stated_roughness_is_compared,
                 a_profile_of_matlab):
        tacto.in_folder(test)
