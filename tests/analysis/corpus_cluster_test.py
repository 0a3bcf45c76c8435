#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`corpus workflow` on Slurm and Snakemake themselves: a task is killed, the rest is resumed, and the results are those of one core.

Slurm runs as one node on 127.0.0.1, without systemd; that needs root. What is not installed is reported as skipped.
"""
import hashlib
import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time

import tacto
from tacto import COMMAND, run, run_json

SKIPPED, UNSUITABLE = 77, 5
SHARDS, COPIES = 4, 120  # a shard takes some time, so that it can be killed in the middle
NEEDED = {"slurm": ["slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "munged"], "snakemake": ["snakemake"]}
os.environ["SOURCE_DATE_EPOCH"] = "1700000000"
os.environ["PATH"] += ":/usr/sbin"


def write_recordings():
    pathlib.Path("raw").mkdir()
    run("record", "-d", "sim:surface=B,speed=60mm/s,seed=3", "--time", "2s", "-o", "B")
    for number in range(COPIES):
        shutil.copy("B.json", f"raw/{number}.json")
        pathlib.Path(f"raw/{number}.json").write_text(pathlib.Path("B.json").read_text().replace('"B.wav"', f'"{number}.wav"'))
        shutil.copy("B.wav", f"raw/{number}.wav")
    pathlib.Path("bin").mkdir()
    pathlib.Path("bin/tactograph").symlink_to(pathlib.Path(COMMAND).resolve())
    os.environ["PATH"] = f"{pathlib.Path('bin').resolve()}:{os.environ['PATH']}"
    run("corpus", "init", "one-core", "--recordings", "raw")
    run("corpus", "run", "one-core")


def contents(study):
    root = pathlib.Path(study) / "units"
    return {str(path.relative_to(root)): hashlib.sha256(path.read_bytes()).hexdigest() for path in root.rglob("*") if path.is_file()}


def wait_for(what, found, seconds=120):
    """These programs answer after seconds; the limit only ends a test that would never end."""
    for _ in range(seconds * 20):
        if found():
            return
        time.sleep(0.05)
    raise AssertionError(f"{what}: not within {seconds} s")


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def processes_of(study):
    """The processes `corpus run` of this study that a cluster has started."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            where = os.readlink(folder / "cwd")
        except OSError:
            continue
        if b"run" in words and (str(pathlib.Path(study).resolve()).encode() in words or where == str(pathlib.Path(study).resolve())) and b"--shard" in words:
            found.append(int(folder.name))
    return found


def kill_one_in_the_middle(study):
    """kill -9 of one task that has begun to compute."""
    wait_for("a task that computes", lambda: processes_of(study) and list(pathlib.Path(study).glob("work/*/*")))
    victim = processes_of(study)[0]
    os.kill(victim, signal.SIGKILL)


def resume_of(file):
    return next(line for line in pathlib.Path(file).read_text().splitlines() if line.startswith("# ") and "--missing" in line).split("tactograph", 1)[1]


class Cluster:
    """munged, slurmctld and slurmd in a folder of their own."""

    def __init__(self):
        self.folder = pathlib.Path("slurm").resolve()
        self.programs = []

    def __enter__(self):
        for name in ("state", "spool", "munge"):
            (self.folder / name).mkdir(parents=True, mode=0o700)
        key = self.folder / "munge/key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        munge = self.folder / "munge"
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge}/socket", f"--pid-file={munge}/pid", f"--log-file={munge}/log",
                   f"--seed-file={munge}/seed", "--num-threads=1")
        wait_for("munged", (munge / "socket").exists)
        with socket.socket() as a, socket.socket() as b:
            a.bind(("127.0.0.1", 0))
            b.bind(("127.0.0.1", 0))
            ports = a.getsockname()[1], b.getsockname()[1]
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(f"""ClusterName=tactograph
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
AuthInfo=socket={munge}/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
MinJobAge=3600
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=500 State=UNKNOWN
PartitionName=short Nodes={host} Default=YES MaxTime=60 State=UP
""")
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D", "-N", host)
        wait_for("a node that is idle", lambda: " idle" in subprocess.run(["sinfo", "-h", "-o", " %T"], capture_output=True, text=True).stdout)
        return self

    def start(self, *command):
        log = open(self.folder / f"{command[0]}.out", "w")
        self.programs.append(subprocess.Popen(command, stdout=log, stderr=log))

    def __exit__(self, kind, *_):
        for program in reversed(self.programs):
            program.terminate()
            try:
                program.wait(20)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        if kind:
            for log in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")):
                print(f"--- {log.name}\n{log.read_text(errors='replace')[-3000:]}")


def submit(file):
    job = output("sbatch", "--parsable", file).strip()
    return job


def wait_for_job(job):
    wait_for(f"job {job}", lambda: output("squeue", "-h", "-j", job).strip() == "")


def states_of(job):
    """Of each task, by Slurm."""
    return sorted(line.split("JobState=")[1].split()[0] for line in output("scontrol", "show", "job", job).splitlines() if "JobState=" in line)


def slurm_resumes():
    with Cluster():
        run("corpus", "init", "slurm-study", "--recordings", "raw")
        run("corpus", "workflow", "slurm-study", "--engine", "slurm", "--shards", SHARDS, "--partition", "short", "--time", "10", "-o", "job")
        job = submit("job")
        kill_one_in_the_middle("slurm-study")
        wait_for_job(job)
        states = states_of(job)
        assert len(states) == SHARDS and states.count("FAILED") == 1 and states.count("COMPLETED") == SHARDS - 1, states
        missing = run_json("corpus", "status", "slurm-study", code=UNSUITABLE)["missing"]
        assert 0 < missing <= COPIES / SHARDS, missing
        subprocess.run(["bash", "-c", "tactograph" + resume_of("job")], check=True, stdout=subprocess.DEVNULL)
        job = submit("job")
        wait_for_job(job)
        assert states_of(job) == ["COMPLETED"], states_of(job)  # one task: the shard that lacked units
        run("corpus", "status", "slurm-study", "--verify")
        assert contents("slurm-study") == contents("one-core")


def slurm_stops_without_loss():
    """SIGTERM to the batch script, as Slurm sends it before the time limit."""
    with Cluster():
        run("corpus", "init", "limited", "--recordings", "raw")
        run("corpus", "workflow", "limited", "--engine", "slurm", "--shards", 1, "-o", "job1")
        job = submit("job1")
        wait_for("a task that computes", lambda: list(pathlib.Path("limited").glob("work/*/*")))
        output("scancel", "--batch", "--signal=TERM", f"{job}_1")
        wait_for_job(job)
        assert states_of(job) == ["FAILED"], states_of(job)
        kept = contents("limited")
        assert kept and kept.items() < contents("one-core").items() and not (pathlib.Path("limited") / "work").exists()


def snakemake_resumes():
    run("corpus", "init", "snake", "--recordings", "raw")
    run("corpus", "workflow", "snake", "--engine", "snakemake", "--shards", SHARDS, "--time", "10", "--mem", "400M", "-o", "Snakefile")
    command = ["snakemake", "--snakefile", "Snakefile", "--cores", "2", "--nocolor"]
    started = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    kill_one_in_the_middle("snake")
    said = started.communicate()[0]
    assert started.returncode != 0, said
    started = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for("a task that computes", lambda: processes_of("snake"))
    started.kill()  # Snakemake itself: its lock stays
    started.wait()
    for process in processes_of("snake"):
        os.kill(process, signal.SIGKILL)
    wait_for("the end of the tasks", lambda: not processes_of("snake"))
    assert run_json("corpus", "status", "snake", code=UNSUITABLE)["missing"] > 0
    assert subprocess.run(command, capture_output=True).returncode != 0  # locked
    subprocess.run([*command, "--unlock"], check=True, capture_output=True)
    subprocess.run(["bash", "-c", "tactograph" + resume_of("Snakefile")], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    run("corpus", "status", "snake", "--verify")
    assert contents("snake") == contents("one-core")
    assert not list(pathlib.Path("snake").glob("shards/*")), "markers stay, so a later run would do nothing"


def all_of_it():
    lacking = {engine: [program for program in programs if not shutil.which(program)] for engine, programs in NEEDED.items()}
    if os.geteuid() != 0:
        lacking["slurm"].append("root")
    if all(lacking.values()):
        print(f"skipped: not here: {lacking}")
        sys.exit(SKIPPED)
    write_recordings()
    for engine, tests in (("snakemake", [snakemake_resumes]), ("slurm", [slurm_resumes, slurm_stops_without_loss])):
        if lacking[engine]:
            print(f"not judged: {engine}: not here: {', '.join(lacking[engine])}")
            continue
        for test in tests:
            shutil.rmtree("slurm", ignore_errors=True)
            test()
            print(f"{test.__name__}: passed")


if __name__ == "__main__":
    tacto.in_folder(all_of_it)
