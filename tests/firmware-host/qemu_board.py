# SPDX-License-Identifier: GPL-3.0-or-later
"""A board's firmware in QEMU behind a pseudo-terminal, as behind a USB serial adapter.

QEMU's own pseudo-terminal is no such line: the whole machine waits while no program reads from it, and for up to a second
QEMU does not see that a program opened it. Here the UART is a socket of QEMU, and two threads are the adapter: what no
program reads is lost, the board runs on. `said` keeps every byte that the board sent.
"""
import contextlib
import os
import pty
import random
import re
import select
import socket
import struct
import subprocess
import threading
import time
import tty

from wire_document_test import frame

HELLO, WELCOME, TICKS, FAULT = 0x01, 0x81, 0x86, 0x88


# What QEMU's log says of a register that it does not emulate: the DAC's, and the set and reset bits of port B (13: enable).
PIN = re.compile(r"(?:(DAC).*offset 0x0*8|GPIOB.*offset 0x0*18), value 0x0*([0-9a-f]+)\)")


class QemuBoard:
    """`port` is the path of the line's end at the host. corrupt(N) changes about one of N bytes from then on; 0: none."""
    def __init__(self, image, folder="."):
        self.said, self._since, self._noise, self._every = bytearray(), 0, random.Random(1), 0
        self._lock = threading.Lock()  # of the line's end here, which unplug() closes
        path = os.path.join(folder, "uart")
        with socket.socket(socket.AF_UNIX) as waiting:
            waiting.bind(path)
            waiting.listen(1)
            self._log, self._debugger = os.path.join(folder, "pins.log"), os.path.join(folder, "debugger")
            self._qemu = subprocess.Popen(["qemu-system-arm", "-M", "netduinoplus2", "-display", "none", "-monitor", "stdio",
                                           "-D", self._log, "-gdb", f"unix:{self._debugger},server=on,wait=off", "-serial",
                                           f"unix:{path}", "-kernel", image], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL)
            waiting.settimeout(60)
            self._uart, _ = waiting.accept()
        os.unlink(path)
        self._uart.settimeout(None)
        self._line, self._host = pty.openpty()
        tty.setraw(self._host)  # otherwise the terminal would return the board's bytes to the board
        os.set_blocking(self._line, False)
        self.port = os.ttyname(self._host)
        for way in (self._to_host, self._to_board):
            threading.Thread(target=way, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        ran = self._qemu.poll() is None
        self._qemu.kill()
        self._qemu.wait(timeout=60)
        self.unplug()
        assert ran, "QEMU ended"

    def corrupt(self, every):
        self._every = every

    def send(self, data):
        """Bytes to the board beside those of the host's program."""
        self._uart.sendall(data)

    def unplug(self):
        """Takes the line away from the host; the board keeps its supply."""
        with self._lock:
            if self._line is not None:
                os.close(self._line)
                os.close(self._host)
            self._line = None

    def restart(self):
        """As after a brown-out: the chip begins again, the line stays."""
        self._ask_qemu("system_reset")

    def _ask_qemu(self, command):
        self._qemu.stdin.write(f"{command}\n".encode())
        self._qemu.stdin.flush()

    def see_pins(self, on):
        """From now on pins() gets what is written to the outputs, which slows the board down."""
        self._ask_qemu("log unimp" if on else "log none")

    def pins(self):
        """In order: ("drive", code of 12 bits) and ("enable", whether it is high)."""
        for line in open(self._log):
            if found := PIN.search(line):
                value = int(found[2], 16)
                yield ("drive", value) if found[1] else ("enable", value == 1 << 13)

    def spoil(self, address):
        """Writes an undefined instruction there, by GDB's remote protocol, which stops the machine for it."""
        with socket.socket(socket.AF_UNIX) as debugger:
            debugger.connect(self._debugger)
            debugger.settimeout(60)
            for packet in (f"M{address:x},2:00de", "D"):
                debugger.sendall(f"${packet}#{sum(packet.encode()) % 256:02x}".encode())
                said = b""
                while b"$OK#9a" not in said:
                    said += debugger.recv(100)
                debugger.sendall(b"+")

    def greet(self):
        """Greets the board until it answers; a board that starts loses what it receives."""
        self.forget()
        self.wait_for(lambda: any(kind == WELCOME for kind, _ in self.messages()), again=lambda: self.send(
            frame(HELLO, 0, struct.pack("<BBHI", 1, 0, 0, 1))))

    def wait_for(self, condition, again=lambda: None):
        latest = time.monotonic() + 120
        while not condition():
            assert time.monotonic() < latest and self._qemu.poll() is None, f"nothing of it in 120 s; the board sent {len(self.said)} bytes"
            again()
            time.sleep(0.2)

    def forget(self):
        """From now on messages() begins after what the board has sent so far."""
        self._since += sum(16 + len(payload) for _, payload in self.messages())

    def forget_all(self):
        """As forget(), also the frame that a restart cut."""
        self._since = len(self.said)

    def messages(self):
        """(type, payload) of the whole frames that the board sent."""
        said, at = bytes(self.said[self._since:]), 0
        while at + 12 <= len(said):
            assert said[at:at + 2] == b"\xa5\x54", (at, said[at:at + 20])
            kind, length = said[at + 3], int.from_bytes(said[at + 4:at + 6], "little")
            if at + 16 + length > len(said):
                return
            yield kind, said[at + 12:at + 12 + length]
            at += 16 + length

    def ticks(self):
        """(encoder, drive in V, flags) of each tick that the board sent."""
        for kind, payload in self.messages():
            if kind == TICKS:
                yield from struct.iter_unpack("<ifI", payload[20:])

    def faults(self):
        return [payload[0] for kind, payload in self.messages() if kind == FAULT]

    def _noisy(self, data):
        if self._every == 0:
            return data
        return bytes(byte ^ self._noise.randrange(1, 256) if self._noise.randrange(self._every) == 0 else byte for byte in data)

    def _to_host(self):
        while data := self._received():
            self.said += data
            with self._lock, contextlib.suppress(BlockingIOError):  # no program reads: the bytes are lost
                if self._line is not None:
                    os.write(self._line, self._noisy(data))

    def _received(self):
        with contextlib.suppress(OSError):
            return self._uart.recv(4096)

    def _to_board(self):
        while (line := self._line) is not None:
            try:
                if not select.select([line], [], [], 0.02)[0]:
                    continue
            except (OSError, ValueError):  # unplugged
                return
            with self._lock, contextlib.suppress(BlockingIOError):
                data = os.read(line, 4096) if self._line is not None else b""
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # QEMU has ended
                self._uart.sendall(self._noisy(data))
