#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recomputes the example frames of core/WIRE.md from its tables with struct and a bitwise CRC: a second codec.

wire_message_test.cpp compares the C++ codec with the same lines. --print prints the lines for the document.
"""
import pathlib
import re
import struct
import sys

WIRE = pathlib.Path(__file__).resolve().parents[2] / "firmware-host/core/WIRE.md"


def crc32c(data):
    check = 0xFFFFFFFF
    for byte in data:
        check ^= byte
        for _ in range(8):
            check = check >> 1 ^ (0x82F63B78 if check & 1 else 0)
    return check ^ 0xFFFFFFFF


def frame(kind, sequence, payload):
    head = struct.pack("<BBBBHI", 0xA5, 0x54, 1, kind, len(payload), sequence)
    head += struct.pack("<H", crc32c(head) & 0xFFFF)
    return head + payload + struct.pack("<I", crc32c(head + payload))


# name: (type, sequence, struct format, values)
EXAMPLES = {
    "hello": (0x01, 0, "<BBHI", (1, 1, 0, 0x12345678)),
    "stream_start": (0x02, 1, "<IB", (10_000_000, 32)),
    "stream_stop": (0x03, 2, "<", ()),
    "limits": (0x04, 3, "<ffffHH", (5.0, 15708.0, 0.05, 0.01, 100, 200)),
    "profile_begin": (0x05, 4, "<IiqQB", (4000, -250, 1 << 31, 1 << 28, 1)),
    "profile_chunk": (0x06, 5, "<IHfff", (512, 3, 0.5, -0.25, 1e-6)),
    "profile_end": (0x07, 6, "<I", (0xDEADBEEF,)),
    "filters": (0x08, 7, "<Bfffff", (1, 1.0, -1.5, 0.75, -1.25, 0.5)),
    "gain": (0x09, 8, "<f", (-2.5,)),
    "sweep": (0x0A, 9, "<fIII", (0.5, 10_000, 800_000, 188_000)),
    "arm": (0x0B, 10, "<BI", (0, 20_000_000)),
    "play": (0x0C, 11, "<", ()),
    "stop": (0x0D, 12, "<", ()),
    "disarm": (0x0E, 13, "<", ()),
    "drive": (0x0F, 14, "<Hff", (2, 0.125, -0.125)),
    "heartbeat": (0x10, 15, "<I", (42,)),
    "reset": (0x11, 16, "<", ()),
    "profile_levels": (0x12, 17, "<BBHI", (5, 3, 0, 1601)),
    "taps": (0x13, 18, "<Hffff", (4, 1.5, -0.25, 0.125, 0.0)),
    "tracking": (0x14, 19, "<B3sfff", (1, b"", 4.0, 8.0, 12.5)),
    "energy": (0x15, 20, "<ff", (1.5, 0.5)),
    "contact": (0x16, 21, "<B3sffff", (3, b"", 0.5, 0.25, 2.0**-27, -0.125)),
    "change": (0x17, 22, "<f", (0.0625,)),
    "hysteresis": (0x18, 23, "<B3sfffff", (2, b"", 1.5, 0.25, -0.5, 1.0, -0.125)),
    "force_limits": (0x19, 24, "<6ffffffHHI", (20.0, 18.0, 0.0, 5.0, 4.0, 0.0, 20.0, 5.0, 20000.0, 0.02, 0.01, 100, 0, 2000)),
    "scene_part": (0x1A, 25, "<IIH4s", (64, 60, 4, bytes.fromhex("0000c842"))),
    "set": (0x1B, 26, "<HHff", (3, 1, 250.0, 0.5)),
    "move": (0x1C, 27, "<HHiif", (3, 0, -1000, 2500, 0.5)),
    "raise": (0x1D, 28, "<H", (3,)),
    "welcome": (0x81, 0, "<BBHI32s32s24sBBHIIIIIIIIff",
                (1, 1, 0, 0x12345678, b"bench 1", b"0007", b"1.2.3", 4, 1, 16, 31, 168_000_000, 10_000_000, 1_000_000,
                 20_000_000, 256, 16384, 1024, 5.0, 15708.0)),
    "channel": (0x82, 1, "<B24s24s8s40sddddd12s",
                (1, b"position", b"position", b"m", b"encoder", 1e-6, 0.0, float("nan"), float("nan"), float("nan"),
                 b"2011-05-01")),
    "note": (0x83, 2, "<BB512s", (0, 2, b"oak, planed")),
    "answer": (0x84, 3, "<BBHII", (0x0B, 4, 0, 10, 3)),
    "samples": (0x85, 4, "<QQIBBHiiii", (1 << 33, 0x0102030405060708, 3, 2, 2, 0, -65536, 1234, 0x7FFF0000, -1)),
    "ticks": (0x86, 5, "<QQB3sifI", (7, 99, 1, b"", -5, 0.0625, 3)),
    "pulse": (0x87, 6, "<IQBBBBifIIIIIIII", (42, 1 << 40, 2, 0, 1, 1, -77, 1.5, 10, 1, 2, 3, 4, 5, 6, 7)),
    "fault": (0x88, 7, "<B3sIQ", (3, b"", 10_000, 123_456_789)),
    "axes": (0x89, 8, "<B3sfffIB3sfffddB3sfffdd", (2, b"", 20.0, 5.0, 20000.0, 32768, 0, b"", 20.0, 5.0, 1e-5, -0.125, 0.125,
                                                   1, b"", 18.0, 4.0, 2e-5, -0.25, 0.25)),
    "axis_ticks": (0x8A, 9, "<QQBBHiiffI", (7, 99, 1, 2, 0, -5, 1234, 0.0625, -1.5, 3)),
}


def lines():
    for name, (kind, sequence, layout, values) in EXAMPLES.items():
        yield f"{name} {frame(kind, sequence, struct.pack(layout, *values)).hex()}"


def broken(line):
    """The line in the form of WIRE.md: at most 50 bytes of the frame in each, further lines indented by four."""
    name, digits = line.split()
    yield f"{name} {digits[:100]}"
    yield from (f"    {digits[at:at + 100]}" for at in range(100, len(digits), 100))


def documented(text):
    """The examples, each joined to one line: a frame's further lines are indented."""
    joined = re.sub(r"(?<=[0-9a-f])\n {4}(?=[0-9a-f]+$)", "", text, flags=re.M)
    return re.findall(r"^([a-z_]+ a554[0-9a-f]+)$", joined, re.M)


def main():
    assert crc32c(b"123456789") == 0xE3069283
    if "--print" in sys.argv:
        print("\n".join(part for line in lines() for part in broken(line)))
        return 0
    written = documented(WIRE.read_text())
    assert written == list(lines()), "WIRE.md's examples are not what its tables say"
    tables = set(re.findall(r"^### `0x[0-9a-f]{2}` ([a-z_]+)", WIRE.read_text(), re.M))
    assert tables == set(EXAMPLES), f"sections and examples differ: {tables ^ set(EXAMPLES)}"
    print(f"{len(written)} examples")
    return 0


if __name__ == "__main__":
    sys.exit(main())
