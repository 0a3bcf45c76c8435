#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of boards (firmware-host/boards/boards.hpp) against the README and the linked images, the image of the rp2350
against what its boot ROM reads, and its program for the encoder in an interpreter of the PIO's instructions, which is
written from the datasheet. No RP2350 was run. Usage: boards_test.py FOLDER_OF_IMAGES
"""
import pathlib
import random
import re
import struct
import sys

from wire_document_test import crc32c

IMAGES = pathlib.Path(sys.argv[1])
BOARDS = pathlib.Path(__file__).parents[2] / "firmware-host/boards"
ROW = re.compile(r'^ *{"(\w+)", Core::(\w+), ([\d\']+), ([\d\']+), ([\d\']+), ([\d\']+), ([\d\']+), ([\d\']+), (\w+)},$', re.M)


def table():
    rows = ROW.findall((BOARDS / "boards.hpp").read_text())
    return {name: (core, *(int(number.replace("'", ""), 0) for number in numbers)) for name, core, *numbers in rows}


class Elf:
    """Loaded segments and symbols of a 32-bit ELF file (System V ABI, chapter 4)."""

    def __init__(self, path):
        self.data = path.read_bytes()
        programs, sections = struct.unpack_from("<II", self.data, 28)
        size, count, section_size, section_count = struct.unpack_from("<HHHH", self.data, 42)
        self.loads = [p for p in (struct.unpack_from("<8I", self.data, programs + i * size) for i in range(count)) if p[0] == 1]
        heads = [struct.unpack_from("<10I", self.data, sections + i * section_size) for i in range(section_count)]
        self.symbols = {}
        for head in (h for h in heads if h[1] == 2):
            for at in range(head[4], head[4] + head[5], 16):
                name, value = struct.unpack_from("<II", self.data, at)
                begin = heads[head[6]][4] + name
                self.symbols[self.data[begin:self.data.index(b"\0", begin)].decode()] = value

    def bytes_at(self, address, size):
        for _, offset, virtual, _, stored, *_ in self.loads:
            if virtual <= address and address + size <= virtual + stored:
                return self.data[offset + address - virtual:][:size]
        raise AssertionError(f"nothing is stored for {address:#x}")

    def ram(self, begin, size):
        """Bytes up to the last one that is loaded or cleared in this RAM."""
        return max(p[2] + p[5] for p in self.loads if begin <= p[2] < begin + size) - begin


def the_readme_says_the_same():
    text = (BOARDS / "README.md").read_text()
    for name, (_, clock, ram, samples, least, usual, most, _) in table().items():
        row = f"| `{name}` | {clock // 10**6} MHz | {ram // 1024} KB | {samples:,} | {least} Hz to {most // 1000} kHz, usually {usual // 1000} kHz |"
        assert row in text, row
        assert (BOARDS / name / "memory.ld").exists()
    rig = (BOARDS.parent / "RIG.md").read_text()
    for column, pins in ((2, r"\bP[AB]\d{1,2}\b"), (3, r"\bGP\d+")):  # of the table, and the pins of both pages
        wired = {pin for line in rig.splitlines() if line.startswith("|") for pin in re.findall(pins, line.split("|")[column])}
        named = {pin for line in text.splitlines() if line.startswith("|") for pin in re.findall(pins, line.split("|")[1])}
        assert wired == named and len(wired) > 8, wired ^ named


def each_image_is_whole():
    for name, (_, _, ram, samples, *_, family) in table().items():
        elf, flash = Elf(IMAGES / f"{name}.elf"), (IMAGES / f"{name}.bin").read_bytes()
        place = elf.symbols["image_check"] - elf.symbols["image_begin"]
        assert struct.unpack_from("<I", flash, place)[0] == crc32c(flash[:place] + flash[place + 4:]), name
        assert 4 * samples < elf.ram(0x20000000, ram) < ram, (name, elf.ram(0x20000000, ram))
        assert (IMAGES / f"{name}.uf2").exists() == (family != 0), name


def a_boot_rom_finds_the_image():
    """RP2350 datasheet, 5.9.5: stack and entry at the beginning; in the first 4 KB one block, linked to itself."""
    elf, flash = Elf(IMAGES / "rp2350.elf"), (IMAGES / "rp2350.bin").read_bytes()
    stack, entry = struct.unpack_from("<II", flash)
    assert 0x20000000 < stack <= 0x20082000 and stack % 8 == 0 and entry & 1 and 0x10000000 < entry < 0x10001000, (stack, entry)
    assert entry == elf.symbols["reset_handler"]
    starts = [i for i in range(0, 4096, 4) if flash[i:i + 4] == bytes.fromhex("d3deffff")]
    assert len(starts) == 1 and struct.unpack_from("<5I", flash, starts[0])[1:] == (0x10210142, 0x1FF, 0, 0xAB123579)
    assert elf.symbols["vectors"] == 0x20000000 and struct.unpack("<I", elf.bytes_at(0x20000000 + 60, 4))[0] == elf.symbols["systick_handler"]
    # The stacks are in banks of their own, behind what is cleared.
    assert (elf.symbols["link_stack_top"], elf.symbols["tick_stack_top"]) == (0x20081000, 0x20082000)
    assert elf.ram(0x20000000, 0x80000) <= 0x80000


def uf2_has_the_same_bytes():
    image, flash = (IMAGES / "rp2350.uf2").read_bytes(), (IMAGES / "rp2350.bin").read_bytes()
    blocks = [image[i:i + 512] for i in range(0, len(image), 512)]
    for i, block in enumerate(blocks):
        assert struct.unpack_from("<8I", block) == (0x0A324655, 0x9E5D5157, 0x2000, 0x10000000 + 256 * i, 256, i, len(blocks), 0xE48BFF59)
        assert len(block) == 512 and block[-4:] == bytes.fromhex("306fb10a")
    assert b"".join(block[32:288] for block in blocks)[:len(flash)] == flash and len(blocks) == -(-len(flash) // 256)


class StateMachine:
    """The instructions that the program uses (RP2350 datasheet, 11.4); out shifts to the right, in to the left."""

    def __init__(self, words, wrap, target):
        self.words, self.wrap, self.target = words, wrap, target
        self.x = self.y = self.isr = self.osr = self.count = 0
        self.place = target

    def step(self, pins):
        word, place = self.words[self.place], self.place
        self.place = self.target if place == self.wrap else place + 1
        assert word & 0x1F00 == 0, "no delay"
        kind, upper, lower = word >> 13, word >> 5 & 7, word & 31
        if word == 0x8018:
            self.count = self.isr
        elif kind == 0 and upper == 0:
            self.place = lower
        elif kind == 0 and upper == 4:
            if self.y:
                self.place = lower
            self.y = self.y - 1 & 0xFFFFFFFF
        elif kind == 2 and upper == 0:
            self.isr = (self.isr << lower | pins & (1 << lower) - 1) & 0xFFFFFFFF
        elif kind == 3 and upper == 6:
            self.isr, self.osr = self.osr & (1 << lower) - 1, self.osr >> lower
        elif kind == 5:
            names = {0: "pins", 1: "x", 2: "y", 5: "place", 6: "isr", 7: "osr"}
            value = pins if lower & 7 == 0 else getattr(self, names[lower & 7])
            setattr(self, names[upper], value ^ 0xFFFFFFFF if lower >> 3 == 1 else value)
        else:
            raise AssertionError(f"{word:#06x}")


def the_encoder_is_counted():
    """A finger that moves to and fro, at up to an edge in ten steps, with a bouncing contact; the count is that of its edges,
    and two's complement below zero."""
    elf = Elf(IMAGES / "rp2350.elf")
    words = struct.unpack("<26H", elf.bytes_at(elf.symbols["quadrature"], 52))
    states = [0, 1, 3, 2]
    draw = random.Random(1)
    for first in range(4):
        machine = StateMachine(words, 25, 17)
        machine.osr = states[first]  # as the board starts it
        at = first
        for _ in range(3000):
            at += draw.choice((-1, 1, 1)) if draw.random() < 0.5 else draw.choice((-1, -1, 1))
            for _ in range(draw.randrange(10, 25)):
                machine.step(states[at % 4])
            if draw.random() < 0.1:
                for _ in range(20):
                    machine.step(states[at % 4])
                assert machine.count == at - first & 0xFFFFFFFF, (machine.count, at)
        # Faster than it samples: the state repeats after two edges, which are no count, and no crash.
        machine.step(states[(at + 2) % 4])
        assert all(0 <= machine.place < 26 for _ in range(50) if machine.step(states[draw.randrange(4)]) is None)


def main():
    for step in (the_readme_says_the_same, each_image_is_whole, a_boot_rom_finds_the_image, uf2_has_the_same_bytes, the_encoder_is_counted):
        step()
        print(step.__name__, flush=True)


if __name__ == "__main__":
    main()
