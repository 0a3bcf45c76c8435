# SPDX-License-Identifier: GPL-3.0-or-later
"""Records from a device, steered by this program: `tactograph record --commands`."""
import json
import subprocess
import tempfile


class RecorderProblem(RuntimeError):
    """The recording was refused or has ended: the message of `tactograph record`, and its `exit_code`."""

    def __init__(self, message, exit_code=None):
        self.exit_code = exit_code
        super().__init__(message)


class Recorder:
    """A recording in progress. `options` are those of `tactograph record`: Recorder("oak", "-d", "usb:", "--subject", "S01").
    It has begun when the constructor returns. If this program ends, the recording ends, and is complete."""

    def __init__(self, name, *options, command="tactograph"):
        self._messages = tempfile.TemporaryFile("w+", encoding="utf-8")
        self._process = subprocess.Popen([command, "record", "-o", name, *options, "--commands", "--json"], encoding="utf-8",
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._messages)
        self.report = None  # of `record`, as a dict, when it has ended
        self._answer()

    def mark(self, label):
        """Sets a mark in the recording; returns its frame and its time_s since the first frame."""
        self._write(f"mark {label}\n")
        return self._answer()

    def stop(self):
        """Ends the recording; returns the report of `record`."""
        if self.report is None:
            self._write("stop\n")
            self._end(self._process.stdout.read())
        return self.report

    def _write(self, line):
        try:
            self._process.stdin.write(line)
            self._process.stdin.flush()
        except (BrokenPipeError, ValueError):  # it has ended by itself; its answer says why
            pass

    def _answer(self):
        line = self._process.stdout.readline() if self.report is None else ""
        if not line.startswith('{"event"'):
            self._end(line + self._process.stdout.read())
            raise RecorderProblem("the recording has ended already")
        answer = json.loads(line)
        if answer.pop("event") == "error":
            raise RecorderProblem(f"{answer['what']}; {answer['remedy']}")
        return answer

    def _end(self, rest):
        code = self._process.wait()
        self._messages.seek(0)
        if code != 0 and not rest.strip():
            error = json.loads(self._messages.read().splitlines()[-1])
            raise RecorderProblem(f"{error['where']}: {error['what']}; {error['remedy']}", code)
        if self.report is None:  # behind the answers to marks by SIGUSR1
            self.report = json.loads("".join(line for line in rest.splitlines(True) if not line.startswith('{"event"')))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
