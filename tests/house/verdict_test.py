#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The lists at the end of ./bootstrap test --all, from lines of ctest 3.25 with --repeat until-pass:2."""
import pathlib
import subprocess
import sys
import tempfile

VERDICT = pathlib.Path(__file__).resolve().parents[1] / "verdict.py"
LOG = """      Start 171: long_session
 6/11 Test #171: long_session .....................***Failed  600.51 sec
      Start 171: long_session
    Test #171: long_session .....................   Passed  522.13 sec
 7/11 Test #122: fidelity_table ...................   Passed   25.47 sec
 8/11 Test  #12: package ..........................***Skipped   0.10 sec
not judged: the machine stopped
 9/11 Test #153: identify_anywhere_test ...........***Failed   18.31 sec
    Test #153: identify_anywhere_test ...........***Timeout 600.00 sec
"""

TWO_BUILDS = """
== tests (test)
1/2 Test #193: usb_recording ....................   Passed   70.32 sec
2/2 Test #194: usb_gadget .......................***Failed   63.17 sec
== tests (sanitize)
1/2 Test #162: usb_recording ....................   Passed   47.29 sec
2/2 Test #163: usb_gadget .......................   Passed   50.66 sec
"""


def lists_of(stage, log):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / f"{stage}.log").write_text(log)
        return subprocess.run([sys.executable, VERDICT, folder, stage], capture_output=True, text=True, check=True).stdout


lists = lists_of("long", LOG)
assert lists.split("\n\n") == ["\nfailed: 1\n  long: identify_anywhere_test (Timeout)", "passed only at the second try: 1\n  long: long_session",
                               "skipped: 1\n  long: package", "not judged: 1\n  long: the machine stopped\n"], lists
lists = lists_of("usb", TWO_BUILDS)
assert "failed: 1\n  usb: usb_gadget (Failed)" in lists and "second try: none" in lists, lists
print("the lists are those of the log: passed")
