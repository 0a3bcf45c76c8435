#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package as a wheel that is made without network, and its client against tactographd.

The wheel is installed into a folder, and the example of the package's README is executed with it.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/end-to-end")]

import run_daemon
import tacto


def pip(*arguments):
    done = subprocess.run(["/usr/bin/python3", "-m", "pip", "--disable-pip-version-check", *map(str, arguments)],
                          capture_output=True, text=True, env={**os.environ, "PIP_NO_INDEX": "1"})
    assert done.returncode == 0, done.stdout + done.stderr


def install_wheel(folder):
    """The wheel's file name; made from a copy, because setuptools writes beside the sources."""
    shutil.copytree(ROOT / "data-schema/python", "source", ignore=shutil.ignore_patterns("__pycache__"))
    pip("wheel", "--no-build-isolation", "--no-deps", "-w", "wheels", "./source")
    wheel, = pathlib.Path("wheels").glob("*.whl")
    pip("install", "--no-deps", "--target", folder, wheel)
    return wheel.name


def example(chapter):
    text = (ROOT / "data-schema/python/README.md").read_text().split(f"## {chapter}\n")[1].split("\n## ")[0]
    return "\n".join(line[4:] for line in text.split("\n") if line.startswith("    "))


def the_wheel_plays():
    wheel = install_wheel("installed")
    version = re.fullmatch(r"tactograph-(.+)-py3-none-any\.whl", wheel)[1]
    assert f"tactograph {version}" in tacto.run("--version")[0]
    run_daemon.prepare_files()
    with run_daemon.daemon():
        done = subprocess.run(["/usr/bin/python3", "-c", example("Play") + "\nprint(len(played.time), tactograph.__file__)"],
                              capture_output=True, text=True, env={**os.environ, "PYTHONPATH": "installed"})
    assert done.returncode == 0, done.stderr
    rms, ticks, place = done.stdout.split()
    assert float(rms) > 0.001 and int(ticks) > 1000 and "installed" in place, done.stdout


def the_readme_starts_a_daemon():
    """Its first line writes the configuration with which the second starts the daemon; that of the daemon's help starts it, too."""
    run_daemon.prepare_files()
    pathlib.Path("tactographd.json").unlink()
    write, start = example("Start a daemon").split("\n")
    assert start == "tactographd --config tactographd.json &", start
    subprocess.run(["bash", "-c", write], check=True)
    with run_daemon.daemon():
        done = subprocess.run(["/usr/bin/python3", "-c", example("Play") + "\nprint(len(played.time))"],
                              capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(ROOT / "data-schema/python")})
    assert done.returncode == 0 and int(done.stdout.split()[-1]) > 1000, done
    shown = subprocess.run([run_daemon.DAEMON, "--help"], capture_output=True, text=True)
    config, = (line for line in (shown.stdout + shown.stderr).split("\n") if '"kind"' in line)
    pathlib.Path("tactographd.json").write_text(config)
    with run_daemon.daemon():
        pass


def problem(call):
    from tactograph import DaemonProblem
    try:
        call()
    except DaemonProblem as found:
        return found
    raise AssertionError("no DaemonProblem")


def refusals_have_the_kinds_of_the_daemon():
    sys.path.insert(0, str(ROOT / "data-schema/python"))
    import tactograph
    run_daemon.prepare_files()
    pathlib.Path("torn.texture.json").write_text("{")
    with run_daemon.daemon(), tactograph.Daemon("control") as daemon:
        assert daemon.about["version"] == "1.0" and daemon.status()["state"] == "idle", (daemon.about, daemon.status())
        assert problem(lambda: daemon.load("none")).kind == "not_found"
        assert problem(lambda: daemon.load("torn")).kind == "malformed"
        early = problem(daemon.play)
        assert early.kind == "usage" and early.remedy and early.what in str(early), early
        assert daemon.load("oak")["length_m"] > 0.03


def events_come_over_a_second_connection():
    import tactograph
    run_daemon.prepare_files()
    with run_daemon.daemon(), tactograph.Daemon("control") as daemon, tactograph.Daemon("control") as watcher:
        events = watcher.events(ticks=True)
        daemon.load("oak")
        daemon.arm()
        states, ticks = [], []
        while "idle" not in states:
            event = next(events)
            states += [event["state"]] if event["event"] == "state" else []
            if event["event"] != "ticks":
                continue
            ticks += event["tick"].tolist()
            assert len(event["tick"]) == len(event["time_ns"]) == len(event["ticks"]["drive"]) and not event["ticks"]["drive"].any()
            if len(ticks) > 100 and daemon.status()["state"] == "armed":
                daemon.disarm()
    assert states == ["armed", "idle"], states
    assert ticks == list(range(len(ticks))), ticks


def a_daemon_that_ends_is_a_connection_error():
    import tactograph
    run_daemon.prepare_files()
    with run_daemon.daemon():
        daemon = tactograph.Daemon("control")
    try:
        daemon.status()
    except OSError:  # ConnectionError is one
        return
    raise AssertionError("an answer without a daemon")


def over_tcp_with_a_token():
    import tactograph
    pathlib.Path("token").write_text("0123456789abcdef\n")
    pathlib.Path("token").chmod(0o600)
    run_daemon.prepare_files(tcp_port=0, tcp_token_file="token")
    with run_daemon.daemon() as process:
        port = int(process.ready.rsplit(":", 1)[1])
        with tactograph.Daemon(("127.0.0.1", port), token="0123456789abcdef") as daemon:
            assert daemon.status()["state"] == "idle"
        assert problem(lambda: tactograph.Daemon(("127.0.0.1", port), token="0123456789abcdee")).kind == "usage"


if __name__ == "__main__":
    for test in (the_wheel_plays, the_readme_starts_a_daemon, refusals_have_the_kinds_of_the_daemon, events_come_over_a_second_connection,
                 a_daemon_that_ends_is_a_connection_error, over_tcp_with_a_token):
        tacto.in_folder(test)
