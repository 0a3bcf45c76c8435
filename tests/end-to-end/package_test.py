#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Debian packages in a bare Debian 12 without the build's libraries, installed as the recipe for Apptainer does; the
tarball in a root folder that contains nothing else but busybox: usage: package_test.py BUILD-FOLDER

Needs root (for a root folder of its own), mmdebstrap and a Debian mirror; otherwise it prints "skipped" and the reason.
"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
EXPOSURE = 1.9  # of the unit, by systemd 252: the value before there was a package

TARBALL = pathlib.Path(__file__).parents[2] / "cmake/tarball"

INSIDE = r"""set -e
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin
cp /root/tactograph_*.deb /tmp
(%s)
cp /tmp/tactograph_*.deb /root
apt-get update -q
apt-get install -y -q --no-install-recommends /root/*.deb man-db systemd
id -nG tactograph | grep -qw plugdev; test -s /etc/tactograph/tactographd.json
cd /tmp
tactograph demo; test -s demo/index.html
man tactograph-spatial | grep -q -- --band; man tactographd | grep -q -- --config; man tactograph-files | grep -q recording
grep -q "tactograph spatial" /usr/share/man/man1/tactograph-spatial.1.gz || zcat /usr/share/man/man1/tactograph-spatial.1.gz | grep -q "tactograph spatial"
/usr/bin/python3 -c 'import tactograph; print(tactograph.read_recording("demo/C", check=True).tangential_force.attrs["units"])' | grep -qx N
bash -c '. /usr/share/bash-completion/completions/tactograph && complete -p tactograph' | grep -q tactograph
systemd-analyze verify /usr/lib/systemd/system/tactographd.service
systemd-analyze security --offline=true /usr/lib/systemd/system/tactographd.service | tail -n 1
apt-get purge -y -q tactograph; test ! -e /etc/tactograph
echo all of it worked
"""

ALONE = """set -e
tactograph demo -o demo
tactograph corpus init study --recordings 'demo/?.json'
tactograph corpus run study --shard 1/1
tactograph export demo/C -o C.mat
tactographd --help
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def make_packages(build, folder):
    """cpack into `folder`, with a fixed date."""
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
    done = subprocess.run(["cpack", "-B", str(folder)], cwd=build, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    packages = sorted(folder.glob("*.deb"))
    assert [re.match(r"[a-z0-9-]+", p.name)[0] for p in packages] == ["python3-tactograph", "tactograph-dev", "tactograph"], packages
    return packages


def checksums(packages):
    return {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in packages}


def lintian_has_no_errors(packages):
    done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", *map(str, packages)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def the_core_compiles_from_its_package(packages, folder):
    """A maker of boards has the -dev package and a compiler, and no other part of tactograph."""
    subprocess.run(["dpkg-deb", "-x", str(next(p for p in packages if "-dev" in p.name)), str(folder)], check=True)
    source = folder / "usr/share/tactograph/src"
    for file in (source / "firmware-host/core").rglob("*.cpp"):
        subprocess.run(["c++", "-std=c++20", "-ffreestanding", "-fsyntax-only", "-I", str(source), str(file)], check=True)
    assert (folder / "usr/share/tactograph/schemas/texture.schema.json").is_file()


def the_tarball_runs_in_an_empty_root(build, folder):
    """Its files are those of the build, so that it loads nothing of the machine and shows letters in the same font."""
    made = subprocess.run([TARBALL / "make.sh", build, folder / "tarball"], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    root = folder / "empty"
    for name in ("bin", "opt", "tmp"):
        (root / name).mkdir(parents=True)
    shutil.copy("/bin/busybox", root / "bin")
    for name in ("sh", "readlink", "dirname"):
        (root / "bin" / name).symlink_to("busybox")
    subprocess.run(["tar", "-xf", made.stdout.strip(), "-C", root / "opt", "--strip-components=1"], check=True)
    (root / "bin/tactograph").symlink_to("../opt/bin/tactograph")
    done = subprocess.run(["/usr/sbin/chroot", root, "/bin/sh", "-c", f"cd /tmp; PATH=/bin:/opt/bin; {ALONE}"], env={}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]
    subprocess.run([pathlib.Path(build).resolve() / "tactograph", "demo", "-o", "demo"], cwd=folder, check=True, capture_output=True)
    for name in ("C.wav", "C.texture.wav", "C.png"):
        assert (root / "tmp/demo" / name).read_bytes() == (folder / "demo" / name).read_bytes(), name
    assert list((root / "tmp/study").rglob("*.texture.wav")) and (root / "tmp/C.mat").stat().st_size > 0


def skip_without_mirror(done):
    if done.returncode != 0 and re.search(r"Could not (resolve|connect)|Failed to fetch|Temporary failure|timed out", done.stdout + done.stderr):
        skip("no Debian mirror answers; packages and lintian were checked")


def bare_debian(folder):
    done = subprocess.run(["mmdebstrap", "--variant=apt", "bookworm", str(folder)], capture_output=True, text=True)
    if done.returncode == 0:
        return
    skip_without_mirror(done)
    raise AssertionError(done.stderr)


def everything_works_inside(folder, packages):
    for package in packages:
        shutil.copy(package, folder / "root")
    shutil.copy("/etc/resolv.conf", folder / "etc/resolv.conf")
    recipe = re.search(r"^%post\n(.*?)^%", (TARBALL / "tactograph.def").read_text(), re.DOTALL | re.MULTILINE)[1]
    (folder / "root/inside.sh").write_text(INSIDE % recipe)
    done = subprocess.run(["unshare", "-mpf", f"--mount-proc={folder}/proc", "chroot", str(folder), "bash", "/root/inside.sh"],
                          env={"PATH": os.environ["PATH"], "HOME": "/root"}, capture_output=True, text=True)
    skip_without_mirror(done)
    assert done.returncode == 0 and done.stdout.endswith("all of it worked\n"), done.stdout[-4000:] + done.stderr[-2000:]
    exposure = float(re.search(r"exposure level for tactographd.service: ([0-9.]+)", done.stdout)[1])
    print(f"systemd's exposure level of the unit: {exposure}")
    assert exposure <= EXPOSURE, exposure


def main():
    build = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory(dir=build) as temporary:
        folder = pathlib.Path(temporary)
        packages = make_packages(build, folder / "one")
        assert checksums(packages) == checksums(make_packages(build, folder / "two")), "equal inputs gave other bytes"
        the_core_compiles_from_its_package(packages, folder / "dev")
        lintian_has_no_errors(packages)
        if os.geteuid() != 0:
            skip("a root folder of its own needs root; packages and lintian were checked")
        if subprocess.run(["unshare", "-mpf", "true"], capture_output=True).returncode != 0:
            skip("this machine allows no namespaces; packages and lintian were checked")
        the_tarball_runs_in_an_empty_root(build, folder)
        bare_debian(folder / "root")
        everything_works_inside(folder / "root", packages)


main()
