# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the end-to-end tests: runs the command, finds real data, reads the files that the command wrote."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import soundfile

COMMAND = os.environ["TACTOGRAPH"]
DATA = pathlib.Path(os.environ.get("TACTO_DATA", "/nonexistent"))
# AddressSanitizer keeps freed memory (256 MB by default), so peaks of memory have no meaning with it.
SANITIZED = "TACTO_SANITIZED" in os.environ
BARE_FINGER = DATA / "bare-finger" / "bare_finger_10kHz.csv"

IMPORT_BARE_FINGER = [
    "import", str(BARE_FINGER), "-o", "finger", "--rate", "10kHz",
    "--channel", "tangential_force=lateral_V*0.444444N",
    "--channel", "normal_force=normal_V*-0.31+1.6647N",
    "--channel", "position=encoder_count*0.5um",
]


def unwrapped(err):
    """What a verb wrote to stderr, each warning on one line: further lines of one are indented by 4."""
    return re.sub(r"^tactograph: warning: .*(?:\n {4}.*)*", lambda found: found[0].replace("\n    ", " "), err, flags=re.M)


def run(*arguments, code=0, cwd=None):
    """Runs `tactograph ARGUMENTS`, checks the exit code, returns (stdout, stderr), warnings unwrapped."""
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=600)
    shown = f"tactograph {' '.join(map(str, arguments))}\nexit {done.returncode}, wanted {code}\n{done.stdout}\n{done.stderr}"
    assert done.returncode == code, shown
    return done.stdout, unwrapped(done.stderr)


def run_json(*arguments, code=0, cwd=None):
    return json.loads(run(*arguments, "--json", code=code, cwd=cwd)[0])


def error_of(*arguments, code, cwd=None):
    """Runs `tactograph ARGUMENTS --json`, checks the exit code, returns the error: what, where, remedy, exit_code."""
    error = json.loads(run(*arguments, "--json", code=code, cwd=cwd)[1].strip().splitlines()[-1])
    assert error["exit_code"] == code, error
    return error


def play_on_host(*arguments, name):
    """`play ... --loop host -o NAME` on an emulated device in real time; returns its JSON, or nothing if this machine
    is too slow.

    The host loop runs in real time. If the computer stalls for longer than the watchdog's time, the loop ends in a
    fault, as it should; then the test's checks of the session are not possible. Every session, complete or ended by a
    fault, must replay.
    """
    command = [COMMAND, "play", *map(str, arguments), "--loop", "host", "-o", name, "--json"]
    for _ in range(5):
        pathlib.Path(f"{name}.session").unlink(missing_ok=True)
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
        assert done.returncode in (0, 8), (command, done)
        if pathlib.Path(f"{name}.session").exists() and done.stdout and json.loads(done.stdout)["ticks"] > 0:
            assert run_json("replay", name)["same_to_the_bit"], done
        if done.returncode == 0:
            return json.loads(done.stdout)
        assert "faul" in done.stderr or "stopped" in done.stderr, done
    print(f"not judged: in five attempts this machine stopped for longer than the watchdog's time: {command[1:]}")
    return None


def peak_mb(*arguments, cwd=None):
    """The largest memory of the command in MB, as the kernel counts it for a child process."""
    measure = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL); " \
              "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)"
    return float(subprocess.run([sys.executable, "-c", measure, COMMAND, *map(str, arguments)], cwd=cwd, check=True,
                                capture_output=True, text=True).stdout)


def expect_little_memory(what, peak, idle, most=32):
    """Checks that `peak` MB is at most `most` MB above `idle` MB; in a sanitized build it is only printed."""
    print(f"{what}: {peak - idle:.1f} MB above {idle:.1f} MB" + (" (sanitized, not judged)" if SANITIZED else ""))
    assert SANITIZED or peak < idle + most, (what, peak, idle)


def texture(stem):
    """(positions in m from the texture's start, values, sidecar)."""
    side = json.loads(pathlib.Path(f"{stem}.texture.json").read_text())
    values, _ = soundfile.read(f"{stem}.texture.wav", dtype="float64")
    return np.arange(len(values)) * side["pitch_m"], values, side


def need_real_data():
    if not BARE_FINGER.exists():
        print("skipped: no real data")
        sys.exit(77)


def in_folder(function):
    """Runs a test in a folder of its own, which is deleted after the test has passed."""
    with tempfile.TemporaryDirectory(prefix="tacto-") as folder:
        os.chdir(folder)
        function()
        os.chdir("/")
    print(f"{function.__name__}: passed")


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))
