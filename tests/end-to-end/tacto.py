# SPDX-License-Identifier: GPL-3.0-or-later
"""What the end-to-end tests share: running the command, finding real data, reading what the command wrote."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import soundfile

COMMAND = os.environ["TACTOGRAPH"]
DATA = pathlib.Path(os.environ.get("TACTO_DATA", "/nonexistent"))
# AddressSanitizer keeps what was freed (256 MB by default), so peaks of memory say nothing under it.
SANITIZED = "TACTO_SANITIZED" in os.environ
BARE_FINGER = DATA / "bare-finger" / "bare_finger_10kHz.csv"

IMPORT_BARE_FINGER = [
    "import", str(BARE_FINGER), "-o", "finger", "--rate", "10kHz",
    "--channel", "tangential_force=lateral_V*0.444444N",
    "--channel", "normal_force=normal_V*-0.31+1.6647N",
    "--channel", "position=encoder_count*0.5um",
]


def run(*arguments, code=0, cwd=None):
    """Runs `tactograph ARGUMENTS`, checks the exit code, gives (stdout, stderr)."""
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=600)
    shown = f"tactograph {' '.join(map(str, arguments))}\nexit {done.returncode}, wanted {code}\n{done.stdout}\n{done.stderr}"
    assert done.returncode == code, shown
    return done.stdout, done.stderr


def run_json(*arguments, cwd=None):
    return json.loads(run(*arguments, "--json", cwd=cwd)[0])


def play_on_host(*arguments, name):
    """`play ... --loop host -o NAME` on a paced emulated device; gives its JSON, or nothing where this machine is too slow.

    The host loop runs by the clock. A computer that stops for longer than the watchdog's time ends it in a fault, as it
    should; what a test asks of the session can then not be asked. Every session, whole or ended by a fault, must replay.
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
    """Most memory that the command ever held, in MB, as the kernel counted it for a child of its own."""
    measure = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL); " \
              "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)"
    return float(subprocess.run([sys.executable, "-c", measure, COMMAND, *map(str, arguments)], cwd=cwd, check=True,
                                capture_output=True, text=True).stdout)


def expect_little_memory(what, peak, idle, most=32):
    """`peak` MB at most `most` MB above `idle` MB; printed only where the build is sanitized."""
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
    """Runs a test in a folder of its own, which goes when the test has passed."""
    with tempfile.TemporaryDirectory(prefix="tacto-") as folder:
        os.chdir(folder)
        function()
        os.chdir("/")
    print(f"{function.__name__}: passed")


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))
