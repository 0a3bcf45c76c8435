#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the seeds of the readers' corpora. Usage: make_reader_corpus.py TACTOGRAPH"""
import io
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def chunk(name, content):
    return name + struct.pack("<I", len(content)) + content


def wav(tag, bits, samples):
    width = bits // 8
    form = chunk(b"fmt ", struct.pack("<HHIIHH", tag, 2, 10000, 20000 * width, 2 * width, bits))
    body = b"WAVE" + form + chunk(b"data", samples)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def write(corpus, name, content):
    folder = HERE / "corpus" / corpus
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)


def write_wavs():
    write("wav", "float32", wav(3, 32, struct.pack("<8f", *range(8))))
    write("wav", "pcm32", wav(1, 32, struct.pack("<8i", *range(8))))
    sizes = chunk(b"ds64", struct.pack("<QQQI", 80, 16, 2, 0))
    form = chunk(b"fmt ", struct.pack("<HHIIHH", 1, 2, 10000, 80000, 8, 32))
    data = b"data" + b"\xff" * 4 + bytes(16)
    write("wav", "rf64", b"RF64" + b"\xff" * 4 + b"WAVE" + sizes + form + data)


def write_mats():
    import numpy as np
    import scipy.io
    made = {"s": {"f": np.arange(6.0), "t": "text", "c": np.array([1, "a"], dtype=object)}, "z": np.arange(3) * 1j, "i": np.arange(4, dtype=np.int16)}
    for name, compressed in (("plain", False), ("compressed", True)):
        file = io.BytesIO()
        scipy.io.savemat(file, made, do_compression=compressed)
        write("mat", name, b"MATLAB 5.0 MAT-file".ljust(116) + file.getvalue()[116:])  # without the date


def write_nrrds():
    import gzip
    head = "NRRD0005\n# volume\ntype: {}\ndimension: 3\nsizes: 2 3 4\nencoding: {}\nendian: {}\n{}\n\n"
    directions = 'space units: "mm" "mm" "mm"\nspace directions: (1,0,0) (0,1,0) (0,0,-2)'
    for name, number, encoding, endian, fields in (("raw", "24h", "raw", "little", "spacings: 1 1 2"), ("big", "24H", "raw", "big", "spacings: 1 1 2"),
                                                   ("gzip", "24f", "gzip", "little", "spacings: 1 1 2"), ("directions", "24h", "gz", "little", directions)):
        data = struct.pack("<>"[endian == "big"] + number, *range(24))
        kind = {"h": "short", "H": "uint16", "f": "float"}[number[-1]]
        write("nrrd", name, head.format(kind, encoding, endian, fields).encode() + (data if encoding == "raw" else gzip.compress(data, mtime=0)))


def write_xdfs():
    import numpy as np
    import xdf_maker as xdf
    begin = xdf.file_header() + xdf.header(1, "F", 2, 1000, "int16", [("Fx", "N"), ("Fz", "N")]) + xdf.header(2, "M", 1, 0, "string")
    end = xdf.clock_offset(1, 5, 1) + xdf.boundary() + xdf.footer(1, 6)
    begin += xdf.texts(2, [[b"go"], [b""]], [0.001, 0.0042])
    write("xdf", "int16", begin + xdf.samples(1, np.arange(12, dtype="<i2").reshape(6, 2), np.arange(6) / 1000, every=3) + end)
    begin = xdf.file_header() + xdf.header(1, "F", 1, 1000, "int64")
    write("xdf", "int64", begin + xdf.samples(1, 2**53 - 3 + np.arange(6, dtype="<i8").reshape(6, 1), np.arange(6) / 1000, every=1) + end)


def write_x3ps():
    import re
    import numpy as np
    import x3p_maker

    def parts(xml, points, mask=None):
        mask = mask or b""
        return b"\1" + re.sub(rb"<(MD5\w+|Record4)>.*?</\1>", b"", xml) + b"\0" + bytes([len(mask)]) + mask + points

    for letter, kind in (("I", "<i2"), ("L", "<i4"), ("F", "<f4"), ("D", "<f8")):
        points = np.arange(12).astype(kind).tobytes()
        mask = b"\xff\x0e" if letter in "IL" else None
        xml = x3p_maker.main_xml(letter, points, mask, sizes=(4, 3, 1))
        write("x3p", f"archive_{letter}", b"\0" + x3p_maker.x3p(xml, points, mask, folder="a/" if letter == "D" else ""))
        write("x3p", f"parts_{letter}", parts(xml, points, mask))
    points = np.arange(5.0).tobytes()
    write("x3p", "parts_profile", parts(x3p_maker.main_xml("D", points, feature="PRF", sizes=(5, 1, 1)), points))


def write_tables():
    rows = [(i / 1000, 0.1 * (i % 5), 40 * i) for i in range(40)]
    lines = "".join(f"{t},{force},{count}\n" for t, force, count in rows)
    write("table", "csv", b"\0time,force,count\n" + lines.encode())
    write("table", "times", b"\2" + lines.encode())
    write("table", "decimal_comma", b"\0" + lines.replace(",", ";").replace(".", ",").encode())
    values = "".join(f"<DATA_POINT_VALUE>{i % 7}</DATA_POINT_VALUE>" for i in range(20))
    head = "<DATA><DATAFILE><UNITS>um</UNITS><NUMPOINTS>20</NUMPOINTS><SPACING>0.5</SPACING>"
    write("table", "xml", b"\1" + f"{head}{values}</DATAFILE></DATA>".encode())


def write_sidecars(tactograph):
    with tempfile.TemporaryDirectory() as folder:
        for words in ("record -d sim:surface=C,speed=50mm/s,seed=1 --time 1s -o oak", "spatial oak -o oak --stroke 1",
            "formants oak -o oak --prominence 40dB", "describe oak -o oak.description.json"):
            subprocess.run([tactograph, *words.split()], cwd=folder, check=True, capture_output=True)
        for path in sorted(pathlib.Path(folder).glob("*.json")):
            write("sidecar", path.name.removesuffix(".json"), path.read_bytes())
        header = json.loads((pathlib.Path(folder) / "oak.json").read_text())
    gap = {"event": "gap", "frame": 10, "device_sequence": 12, "count": 2}
    lines = [json.dumps(each) for each in ({"event": "begin", "recording": header}, gap)]
    write("sidecar", "events", "\n".join(lines).encode() + b"\n")


if __name__ == "__main__":
    write_wavs()
    write_mats()
    write_xdfs()
    write_nrrds()
    write_x3ps()
    write_tables()
    write_sidecars(str(pathlib.Path(sys.argv[1]).resolve()))
