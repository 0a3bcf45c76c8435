#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the seeds of the corpora: WIRE.md's example frames, and conversations that start a drive."""
import math
import pathlib
import re
import struct

HERE = pathlib.Path(__file__).resolve().parent
WIRE = HERE.parents[1] / "firmware-host/core/WIRE.md"


def action_frame(kind, payload=b""):
    """firmware_fuzz's action 0."""
    return bytes([0, kind, len(payload)]) + payload


TICKS = bytes([2, 250])
HELLO = action_frame(1, struct.pack("<BBHI", 1, 0, 0, 1))
LIMITS = action_frame(4, struct.pack("<ffffHH", 5.0, 15708.0, 0.002, 0.005, 50, 100))
PLAY, STOP, DISARM = (action_frame(kind) for kind in (0x0C, 0x0D, 0x0E))


def arm(source):
    return action_frame(0x0B, struct.pack("<BI", source, 10_000_000))


def profile(volts=3):
    values = [volts * math.sin(i) for i in range(32)]
    begin = action_frame(5, struct.pack("<IiqQB", 32, 0, 16 << 32, 1 << 32, 1))
    chunk = action_frame(6, struct.pack("<IH32f", 0, 32, *values))
    return begin + chunk + action_frame(7, struct.pack("<I", crc32c(struct.pack("<32f", *values))))


def change(fade_s):
    return action_frame(0x17, struct.pack("<f", fade_s))


def crc32c(data):
    check = 0xFFFFFFFF
    for byte in data:
        check ^= byte
        for _ in range(8):
            check = check >> 1 ^ (0x82F63B78 if check & 1 else 0)
    return check ^ 0xFFFFFFFF


def grooves_table(per_count, per_m, amplitudes):
    """Periods per count along x and y, with 32 bits after the point; periods per metre."""
    strides = [word for at in per_count for word in (at >> 32, at & 0xFFFFFFFF, 0)]
    return struct.pack("<iIiIIiII2fI", -1, 2**31, *strides, *per_m, len(amplitudes)) + struct.pack(f"<{len(amplitudes)}f", *amplitudes)


def noise_table(per_count, per_m, amplitudes):
    """The axes of the patch are those of the plane."""
    rows = struct.pack("<iIiIIiII", 0, 0, per_count >> 32, per_count & 0xFFFFFFFF, 0, 0, 0, 0) + struct.pack("<iIiIIiII", 5, 77, 0, 0, 0, per_count >> 32, per_count & 0xFFFFFFFF, 0)
    return rows + struct.pack("<fI", per_m, len(amplitudes)) + bytes(range(256)) + struct.pack(f"<{len(amplitudes)}f", *amplitudes)


def relief_table(per_m, levels):
    """A level: samples per count along x and y with 32 bits after the point, samples per metre, columns, rows."""
    table, first, coefficients = struct.pack("<fIff", per_m, len(levels), 0.8, -0.6), 0, b""
    for x, y, samples_per_m, columns, rows in levels:
        along = struct.pack("<iIiIIiII", 1, 2**31, x >> 32, x & 0xFFFFFFFF, 0, y >> 32, y & 0xFFFFFFFF, 0)
        table += along * 2 + struct.pack("<2f3I", samples_per_m, samples_per_m, columns, rows, first)
        first += columns * rows
        coefficients += struct.pack(f"<{columns * rows}f", *(10 * (-1) ** i / (1 + i % 3) for i in range(columns * rows)))
    return table + coefficients


def force_table(per_m, levels):
    """As of a relief, with the coefficients of both components."""
    table = relief_table(per_m, levels)
    return table + table[16 + 84 * len(levels):]


def field_table(units_per_m, core, atoms):
    """Two rows of 2^-32 periods per count; an atom is (x, y, z, sigma^2, force constants)."""
    along = struct.pack("<iIiIIiII", 0, 0, 0, 86, 0, -1, 0xFFFFFFA0, 0)
    return along * 2 + struct.pack("<2fI", units_per_m, core, len(atoms)) + b"".join(struct.pack("<2i4f", *atom) for atom in atoms)


def scene_block(patches):
    """With a check of zero; a patch is (x, y, cosine, sine, half sizes, adds, [(kind, numbers, table)]), the table if there is one."""
    layers = [layer for patch in patches for layer in patch[-1]]
    numbers = [number for layer in layers for number in layer[1]]
    tables = b"".join(layer[2] for layer in layers if len(layer) > 2)
    block, first_layer, first_number, table = b"", 0, 0, 0
    for *place, adds, of_patch in patches:
        block += struct.pack("<6fHHI", *place, first_layer, len(of_patch), adds)
        first_layer += len(of_patch)
    for kind, of_layer, *of_table in layers:
        block += struct.pack("<HHI", kind, first_number, table)
        first_number += len(of_layer)
        table += len(b"".join(of_table)) // 4
    block += struct.pack(f"<{len(numbers)}f", *numbers) + tables
    return struct.pack("<4sHHHHII", b"TSCN", 1, len(patches), len(layers), len(numbers), 0, len(tables) // 4) + block


def checked(block):
    return block[:12] + struct.pack("<I", crc32c(block[:12] + block[16:])) + block[16:]


def scene(motion, patches):
    """scene_fuzz's input."""
    return struct.pack("<4i", *motion) + scene_block(patches)


SPRING_BLOCK = checked(scene_block([(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(0, (900, 0.01, 0)), (1, (3,))])]))
FORCE_LIMITS = action_frame(0x19, struct.pack("<6f5fHHI", 20, 20, 0, 5, 5, 0, 20, 5, 20000, 0.002, 0.002, 50, 0, 2000))
COUNTS = bytes([6, 100, 30, 0])


CONVERSATIONS = {
    "stream": HELLO + action_frame(2, struct.pack("<IB", 10_000_000, 32)) + TICKS + action_frame(3),
    "profile": HELLO + LIMITS + profile() + action_frame(8, struct.pack("<Bfffff", 1, 1, 0.5, 0, -0.3, 0.1)) + arm(0) +
               PLAY + TICKS + bytes([4, 5]) + TICKS + STOP + TICKS + DISARM + TICKS,
    "change": HELLO + LIMITS + profile() + arm(0) + PLAY + TICKS + profile(-4) +
              action_frame(0x14, struct.pack("<B3sfff", 1, b"", 0, 9, 1)) + change(0.01) + TICKS + profile(2) + change(0) +
              TICKS + DISARM + TICKS,
    "host_drive": HELLO + LIMITS + arm(1) + PLAY + action_frame(0x0F, struct.pack("<H50f", 50, *[2.0] * 50)) + TICKS +
                  bytes([3]) + TICKS + DISARM + TICKS,
    "scene": HELLO + FORCE_LIMITS + action_frame(0x1A, struct.pack("<IIH", len(SPRING_BLOCK), 0, len(SPRING_BLOCK)) + SPRING_BLOCK) + arm(3) + PLAY +
             TICKS + COUNTS + TICKS + action_frame(0x1B, struct.pack("<HHff", 0, 0, 100, 0.01)) + TICKS +
             action_frame(0x1C, struct.pack("<HHiif", 0, 0, -40, 70, 0.01)) + action_frame(0x1D, struct.pack("<H", 0)) + TICKS + bytes([3]) + TICKS + DISARM + TICKS,
    "sweep": HELLO + LIMITS + action_frame(0x0A, struct.pack("<fIII", 1, 10_000, 500_000, 4_000_000)) + arm(2) + PLAY +
             TICKS * 3 + action_frame(0x10, struct.pack("<I", 1)) + DISARM,
}


def says(kind, payload):
    """A frame of client_fuzz's device: type 0x81 + kind, with a valid check."""
    return bytes([72 + kind, len(payload)]) + payload


def samples(first):
    return says(4, struct.pack("<QQIBBH16i", first, first * 100, 0xFF, 2, 8, 0, *range(16)))


DEVICES = {
    "stream": bytes([2, 1, 100]) + says(3, struct.pack("<BBHII", 2, 0, 0, 1, 0)) + samples(0) + samples(8) +
              samples(24) + says(7, struct.pack("<B3sIQ", 7, b"", 8, 900)) + samples(32),
    "silence": bytes([1, 0, 1, 0, 0]),
}


SPRING, DAMPER, GROOVES, NOISE, HEIGHT_MAP, BODY, LASSO, MOVER, FIELD, FORCE_MAP, TICK_DAMPER = range(11)
PLANE, SPHERE, CYLINDER, QUADRIC, MESH, RELIEF, VOLUME = 16, 17, 18, 19, 20, 22, 24
AT_REST = (0,) * 9


def piece(kind, origin, form, wall=(2000, 4, 0.15, 5000, 2, 0.5, 0.6, 0.4, 2, 1), transient=(0, 33, -0.045, 0.284, -0.284, -0.22), texture=b"", travel=(), slide=b""):
    """A layer of a scene in space: the numbers of its wall with a state of zeros, and its table, with what is behind it of its texture."""
    points = struct.pack(f"<I{2 * len(travel)}f", len(travel), *(number for point in travel for number in point)) if travel else b""
    at = 25 + len(points) // 4
    table = struct.pack("<3i3f10f6fIII", *origin, 1e-6, 0, -2e-6, *form, *(0,) * (10 - len(form)), *transient, 25 if travel else 0,
                        at + len(slide) // 4 if texture else 0, at if slide else 0)
    return kind, (*wall, *(0,) * 17), table + points + slide + texture


def recording(passes_per_m, columns):
    return struct.pack("<I3f6f2f", 1, passes_per_m, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0) + relief_table(1000, ((0, 0, 1e3, columns, 1), (0, 0, 500, columns // 2, 1)))


def bump(origin_m, columns, rows):
    return struct.pack("<I3f6f2f", 2, 0, 0, 0, 0.6, 0.8, 0, 0, -0.6, 0.8, origin_m, -1) + relief_table(1e8, ((0, 0, 1e8, columns, rows), (0, 0, 500, 1, 1)))


SINE = struct.pack("<I3f6f2f", 3, 1e6, 300, 1000, 0, 0, 1, 0, 1, 0, 20, -20)


SLIDE = struct.pack("<10f", 0, 0.6, 0.8, -0.01, 0.02, 0.01, 0.9, 0.1, 0.5, 200)
HARD_SLIDE = struct.pack("<10f", 1, 0, 0, -20, 20, 1e9, 1, 0, 1000, 1e6)


def mesh(size_m):
    """A tetrahedron: a root and two leaves."""
    def node(skip, leaf):
        return struct.pack("<6fII", *[-0.01 * size_m] * 3, *[1.01 * size_m] * 3, skip, leaf)

    kind, numbers, table = piece(MESH, (3, -4, 5), (0, 0, 1, size_m))
    tree = node(3, 0) + node(2, 0 * 8 + 2) + node(3, 2 * 8 + 2)
    triangles = struct.pack("<12I", 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3)
    return kind, numbers, table + struct.pack("<fIII", size_m * 2**-18, 3, 4, 4) + tree + triangles + struct.pack("<12f", *[0] * 3, size_m, 0, 0, 0, size_m, 0, 0, 0, size_m)


def raised(origin, bend_per_m, samples_per_m, columns, rows, clay=(0, 0, 0, 0, 0)):
    """A plane with the relief of a map."""
    kind, numbers, table = piece(RELIEF, origin, (0, 0.6, 0.8))
    return kind, numbers, table + struct.pack("<9f", 1, 0, 0, 0, 0.8, -0.6, 1e-3, -1, bend_per_m) + struct.pack("<4fI", *clay) + relief_table(1000, ((0, 0, samples_per_m, columns, rows),))


def volume(samples, spacing_m, m_per_value, carve=(0, 0, 0), points=()):
    """Values that fall along the sum of the three places, around 0; places per count of an encoder of 10 um."""
    kind, numbers, table = piece(VOLUME, (3, -4, 5), (0, 0, 1, 0.1))
    axes = b"".join(struct.pack("<iIiIfI", (n - 1) // 2, (n - 1) % 2 << 31, int(1e-5 / spacing_m), int(1e-5 / spacing_m % 1 * 2**32), 1 / spacing_m, n) for n in samples)
    values = [1000 - 300 * (x + y + z) for z in range(samples[2]) for y in range(samples[1]) for x in range(samples[0])]
    values += [0] * (len(values) % 2)
    values += [1000, 0] if points else []  # the largest of its one block of cells
    offsets = b"".join(struct.pack("<3i3I", *whole, *part) for whole, part in points)
    return kind, numbers, table + axes + struct.pack("<fffIiII", 12.5, m_per_value, *carve, 0, len(points)) + offsets + struct.pack(f"<{len(values)}h", *values)


SCENES = {
    "spring": scene((3, -2, 5, 0), [(0, 0, 1, 0, 0.1, 0.1, 0, [(SPRING, (100, 0, 0))])]),
    "ice_on_soup": scene((90, 1, -70, 40), [(0, 0, 0.6, 0.8, 0.01, 0.01, 0, [(DAMPER, (0.1,))]),
                                           (0, 0, 1, 0, 1, 1, 0, [(DAMPER, (50,))]),
                                           (0.01, 0, 1, 0, 1, 1, 1, [(SPRING, (1e6, 0.01, -0.02)), (DAMPER, (1e4,)), (TICK_DAMPER, (1e4,))])]),
    "grooves": scene((3, -2, 50, 7), [(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(GROOVES, (1e-4, 2), grooves_table((2**25, -2**24), (800, 600), (0.6, 0, -0.2))),
                                                                      (GROOVES, (1, 1000), grooves_table((2**40, 7), (1e6, 0), (2,) * 64)), (DAMPER, (1,))])]),
    "noise": scene((3, -2, 50, 7), [(0, 0, 1, 0, 1000, 1000, 0, [(NOISE, (1e-4, 2), noise_table(2**26, 900, (0.5, 0.25, 0.125))),
                                                                 (NOISE, (1, 1000), noise_table(2**50, 1e6, (2,) * 16))])]),
    "height_map": scene((3, -2, 50, 7), [(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(HEIGHT_MAP, (2,), relief_table(1000, ((2**25, -2**24, 1e3, 6, 4), (2**24, -2**23, 500, 3, 2))))]),
                                         (0, 0, 1, 0, 1000, 1000, 1, [(HEIGHT_MAP, (1000,), relief_table(0, ((2**40, 7, 1e8, 2, 1),)))])]),
    "bodies": scene((3, -2, 50, 7), [(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(BODY, (300, 2, 1, 0.5, *AT_REST), struct.pack("<4f", 0, 1e-3, 5e-3, 2.5e-6)),
                                                                    (LASSO, (200, 0.01, *AT_REST), struct.pack("<4f", -0.01, 1e-3, 1e-2, 5e-6)),
                                                                    (MOVER, (3, 0.1), struct.pack("<2f", 0.6, -0.8))])]),
    "stiff_bodies": scene((90, 2**30, -70, 40), [(0, 0, 1, 0, 1000, 1000, 0, [(BODY, (1e6, 1e4, 0, 0, *AT_REST), struct.pack("<4f", 0, 10, 1e9, 1e9)),
                                                                            (LASSO, (1e6, 0, *AT_REST), struct.pack("<4f", -1, 0, 1e-12, 0))])]),
    "field": scene((3, -2, 50, 7), [(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(FIELD, (1e10, 0.001), field_table(8.6e9, 1, ((5, -9, 0, 6e14, 1e-18, 0), (10**7, 10**6, 1e6, 6e14, 1e-18, -1e-19))))]),
                                    (0, 0, 1, 0, 1000, 1000, 1, [(FIELD, (1e15, -10), field_table(1e17, 0.25, ((2**31 - 1, -2**31, 1e10, 7e19, 1, 1), (0, 0, 0, 1, 1, -1))))])]),
    "force_map": scene((3, -2, 50, 7), [(0, 0, 0.6, 0.8, 0.1, 0.1, 0, [(FORCE_MAP, (2,), force_table(1000, ((2**25, -2**24, 1e3, 6, 4), (2**24, -2**23, 500, 3, 2))))]),
                                        (0, 0, 1, 0, 1000, 1000, 1, [(FORCE_MAP, (-1000,), force_table(0, ((2**40, 7, 1e8, 2, 1),)))])]),
    "pieces": scene((3, -2, 50, 7), [(0, 0, 1, 0, 1000, 1000, 0, [piece(PLANE, (0, 0, 90), (0, 0.6, 0.8, 0.001), texture=recording(25, 20), travel=[(1e-4, 2), (1e-4, 1), (3e-4, 2)]), piece(SPHERE, (40, 9, 0), (0, 0, 1, 0.002), texture=bump(1e-3, 6, 4), slide=SLIDE),
                                                                  piece(CYLINDER, (-90, 1, 7), (0.6, 0, 0.8, 0.001), texture=SINE), piece(QUADRIC, (5, 1, 300), (1e6, 1e5, 1e6, 0, 10, 0, 0, 1, 0, -1))])]),
    "hard_pieces": scene((2**31 - 1, -70, 2**20, 40), [(0, 0, 1, 0, 1000, 1000, 1, [piece(QUADRIC, (0, 0, 0), (1e9, -1e9, 1e9, 1e9, -1e9, 0, 1e9, 0, 0, -1e9), (1e6, 1e4, 100, 1e7, 1000, 1000, 10, 10, 1e4, -1000), (-1e6, 1e6, -1.9, 0.1, -0.1, -1.9)),
                                                                                   piece(PLANE, (2**31 - 1, 0, -2**31), (1, 0, 0, 20), (1e6, 1e4, 100, 1e7, 1000, 1000, 1e-6, 10, 1e4, 1000), (0, 0, -1, 0, 0, -1), recording(1e6, 2), [(0, 1000), (0, 0), (20, 1000)], HARD_SLIDE)])]),
    "mesh": scene((3, -2, 50, 7), [(0, 0, 1, 0, 1000, 1000, 0, [mesh(0.002), piece(PLANE, (0, 0, -90), (0, 0.6, 0.8, 0.001))])]),
    "reliefs": scene((3, -2, 50, 7), [(0, 0, 1, 0, 1000, 1000, 0, [raised((0, 0, 90), 1e7, 500, 6, 5, (1e-3, 1e-6, -0.01, 0.01, 1)), raised((2**31 - 1, 0, -2**31), 0, 1e8, 1, 2), piece(PLANE, (0, 0, -90), (0, 0, 1, 0.001))])]),
    "volume": scene((3, -2, 50, 7), [(0, 0, 1, 0, 1000, 1000, 0, [volume((4, 5, 6), 5e-4, 1e-6, (0.01, 70000, -3500), [((0, 0, 0), (0, 0, 0)), ((-1, 0, 1), (7, 2**31, 9))]), piece(PLANE, (0, 0, -90), (0, 0.6, 0.8, 0.001)),
                                                                  volume((3, 3, 3), 1e-7, 0.1, (1000, 0xFFFF0000, 32767))])]),
    "jumps": scene((2**31 - 1, -2**31, 2**30, 7), [(0, 0, 1, 0, 1000, 1000, 1, [(SPRING, (1e6, 10, -10)), (DAMPER, (1e4,)), (TICK_DAMPER, (1e4,))])]),
}


def main():
    joined = re.sub(r"(?<=[0-9a-f])\n {4}(?=[0-9a-f]+$)", "", WIRE.read_text(), flags=re.M)
    frames = dict(re.findall(r"^([a-z_]+) (a554[0-9a-f]+)$", joined, re.M))
    for name, text in frames.items():
        (HERE / "corpus/wire" / name).write_bytes(b"\x3f" + bytes.fromhex(text))
    for name, actions in CONVERSATIONS.items():
        (HERE / "corpus/firmware" / name).write_bytes(actions)
    for name, scene in SCENES.items():
        (HERE / "corpus/scene" / name).write_bytes(scene)
    for name, sayings in DEVICES.items():
        (HERE / "corpus/client" / name).write_bytes(sayings)


if __name__ == "__main__":
    main()
