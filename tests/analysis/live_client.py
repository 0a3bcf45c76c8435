# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the tests of `tactograph live`: the server, and a client of plain sockets, which may misbehave."""
import base64
import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess

from tacto import COMMAND

HERE = pathlib.Path(__file__).resolve().parent


class Answer:
    def __init__(self, raw):
        head, self.body = raw.split(b"\r\n\r\n", 1)
        lines = head.decode().split("\r\n")
        self.status = int(lines[0].split()[1])
        self.headers = {k.lower(): v for k, v in (line.split(": ", 1) for line in lines[1:])}


class Live:
    """A running `tactograph live`."""

    def __init__(self, process, address):
        self.process, self.address = process, address
        self.port, self.token = int(re.search(r":(\d+)/", address)[1]), address.split("token=")[1]
        self.cookie = f"tactograph-{self.port}={self.token}"

    def ask(self, path, method="GET", cookie=True, **headers):
        """One request as given, without any correction; the headers' names have _ for -."""
        lines = {"Host": f"127.0.0.1:{self.port}", "Connection": "close"}
        if cookie:
            lines["Cookie"] = self.cookie
        lines.update({name.replace("_", "-"): value for name, value in headers.items()})
        text = "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None)
        with socket.create_connection(("127.0.0.1", self.port), timeout=120) as connection:
            connection.sendall(f"{method} {path} HTTP/1.1\r\n{text}\r\n".encode())
            parts = []
            while True:
                part = connection.recv(1 << 20)
                parts.append(part)
                raw = b"".join(parts)
                length = re.search(rb"(?i)\r\ncontent-length: (\d+)\r\n", raw)
                whole = b"\r\n\r\n" in raw and length and len(raw.split(b"\r\n\r\n", 1)[1]) >= int(length[1])
                if not part or whole:
                    return Answer(raw)

    def page(self, path="/session", **headers):
        """The WebSocket of a page; a header of None is left out."""
        own = {"Origin": f"http://127.0.0.1:{self.port}", "Cookie": self.cookie}
        return WebSocket(self.port, path, **{**own, **headers})

    def json(self, path):
        return json.loads(self.ask(path).body)


class WebSocket:
    """RFC 6455, the client's side. `status` is that of the answer to the upgrade."""

    def __init__(self, port, path, **headers):
        lines = {"Host": f"127.0.0.1:{port}", "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
                 "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(), **headers}
        text = "".join(f"{name}: {value}\r\n" for name, value in lines.items() if value is not None)
        self.connection = socket.create_connection(("127.0.0.1", port), timeout=120)
        self.connection.sendall(f"GET {path} HTTP/1.1\r\n{text}\r\n".encode())
        raw = b""
        while b"\r\n\r\n" not in raw and (part := self.connection.recv(4096)):
            raw += part
        self.status = int(raw.split()[1]) if raw else 0
        self.rest = raw.split(b"\r\n\r\n", 1)[1] if raw else b""

    def send(self, data):
        """Text as a text message, bytes as a binary one."""
        opcode, data = (1, data.encode()) if isinstance(data, str) else (2, bytes(data))
        size = len(data)
        length = bytes([0x80 | size]) if size < 126 else struct.pack(">BH", 0xFE, size) if size < 65536 else struct.pack(">BQ", 0xFF, size)
        self.connection.sendall(bytes([0x80 | opcode]) + length + bytes(4) + data)  # a mask of zeros

    def _bytes(self, count):
        while len(self.rest) < count:
            part = self.connection.recv(1 << 20)
            if not part:
                raise EOFError
            self.rest += part
        head, self.rest = self.rest[:count], self.rest[count:]
        return head

    def receive(self):
        """A text as JSON, or ("closed", code)."""
        data, last = b"", False
        while not last:
            opcode, length = self._bytes(2)
            last = opcode & 0x80 != 0
            if length >= 126:
                length = int.from_bytes(self._bytes(2 if length == 126 else 8), "big")
            data += self._bytes(length)
            if opcode & 15 == 8:
                return "closed", struct.unpack(">H", data[:2])[0] if data else 1005
        return json.loads(data)

    def ask(self, **request):
        self.send(json.dumps(request))
        return self.receive()


@contextlib.contextmanager
def live(*arguments):
    """Starts the server on a free port; ends it as Ctrl-C does."""
    process = subprocess.Popen([COMMAND, "live", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        said = []
        for line in process.stderr:
            said.append(line)
            if line.startswith("http://"):
                break
        assert said and said[-1].startswith("http://"), said
        yield Live(process, said[-1].strip())
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        assert process.returncode == 0, (process.returncode, out, err)
    finally:
        process.kill()
        process.wait()


def fetch_page(server, files, scripts):
    """Files of the page, and scripts of this folder that import them, for node: in the folder page."""
    pathlib.Path("page").mkdir(exist_ok=True)
    for name in files:
        pathlib.Path("page", name).write_bytes(server.ask("/" + name).body)
    pathlib.Path("page/package.json").write_text('{"type": "module"}')
    for script in scripts:
        shutil.copy(HERE / script, "page")


class TickFrame:
    """The last frame of ticks (of a `kind` of the wire) in the first half of a page's log."""

    def __init__(self, log, kind):
        self.log, self.begin = log, log.rfind(b"\xa5\x54\x01" + bytes([kind]), 0, len(log) // 2)
        length = struct.unpack_from("<H", log, self.begin + 4)[0]
        self.head, self.payload = log[self.begin:self.begin + 12], log[self.begin + 12:self.begin + 12 + length]
        self.end = self.begin + 12 + length + 4

    def with_one_bit_changed(self, at):
        """The log with the lowest bit of a byte of the payload changed; the frame's check is right again."""
        payload = bytearray(self.payload)
        payload[at] ^= 1
        return self.log[:self.begin] + self.head + payload + struct.pack("<I", crc32c(self.head + payload)) + self.log[self.end:]

    def left_out(self):
        return self.log[:self.begin] + self.log[self.end:]


def crc32c(data):
    check = 0xFFFFFFFF
    for byte in data:
        check ^= byte
        for _ in range(8):
            check = check >> 1 ^ (0x82F63B78 if check & 1 else 0)
    return check ^ 0xFFFFFFFF
