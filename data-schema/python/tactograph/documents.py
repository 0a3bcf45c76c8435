# SPDX-License-Identifier: GPL-3.0-or-later
"""Find a file by its stem, read its JSON document, check kind, version and checksum."""
import hashlib
import json
import pathlib
import warnings

from tactograph.errors import FileProblem

MAJOR = 1


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
        raise FileProblem("there is no such file", path, f"give a stem, or a name that ends in {' or '.join(endings)}")
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
    if minor > newest_minor:
        warnings.warn(f"{path}: version {document['version']} is newer than this package; unknown members are ignored")
    return document


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
