# SPDX-License-Identifier: GPL-3.0-or-later
"""How long this machine stopped while a test ran: a test of a device in real time judges only where it did not."""
import threading
import time

PERIOD_S = 0.01


class MachineStops:
    """Measures in a thread, from `with` to its end, by how much pauses of 10 ms were longer.

        with MachineStops() as stops:
            ...
        if stops.allow(0.3, "what is judged"):
            assert ...
    """
    def __enter__(self):
        self.longest_s, self._ended = 0.0, threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended.set()
        self._thread.join()

    def _watch(self):
        begun = time.monotonic()
        while not self._ended.wait(PERIOD_S):
            now = time.monotonic()
            self.longest_s, begun = max(self.longest_s, now - begun - PERIOD_S), now

    def allow(self, most_s, what):
        """Whether the machine stopped for less than `most_s`; otherwise it prints what is not judged."""
        if self.longest_s < most_s:
            return True
        print(f"not judged: {what}, because this machine stopped for {self.longest_s:.2f} s")
        return False
