#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# cortex_m4.sh OUT.elf MEMORY.ld SOURCE... : the core and these sources, linked for a Cortex-M4F without any library. A
# hosted header or an unknown symbol is an error, and so is a function that needs more than 768 bytes of stack.
set -eu
root=$(dirname "$0")/../..
out=$1 memory=$2
shift 2
version=$(sed -n 's/^project(tactograph VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
# shellcheck disable=SC2046  # the names have no spaces
exec "${CLANGXX:-clang++-16}" --target=thumbv7em-none-eabihf -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard -std=c++20 -O2 \
  -ffreestanding -nostdlibinc -nostdlib -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno -ffp-contract=off \
  -ffunction-sections -fdata-sections -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion \
  -Wframe-larger-than=768 -Werror -DTACTO_VERSION="\"$version\"" -I"$root" \
  $(find "$root/firmware-host/core" -name '*.cpp' | sort) "$root/firmware-host/boards/implicit_calls.cpp" "$@" \
  -fuse-ld=lld -Wl,--gc-sections -Wl,-e,reset_handler -Wl,-T,"$memory" -o "$out"
