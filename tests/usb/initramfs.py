# SPDX-License-Identifier: GPL-3.0-or-later
"""A file system in memory for the kernel's start: cpio's "newc" format, as in the kernel's initramfs documentation."""
import pathlib
import stat


def entry(name, mode, content=b"", inode=0):
    fields = [inode, mode, 0, 0, 1, 0, len(content), 0, 0, 0, 0, len(name) + 1, 0]
    head = b"070701" + b"".join(b"%08x" % field for field in fields) + name.encode() + b"\0"
    return head + b"\0" * (-len(head) % 4) + content + b"\0" * (-len(content) % 4)


def archive(folders, files):
    """`folders` are names; `files` maps a name to its content; all of them are executable."""
    entries = [(name, stat.S_IFDIR | 0o755, b"") for name in folders]
    entries += [(name, stat.S_IFREG | 0o755, content) for name, content in files.items()]
    parts = [entry(*e, inode=1 + i) for i, e in enumerate(entries)]
    return b"".join(parts) + entry("TRAILER!!!", 0)


def for_guest(kernel, init):
    """Busybox, the kernel's modules and our /init; `kernel` is the folder of fetch_kernel.py."""
    files = {"init": pathlib.Path(init).read_bytes(), "bin/busybox": pathlib.Path("/bin/busybox").read_bytes(),
             "modules/order": (kernel / "modules").read_bytes()}
    for path in sorted(kernel.glob("*.ko")):
        files[f"modules/{path.name}"] = path.read_bytes()
    return archive(["bin", "dev", "proc", "sys", "modules", "host", "root"], files)
