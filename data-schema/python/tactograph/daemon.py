# SPDX-License-Identifier: GPL-3.0-or-later
"""A client of tactographd (the protocol: playback/daemon/CONTROL.md)."""
import base64
import json
import socket

from tactograph.session import ticks_in

_KINDS = ("internal", "usage", "not_found", "malformed", "unsuitable", "newer_version", "cannot_write", "device")


class DaemonProblem(RuntimeError):
    """A request that the daemon refused: what is wrong, where, what to do, and its `kind`, for example "not_found"."""

    def __init__(self, error):
        self.what, self.where, self.remedy = error["what"], error.get("where", ""), error.get("remedy", "")
        self.kind = _KINDS[error["fault"]]
        super().__init__(": ".join(filter(None, (self.where, self.what))) + (f"; {self.remedy}" if self.remedy else ""))


def _decoded(event):
    if event["event"] == "ticks":
        event["tick"], event["time_ns"], event["ticks"] = ticks_in(event["block"], base64.b64decode(event["ticks"]))
        if "cell_ticks" in event:
            del event["tick"]
    return event


class Daemon:
    """A connection. `place`: the path of the socket, or ("127.0.0.1", port) with the `token`. Each answer is a dict."""

    def __init__(self, place="/run/tactographd/control", **hello):
        self._socket = socket.socket(socket.AF_UNIX if isinstance(place, str) else socket.AF_INET)
        self._socket.connect(place)
        self._lines = self._socket.makefile("r", encoding="utf-8")
        self.about = self.ask("hello", version="1.0", **hello)

    def ask(self, request, **members):
        """Any request with its members; raises DaemonProblem."""
        self._socket.sendall((json.dumps({"request": request, **members}) + "\n").encode())
        line = self._lines.readline()
        if not line:
            raise ConnectionError("tactographd has closed the connection")
        answer = json.loads(line)
        if not answer["ok"]:
            raise DaemonProblem(answer["error"])
        return answer

    def load(self, file, **members):
        return self.ask("load", file=file, **members)

    def arm(self, **members):
        return self.ask("arm", **members)

    def play(self):
        return self.ask("play")

    def stop(self):
        return self.ask("stop")

    def disarm(self):
        return self.ask("disarm")

    def mark(self, text):
        """Puts a line into the session; the answer has its `tick`."""
        return self.ask("mark", text=text)

    def status(self):
        return self.ask("status")

    def events(self, ticks=False):
        """The events from now on, as dicts; the connection is then for events only.

        ticks: also the event "ticks", 50 times a second, with arrays: `tick` (since arming), `time_ns` (of the device) and the
        structured array `ticks` with `encoder_count`, `drive` (V), `flags`, `lateness_ns`; of a scene of forces
        `encoder_count` and `force` (N) of each axis. From 6 kHz on it has `cell_ticks` and no `tick`: the least and the greatest
        drive of each 0.5 ms.
        """
        self.ask("watch", **({"ticks": True} if ticks else {}))
        return map(_decoded, map(json.loads, self._lines))

    def close(self):
        self._lines.close()
        self._socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
