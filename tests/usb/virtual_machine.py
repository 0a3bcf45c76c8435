# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a shell script on Debian's stock kernel in QEMU. The host's files are its root; a folder receives its results.
README.md lists what a guest script may use.
"""
import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import time

import initramfs

HERE = pathlib.Path(__file__).resolve().parent
KERNEL = pathlib.Path(os.environ.get("TACTO_KERNEL", HERE.parents[1] / "build" / "kernel"))
NO_KVM = KERNEL / "no-kvm"  # its time says since when KVM is known not to work
BOOT_S = 400  # without KVM; a fast machine needs ten, a shared one a hundred
KVM_BOOT_S = 20  # with KVM; it needs about one
MEMORY_MB = 1024
# Without KVM the guest's clock counts its instructions, 2^2 ns each, and follows real time only while the guest is
# idle. So a slow computer takes longer, but nothing in the guest is late; a stall of a second may still end a test.
COUNTED_CLOCK = ["-icount", "shift=2,align=off,sleep=on"]


class GuestFailed(Exception):
    """The guest did not boot, did not end in time, or its script failed."""


def this_boot():
    return pathlib.Path("/proc/sys/kernel/random/boot_id").read_text()


def accelerators():
    """KVM if it can be opened; it may still fail, so QEMU's own emulation is next."""
    if "TACTO_QEMU_ACCEL" in os.environ:
        return [os.environ["TACTO_QEMU_ACCEL"]]
    tried = NO_KVM.exists() and NO_KVM.read_text() == this_boot()
    return ["kvm", "tcg"] if os.access("/dev/kvm", os.R_OK | os.W_OK) and not tried else ["tcg"]


def qemu_command(image, results, accel, devices):
    share = "local,security_model=none,multidevs=remap"
    processor = "max" if accel == "kvm" else "qemu64"  # the fastest choice for QEMU's emulation
    clock = [] if accel == "kvm" else COUNTED_CLOCK
    return ["qemu-system-x86_64", "-M", "q35", "-accel", accel, *clock, "-cpu", processor, "-smp", "1", "-m", str(MEMORY_MB),
            "-nodefaults", "-display", "none", "-no-reboot", "-serial", "stdio",
            "-kernel", str(KERNEL / "vmlinuz"), "-initrd", str(image), "-append", "console=ttyS0 quiet panic=-1",
            "-virtfs", f"{share},path=/,mount_tag=host,readonly=on,id=host",
            "-virtfs", f"{share},path={results},mount_tag=results,id=results", *devices]


def write_environment(results, script, environment):
    lines = {"GUEST_SCRIPT": str(script), "GUEST": str(HERE / "guest"), "HOME": "/guest", "TMPDIR": "/guest/tmp",
             "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", **environment}
    text = "".join(f"export {name}={shlex.quote(str(value))}\n" for name, value in lines.items())
    (results / "environment").write_text(text)


def require_parts():
    if not (KERNEL / "modules").exists():
        raise GuestFailed(f"no kernel in {KERNEL}: run ./bootstrap install (or tests/usb/fetch_kernel.py {KERNEL})")
    for program, package in (("qemu-system-x86_64", "qemu-system-x86"), ("/bin/busybox", "busybox-static")):
        if not shutil.which(program):
            raise GuestFailed(f"{program} is not here: install {package}, or run ./bootstrap install")


def wait_for(machine, results, accel, timeout_s):
    """Waits until the guest has switched itself off; kills it if it does not boot, or does not end, in time."""
    up_by = time.monotonic() + (KVM_BOOT_S if accel == "kvm" else BOOT_S)
    while machine.poll() is None and not (results / "up").exists() and time.monotonic() < up_by:
        time.sleep(0.05)
    try:
        # Seconds of the guest; without KVM a shared computer needs several real seconds for each.
        machine.wait((timeout_s if accel == "kvm" else 5 * timeout_s) if (results / "up").exists() else 0)
    except subprocess.TimeoutExpired:
        machine.kill()
        machine.wait()
        return f"\nended from outside: not {'done' if (results / 'up').exists() else 'up'} in time\n"
    return ""


def boot(results, accel, timeout_s, devices):
    """Returns the guest's output on its serial port, and the reason if it did not end by itself."""
    with tempfile.TemporaryDirectory(prefix="tacto-guest-") as folder:
        image, serial = pathlib.Path(folder) / "initramfs", pathlib.Path(folder) / "serial"
        image.write_bytes(initramfs.for_guest(KERNEL, HERE / "guest" / "init"))
        with serial.open("wb") as port:
            machine = subprocess.Popen(qemu_command(image, results, accel, devices), stdin=subprocess.DEVNULL, stdout=port,
                                       stderr=subprocess.STDOUT)
            ended = wait_for(machine, results, accel, timeout_s)
        return serial.read_text(errors="replace").replace("\r", "") + ended


def run(script, results, timeout_s, devices=(), **environment):
    """Runs guest/SCRIPT with `environment` set. Files that it writes to /guest/results are in `results` afterwards. `devices`:
    more of QEMU's options.

    Returns its output. Raises GuestFailed with the whole output unless the script ended with 0.
    """
    require_parts()
    results = pathlib.Path(results)
    write_environment(results, HERE / "guest" / script, environment)
    said = ""
    for accel in accelerators():
        said += boot(results, accel, timeout_s, devices)
        if (results / "up").exists():
            break
        if accel == "kvm":
            NO_KVM.write_text(this_boot())
    status = results / "status"
    ended = status.read_text().strip() if status.exists() else "nothing: it did not come to its end"
    if ended != "0":
        log = results / "gadget.log"
        said += log.read_text() if log.exists() else ""
        raise GuestFailed(f"{script} in the guest ({accel}) ended with {ended}\n{said}")
    return said
