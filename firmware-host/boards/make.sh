#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# make.sh BOARD FOLDER : the firmware of a board, FOLDER/BOARD.elf and BOARD.bin; prints its build and sizes.
set -eu
here=$(dirname "$0")
"$here/cortex_m4.sh" "$2/$1.elf" "$here/$1/memory.ld" "$here/$1"/*.cpp
"$here/image.py" "$2/$1.elf"
