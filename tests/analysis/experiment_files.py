# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of runs against their schemas, by the validator of Python's jsonschema."""
import csv
import json
import pathlib

import jsonschema

SCHEMAS = pathlib.Path(__file__).resolve().parents[2] / "data-schema/schemas"


def validator(name):
    rules = json.loads((SCHEMAS / f"{name}.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(rules)
    return jsonschema.Draft7Validator(rules)


def check(rules, document, where):
    for error in rules.iter_errors(document):
        raise AssertionError((where, document, error.message, [each.message for each in error.context]))


def keep_to_their_schemas(*events):
    """Journals, tables of trials and tables of exports below this folder; the journals have these events, too."""
    journals, tables = validator("trials"), validator("trials_table")
    found = set()
    here = pathlib.Path(".")
    for path in here.rglob("*.trials.jsonl"):
        for line in path.read_text().splitlines(keepends=True):
            if line.endswith("\n"):  # else the run was killed in it
                check(journals, json.loads(line), path)
                found.add(json.loads(line)["event"])
    assert found >= {"plan", "begun", "answered", "end", *events}, found
    for path in [*here.rglob("*.trials.tsv"), *here.rglob("*_beh.tsv")]:
        with open(path) as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
        for row in rows:
            assert None not in row and None not in row.values(), (path, row)
            check(tables, {name: "" if cell == "n/a" else cell for name, cell in row.items()}, path)
        if not rows:
            continue  # a run without an attempt
        for name in set(rows[0]) - {"force_within", "seemed_longer", "correct"}:
            assert not tables.is_valid({other: cell for other, cell in rows[0].items() if other != name}), (path, name)
        assert not tables.is_valid({**rows[0], "attempt": "first"}) and not tables.is_valid({**rows[0], "remark": ""}), path
