#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The firmware of the board stm32f405 in QEMU, behind a serial line: the image that ./bootstrap firmware makes.

The emulated chip counts its own ticks: the codes of the two analogue channels contain the tick, so that each frame is
checked. Losses, bits and the board's own words are judged, never time. QEMU has neither the chip's clocks, ports,
converters nor its watchdog. Usage: tty_firmware_test.py stm32f405.elf
"""
import hashlib
import json
import pathlib
import signal
import subprocess
import sys

import numpy as np
import soundfile

import tacto
from boards_test import Elf
from qemu_board import QemuBoard
from wire_document_test import crc32c

IMAGE = pathlib.Path(sys.argv[1])
VECTORS = 4 * 98                     # bytes; then comes the check of the flash
SAMPLES = 12_000                     # of a texture, in the board's RAM
DRIVE_ZERO = 2048                    # the code for 0 V at the amplifier's input
UNSUITABLE, DEVICE = 5, 8            # exit codes
PLAYING, FAULTED, HOST_SILENT = 2, 4, 1  # flags of a tick, the code of a fault (core/WIRE.md)
RATE_HZ = 2000
RECORD_S, NOISY_S = 60, 5
PITCH_M = 10e-6
MASS_KG, STIFFNESS, DAMPING = 6.8e-3, 8.052e4, 4.49  # N/m, N s/m
TRAY = {"resonance_hz": np.sqrt(STIFFNESS / MASS_KG) / (2 * np.pi), "damping_ratio": DAMPING / (2 * np.sqrt(STIFFNESS * MASS_KG)),
        "gain_m_per_v": 20e-6, "pole_hz": 1 / (2 * np.pi * 680 * 1.636e-6)}


def checks(port, code=0):
    report = json.loads(tacto.run("doctor", "-d", f"tty:{port}", "--json", code=code)[0])
    return {row["check"]: row for row in report["checks"]}


def doctor_works_twice(board):
    """Each opens the port again. The firmware's build is the check of the image's flash."""
    flash = IMAGE.with_suffix(".bin").read_bytes()
    build = f"{crc32c(flash[:VECTORS] + flash[VECTORS + 4:]):08x}"
    assert flash[VECTORS:VECTORS + 4] == bytes.fromhex(build)[::-1]
    for _ in range(2):
        rows = checks(board.port)
        assert rows["device"]["state"] == rows["firmware"]["state"] == "works", rows
        assert rows["round trip"]["state"] in ("works", "warning") and build in rows["firmware"]["found"], rows


def codes_of(name):
    return soundfile.read(f"{name}.wav", dtype="int32", always_2d=True)[0]


def is_every_frame_true(codes):
    """Returns the ticks of the frames."""
    ticks = codes[:, 1].view(np.uint32) >> 12
    at = ticks.astype(np.int64) * 20 % 60000
    assert np.array_equal(codes[:, 2].view(np.uint32) >> 12, ~ticks & 0xFFFFF)
    assert np.array_equal(codes[:, 0], np.where(at < 30000, at, 60000 - at))
    return ticks


def every_frame_comes(board):
    tacto.run("record", "-d", f"tty:{board.port}", "--time", f"{RECORD_S}s", "-o", "counted")
    ticks = is_every_frame_true(codes_of("counted"))
    assert len(ticks) >= RECORD_S * RATE_HZ and ticks[0] == 1 and np.all(np.diff(ticks) == 1), ticks


def play_command(board, name, time_s):
    return [tacto.COMMAND, "play", "oak", "-d", f"tty:{board.port}", "--transducer", "wiertlewski2011", "--rate", "2kHz", "--gain",
            "0.1mm/N", "--interpolation", "sinc", "--time", f"{time_s}s", "-o", name, "--json"]


def make_texture():
    """35 mm with lines at 2 and 10 /mm, over which the emulated finger moves."""
    x = np.arange(3500) * PITCH_M
    force_n = 0.05 * np.sin(2 * np.pi * 2000 * x) + 0.01 * np.sin(2 * np.pi * 10_000 * x)
    soundfile.write("oak.texture.wav", force_n.astype(np.float32), round(1 / PITCH_M), subtype="FLOAT")
    check = hashlib.sha256(pathlib.Path("oak.texture.wav").read_bytes()).hexdigest()
    pathlib.Path("oak.texture.json").write_text(json.dumps({
        "kind": "texture", "version": "1.0", "pitch_m": PITCH_M, "quantity": "tangential_force", "unit": "N", "direction": 1,
        "source_origin_m": 0.0, "data": {"file": "oak.texture.wav", "sha256": check, "samples": len(force_n)}}))


def a_texture_replays(board):
    """A fault of the board's watchdog is right if this machine stopped for longer; that session replays, too."""
    for attempt in range(5):
        name = f"played-{attempt}"
        done = subprocess.run(play_command(board, name, 2), capture_output=True, text=True, timeout=600)
        assert done.returncode in (0, DEVICE), done
        if done.returncode == DEVICE and not pathlib.Path(f"{name}.session").exists():
            continue  # an answer took too long
        assert tacto.run_json("replay", name)["same_to_the_bit"], done
        if done.returncode == 0:
            played = json.loads(done.stdout)
            assert played["lost_ticks"] == 0 and played["ticks"] >= 2 * RATE_HZ, played
            assert max(abs(drive_v) for _, drive_v, _ in board.ticks()) > 0.01
            return
    raise AssertionError(f"in five attempts this machine stopped for longer than the watchdog's time: {done}")


def falls_to_zero(board):
    """By the board's own words: it was driven, it names the silent host, and the drive is zero from 20 ms on."""
    board.wait_for(lambda: HOST_SILENT in board.faults())
    ticks = []

    def is_at_rest():
        ticks[:] = list(board.ticks())
        return ticks[-1][2] & FAULTED and ticks[-1][1] == 0
    board.wait_for(is_at_rest)
    first = next(i for i, (_, _, flags) in enumerate(ticks) if flags & FAULTED)
    assert max(abs(drive_v) for _, drive_v, _ in ticks[:first]) > 0.01
    assert all(drive_v == 0 for _, drive_v, _ in ticks[first + RATE_HZ // 50:]), ticks[first:first + 60]


def start_playing(board, name):
    """A program that plays, from the time on at which the board reports a second of it; it may need another attempt."""
    for attempt in range(5):
        board.forget()
        program = subprocess.Popen(play_command(board, f"{name}-{attempt}", 600), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        board.wait_for(lambda: program.poll() is not None or sum(flags & PLAYING > 0 for _, _, flags in board.ticks()) > RATE_HZ)
        if program.poll() is None:
            return program
        ended = program.communicate()
    raise AssertionError(f"in five attempts this machine stopped for longer than the watchdog's time: {ended}")


def a_stopped_host():
    with QemuBoard(str(IMAGE)) as board:
        board.greet()
        program = start_playing(board, "stopped")
        program.send_signal(signal.SIGSTOP)
        falls_to_zero(board)
        program.send_signal(signal.SIGCONT)
        _, error = program.communicate(timeout=120)
        assert program.returncode == DEVICE, (program.returncode, error)
        checks(board.port)


def an_unplugged_board():
    with QemuBoard(str(IMAGE)) as board:
        board.greet()
        program = start_playing(board, "pulled")
        board.unplug()
        _, error = program.communicate(timeout=120)
        assert program.returncode == DEVICE and "unplugged" in error, (program.returncode, error)
        falls_to_zero(board)


def a_board_that_restarts():
    """The host ends with the device's error and a session that replays; the board is idle, and works again only when it is greeted."""
    with QemuBoard(str(IMAGE)) as board:
        board.greet()
        program = start_playing(board, "restarted")
        board.restart()
        _, error = program.communicate(timeout=120)
        assert program.returncode == DEVICE, (program.returncode, error)
        (session,) = pathlib.Path().glob("restarted-*.session")
        assert tacto.run_json("replay", session.stem)["same_to_the_bit"]
        board.forget_all()
        board.greet()
        assert not list(board.ticks()), "it plays after its restart"
        assert checks(board.port)["device"]["state"] == "works"


def a_texture_that_is_too_large(board):
    """With hermite this texture takes more than the RAM holds. The error names what fits."""
    _, error = tacto.run("play", "oak", "-d", f"tty:{board.port}", "--transducer", "wiertlewski2011", "--interpolation", "hermite",
                         "--time", "1s", "-o", "none", code=UNSUITABLE)
    assert str(SAMPLES) in error, error
    assert not pathlib.Path("none.session").exists()


def identify(board, code, *options):
    for _ in range(10):  # on a busy computer the drive may come too late, or the watchdog end it
        done = subprocess.run([tacto.COMMAND, "identify", "-d", f"tty:{board.port}", "-o", "bench", "--json", *options], capture_output=True,
                              text=True, timeout=600)
        if done.returncode == code:
            return done
        assert done.returncode == DEVICE and not pathlib.Path("bench.transducer.json").exists(), done
    raise AssertionError(f"the drive came too late in ten attempts: {done}")


def identify_finds_the_tray(board):
    """The image moves a tray in place of QEMU, which has none. Its true values are those of the equations in emulated_tray.hpp.
    A drive below half a step of the DAC (2.4 mV) does not move it, which is refused."""
    identify(board, UNSUITABLE, "--method", "multisine", "--amplitude", "1mV")
    assert not pathlib.Path("bench.transducer.json").exists()
    said = json.loads(identify(board, 0).stdout)
    assert said["verdict"] == "fits" and "QEMU" in said["simulated"], said
    found = {row["parameter"]: row for row in said["parameters"]}
    for name, truth in TRAY.items():
        row = found[name]
        # A true value is three half widths of a 95 % interval away once in 2e8. Beside that, the steps of the DAC, 0.7 mV (RMS) of
        # 1 V, are the same in each measurement: 1e-4 of a mean over 100 samples.
        assert abs(row["value"] - truth) < 1.5 * (row["high_of_95"] - row["low_of_95"]) + 1e-4 * truth, (name, truth, row)
        print(f"{name}: {row['value']:.7g} ({row['low_of_95']:.7g} to {row['high_of_95']:.7g}), true {truth:.7g}")


def damaged_bytes_are_gaps(board):
    """Whatever arrives is true, and the line works again afterwards. The board has received random bytes, too."""
    board.corrupt(3000)
    done = subprocess.run([tacto.COMMAND, "record", "-d", f"tty:{board.port}", "--time", f"{NOISY_S}s", "-o", "noisy", "--allow-gaps"],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode in (0, DEVICE), done
    ticks = is_every_frame_true(codes_of("noisy"))
    lost = np.diff(ticks.astype(np.int64), prepend=0) - 1  # the first frame is that of the first tick
    gaps = json.loads(pathlib.Path("noisy.json").read_text()).get("gaps", [])
    assert np.all(lost >= 0) and lost.sum() > 0 and sum(gap["count"] for gap in gaps) == lost.sum(), (lost.sum(), gaps, done)
    board.corrupt(0)
    board.send(np.random.default_rng(1).bytes(5000))
    board.greet()
    assert checks(board.port)["device"]["state"] == "works"


def its_outputs_are_safe():
    """By what the program writes to its pins: the amplifier is off while the board is idle, on while it plays; and a hardware
    fault then (an undefined instruction in the tick) ends in a drive of zero, then with the amplifier off, and nothing more."""
    with QemuBoard(str(IMAGE)) as board:
        board.greet()
        board.see_pins(True)
        checks(board.port)
        assert {("enable", False)} <= set(board.pins()) <= {("drive", DRIVE_ZERO), ("enable", False)}, set(board.pins())
        board.see_pins(False)
        program = start_playing(board, "spoiled")
        board.see_pins(True)
        board.wait_for(lambda: any(pin == "drive" and value != DRIVE_ZERO for pin, value in board.pins()))
        assert ("enable", True) in board.pins()
        board.spoil(Elf(IMAGE).symbols["systick_handler"] & ~1)
        _, error = program.communicate(timeout=120)
        assert program.returncode == DEVICE, (program.returncode, error)
        assert list(board.pins())[-2:] == [("drive", DRIVE_ZERO), ("enable", False)]


def a_damaged_flash_is_refused():
    image = bytearray(IMAGE.read_bytes())
    image[image.index(b"QEMU: encoder")] ^= 1
    pathlib.Path("damaged.elf").write_bytes(image)
    with QemuBoard("damaged.elf") as board:
        board.wait_for(lambda: board.said, again=lambda: board.send(b"?"))
        assert "flash check failed" in checks(board.port, DEVICE)["device"]["found"]


def test():
    make_texture()
    with QemuBoard(str(IMAGE)) as board:
        board.greet()
        for step in (doctor_works_twice, every_frame_comes, a_texture_replays, a_texture_that_is_too_large,
                     identify_finds_the_tray, damaged_bytes_are_gaps):
            step(board)
            print(step.__name__, flush=True)
    for step in (a_stopped_host, an_unplugged_board, a_board_that_restarts, its_outputs_are_safe, a_damaged_flash_is_refused):
        step()
        print(step.__name__, flush=True)


if __name__ == "__main__":
    tacto.in_folder(test)
