#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`corpus workflow` and `corpus pack`: the files that they write are executed and checked by other programs."""
import csv
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import time
import urllib.parse

import tacto
from tacto import COMMAND, run, run_json

USAGE, NOT_FOUND, UNSUITABLE, CANNOT_WRITE = 2, 3, 5, 7
SURFACES, COPIES = "ABC", 4
CODE, SHORT = "Quokka42", "7"  # of subjects; no checksum contains the first
CITATION = ["--title", "Oak & linen \"1\"", "--creator", "Doe, Jane <0000-0002-1825-0097>", "--creator", "Nowak, Ola", "--publisher", "A lab",
            "--year", "2026", "--licence", "CC-BY-4.0"]
os.environ["SOURCE_DATE_EPOCH"] = "1700000000"


def copy(name, other, **changed):
    side = json.loads(pathlib.Path(f"{name}.json").read_text())
    side["data"]["file"] = pathlib.Path(f"{other}.wav").name
    pathlib.Path(f"{other}.json").write_text(json.dumps({**side, **changed}))
    shutil.copy(f"{name}.wav", f"{other}.wav")


def write_recordings():
    pathlib.Path("raw").mkdir()
    for surface in SURFACES:
        run("record", "-d", f"sim:surface={surface},speed=60mm/s,seed=3", "--time", "1.2s", "-o", surface)
        for number in range(COPIES):
            copy(surface, f"raw/{surface}{number}")


def contents(folder):
    root = pathlib.Path(folder)
    return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(root.rglob("*")) if path.is_file()}


def with_command_on_path():
    """The scripts call `tactograph`."""
    pathlib.Path("bin").mkdir()
    pathlib.Path("bin/tactograph").symlink_to(pathlib.Path(COMMAND).resolve())
    return {**os.environ, "PATH": f"{pathlib.Path('bin').resolve()}:{os.environ['PATH']}"}


def array_of(script):
    """The indices that Slurm would give to the tasks."""
    found = re.findall(r"^#SBATCH --array=(\S+)$", script, flags=re.M)
    assert len(found) == 1, script
    indices = []
    for part in found[0].split(","):
        first, _, last = part.partition("-")
        indices += range(int(first), int(last or first) + 1)
    return indices


def slurm_runs_each_shard_and_resumes(environment):
    study = "a study's $HOME {x}"  # as a word of a shell, a text of Python and a pattern of Snakemake
    run("corpus", "init", "one-core", "--recordings", "raw")
    run("corpus", "run", "one-core")
    run("corpus", "init", study, "--recordings", "raw")
    made = run_json("corpus", "workflow", study, "--engine", "slurm", "--shards", "5", "--account", "lab", "--partition", "short", "--time", "1-0:30", "--mem", "2G", "-o", "job")
    assert (made["recordings"], made["shards"], made["shards_in_the_file"]) == (12, 5, 5), made
    # 12 recordings of 12,000 frames, 23 ms for 20,000
    assert made["estimated_from_recordings"] == 12 and abs(made["estimated_work_s"] - 12 * 12000 * 23e-3 / 20000) < 1e-9, made
    script = pathlib.Path("job").read_text()
    assert {"#SBATCH --account=lab", "#SBATCH --partition=short", "#SBATCH --time=1-0:30", "#SBATCH --mem=2G"} <= set(script.splitlines()), script
    assert array_of(script) == [1, 2, 3, 4, 5], script
    for line in script.splitlines():  # options are read up to the first command
        assert line == "" or line.startswith("#") or line.startswith("exec tactograph corpus run "), line

    def task(index):
        return subprocess.Popen(["bash", "job"], env={**environment, "SLURM_ARRAY_TASK_ID": str(index)}, cwd=".", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    for index in (1, 3, 5):
        assert task(index).wait() == 0, index
    killed = task(2)
    while killed.poll() is None and not list(pathlib.Path(study).glob("work/*/*")):
        time.sleep(0.001)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    status = run_json("corpus", "status", study, code=UNSUITABLE)
    shard_of = {row["path"]: i % 5 + 1 for i, row in enumerate(json.loads((pathlib.Path(study) / "plan.corpus.json").read_text())["recordings"])}
    lacking = sorted({shard_of[row["recording"]] for row in status["not_made"]})
    assert 4 in lacking and set(lacking) <= {2, 4}, lacking
    resume = next(line for line in script.splitlines() if line.startswith("# Resume:")).removeprefix("# Resume:")
    subprocess.run(["bash", "-c", resume], env=environment, check=True, stdout=subprocess.DEVNULL)
    script = pathlib.Path("job").read_text()
    assert array_of(script) == lacking and "#SBATCH --mem=2G" in script.splitlines(), script
    for index in lacking:
        assert task(index).wait() == 0, index
    run("corpus", "status", study)
    assert contents(f"{study}/units") == contents("one-core/units")
    run("corpus", "workflow", study, "--engine", "slurm", "--missing", "-o", "nothing", code=UNSUITABLE)
    assert not pathlib.Path("nothing").exists()


def snakemake_has_the_same_shards(environment):
    """The rules are read as Python with the words of Snakemake as its calls; Snakemake itself: corpus_cluster_test.py."""
    run("corpus", "init", "snake", "--recordings", "raw")
    run("corpus", "run", "snake", "--shard", "2/3")
    run("corpus", "workflow", "snake", "--engine", "snakemake", "--missing", "--shards", "3", "--time", "1:30:30", "--mem", "3G", "--account", "lab", "-o", "Snakefile")
    text = pathlib.Path("Snakefile").read_text()
    assert re.findall(r"^SHARDS = (.*)$", text, flags=re.M) == ["[1, 3]"], text
    assert json.loads(re.findall(r"^workdir: (.*)$", text, flags=re.M)[0]) == str(pathlib.Path("snake").resolve())
    resources = dict(re.findall(r"(\w+)=([^,\n]+)", re.findall(r"resources: (.*)", text)[0]))
    assert resources == {"slurm_account": '"lab"', "runtime": "91", "mem_mb": "3072"}, resources
    command = json.loads(re.findall(r"shell: (.*)", text)[0])
    for shard in ("1", "3"):
        subprocess.run(["bash", "-c", command.replace("{wildcards.shard}", shard)], env=environment, cwd="snake", check=True, stdout=subprocess.DEVNULL)
    run("corpus", "status", "snake")
    assert contents("snake/units") == contents("one-core/units")


def wrong_workflows_are_refused():
    def refused(word, *options, code=USAGE):
        error = run("corpus", "workflow", "one-core", "--engine", "slurm", "-o", "refused", *options, code=code)[1]
        assert word in error and not pathlib.Path("refused").exists(), (word, error)

    refused("--shards", "--shards", "1001")
    refused("--shards", "--shards", "0")
    for wrong in ("x", "", "1:2:3:4", "1-", "-5", "1-1:1:1:1", "1\n#SBATCH --wrap=x", "2"):
        if wrong:
            refused("--time", f"--time={wrong}")
    for wrong in ("4P", "G", "1.5G", "-1"):
        refused("--mem", f"--mem={wrong}")
    refused("--account", "--account", "a\n#SBATCH --wrap=x")
    refused("--partition", "--partition", "a b")
    run("corpus", "workflow", "one-core", "--engine", "pbs", "-o", "refused", code=USAGE)
    run("corpus", "workflow", "raw", "--engine", "slurm", "-o", "refused", code=NOT_FOUND)
    run("corpus", "workflow", "one-core", "--engine", "slurm", "-o", "job", code=USAGE)  # exists
    # --force replaces what `workflow` wrote, nothing else.
    pathlib.Path("own.sh").write_text("#!/bin/bash\n# mine\n")
    pathlib.Path("only.sh").write_text("#!/bin/bash\n")
    for name in ("raw/A0.json", "raw/A0.wav", "one-core/plan.corpus.json", "own.sh", "only.sh"):
        before = pathlib.Path(name).read_bytes()
        run("corpus", "workflow", "one-core", "--engine", "slurm", "--force", "-o", name, code=USAGE)
        assert pathlib.Path(name).read_bytes() == before, name
    for engine in ("slurm", "snakemake", "slurm"):
        run("corpus", "workflow", "one-core", "--engine", engine, "--force", "-o", "replaced")
        assert ("#SBATCH" in pathlib.Path("replaced").read_text()) == (engine == "slurm")
    many = json.loads(pathlib.Path("one-core/plan.corpus.json").read_text())
    many["recordings"] *= 10**5 // 12
    pathlib.Path("many").mkdir()
    pathlib.Path("many/plan.corpus.json").write_text(json.dumps(many))
    made = run_json("corpus", "workflow", "many", "--engine", "slurm", "-o", "many.job")
    assert made["shards"] == int(made["estimated_work_s"] / 60) and made["shards"] > 10, made  # a minute of work or more


def entities_of(folder):
    """The graph by @id, after a check that each reference in it leads to an entity, and each entity of data to a file or folder."""
    metadata = json.loads((pathlib.Path(folder) / "ro-crate-metadata.json").read_text())
    assert metadata["@context"] == "https://w3id.org/ro/crate/1.1/context", metadata["@context"]
    entities = {entity["@id"]: entity for entity in metadata["@graph"]}
    assert len(entities) == len(metadata["@graph"]), "an @id stands twice"

    def references(value):
        if isinstance(value, list):
            return [found for each in value for found in references(each)]
        if isinstance(value, dict):
            return [value["@id"]] if set(value) == {"@id"} else references(list(value.values()))
        return []

    outside = {"https://w3id.org/ro/crate/1.1"}
    for entity in entities.values():
        for reference in references(list(entity.values())):
            assert reference in entities or reference in outside, (entity["@id"], reference)
    reached = set()

    def descend(entity):
        for part in entity.get("hasPart", []):
            reached.add(part["@id"])
            descend(entities[part["@id"]])

    descend(entities["./"])
    data = {name for name, entity in entities.items() if entity["@type"] in ("File", "Dataset") and name != "./"}
    assert data == reached, data ^ reached  # "MUST be linked to, either directly or indirectly, from the Root"
    for name in data:
        path = pathlib.Path(folder) / urllib.parse.unquote(name)
        if entities[name]["@type"] == "Dataset":
            assert path.is_dir() and name.endswith("/"), name
        else:
            assert path.stat().st_size == int(entities[name]["contentSize"]), name
    return entities


def check_dataset(folder):
    """Checksums by hashlib and by sha256sum, the graph, and each file by `validate`. Returns graph and table."""
    sums = {}
    for line in (pathlib.Path(folder) / "SHA256SUMS").read_text().splitlines():
        value, name = line.split("  ", 1)
        assert name not in sums
        sums[name] = value
    assert sums == {name: value for name, value in contents(folder).items() if name != "SHA256SUMS"}
    subprocess.run(["sha256sum", "--check", "--quiet", "--strict", "SHA256SUMS"], cwd=folder, check=True)
    entities = entities_of(folder)
    files = {urllib.parse.unquote(name) for name, entity in entities.items() if entity["@type"] == "File"}
    assert files | {"ro-crate-metadata.json"} == set(contents(folder)), files
    assert run_json("validate", folder)["valid"]
    with open(pathlib.Path(folder) / "recordings.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    assert all(None not in row and None not in row.values() for row in rows), rows
    return entities, rows


def write_study_with_subjects():
    """Codes in each place where a person or a program may have put one."""
    pathlib.Path("people").mkdir()
    side = json.loads(pathlib.Path("A.json").read_text())
    channels = [{**channel, "source": f"input of {CODE.lower()}"} for channel in side["channels"]]
    copy("A", f"people/{CODE}_oak", subject=CODE, notes=f"as printed by {CODE.upper()}, not 70 mm/s", channels=channels,
         marks=[{"frame": 5, "label": f"x{CODE}x"}], faults=[{"frame": 6, "what": f"{CODE} sneezed"}], warnings=[f"of {CODE}"], surface=f"{CODE}'s oak",
         source_file=f"{CODE}.csv", finger="index", x_form={f"{CODE} says": [f"{CODE}", 7, 12]})
    copy("B", "people/plain", subject=SHORT, notes=f"after {CODE}; subject 7, 70 mm/s")
    run("import", "rest.csv", "-o", f"people/rest-{CODE}", "--rate", "1kHz", "--channel", "tangential_force=f*1N", "--channel", "position=x*1m", "--subject", CODE)
    for name in ("torn", "broken"):
        copy("C", f"people/{CODE}{name}", subject=CODE)
    pathlib.Path(f"people/{CODE}torn.json").write_text(pathlib.Path(f"people/{CODE}torn.json").read_text()[:200])
    wav = pathlib.Path(f"people/{CODE}broken.wav")
    wav.write_bytes(wav.read_bytes()[:-40] + bytes(40))
    run("corpus", "init", "survey", "--recordings", "people", "--spatial", "--grid 100um --band 15Hz..2000Hz")
    run("corpus", "run", "survey")


def codes_of_subjects_are_removed():
    pathlib.Path("rest.csv").write_text("f,x\n" + "".join(f"{0.01 * (i % 7)},0.01\n" for i in range(500)))
    write_study_with_subjects()
    made = run_json("corpus", "pack", "survey", "-o", "published/", *CITATION)
    assert (made["recordings"], made["left_out_damaged_recordings"], made["renamed_because_of_a_subjects_code"]) == (5, 2, 2), made
    entities, rows = check_dataset("published")
    for path in pathlib.Path("published").rglob("*"):
        assert CODE.lower() not in str(path).lower(), path
        assert path.is_dir() or CODE.lower().encode() not in path.read_bytes().lower(), path
    assert "subject" not in rows[0] and len(rows) == 5
    by_name = {row["name"]: row for row in rows}
    assert by_name["plain"]["textures"] == "2" and by_name["plain"]["failure"] == "" and by_name["plain"]["warnings"] == "yes", by_name
    assert sum(row["failure"] != "" for row in rows) == 3, rows
    plain = json.loads(next(pathlib.Path("published").rglob("plain.json")).read_text())
    assert plain["notes"] == "after [subject]; subject [subject], 70 mm/s" and "subject" not in plain, plain["notes"]
    oak = next(json.loads(path.read_text()) for path in pathlib.Path("published").rglob("0000?.json") if "x_form" in path.read_text())
    assert oak["x_form"] == {"[subject] says": ["[subject]", "[subject]", 12]} and oak["marks"][0]["label"] == "x[subject]x" and oak["finger"] == "index", oak
    # What is left is what was measured: samples to the bit, numbers to the bit, and references that lead to files.
    assert oak["data"]["numbers_sha256"] == json.loads(pathlib.Path(f"people/{CODE}_oak.json").read_text())["data"]["numbers_sha256"], oak
    for texture in pathlib.Path("published").rglob("*.texture.json"):
        side = json.loads(texture.read_text())
        assert "subject" not in side and (texture.parent / side["source"]["recording"]).exists() and (texture.parent / side["data"]["file"]).exists(), side
    for description in pathlib.Path("published").rglob("*.descriptions.json"):
        for each in json.loads(description.read_text())["textures"]:
            assert (description.parent / f"{each['texture']}.texture.json").exists(), each["texture"]
    assert all("/" not in row["failure"] for row in rows), rows
    return entities


def citation_is_what_was_stated(entities):
    root = entities["./"]
    assert (root["name"], root["datePublished"], root["license"]["@id"]) == ('Oak & linen "1"', "2026", "https://creativecommons.org/licenses/by/4.0/"), root
    assert [entities[each["@id"]]["name"] for each in root["creator"]] == ["Doe, Jane", "Nowak, Ola"]
    assert root["creator"][0]["@id"] == "https://orcid.org/0000-0002-1825-0097" and entities[root["publisher"]["@id"]]["name"] == "A lab"
    assert entities["ro-crate-metadata.json"]["conformsTo"]["@id"] == "https://w3id.org/ro/crate/1.1" and entities["ro-crate-metadata.json"]["about"]["@id"] == "./"


def codes_stay_if_they_are_asked_for():
    run("corpus", "pack", "survey", "-o", "with/subjects", "--with-subjects", *CITATION)
    _, rows = check_dataset("with/subjects")
    assert sorted(row["subject"] for row in rows) == ["", "", SHORT, CODE, CODE] and f"{CODE}_oak" in [row["name"] for row in rows], rows
    for path in pathlib.Path("with/subjects").rglob(f"{CODE}_oak.*"):
        if ".descriptions" not in path.name:
            assert path.read_bytes() == pathlib.Path(f"people/{path.name}").read_bytes(), path


def a_code_in_a_wav_is_refused():
    """Other programs add chunks of text behind the samples."""
    side = json.loads(pathlib.Path("people/plain.json").read_text())
    pathlib.Path("tagged").mkdir()
    data = bytearray(pathlib.Path("people/plain.wav").read_bytes())
    text = b"IART" + struct.pack("<I", 8) + b"Quokka42"
    data += b"LIST" + struct.pack("<I", 4 + len(text)) + b"INFO" + text
    data[4:8] = struct.pack("<I", len(data) - 8)
    pathlib.Path("tagged/plain.wav").write_bytes(data)
    side["data"]["sha256"] = hashlib.sha256(data).hexdigest()
    pathlib.Path("tagged/plain.json").write_text(json.dumps({**side, "subject": CODE}))
    run("corpus", "init", "tags", "--recordings", "tagged")
    run("corpus", "run", "tags")
    assert "plain.wav" in run("corpus", "pack", "tags", "-o", "tagged-pack", *CITATION, code=UNSUITABLE)[1]
    assert not list(pathlib.Path(".").glob("tagged-pack*"))
    run("corpus", "pack", "tags", "-o", "tagged-pack", "--with-subjects", *CITATION)


def numbers_in_a_wavs_header_are_no_codes():
    """20,000 frames are the bytes 20 4E 00 00 in the chunk "fact"; 4E is the letter N."""
    pathlib.Path("short").mkdir()
    run("record", "-d", "sim:speed=60mm/s,seed=3", "--time", "2s", "-o", "short/oak", "--subject", "N")
    data = pathlib.Path("short/oak.wav").read_bytes()
    assert b"fact" + struct.pack("<II", 4, 20000) in data[:200], data[:200]
    run("corpus", "init", "letters", "--recordings", "short")
    run("corpus", "run", "letters")
    run("corpus", "pack", "letters", "-o", "letters-pack", *CITATION)
    side = json.loads(next(pathlib.Path("letters-pack").rglob("oak.json")).read_text())
    assert "subject" not in side, side


def other_spellings_of_a_code_are_found():
    pathlib.Path("spelled").mkdir()
    names = ("Jane Roe", "Jane_Roe", "jane-roe", "JaneRoe", "JANE - ROE")
    copy("A", "spelled/Jane_Roe-oak", subject="Jane Roe", notes="; ".join(names))
    copy("B", "spelled/plain", subject="S0-1", notes="s01, S_01, S0 1; 0.1 s")
    run("corpus", "init", "spellings", "--recordings", "spelled")
    run("corpus", "run", "spellings")
    run("corpus", "pack", "spellings", "-o", "spelled-pack", *CITATION)
    sides = [json.loads(path.read_text()) for path in pathlib.Path("spelled-pack").rglob("*.json") if path.name in ("00001.json", "plain.json")]
    assert sorted(side["notes"] for side in sides) == ["[subject], [subject], [subject]; 0.1 s", "; ".join(["[subject]"] * len(names))], sides
    # "e" with two dots is one character or two, capital or small: such a code is refused before anything is written.
    copy("B", "spelled/plain", subject="Zo\u00eb", notes="zoe\u0308")
    run("corpus", "init", "spellings", "--recordings", "spelled", "--force")
    run("corpus", "run", "spellings")
    assert "plain.json" in run("corpus", "pack", "spellings", "-o", "zoe", *CITATION, code=UNSUITABLE)[1]
    assert not list(pathlib.Path(".").glob("zoe*"))
    run("corpus", "pack", "spellings", "-o", "zoe", "--with-subjects", *CITATION)


def what_is_missing_is_named_at_once():
    error = run("corpus", "pack", "survey", "-o", "refused", "--publisher", "P", code=USAGE)[1]
    assert error.count("\n") == 1 and all(option in error for option in ("--title", "--creator", "--year", "--licence")) and "--publisher" not in error, error
    for option, wrong in (("--licence", "CC-BY"), ("--year", "26"), ("--year", "202x"), ("--creator", "Doe, Jane <0000-0002-1825-0098>"), ("--creator", "Doe <x>"),
                          ("--creator", "")):
        replaced = [wrong if before == option else word for before, word in zip([None, *CITATION], CITATION)]
        assert option in run("corpus", "pack", "survey", "-o", "refused", *replaced, code=USAGE)[1], (option, wrong)
    assert not list(pathlib.Path(".").glob("refused*"))


def nothing_is_lost_or_half_written():
    before = contents("published")
    assert "--force" in run("corpus", "pack", "survey", "-o", "published", *CITATION, code=USAGE)[1] and contents("published") == before
    run("corpus", "pack", "survey", "-o", "published", "--force", *CITATION)
    assert contents("published") == before
    # A file of another author, a changed one and a link stay, also with --force.
    pathlib.Path("published/notes").mkdir()
    pathlib.Path("published/notes/mine.txt").write_text("mine")
    pathlib.Path("published/link").symlink_to("recordings")
    table = pathlib.Path("published/recordings.csv").read_bytes()
    pathlib.Path("published/recordings.csv").write_bytes(table + b"\n")
    for name in ("link", "notes/mine.txt", "recordings.csv"):  # the first by name
        kept = contents("published")
        assert name in run("corpus", "pack", "survey", "-o", "published", "--force", *CITATION, code=USAGE)[1], name
        assert contents("published") == kept and pathlib.Path("published", name).exists(), name
        pathlib.Path("published", name).unlink()
    pathlib.Path("published/recordings.csv").write_bytes(table)
    pathlib.Path("published/notes").rmdir()
    run("corpus", "pack", "survey", "-o", "published", "--force", *CITATION)
    assert contents("published") == before
    for folder in ("people", "survey", "."):  # also with --force
        kept = contents(folder)
        run("corpus", "pack", "survey", "-o", folder, "--force", *CITATION, code=USAGE)
        assert contents(folder) == kept
    # Results that are missing, or of a recording that is another one now.
    run("corpus", "init", "unmade", "--recordings", "raw")
    run("corpus", "pack", "unmade", "-o", "early", *CITATION, code=UNSUITABLE)
    text = pathlib.Path("people/plain.json").read_text()
    pathlib.Path("people/plain.json").write_text(text + "\n")
    assert "plain" in run("corpus", "pack", "survey", "-o", "early", *CITATION, code=UNSUITABLE)[1]
    pathlib.Path("people/plain.json").write_text(text)
    assert not list(pathlib.Path(".").glob("early*"))
    process = subprocess.Popen([COMMAND, "corpus", "pack", "one-core", "-o", "cut", *CITATION], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and not list(pathlib.Path(".").glob("cut.part/*/dataset/recordings/*")):
        time.sleep(0.001)
    process.kill()
    process.wait()
    assert not pathlib.Path("cut").exists() or (pathlib.Path("cut") / "SHA256SUMS").exists()
    run("corpus", "pack", "one-core", "-o", "cut", "--force", *CITATION)
    check_dataset("cut")
    assert not pathlib.Path("cut.part").exists()


def a_full_disk_is_named():
    """RLIMIT_FSIZE: writing beyond 100 kB fails as on a full disk; the recordings have more."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    assert all(path.stat().st_size > 100_000 for path in pathlib.Path("raw").glob("*.wav"))
    done = subprocess.run([COMMAND, "corpus", "pack", "one-core", "-o", "full", *CITATION], capture_output=True, text=True, preexec_fn=limit)
    assert done.returncode == CANNOT_WRITE and f"{pathlib.Path('full.part').resolve()}/" in done.stderr, done
    assert not list(pathlib.Path(".").glob("full*"))


def all_of_it():
    write_recordings()
    environment = with_command_on_path()
    slurm_runs_each_shard_and_resumes(environment)
    snakemake_has_the_same_shards(environment)
    wrong_workflows_are_refused()
    citation_is_what_was_stated(codes_of_subjects_are_removed())
    codes_stay_if_they_are_asked_for()
    a_code_in_a_wav_is_refused()
    numbers_in_a_wavs_header_are_no_codes()
    other_spellings_of_a_code_are_found()
    what_is_missing_is_named_at_once()
    nothing_is_lost_or_half_written()
    a_full_disk_is_named()


if __name__ == "__main__":
    tacto.in_folder(all_of_it)
