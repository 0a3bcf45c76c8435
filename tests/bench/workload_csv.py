#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmarks' recording as a table.

usage: workload_csv.py FILE.csv SECONDS
"""
import sys

import numpy as np
from scipy_columns import RATE, workload

path, seconds = sys.argv[1], int(sys.argv[2])
position, force = workload(seconds)
table = np.column_stack([np.arange(len(force)) / RATE, force, np.round(position / 1e-6)])
with open(path, "w", encoding="ascii") as file:
    file.write("time_s,force_V,count\n")
    np.savetxt(file, table, delimiter=",", fmt=("%.6f", "%.9f", "%d"))
