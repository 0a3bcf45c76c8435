# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures that tests compute, for tests/MEASURED.md (tests/README.md, "Measured results")."""
import re


def measured(key, value):
    """Prints "[measured] KEY VALUE", which tests/measured.py collects. Call it beside the assertion of the same figure.

    KEY is `<subject>.<figure>_<unit>` of a-z, 0-9, '_' and '.', and unique among all tests.
    """
    print(f"[measured] {key} {float(value):.10g}", flush=True)


def not_measured(keys, reason):
    """Says why keys are not printed in this run: KEYS is one key, or ends in '*'."""
    print(f"[not measured] {keys} {reason}", flush=True)


def key_part(words):
    """Words as a part of a key, as tests/measured.hpp makes it: "second mode, 800 Hz" is "second_mode_800_hz"."""
    return re.sub(r"[^a-z0-9]+", "_", words.lower().replace("+", "")).strip("_")
