# SPDX-License-Identifier: GPL-3.0-or-later
"""Chunks of XDF files (sccn/xdf, "Specifications"), for tests and the fuzzer's corpus."""
import struct

BOUNDARY = bytes.fromhex("43A546DCCBF5410FB30ED5467383CBE4")


def varied(length):
    """A length in the fewest of 1, 4 and 8 bytes."""
    for width, form in ((1, "<B"), (4, "<I"), (8, "<Q")):
        if length < 256**width:
            return bytes([width]) + struct.pack(form, length)
    raise ValueError(length)


def chunk(tag, content):
    return varied(2 + len(content)) + struct.pack("<H", tag) + content


def file_header(version="1.0"):
    return b"XDF:" + chunk(1, f'<?xml version="1.0"?><info><version>{version}</version></info>'.encode())


def header(number, name, channels, rate, kind, labels=()):
    each = "".join(f"<channel><label>{label}</label><unit>{unit}</unit></channel>" for label, unit in labels)
    info = (f'<?xml version="1.0"?><info><name>{name}</name><type>Haptics</type><channel_count>{channels}</channel_count>'
            f"<nominal_srate>{rate}</nominal_srate><channel_format>{kind}</channel_format><desc><channels>{each}</channels></desc></info>")
    return chunk(2, struct.pack("<I", number) + info.encode())


def samples(number, values, times_s, every=1000):
    """Chunks of `every` samples, of which the first has a time; with 1 every sample has one, in chunks of 100."""
    chunks = b""
    size = 100 if every == 1 else every
    for begin in range(0, len(values), size):
        content = struct.pack("<I", number) + varied(len(values[begin:begin + size]))
        for i in range(begin, min(begin + size, len(values))):
            content += (b"\x08" + struct.pack("<d", times_s[i]) if i == begin or every == 1 else b"\x00") + values[i].tobytes()
        chunks += chunk(3, content)
    return chunks


def texts(number, rows, times_s):
    """Samples of a stream of text, each with a time; a row has a text (bytes) for each channel."""
    content = struct.pack("<I", number) + varied(len(rows))
    for row, time_s in zip(rows, times_s):
        content += b"\x08" + struct.pack("<d", time_s) + b"".join(varied(len(text)) + text for text in row)
    return chunk(3, content)


def clock_offset(number, time_s, ahead_s):
    return chunk(4, struct.pack("<Idd", number, time_s, ahead_s))


def boundary():
    return chunk(5, BOUNDARY)


def footer(number, count):
    return chunk(6, struct.pack("<I", number) + f"<info><sample_count>{count}</sample_count></info>".encode())
