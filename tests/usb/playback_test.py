#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tactographd over the kernel's USB: the device's loop and the host's, each with a session that replays to the bit; a
daemon that is killed or stopped, and a device that is unplugged, in mid-play. Finger and transducer are simulated.
"""
import hashlib
import json
import os
import pathlib
import re
import sys

import numpy as np
import soundfile

import tacto
import virtual_machine

TIME_S = int(os.environ["TACTO_USB_SECONDS"])
HOST_S = 10
RATES_HZ = {"device": 2000, "host": 1000}
WATCHDOG_MS = 1000
LEAST_TICKS = 2000  # the emulated board skips time without its processor: of 120,000 in 60 s it had 24,000


def write_texture(folder):
    x = np.arange(40000) * 1e-6
    soundfile.write(folder / "oak.texture.wav", (0.02 * np.sin(2 * np.pi * 1000 * x)).astype(np.float32), 1000000, subtype="FLOAT")
    sha256 = hashlib.sha256((folder / "oak.texture.wav").read_bytes()).hexdigest()
    (folder / "oak.texture.json").write_text(json.dumps({
        "kind": "texture", "version": "1.0", "pitch_m": 1e-6, "quantity": "tangential_force", "unit": "N", "direction": 1,
        "source_origin_m": 0.0, "data": {"file": "oak.texture.wav", "sha256": sha256, "samples": len(x)}}))


# QEMU's emulated processor stalls for tens of milliseconds, on a busy machine for hundreds. So lateness is printed, not
# asserted, and the watchdog's time is long.
def write_configs(folder):
    config = {"kind": "daemon", "version": "1.0", "device": "usb:", "transducer": "wiertlewski2011", "socket": "/guest/control",
              "sessions": "/guest/sessions", "files": "/guest", "rate_hz": RATES_HZ["device"], "watchdog_ms": WATCHDOG_MS}
    for name in ("device", "killed", "after"):
        (folder / f"{name}.config.json").write_text(json.dumps(config))
    (folder / "second.config.json").write_text(json.dumps({**config, "socket": "/guest/second"}))
    host = {"loop": "host", "rate_hz": RATES_HZ["host"], "most_late_percent": 100, "most_speed_mps": 100,
            "real_time_priority": 0}  # device and bus use the same single processor
    (folder / "host.config.json").write_text(json.dumps({**config, **host}))


def status(name):
    return json.loads(pathlib.Path(f"{name}.json").read_text())


def ticks_of(name):
    tacto.run("session", f"{name}.session", "--force", "-o", f"{name}.csv")
    return np.genfromtxt(f"{name}.csv", delimiter=",", names=True)


def expect_played(name):
    """The drive followed the finger, no tick was lost, and the session replays."""
    said = status(name)
    assert said["state"] == "playing" and said["drive_peak_v"] > 0.01 and said["lost_ticks"] == 0, said
    replayed = tacto.run_json("replay", f"{name}.session")
    assert replayed["same_to_the_bit"] and replayed["ticks_compared"] > LEAST_TICKS, replayed
    assert tacto.run_json("validate", f"{name}.session")["valid"]
    ticks = ticks_of(name)
    position = ticks["encoder_count"]
    assert np.any(np.diff(position) > 0) and np.any(np.diff(position) < 0) and np.any(np.diff(position) == 0)
    print(f"{name} loop: {len(ticks)} ticks, drive {np.ptp(ticks['drive_v']):.2f} V peak to peak, replayed to the bit; "
          f"round trip {1e3 * said.get('round_trip_s', float('nan')):.2f} ms, late {said.get('late_ticks')}, missed {said.get('missed_ticks')}")


def expect_fall(name):
    """Measures the fall of the drive from the device's ticks: it may take 20 ms, and begins at the latest the
    watchdog's time after the last message of the host. Returns the level before the fall, and how long the host had
    been silent at the fault."""
    said = pathlib.Path(f"{name}.fall").read_text()
    print(f"{name}: {said.strip()}")
    assert "the device received nothing from this computer" in said, said
    silent_ms = float(re.search(r"came (\S+) ms before it", said).group(1))
    from_v, left_v, within_ms = map(float, re.search(r"from (\S+) V to (\S+) V within (\S+) ms", said).groups())
    assert left_v == 0 and within_ms <= 20, said
    assert silent_ms + within_ms <= WATCHDOG_MS + 20, said
    return from_v, silent_ms


def expect_quiet_once_woken(name):
    """After SIGCONT the device gets no drive until the daemon is asked to play again; the script has seen that rise."""
    woken = pathlib.Path(f"{name}.woken").read_text().strip()
    print(f"{name}: {woken} rises of the drive after SIGCONT, state {status(name)['state']}")
    assert woken == "0", woken
    assert status(name)["state"] in ("fault", "lost"), status(name)


def played_over_usb():
    results = pathlib.Path("results")
    results.mkdir()
    write_texture(results)
    write_configs(results)
    said = virtual_machine.run("playback.sh", results.resolve(), timeout_s=8 * TIME_S + 300, TACTOGRAPH=tacto.COMMAND,
                               TACTOGRAPHD=os.environ["TACTOGRAPHD"], GADGET=os.environ["GADGET"], SECONDS_WANTED=TIME_S,
                               HOST_SECONDS=HOST_S)
    print(said)
    os.chdir(results)
    found = json.loads(pathlib.Path("scan.out").read_text())["devices"]
    assert [d["serial"] for d in found if d["uri"].startswith("usb:")] == ["P1"], found
    expect_played("device")
    expect_played("host")
    for name in ("killed", "after"):
        assert status(name)["state"] == "playing", status(name)
    replayed = tacto.run_json("replay", "killed.session")
    assert replayed["same_to_the_bit"] and replayed["ticks_compared"] > LEAST_TICKS / 10, replayed
    expect_fall("killed")
    drive = ticks_of("killed")["drive_v"]  # the last second: at the kill itself the texture may be near zero
    assert np.max(np.abs(drive[-RATES_HZ["device"]:])) > 0.1, drive
    expect_fall("unplugged")
    assert expect_fall("stopped")[1] >= WATCHDOG_MS  # the finger may rest, so the level before the fall is not asserted
    expect_quiet_once_woken("stopped")
    for name in ("second", "beside"):
        said = pathlib.Path(f"{name}.said").read_text()
        assert "device" in said, said
    assert status("undisturbed")["state"] == "playing" and "fault" not in status("undisturbed"), status("undisturbed")
    assert status("unplugged")["state"] == "lost" and "unplugged" in json.dumps(status("unplugged")), status("unplugged")
    assert tacto.run_json("replay", "after.session")["same_to_the_bit"]
    assert status("replugged")["state"] == "playing", status("replugged")


if __name__ == "__main__":
    try:
        tacto.in_folder(played_over_usb)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
