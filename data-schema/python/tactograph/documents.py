# SPDX-License-Identifier: GPL-3.0-or-later
"""Find a file by its stem, read its JSON document, check kind, version and checksum."""
import glob
import hashlib
import json
import pathlib
import struct
import warnings

from tactograph.errors import FileProblem

MAJOR = 1
COVERED = {  # by numbers_sum
    "recording": ("sample_rate_hz", "channels", "gaps", "transducer"),
    "texture": ("pitch_m", "quantity", "unit", "direction", "source_origin_m", "valid_band", "source", "transform", "average"),
}


def find(name, endings):
    """The file that `name` means: the name as it is, or a stem with the first of `endings`.

    Any of `endings` may be given in full; the path returned always has the first one.
    """
    name = str(name)
    for ending in sorted(endings, key=len, reverse=True):
        if name.endswith(ending):
            name = name[:-len(ending)]
            break
    path = pathlib.Path(name + endings[0])
    if not path.is_file():
        others = sorted(str(other)[:-len(endings[0])] for other in path.parent.glob(f"{glob.escape(pathlib.Path(name).name)}-*{endings[0]}"))
        raise FileProblem("there is no such file", path, f"give a stem, or a name that ends in {' or '.join(endings)}"
                          + (f"; there are {', '.join(others)}" if others else ""))
    return path


def check_kind(document, kind, path):
    """Raises FileProblem for another kind of document or a newer major version; warns of a newer minor one."""
    if document.get("kind") != kind:
        raise FileProblem(f"is of kind {document.get('kind')!r}, not {kind!r}", path)
    version = str(document.get("version", ""))
    major, _, minor = version.partition(".")
    if not (major.isdigit() and minor.isdigit()):
        raise FileProblem(f"has no version (found {version!r})", path)
    if int(major) != MAJOR:
        raise FileProblem(f"is of version {version}; this package reads version {MAJOR}", path, "install a newer tactograph")
    return int(minor)


def read_document(path, kind, newest_minor=0):
    """The JSON document at `path`, as a dict."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise FileProblem(f"is not a JSON document ({error})", path) from error
    if not isinstance(document, dict):
        raise FileProblem("is not a JSON object", path)
    minor = check_kind(document, kind, path)
    if document.get("data", {}).get("numbers_sha256", "") not in ("", numbers_sum(document)):
        raise FileProblem("its numbers do not match their checksum (SHA-256): a number, quantity or unit was changed", path,
                          "restore the file; if the change is intended, remove the member data.numbers_sha256")
    if minor > newest_minor:
        warnings.warn(f"{path}: version {document['version']} is newer than this package; unknown members are ignored")
    return document


def numbers_sum(document):
    """SHA-256 of the numbers that give the samples their meaning, as in `data.numbers_sha256`; None for other kinds."""
    if document["kind"] not in COVERED:
        return None
    covered = {key: document[key] for key in COVERED[document["kind"]] if key in document}
    total = hashlib.sha256()
    for pointer, value in sorted(_leaves("", covered), key=lambda leaf: leaf[0].encode()):
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            total.update(pointer.encode() + b"\n" + struct.pack("<d", value))
        elif isinstance(value, str) and pointer.endswith(("/quantity", "/unit")):
            total.update(pointer.encode() + b"\n" + value.encode() + b"\n")
    return total.hexdigest()


def _leaves(pointer, value):
    """Pairs of JSON pointer and value."""
    if isinstance(value, dict):
        for key, one in value.items():
            if not key.startswith("x_"):
                yield from _leaves(pointer + "/" + key.replace("~", "~0").replace("/", "~1"), one)
    elif isinstance(value, list):
        for i, one in enumerate(value):
            yield from _leaves(f"{pointer}/{i}", one)
    else:
        yield pointer, value


def check_sum(path, expected):
    """Raises FileProblem where the file's SHA-256 is not the expected one."""
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != expected:
        raise FileProblem("its SHA-256 differs from that in its document: the file was changed", path)


def plain_attributes(document, leave_out):
    """A value as netCDF attributes support it: numbers and texts unchanged, everything else as JSON text."""
    kept = {}
    for key, value in document.items():
        if key in leave_out:
            continue
        kept[key] = value if isinstance(value, (str, int, float)) and not isinstance(value, bool) else json.dumps(value)
    return kept
