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

with tempfile.TemporaryDirectory() as folder:
    (pathlib.Path(folder) / "long.log").write_text(LOG)
    lists = subprocess.run([sys.executable, VERDICT, folder, "long"], capture_output=True, text=True, check=True).stdout
assert lists.split("\n\n") == ["\nfailed: 1\n  long: identify_anywhere_test (Timeout)", "passed only at the second try: 1\n  long: long_session",
                               "skipped: 1\n  long: package", "not judged: 1\n  long: the machine stopped\n"], lists
print("the lists are those of the log: passed")
