#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A tarball that runs on any x86-64 Linux with /bin/sh, without root: usage: cmake/tarball/make.sh BUILD-FOLDER [OUTPUT-FOLDER]
# Beside the programs it contains every library that they load, the C library and its loader among them, because
# clusters have older ones than Debian 12; and a font for pictures.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
build=$1 out=${2:-$1/packages}
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=tactograph-$version-$(uname -m)
stage=$(mktemp -d); trap 'rm -rf "$stage"' EXIT
root=$stage/$name
cmake --install "$build" --component tactograph --prefix "$root" --strip >/dev/null

rm -r "$root/lib/udev" "$root/lib/systemd"  # both need root
programs=("$root"/bin/*)
mkdir "$root/libexec" "$root/lib/debian" "$root/share/fonts" "$root/share/doc/libraries"
# ldd prints "NAME => FILE (ADDRESS)", and for the loader "FILE (ADDRESS)".
mapfile -t libraries < <(ldd "${programs[@]}" "$root"/lib/tactograph/*.so | grep -o '/[^ ]* (0x' | sed 's/ (0x//' | sort -u)
cp -L "${libraries[@]}" "$root/lib/debian"
cp /usr/share/fonts/truetype/dejavu/DejaVuSans*.ttf "$root/share/fonts"
cp "$here/fonts.conf" "$root/share/fonts"
for program in "${programs[@]}"; do
  mv "$program" "$root/libexec"
  cp "$here/launch.sh" "$program"
done
# Licences, and the versions whose sources Debian keeps. dpkg knows some libraries as /lib/..., others as /usr/lib/...
packages=$(readlink -f "${libraries[@]}" | sed 's|^/usr/lib/|*/lib/|' | xargs dpkg-query -S | cut -d: -f1 | sort -u)
for package in $packages fonts-dejavu-core; do
  cp -L "/usr/share/doc/$package/copyright" "$root/share/doc/libraries/$package"
  dpkg-query -W -f '${Package} ${Version} (source: ${source:Package} ${source:Version})\n' "$package"
done | sort -u >"$root/share/doc/libraries/VERSIONS"

mkdir -p "$out"
tar -C "$stage" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-$(date +%s)}" \
  -czf "$out/$name.tar.gz" "$name"
echo "$out/$name.tar.gz"
