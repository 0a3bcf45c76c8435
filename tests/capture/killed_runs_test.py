#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remains of a killed run are removed: by the next run with its name, by `recover`, by `doctor`."""
import os
import pathlib
import signal
import subprocess

import numpy as np

import tacto

ROWS = 400_000
IMPORT = ["--rate", "10kHz", "--channel", "tangential_force=f*1N", "--channel", "position=x*1um"]


def hidden():
    return sorted(path.name for path in pathlib.Path(".").iterdir() if path.name.startswith("."))


def table():
    rows = np.column_stack([np.sin(np.arange(ROWS) / 50), np.arange(ROWS)])
    np.savetxt("long.csv", rows, fmt="%.9f", delimiter=",", header="f,x", comments="")


def written(name):
    return any(one.startswith(f".{name}.wav") for one in hidden())


def stopped(name):
    """An import that has begun to write its samples, and is stopped there. It shares one processor with this process, and has
    the smaller part of it: so it cannot write everything while this process waits for its turn."""
    processors = os.sched_getaffinity(0)
    for _ in range(20):
        os.sched_setaffinity(0, {min(processors)})
        process = subprocess.Popen([tacto.COMMAND, "import", "long.csv", "-o", name, *IMPORT],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=lambda: os.nice(5))
        while process.poll() is None and not written(name):
            pass
        os.sched_setaffinity(0, processors)
        process.send_signal(signal.SIGSTOP)
        if os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT).si_code == os.CLD_STOPPED:
            if written(name):
                return process
            process.send_signal(signal.SIGCONT)
        process.wait()
        for ending in (".wav", ".json"):  # the import ended before it was stopped: again
            pathlib.Path(name + ending).unlink(missing_ok=True)
    raise AssertionError("in 20 attempts the import ended before it could be stopped")


def killed(name):
    process = stopped(name)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert hidden(), "nothing was left to remove"
    assert not pathlib.Path(f"{name}.wav").exists()


def the_next_run_of_that_name_removes_it():
    table()
    killed("oak")
    killed("elm")
    tacto.run("import", "long.csv", "-o", "oak", *IMPORT)
    assert all(name.startswith(".elm.wav.") for name in hidden()) and hidden(), hidden()
    tacto.run("validate", "oak")


def recover_removes_it():
    table()
    killed("oak")
    report = tacto.run_json("recover", "oak")
    assert not hidden() and ".oak.wav." in report["removed_temporary_files"][0], (hidden(), report)
    tacto.run("recover", "oak", code=3)  # now there is nothing


def doctor_removes_and_says_it():
    table()
    killed("oak")
    report = tacto.run_json("doctor", "-d", "sim:finger=up")
    row = next(row for row in report["checks"] if row["check"] == "temporary files")
    assert row["state"] == "works" and row["found"].startswith("removed 1 file"), row
    assert not hidden(), hidden()


def what_runs_is_left_alone():
    table()
    process = stopped("oak")
    before = hidden()
    tacto.run("recover", "oak", code=3)
    tacto.run("doctor", "-d", "sim:finger=up")
    tacto.run("import", "long.csv", "-o", "oak", *IMPORT, "--force")
    assert hidden() == before, (before, hidden())
    process.send_signal(signal.SIGCONT)
    process.wait()
    assert not hidden(), hidden()


def of_another_machine_it_is_said_and_left():
    """Remains of another host, as on shared storage, are reported and kept. Uses a namespace of its own if
    permitted."""
    table()
    ours = subprocess.run(["unshare", "--uts", "sh", "-c", "hostname another-host"], capture_output=True)
    if ours.returncode != 0:
        print("no other host name could be set: tested in leftover_files_test alone")
        return
    killed("oak")
    before = hidden()
    done = subprocess.run(["unshare", "--uts", "sh", "-c", 'hostname another-host; "$@"', "-", tacto.COMMAND, "doctor",
                           "-d", "sim:finger=up"], capture_output=True, text=True)
    assert done.returncode == 0 and "may still be active" in done.stdout and "rm ./.oak.wav" in done.stdout, done
    assert hidden() == before


def without_proc_a_recording_is_closed():
    """/proc may be absent (chroot, container): here it is hidden, if permitted."""
    if tacto.SANITIZED:
        print("the sanitizers themselves need /proc: not tested")
        return
    covered = subprocess.run(["unshare", "--mount", "mount", "-t", "tmpfs", "none", "/proc"], capture_output=True)
    if covered.returncode != 0:
        print("/proc could not be covered: not tested")
        return
    script = 'mount -t tmpfs none /proc && exec "$@"'
    done = subprocess.run(["unshare", "--mount", "sh", "-c", script, "-", tacto.COMMAND, "record", "-d", "sim:seed=1",
                           "--time", "0.3s", "-o", "oak"], capture_output=True, text=True)
    assert done.returncode == 0, done
    tacto.run("validate", "oak")


if __name__ == "__main__":
    for test in (the_next_run_of_that_name_removes_it, recover_removes_it, doctor_removes_and_says_it,
                 what_runs_is_left_alone, of_another_machine_it_is_said_and_left, without_proc_a_recording_is_closed):
        tacto.in_folder(test)
