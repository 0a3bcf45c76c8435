#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Starts the program of the same name in ../libexec with the libraries of this folder only.
program=$(readlink -f "$0")
root=$(dirname "$(dirname "$program")")
export FONTCONFIG_FILE="$root/share/fonts/fonts.conf"
for loader in "$root"/lib/debian/ld-linux*; do
  exec "$loader" --argv0 "$0" --library-path "$root/lib/debian" "$root/libexec/${program##*/}" "$@"
done
