#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`corpus`: a folder as one job. The reference of every run is an unbroken one with one thread, and the verbs themselves."""
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time

import tacto
from tacto import COMMAND, peak_mb, run, run_json

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE, NEWER = 2, 3, 4, 5, 6
SURFACES, COPIES = "ABCDE", 10  # 50 recordings, 100 units: more than a batch of 64
os.environ["SOURCE_DATE_EPOCH"] = "1700000000"  # files of two runs differ in nothing


def copy(name, other):
    """The recording under another name."""
    side = json.loads(pathlib.Path(f"{name}.json").read_text())
    side["data"]["file"] = pathlib.Path(f"{other}.wav").name
    pathlib.Path(f"{other}.json").write_text(json.dumps(side))
    shutil.copy(f"{name}.wav", f"{other}.wav")


def write_recordings():
    for folder in ("raw/deep", "odd"):
        pathlib.Path(folder).mkdir(parents=True)
    for surface in SURFACES:
        run("record", "-d", f"sim:surface={surface},speed=60mm/s,seed=3", "--time", "1.2s", "-o", surface)
        for number in range(COPIES):
            copy(surface, f"raw/{'deep/' if number % 2 else ''}{surface}{number}")
    pathlib.Path("raw/table.json").write_text('{"other": "program"}')
    run("import", write_rest(), "-o", "odd/rest", "--rate", "1kHz", "--channel", "tangential_force=f*1N", "--channel", "position=x*1m")


def write_rest():
    """A finger at rest: a whole recording without a stroke."""
    pathlib.Path("rest.csv").write_text("f,x\n" + "".join(f"{0.01 * (i % 7)},0.01\n" for i in range(500)))
    return "rest.csv"


def init(study, *options, recordings="raw/**/*.json"):
    return run_json("corpus", "init", study, "--recordings", recordings, *options)


def job(study, *options, **more):
    return run_json("corpus", "run", study, *options, **more)


def units(study):
    return sorted(path for path in pathlib.Path(study).glob("units/*/*") if path.is_dir())


def contents(study):
    """Every file below units, by name: its checksum."""
    root = pathlib.Path(study) / "units"
    return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest() for path in root.rglob("*") if path.is_file()}


def identity(study):
    """Of each unit: a unit that was made twice has another one."""
    return {unit.name: ((unit / "SHA256SUMS").stat().st_ino, (unit / "SHA256SUMS").stat().st_mtime_ns) for unit in units(study)}


def is_idle(study):
    return not (pathlib.Path(study) / "work").exists()


def an_unbroken_run_equals_the_verbs():
    made = init("whole")
    recordings = len(SURFACES) * COPIES
    assert made["recordings"] == recordings and made["skipped_other_files"] == 1, made
    assert run_json("corpus", "status", "whole", code=UNSUITABLE)["missing"] == recordings
    counts = job("whole")
    assert (counts["recordings"], counts["recordings_worked_on"], counts["results_made"], counts["results_already_there"]) == (recordings, recordings, 2 * recordings, 0), counts
    assert len(units("whole")) == 2 * recordings and is_idle("whole")
    status = run_json("corpus", "status", "whole")
    assert (status["done"], status["failed"], status["missing"]) == (recordings, 0, 0) and len(status["results"]) == 2 * recordings, status
    pathlib.Path("by-verbs").mkdir()
    for result in status["results"][::9]:
        recording = pathlib.Path("whole") / result["recording"]
        name = recording.stem
        if result["step"] == "spatial":
            run("spatial", recording, "-o", f"by-verbs/{name}/")
            wanted = pathlib.Path(f"by-verbs/{name}")
        else:
            run("spatial", recording, "-o", f"by-verbs/{name}-textures/")
            run("describe", f"by-verbs/{name}-textures", "-o", f"by-verbs/{name}-described/{name}")
            wanted = pathlib.Path(f"by-verbs/{name}-described")
        stored = {path.name: path.read_bytes() for path in pathlib.Path(result["folder"]).iterdir() if path.name not in ("SHA256SUMS", "warnings.txt")}
        assert stored and stored == {path.name: path.read_bytes() for path in wanted.iterdir()}, (result, sorted(stored))
        subprocess.run(["sha256sum", "--check", "--quiet", "--strict", "SHA256SUMS"], cwd=result["folder"], check=True)
    run("validate", "whole/plan.corpus.json")
    assert run_json("info", "whole/plan.corpus.json")["recordings"] == recordings
    before = identity("whole")
    again = job("whole", "--jobs", 2)
    assert (again["recordings_worked_on"], again["results_made"], again["results_already_there"]) == (0, 0, 2 * recordings) and identity("whole") == before, again


def options_are_those_of_the_verbs():
    """Also an average, which has other names; and the window of the description."""
    run("record", "-d", "sim:surface=E,speed=60mm/s,seed=3", "--time", "3s", "-o", "F")
    init("mean", "--spatial", "--average --band 30Hz..200Hz", "--describe", "--window 4mm", recordings="F.json")
    job("mean")
    found = {result["step"]: pathlib.Path(result["folder"]) for result in run_json("corpus", "status", "mean")["results"]}
    run("spatial", "F", "--average", "--band", "30Hz..200Hz", "-o", "by-verbs/mean/")
    run("describe", "by-verbs/mean", "--window", "4mm", "-o", "by-verbs/mean-described/F")
    for step, wanted in (("spatial", "by-verbs/mean"), ("describe", "by-verbs/mean-described")):
        for path in pathlib.Path(wanted).iterdir():
            assert (found[step] / path.name).read_bytes() == path.read_bytes(), (step, path)


def start(study, *options):
    return subprocess.Popen([COMMAND, "corpus", "run", study, *options, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def seen(study):
    """How far a run is: folders of units, published or in work."""
    return len(units(study)) + len(list(pathlib.Path(study).glob("work/*/*")))


def wait_until_seen(study, count, process):
    while process.poll() is None and seen(study) < count:
        time.sleep(0.001)


def killed_at_any_moment_it_ends_like_an_unbroken_run():
    chosen = random.Random(35)
    init("killed")
    all_units, killed = len(units("whole")), 0
    known = {}
    for _ in range(20):
        process = start("killed", "--jobs", str(chosen.randint(1, 2)))
        wait_until_seen("killed", len(units("killed")) + chosen.randint(1, 90), process)
        time.sleep(chosen.uniform(0, 0.02))
        process.kill()
        process.communicate()
        killed += process.returncode == -signal.SIGKILL
        now = identity("killed")
        assert known.items() <= now.items(), "a unit was made twice"
        known = now
        if len(known) == all_units:
            break
    assert killed > 0
    counts = job("killed")
    assert counts["results_made"] + counts["results_already_there"] == all_units and counts["results_already_there"] == len(known), (counts, len(known))
    assert known.items() <= identity("killed").items() and contents("killed") == contents("whole") and is_idle("killed")
    run("corpus", "status", "killed", "--verify")


def a_stopped_run_loses_nothing():
    init("stopped")
    process = start("stopped")
    wait_until_seen("stopped", 5, process)
    process.send_signal(signal.SIGTERM)
    counts = json.loads(process.communicate()[0])
    assert process.returncode == (UNSUITABLE if counts.get("stopped") else 0), (process.returncode, counts)
    assert counts["results_made"] == len(units("stopped")) >= 3 and is_idle("stopped"), counts
    rest = job("stopped")
    assert rest["results_already_there"] == counts["results_made"] and contents("stopped") == contents("whole"), rest


def two_runs_at_once_share_the_work():
    init("shared")
    counts = []
    for process in [start("shared", "--jobs", "2"), start("shared")]:
        counts.append(process)
    counts = [(process, json.loads(process.communicate()[0])) for process in counts]
    assert all(process.returncode == 0 for process, _ in counts), counts
    assert sum(count["results_made"] for _, count in counts) == len(units("whole")), counts
    assert contents("shared") == contents("whole") and is_idle("shared")


def shards_are_parts():
    init("parts")
    parts = [job("parts", "--shard", f"{i}/3") for i in (3, 1, 2)]
    assert [part["recordings"] for part in parts] == [16, 17, 17] and all(part["results_made"] == 2 * part["recordings"] for part in parts), parts
    assert contents("parts") == contents("whole")
    assert job("parts", "--shard", "77/77")["recordings"] == 0
    assert "shard" in run("corpus", "run", "parts", "--shard", "", code=USAGE)[1]  # a variable that is not set
    for wrong in ("0/3", "4/3", "3", "1/2/3", "a/b", "-1/3", "/"):
        assert wrong in run("corpus", "run", "parts", f"--shard={wrong}", code=USAGE)[1], wrong


def only_what_depends_on_a_change_is_made_again():
    recordings = len(SURFACES) * COPIES
    before = identity("parts")
    assert "--force" in run("corpus", "init", "parts", "--recordings", "raw/**/*.json", code=USAGE)[1]

    def made_with(*options):
        init("parts", "--force", *options)
        counts = job("parts", "--jobs", 2)
        return counts["results_made"], counts["results_already_there"]

    assert made_with("--describe", "--window 5mm") == (recordings, recordings)
    assert made_with("--spatial", "--band 20Hz..400Hz") == (2 * recordings, 0)
    assert made_with("--steps", "spatial") == (0, recordings)
    assert made_with() == (0, 2 * recordings)
    side = json.loads(pathlib.Path("raw/A0.json").read_text())
    text = pathlib.Path("raw/A0.json").read_text()
    pathlib.Path("raw/A0.json").write_text(json.dumps({**side, "notes": "wiped"}))
    assert made_with() == (2, 2 * recordings - 2)
    pathlib.Path("raw/A0.json").write_text(text)
    assert made_with() == (0, 2 * recordings)
    assert before.items() <= identity("parts").items()


def a_failure_is_noted_and_stops_nothing():
    for name in ("broken", "changed", "fine"):
        copy("B", f"odd/{name}")
    pathlib.Path("odd/torn.json").write_text(pathlib.Path("odd/fine.json").read_text()[:300])
    shutil.copy("odd/fine.wav", "odd/torn.wav")
    data = pathlib.Path("odd/broken.wav").read_bytes()
    pathlib.Path("odd/broken.wav").write_bytes(data[:-400] + bytes(400))
    init("odd-study", recordings="odd")
    text = pathlib.Path("odd/changed.json").read_text()
    pathlib.Path("odd/changed.json").write_text(text + "\n")
    counts = job("odd-study", "--jobs", 2)
    assert (counts["recordings"], counts["results_made"], counts["of_these_failures"]) == (5, 6, 4), counts
    status = run_json("corpus", "status", "odd-study", code=UNSUITABLE)
    assert (status["done"], status["failed"], status["missing"]) == (1, 4, 0) and "not_made" not in status, status
    because = {pathlib.Path(row["recording"]).stem: row["because"] for row in status["failures"]}
    assert set(because) == {"rest", "broken", "changed", "torn"} and all(row["step"] == "spatial" for row in status["failures"])
    assert "position" in because["rest"] and "SHA-256" in because["broken"] and "SHA-256" in because["changed"], because
    assert all("/" not in reason.split(":")[0] for reason in because.values()), because  # the same on every machine
    fine = identity("odd-study")
    # What its key covers will not change: a finger at rest is not tried again. The others are.
    again = job("odd-study")
    assert (again["results_made"], again["of_these_failures"], again["results_already_there"]) == (3, 3, 3), again
    pathlib.Path("odd/changed.json").write_text(text)
    pathlib.Path("odd/broken.wav").write_bytes(data)
    repaired = job("odd-study")
    assert (repaired["results_made"], repaired["of_these_failures"]) == (5, 1), repaired
    status = run_json("corpus", "status", "odd-study", code=UNSUITABLE)
    assert (status["done"], status["failed"]) == (3, 2), status
    kept = [unit for unit in fine if identity("odd-study").get(unit) == fine[unit]]
    assert len(kept) == 3, kept  # fine's two, and the finger at rest


def a_study_behind_a_link_and_a_folder_of_one_letter():
    pathlib.Path("far/away").mkdir(parents=True)
    pathlib.Path("link").symlink_to("far/away")
    pathlib.Path("m").mkdir()
    for name in ("A", "[1]"):
        copy("A", f"m/{name}")
    init("link", "--spatial", "--grid 100um --band 15Hz..2000Hz", recordings="m/[1].json")
    assert job("link")["recordings"] == 1
    init("link", "--force", "--spatial", "--grid 100um --band 15Hz..2000Hz", recordings="m")
    counts = job("link")
    assert counts["recordings"] == 2 and "of_these_failures" not in counts, counts
    warned = [path.read_text() for path in pathlib.Path("link").rglob("warnings.txt")]
    assert warned and all("mm/s" in text and "m/A" not in text for text in warned), warned
    assert "changed_since_init" not in run_json("corpus", "status", "link", "--verify")
    copy("B", "m/A")
    assert run_json("corpus", "status", "link")["done"] == 2
    assert len(run_json("corpus", "status", "link", "--verify", code=UNSUITABLE)["changed_since_init"]) == 1


def damaged_results_are_made_again():
    wanted = contents("shared")
    wav = sorted(pathlib.Path("shared/units").rglob("*.texture.wav"))[7]
    times = wav.stat()
    data = bytearray(wav.read_bytes())
    data[-3] ^= 1
    wav.write_bytes(data)
    os.utime(wav, ns=(times.st_atime_ns, times.st_mtime_ns + 10**12))  # later than its checksum
    status = run_json("corpus", "status", "shared", code=UNSUITABLE)
    assert status["missing"] == 1 and [row["damaged"] for row in status["not_made"]] == [True], status
    assert job("shared")["results_made"] == 1 and contents("shared") == wanted
    # A disk that loses a bit leaves the date: --verify reads everything.
    times = wav.stat()
    wav.write_bytes(data)
    os.utime(wav, ns=(times.st_atime_ns, times.st_mtime_ns))
    run("corpus", "status", "shared")
    assert run_json("corpus", "status", "shared", "--verify", code=UNSUITABLE)["missing"] == 1
    assert job("shared", "--verify")["results_made"] == 1 and contents("shared") == wanted
    wav.unlink()
    assert job("shared")["results_made"] == 1 and contents("shared") == wanted
    shutil.rmtree(wav.parent)
    assert job("shared")["results_made"] == 1 and contents("shared") == wanted


def foreign_plans_are_refused():
    path = pathlib.Path("foreign/plan.corpus.json")
    init("foreign", recordings="raw/A0")
    plan = json.loads(path.read_text())

    def refused(code, word, **changed):
        path.write_text(json.dumps({**plan, **changed}))
        _, err = run("corpus", "run", "foreign", code=code)
        assert word in err and err.count("\n") == 1 and not units("foreign") and is_idle("foreign"), (word, err)

    refused(UNSUITABLE, "tactograph 0.0.1", creator="tactograph 0.0.1")
    refused(MALFORMED, "#/jobs", jobs=2)
    refused(MALFORMED, "#/recordings/0/sha", recordings=[{**plan["recordings"][0], "sha": "1"}])
    refused(MALFORMED, "#/kind", kind="scene")
    refused(NEWER, "2.0", version="2.0")
    refused(MALFORMED, "#/steps/0/step", steps=plan["steps"][::-1])
    refused(MALFORMED, "#/steps/2/step", steps=[*plan["steps"], plan["steps"][1]])
    refused(USAGE, "--frob", steps=[{"step": "spatial", "options": "--frob"}])
    path.unlink()
    for part in ("run", "status"):
        assert "plan.corpus.json" in run("corpus", part, "foreign", code=NOT_FOUND)[1]
    for wrong in ("--frob", "--band nonsense", "-o x", "--jobs 2", "--list", "--quality high", "raw/A0", "--help"):
        run("corpus", "init", "foreign", "--recordings", "raw/A0", "--spatial", wrong, code=USAGE)
    run("corpus", "init", "foreign", "--recordings", "raw/A0", "--steps", "describe", code=USAGE)
    run("corpus", "init", "foreign", "--recordings", "raw/A0", "--steps", "spatial", "--describe", "--window 5mm", code=USAGE)
    for nothing in ("raw/*.texture.json", "nothere", "raw/deep/deeper/*.json"):
        assert nothing in run("corpus", "init", "foreign", "--recordings", nothing, code=NOT_FOUND)[1]
    run("corpus", "init", "rest.csv", "--recordings", "raw/A0", code=7)
    assert not path.exists()


def patterns_name_recordings():
    def found(*patterns):
        made = run_json("corpus", "init", "patterns", "--force", "--recordings", *patterns)["recordings"]
        paths = [each["path"] for each in json.loads(pathlib.Path("patterns/plan.corpus.json").read_text())["recordings"]]
        assert made == len(paths) == len(set(paths)) and all((pathlib.Path("patterns") / path).exists() for path in paths), paths
        return made

    assert found("raw") == found("raw/**/*.json") == found("raw", "raw/A0", "./raw/*.json") == 50
    assert found("raw/*.json") == found("raw/deep/*.json") == 25
    assert found("raw/**/[AB]?.json") == 20 and found("r*/deep/A1.json") == found(pathlib.Path("raw/A0.json").resolve()) == 1
    pathlib.Path("raw/.hidden").mkdir()
    copy("A", "raw/.hidden/A0")
    assert found("raw") == 50
    # From another folder, and after both folders have moved.
    pathlib.Path("place").mkdir()
    shutil.copytree("raw", "place/raw")
    run("corpus", "init", "study", "--recordings", "raw/A0.json", cwd="place")
    pathlib.Path("place").rename("other")
    assert job("other/study")["results_made"] == 2


def thousands_of_recordings_need_little_memory():
    """Links, as many as the largest published set has. In 472 folders, so that they are 40 inputs."""
    names = sorted(path.stem for path in pathlib.Path("raw").rglob("[A-D]?.json") if path.parent.name != ".hidden")
    for number in range(472):
        folder = pathlib.Path(f"many/{number:03}")
        folder.mkdir(parents=True)
        for name in names:
            source = next(path for path in (pathlib.Path(f"raw/{name}"), pathlib.Path(f"raw/deep/{name}")) if path.with_suffix(".json").exists())
            for ending in (".json", ".wav"):
                (folder / f"{name}{ending}").symlink_to(source.with_suffix(ending).resolve())
    peaks = {"init": peak_mb("corpus", "init", "thousands", "--recordings", "many/*/*.json")}
    assert job("thousands", "--jobs", 2)["results_made"] == 80
    assert run_json("corpus", "status", "thousands")["done"] == 18880
    for part in ("run", "status"):
        peaks[part] = peak_mb("corpus", part, "thousands")
    peaks["status --json"] = peak_mb("corpus", "status", "thousands", "--json")
    print(f"18,880 recordings, peaks of memory (MB): {peaks}")
    assert tacto.SANITIZED or max(peaks.values()) < 100, peaks


def all_of_it():
    write_recordings()
    for test in (an_unbroken_run_equals_the_verbs, options_are_those_of_the_verbs, killed_at_any_moment_it_ends_like_an_unbroken_run,
                 a_stopped_run_loses_nothing, two_runs_at_once_share_the_work, shards_are_parts,
                 only_what_depends_on_a_change_is_made_again, a_failure_is_noted_and_stops_nothing,
                 a_study_behind_a_link_and_a_folder_of_one_letter, damaged_results_are_made_again,
                 foreign_plans_are_refused, patterns_name_recordings, thousands_of_recordings_need_little_memory):
        test()
        print(f"{test.__name__}: passed")


if __name__ == "__main__":
    tacto.in_folder(all_of_it)
