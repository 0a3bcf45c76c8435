#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# make.sh BOARD FOLDER : the firmware of a board (boards.hpp), FOLDER/BOARD.elf and BOARD.bin, and BOARD.uf2 if its boot
# loader takes one; prints its build and sizes. make.sh --list : the boards, each with its core.
set -eu
here=$(dirname "$0")
# Rows of kBoards as words: name, core, family of UF2.
rows() { sed -n 's/^ *{"\([a-z0-9]*\)", Core::\([a-z0-9_]*\),.*, \([0-9a-fx]*\)},$/\1 \2 \3/p' "$here/boards.hpp"; }
if [ "$1" = --list ]; then
  rows | cut -d ' ' -f 1,2
  exit
fi
row=$(rows | grep "^$1 ") || { echo "make.sh: no board '$1' in boards.hpp" >&2; exit 2; }
core=$(echo "$row" | cut -d ' ' -f 2)
"$here/link.sh" "$core" "$2/$1.elf" "$here/$1/memory.ld" "$here/$1"/*.cpp
"$here/image.py" "$2/$1.elf" "$(echo "$row" | cut -d ' ' -f 3)"
