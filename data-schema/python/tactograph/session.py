# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions: each tick of a playback (NAME.session; its bytes are described in data-schema/SESSION.md)."""
import hashlib
import json
import struct
import warnings

import numpy as np
import xarray

from tactograph.documents import check_kind, find, plain_attributes
from tactograph.errors import FileProblem

_MARK = 0x31534354  # "TCS1"
_BLOCK = struct.Struct("<IB3xI8s")
_LARGEST = 1 << 20
_TICK = np.dtype([("after_ns", "<u4"), ("encoder_count", "<i4"), ("drive", "<f4"), ("flags", "<u4"), ("lateness_ns", "<i4")])
_HEADER, _TICKS, _COMMAND, _LOSS, _EVENT, _END, _MEASURED, _AXIS_TICKS = 0, 1, 2, 3, 4, 5, 7, 8
_NEWEST_MINOR = 1
_NOT_MEASURED = -2**31
_GAIN, _ARM = 0x09, 0x0B
_STEERING = {0x09, 0x0C, 0x0D, 0x0E, 0x17}  # gain, play, stop, disarm, change: counted in a tick's flags
_FLAGS = {"playing": 2, "fault": 4, "limited": 8 | 16, "late": 32, "energy_limited": 64, "gated": 128, "blind": 256, "touching": 512}
_FORCE_FLAGS = {name: _FLAGS[name] for name in ("playing", "fault", "limited", "late")} | {"rms_limited": _FLAGS["energy_limited"]}
_CAUSES = ("link", "recorder", "disk")


def read_session(name):
    """A session as an xarray.Dataset along `time` (s since its first tick).

    name: the stem or NAME.session. Variables: `tick` (since arming; ticks that were lost leave a step), `encoder_count`
    (as the wire has it), `position` (m, the middle of the count, across overflows of the 32-bit counter), `drive` (V at
    the amplifier's input), `gain` (factor on the textures' own gains), `lateness` (s, NaN where it was not measured),
    `device_time` (s), `flags`, and one mask a flag: `playing`, `fault`, `limited`, `late`, `energy_limited`, `gated`,
    `blind`, `touching`. `after_gap` is True at the first tick after lost ones. Where the device reports its tray, `measured`
    (m) holds the sensor's own samples along `measured_time` (s since the first tick). The session of a force device instead has
    `position` (m), `force` (N, on the hand) and `encoder_count` along `time` and `axis`, `tick`, `device_time` (s), `flags`,
    `playing`, `fault`, `limited` (a peak or the slew), `late`, `rms_limited` and `after_gap`. Attributes: the header; `events`
    and `losses` as JSON texts; `closed`, 0 where the session ends without its last block. Raises FileProblem.
    """
    path = find(name, [".session"])
    blocks = _blocks(path.read_bytes())
    kind, payload = next(blocks, (None, b""))
    if kind != _HEADER:
        raise FileProblem("does not begin with a session's header", path)
    header = json.loads(payload)
    if check_kind(header, "session", path) > _NEWEST_MINOR:
        warnings.warn(f"{path}: version {header['version']} is newer than this package; unknown parts are ignored")
    return _Reader(header).read(blocks)


def _blocks(data):
    """(type, payload) of each complete block with a correct checksum, up to the first block without one."""
    at = 0
    while at + _BLOCK.size <= len(data):
        mark, kind, size, check = _BLOCK.unpack_from(data, at)
        payload = data[at + _BLOCK.size:at + _BLOCK.size + size]
        hashed = hashlib.sha256(struct.pack("<BI", kind, size) + payload).digest()[:8]
        if mark != _MARK or size > _LARGEST or len(payload) != size or hashed != check:
            return
        yield kind, payload
        at += _BLOCK.size + size


def ticks_in(block, payload):
    """(tick since arming, time of the device in ns, rows) of the payload of a block of ticks (1, or 8 of a force device)."""
    first, time_ns, count = struct.unpack_from("<QqI", payload)
    row = _axis_tick(struct.unpack_from("<I", payload, 20)[0]) if block == _AXIS_TICKS else _TICK
    rows = np.frombuffer(payload, row, count, offset=24 if block == _AXIS_TICKS else 20)
    return first + np.arange(count, dtype=np.int64), time_ns + rows["after_ns"].astype(np.int64), rows


class _Reader:
    def __init__(self, header):
        self.header = header
        self.ticks, self.gains, self.events, self.losses, self.measured = [], [], [], [], []
        self.armed = self.closed = False

    def read(self, blocks):
        take = {_TICKS: self._take_ticks, _COMMAND: self._take_command, _LOSS: self._take_loss, _EVENT: self._take_event,
                _END: self._take_end, _MEASURED: self._take_measured, _AXIS_TICKS: self._take_axis_ticks}
        for kind, payload in blocks:
            if kind in take:  # later versions may add types
                take[kind](payload)
        return self._dataset()

    def _take_ticks(self, payload):
        self.ticks.append(ticks_in(_TICKS, payload))

    def _take_axis_ticks(self, payload):
        self.ticks.append(ticks_in(_AXIS_TICKS, payload))

    def _take_command(self, payload):
        kind = payload[16 + 3]  # the frame's type; its payload begins at byte 12
        if kind == _ARM:
            self.armed = True
        elif self.armed and kind in _STEERING:
            gain = struct.unpack_from("<f", payload, 16 + 12)[0] if kind == _GAIN else None
            self.gains.append(gain)

    def _take_loss(self, payload):
        first, count, why = struct.unpack_from("<QQB", payload)
        self.losses.append({"first_tick": first, "count": count, "cause": _CAUSES[why] if why < 3 else str(why)})

    def _take_event(self, payload):
        tick, time_ns = struct.unpack_from("<Qq", payload)
        self.events.append({"tick": tick, "host_s": 1e-9 * time_ns, "text": payload[16:].decode(errors="replace")})

    def _take_measured(self, payload):
        _first, time_ns, count = struct.unpack_from("<QqI", payload)
        codes = np.frombuffer(payload, "<i4", count, offset=20)
        times_ns = time_ns + np.round(np.arange(count) * 1e9 / self.header["measured"]["rate_hz"])
        self.measured.append((times_ns, codes))

    def _take_end(self, _payload):
        self.closed = True

    def _dataset(self):
        tick = _joined([part[0] for part in self.ticks], np.int64)
        device_ns = _joined([part[1] for part in self.ticks], np.int64)
        forces = self.header.get("forces")
        rows = _joined([part[2] for part in self.ticks], _axis_tick(len(forces["axes"])) if forces else _TICK)
        first_ns = device_ns[0] if len(device_ns) else 0
        variables = _force_columns(tick, rows, forces["axes"]) if forces else self._columns(tick, rows)
        variables |= _masks(rows["flags"], _FORCE_FLAGS if forces else _FLAGS)
        variables["device_time"] = ("time", 1e-9 * device_ns, {"units": "s", "long_name": "time by the device's clock"})
        variables["after_gap"] = ("time", np.diff(tick, prepend=tick[:1] - 1) > 1, {"long_name": "ticks are missing before this one"})
        variables |= self._measured_since(first_ns)
        time = ("time", 1e-9 * (device_ns - first_ns), {"units": "s", "long_name": "time since the first tick"})
        attributes = plain_attributes(self.header, set())
        attributes |= {"events": json.dumps(self.events), "losses": json.dumps(self.losses), "closed": int(self.closed)}
        axis = {"axis": [each["name"] for each in forces["axes"]]} if forces else {}
        return xarray.Dataset(variables, {"time": time} | axis, attributes)

    def _measured_since(self, first_ns):
        if "measured" not in self.header:
            return {}
        about = self.header["measured"]
        codes = _joined([part[1] for part in self.measured], np.int32)
        times = 1e-9 * (_joined([part[0] for part in self.measured], np.float64) - first_ns)
        return {
            "measured": ("measured_time", codes * about["scale"] + about["offset"],
                         {"units": "m", "long_name": "displacement of the tray, as its sensor measured it"}),
            "measured_time": ("measured_time", times, {"units": "s", "long_name": "time since the first tick"}),
        }

    def _columns(self, tick, rows):
        late = rows["lateness_ns"].astype(np.float64)
        late[late == _NOT_MEASURED] = np.nan
        return {
            "tick": ("time", tick, {"long_name": "tick since arming"}),
            "encoder_count": ("time", rows["encoder_count"].copy(), {"long_name": "encoder count"}),
            "position": ("time", self._positions(rows["encoder_count"]), {"units": "m", "long_name": "position"}),
            "drive": ("time", rows["drive"].copy(), {"units": "V", "long_name": "drive at the amplifier's input"}),
            "gain": ("time", self._gain_in(rows["flags"]), {"units": "1", "long_name": "factor on the textures' gains"}),
            "lateness": ("time", 1e-9 * late, {"units": "s", "long_name": "lateness of the tick"}),
            "flags": ("time", rows["flags"].copy(), {"long_name": "flags of the wire's ticks"}),
        }

    def _positions(self, counts):
        """The middle of each count; differences are modulo 2^32, so an overflow is not a jump."""
        steps = np.diff(counts, prepend=counts[:1]).astype(np.int32).astype(np.int64)  # int32 subtraction wraps
        whole = np.cumsum(steps) + (int(counts[0]) if len(counts) else 0)
        return (whole + 0.5) * self.header["metres_per_count"]

    def _gain_in(self, flags):
        """The factor of each tick: a gain is valid from the first tick that counts its command."""
        own = max((abs(texture["gain_m_per_n"]) for texture in self.header["textures"]), default=0.0) or 1.0
        steered = (flags >> 24).astype(np.int64)
        taken = np.cumsum(np.diff(steered, prepend=0) % 256)  # the counter runs over at 256
        factors, now = [self.header["initial"]["gain"]], self.header["initial"]["gain"]
        for gain in self.gains:
            now = now if gain is None else gain / own
            factors.append(now)
        return np.array(factors)[np.minimum(taken, len(factors) - 1)]


def _joined(parts, kind):
    return np.concatenate(parts) if parts else np.empty(0, kind)


def _masks(flags, bits_of):
    return {name: ("time", (flags & bits) != 0, {"long_name": name.replace("_", " ")}) for name, bits in bits_of.items()}


def _axis_tick(axes):
    return np.dtype([("after_ns", "<u4"), ("encoder_count", "<i4", (axes,)), ("force", "<f4", (axes,)), ("flags", "<u4")])


def _force_columns(tick, rows, axes):
    metres_per_count = np.array([axis["metres_per_count"] for axis in axes])
    return {
        "tick": ("time", tick, {"long_name": "tick since arming"}),
        "encoder_count": (("time", "axis"), rows["encoder_count"].copy(), {"long_name": "encoder count"}),
        "position": (("time", "axis"), rows["encoder_count"] * metres_per_count, {"units": "m", "long_name": "position"}),
        "force": (("time", "axis"), rows["force"].copy(), {"units": "N", "long_name": "force on the hand"}),
        "flags": ("time", rows["flags"].copy(), {"long_name": "flags of the wire's ticks"}),
    }
