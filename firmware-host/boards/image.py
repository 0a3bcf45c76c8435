#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""image.py NAME.elf FAMILY: writes the check of the flash into NAME.elf, writes NAME.bin, and NAME.uf2 unless FAMILY is 0;
prints the sizes.

The check is the CRC-32C of all bytes of the flash except the four of the check itself, at the symbol image_check. UF2 is
microsoft/uf2, README: blocks of 512 bytes, each with 256 bytes of the flash.
"""
import pathlib
import struct
import sys

LOAD, SYMBOLS = 1, 2  # of a program header, of a section header (System V ABI, chapter 4)


def crc32c(data):
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    check = 0xFFFFFFFF
    for byte in data:
        check = check >> 8 ^ table[(check ^ byte) & 255]
    return check ^ 0xFFFFFFFF


def records(elf, at, size, count, layout):
    return [struct.unpack_from(layout, elf, at + i * size) for i in range(count)]


def symbol(elf, sections, wanted):
    for kind, at, size, names in ((s[1], s[4], s[5], sections[s[6]][4]) for s in sections if s[1] == SYMBOLS):
        for name, value, *_ in records(elf, at, 16, size // 16, "<III"):
            if elf[names + name:elf.index(b"\0", names + name)] == wanted:
                return value
    raise SystemExit(f"image.py: no symbol {wanted.decode()}")


def uf2(image, address, family):
    parts = [image[i:i + 256].ljust(256, b"\0") for i in range(0, len(image), 256)]
    return b"".join(struct.pack("<8I", 0x0A324655, 0x9E5D5157, 0x2000, address + 256 * i, 256, i, len(parts), family)
                    + part.ljust(476, b"\0") + struct.pack("<I", 0x0AB16F30) for i, part in enumerate(parts))


def main(path, family):
    elf = bytearray(path.read_bytes())
    programs_at, sections_at, _, _, program_size, programs, section_size, count = struct.unpack_from("<IIIHHHHH", elf, 28)
    loads = [p for p in records(elf, programs_at, program_size, programs, "<8I") if p[0] == LOAD]
    sections = records(elf, sections_at, section_size, count, "<10I")
    parts = sorted((p[3], p[1], p[4]) for p in loads if p[4] > 0)  # address in the flash, place in the file, bytes
    for (address, _, size), (following, _, _) in zip(parts, parts[1:]):
        assert address + size == following, f"the image has a gap at {address + size:#x}"
    begin, check_at = parts[0][0], symbol(elf, sections, b"image_check")
    image = b"".join(elf[at:at + size] for _, at, size in parts)
    assert begin + len(image) == symbol(elf, sections, b"image_end")
    place = check_at - begin
    check = crc32c(image[:place] + image[place + 4:])
    patch = struct.pack("<I", check)
    in_file = next(at + check_at - address for address, at, size in parts if address <= check_at < address + size)
    elf[in_file:in_file + 4] = patch
    path.write_bytes(elf)
    image = image[:place] + patch + image[place + 4:]
    path.with_suffix(".bin").write_bytes(image)
    if family:
        path.with_suffix(".uf2").write_bytes(uf2(image, begin, family))
    ram = sum(p[5] for p in loads if p[2] != p[3] or p[4] == 0)
    print(f"{path.stem}: build {check:08x}, flash {len(image)} bytes, RAM {ram} bytes without the stack")


main(pathlib.Path(sys.argv[1]), int(sys.argv[2], 0))
