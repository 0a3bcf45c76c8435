#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Extracts Debian's stock kernel from the distribution's current package into a folder: the image, and the modules that
the USB tests need, in the order of loading. Installs nothing. Does nothing if the folder is complete. apt checks the
package against its signed lists.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

META_PACKAGE = "linux-image-amd64"
# dummy_hcd: controller and device in one; usb_f_fs, usb_f_acm: the device's functions; cdc_acm, ftdi_sio: serial ports, the
# latter's adapter behind QEMU's xHCI; 9p: the host's files; comedi_test: an emulated data acquisition card.
WANTED = ["virtio_pci", "9pnet_virtio", "9p", "libcomposite", "usb_f_fs", "usb_f_acm", "dummy_hcd", "xhci_pci", "cdc_acm", "ftdi_sio",
          "comedi_test"]


def output(*command, **more):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def package_name():
    names = re.findall(r"Depends: (linux-image-[0-9]\S*)", output("apt-cache", "depends", META_PACKAGE))
    if not names:
        raise RuntimeError(f"apt knows no {META_PACKAGE}: run apt-get update")
    return names[0]


def unpacked(package, folder):
    output("apt-get", "download", "-q", package, cwd=folder)
    (archive,) = folder.glob("*.deb")
    output("dpkg-deb", "-x", str(archive), str(folder / "x"))
    return folder / "x"


def dependencies(module):
    """The dependencies in the module's .modinfo, without its own name."""
    named = re.search(rb"\0depends=([^\0]*)\0", module.read_bytes())
    return [name.replace("-", "_") for name in named.group(1).decode().split(",") if name] if named else []


def in_loading_order(wanted, files):
    order = []

    def add(name):
        if name in order:
            return
        for other in dependencies(files[name]):
            add(other)
        order.append(name)

    for name in wanted:
        add(name)
    return order


def keep(tree, folder):
    (image,) = (tree / "boot").glob("vmlinuz-*")
    files = {path.stem.replace("-", "_"): path for path in tree.rglob("*.ko")}
    order = in_loading_order(WANTED, files)
    for name in order:
        shutil.copy(files[name], folder / f"{name}.ko")
    shutil.copy(image, folder / "vmlinuz")
    (folder / "modules").write_text("\n".join(order) + "\n")  # written last: it marks the folder as complete


def complete(folder):
    return (folder / "modules").exists() and (folder / "modules").stat().st_mtime > pathlib.Path(__file__).stat().st_mtime


def main():
    folder = pathlib.Path(sys.argv[1])
    if complete(folder):
        return 0
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="tacto-kernel-") as temporary:
        package = package_name()
        print(f"fetching {package} for the tests of USB", file=sys.stderr)
        keep(unpacked(package, pathlib.Path(temporary)), folder)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, subprocess.CalledProcessError) as error:
        sys.exit(f"fetch_kernel: {error}")
