# SPDX-License-Identifier: GPL-3.0-or-later
"""A person at the terminal of a command: what it shows on stderr is read, and keys are pressed."""
import os
import pty
import re
import select
import subprocess

import tacto


class Person:
    def __init__(self, *arguments):
        self.ours, self.its = pty.openpty()
        # Only the controlling terminal of its own session delivers keys.
        self.run = subprocess.Popen(["setsid", "--ctty", "--wait", tacto.COMMAND, *arguments], stdin=self.its,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.shown, self.seen = b"", 0  # everything; the end of the last match

    def press(self, keys):
        os.write(self.ours, keys)

    def reads(self, reply):
        """Reads what is shown next; False: the command has closed its screen. Presses reply(shown) when nothing new is
        shown for 0.05 s: a key from before its prompt is no answer, so it has to come again."""
        while not select.select([self.run.stderr], [], [], 0.05)[0]:
            self.press(reply(self.shown))
        more = os.read(self.run.stderr.fileno(), 4096)
        self.shown += more
        return bool(more)

    def until(self, pattern, reply=lambda shown: b""):
        """Replies until the pattern is shown after the last match, and returns its match."""
        while not (found := re.compile(pattern).search(self.shown, self.seen)):
            assert self.reads(reply), (pattern, self.shown)
        self.seen = found.end()
        return found

    def ends(self, reply=lambda shown: b""):
        """Replies until the command ends, and returns its exit code."""
        while self.reads(reply):
            pass
        code = self.run.wait(timeout=120)
        os.close(self.ours), os.close(self.its)
        return code
