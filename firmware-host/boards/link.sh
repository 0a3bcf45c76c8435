#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# link.sh CORE OUT.elf MEMORY.ld SOURCE... : the core and these sources, linked for a Cortex-M without any library. CORE is
# cortex_m4 or cortex_m33 (boards.hpp). A hosted header or an unknown symbol is an error, and so is a function that needs
# more than 768 bytes of stack.
set -eu
root=$(dirname "$0")/../..
core=$1 out=$2 memory=$3
shift 3
case $core in
  cortex_m4) target="--target=thumbv7em-none-eabihf -mcpu=cortex-m4 -mfpu=fpv4-sp-d16" ;;
  cortex_m33) target="--target=thumbv8m.main-none-eabihf -mcpu=cortex-m33 -mfpu=fpv5-sp-d16" ;;
  *) echo "link.sh: no core '$core'; there are cortex_m4 and cortex_m33" >&2; exit 2 ;;
esac
version=$(sed -n 's/^project(tactograph VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
# shellcheck disable=SC2046,SC2086  # the names have no spaces; the target is several words
exec "${CLANGXX:-clang++-16}" $target -mfloat-abi=hard -std=c++20 -O2 \
  -ffreestanding -nostdlibinc -nostdlib -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno -ffp-contract=off \
  -ffunction-sections -fdata-sections -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion \
  -Wframe-larger-than=768 -Werror -DTACTO_VERSION="\"$version\"" -I"$root" \
  $(find "$root/firmware-host/core" -name '*.cpp' | sort) "$root/firmware-host/boards/implicit_calls.cpp" "$@" \
  -fuse-ld=lld -Wl,--gc-sections -Wl,-e,reset_handler -Wl,-T,"$memory" -o "$out"
