#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark table: each stage here and in SciPy, measured in this run; and the memory of whole commands.

usage: table.py TACTOGRAPH BENCH_FOLDER [-o table.json]

CPU time, medians; of one thread, for `import_csv` of all its threads. Machines are shared and noisy: compare the columns of one run, not two runs.
"""
import argparse
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
CORPUS = 400  # recordings of the measured `corpus run`
PYTHON = "/usr/bin/python3"  # Debian's own: SciPy is installed for it
# stage -> its name in the table
STAGES = {
    "pchip_true_inverse": "PCHIP with true inverse (SciPy: axes swapped)",
    "zero_phase_sos": "zero-phase second-order sections, in time",
    "fourier_band_pass/60": "Fourier band-pass, 60 s",
    "fourier_band_pass/600": "Fourier band-pass, 600 s, in blocks",
    "packed_fftw_float": "peer: FFTW alone, float, two frames packed",
    "spectrogram_all_bins": "spectrogram, all 8,193 bins",
    "spectrogram_to_15_per_mm": "spectrogram up to 15 /mm (SciPy: decimated by hand)",
    "import_csv": "import of the recording's CSV (NumPy: loadtxt)",
    "recording_to_spectrogram": "recording to spectrogram up to 15 /mm, written",
    "design_of_16_patches": "design of 16 patches of four layers: at most 100 ms",
    "design_of_16_patches_simulated": "the same with simulated taps: at most 5 s",
    "adversary_of_10000_paths": "10,000 paths of an adversary: at most 200 ms",
}
# benchmark -> its name in the table, the most nanoseconds per place (issue of force scenes, x86 near 3 GHz)
PLACES = {
    "SceneReliefTwoLevels": ("gradient of a 4096 x 4096 map, two levels", 1000),
    "SceneReliefTwoLevelsCold": ("the same, places far from each other", 1000),
    "SceneFractalOf8Octaves": ("fractal of 8 octaves, value and gradient", 1000),
    "SceneSquareGrooves": ("square grooves of 64 harmonics", 1000),
    "SceneFieldOf2000Atoms": ("2,000 atoms summed", 10_000),
}


def progress(text):
    print(text, file=sys.stderr, flush=True)


def medians(folder):
    """Median CPU time in ms and the counters of every benchmark."""
    found = {}
    for bench in sorted(glob.glob(os.path.join(folder, "*_bench"))):
        progress(f"running {os.path.basename(bench)}")
        run = subprocess.run([bench, "--benchmark_format=json", "--benchmark_repetitions=5",
                              "--benchmark_report_aggregates_only=true"], stdout=subprocess.PIPE, check=True)
        for entry in json.loads(run.stdout)["benchmarks"]:
            if entry.get("aggregate_name") == "median":
                scale = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[entry["time_unit"]]
                name = entry["run_name"].removesuffix("/real_time").removesuffix("/process_time")
                found[name] = {**entry, "ms": entry["cpu_time"] * scale, "error": entry.get("error")}
    return found


def scipy_columns():
    progress("running SciPy's columns")
    return json.loads(subprocess.run([PYTHON, os.path.join(HERE, "scipy_columns.py")], stdout=subprocess.PIPE,
                                     check=True).stdout)


def peak_memory_mb(command, folder):
    """The largest resident size of a run."""
    child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = child.stderr.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"table.py: {' '.join(command)} failed: {said.decode()}")
    return usage.ru_maxrss / 1024


def write_csv(path, seconds):
    """In a process of its own: a child's peak includes its parent's memory at the fork, and this one has to stay
    small."""
    subprocess.run([PYTHON, os.path.join(HERE, "workload_csv.py"), path, str(seconds)], check=True)


def memory(tactograph):
    """Peak memory above an idle process in MB, by command and the recording's length."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        idle = peak_memory_mb([tactograph, "--version"], folder)
        for seconds in (60, 600):
            progress(f"memory of whole commands on {seconds} s")
            write_csv(os.path.join(folder, f"r{seconds}.csv"), seconds)
            name = f"r{seconds}"
            commands = {
                "import": ["import", f"{name}.csv", "-o", name, "--rate", "10kHz", "--channel", "tangential_force=2*1N",
                           "--channel", "position=3*1um"],
                "spatial": ["spatial", name, "-o", name],
                "spectrogram": ["spectrogram", name, "-o", f"{name}.nc"],
            }
            for verb, command in commands.items():
                rows[f"{verb}, {seconds} s"] = peak_memory_mb([tactograph, *command], folder) - idle
    return {"idle_mb": idle, "above_idle_mb": rows}


def corpus_rates(tactograph):
    """Recordings of 2 s at 10 kHz a second: {jobs: (by the clock, by CPU time)} of `corpus run`, step spatial."""
    rates = {}
    with tempfile.TemporaryDirectory() as folder:
        progress(f"corpus run on {CORPUS} recordings")
        os.mkdir(os.path.join(folder, "raw"))
        for surface in "ABCDE":
            subprocess.run([tactograph, "record", "-d", f"sim:surface={surface},seed=3", "--time", "2s", "-o", surface], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, f"{surface}.json"), encoding="utf-8") as file:
                side = json.load(file)
            for i in range(CORPUS // 5):
                name = f"{surface}{i}"
                side["data"]["file"] = f"{name}.wav"
                shutil.copy(os.path.join(folder, f"{surface}.wav"), os.path.join(folder, "raw", f"{name}.wav"))
                with open(os.path.join(folder, "raw", f"{name}.json"), "w", encoding="utf-8") as file:
                    json.dump(side, file)
        for jobs in (1, 2):
            study = f"study{jobs}"
            subprocess.run([tactograph, "corpus", "init", study, "--recordings", "raw", "--steps", "spatial"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            began, before = time.monotonic(), os.times()
            subprocess.run([tactograph, "corpus", "run", study, "--jobs", str(jobs)], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            after = os.times()
            cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
            rates[jobs] = (CORPUS / (time.monotonic() - began), CORPUS / cpu_s)
    return rates


def print_table(ours, theirs, used, corpus):
    print(f"{'stage':56} {'SciPy':>10} {'here':>10} {'ratio':>7}   error")
    for stage, title in STAGES.items():
        mine, other = ours[stage], theirs.get(stage)
        beside = f"{other:8.1f}ms" if other else " " * 10
        ratio = f"{other / mine['ms']:6.1f}x" if other else " " * 7
        error = "" if mine["error"] is None else f"   {mine['error']:.2g}"
        print(f"{title:56} {beside} {mine['ms']:8.1f}ms {ratio}{error}")
    peer = ours["spectrogram_all_bins"]["ms"] / ours["packed_fftw_float"]["ms"]
    print(f"\nspectrogram of all bins against FFTW alone: {peer:.2f} times")
    print(f"\n{'a place of a force scene':56} {'at most':>10} {'median':>10} {'p99':>10}")
    for stage, (title, most_ns) in PLACES.items():
        print(f"{title:56} {most_ns:8}ns {ours[stage]['ns_per_place']:8.0f}ns {ours[stage]['p99_ns_per_place']:8.0f}ns")
    print()
    for pause, iterations, most in ((0, 200000, "1.2; 4"), (1, 10000, "4; 15")):
        mesh = ours[f"GhostOnMeshOf99856/pause_ms:{pause}/iterations:{iterations}"]
        title = "ghost point, 99,856 triangles, 0.2 m/s, 1 mm deep" + (", at 1 kHz" if pause else "")
        print(f"{title:64} median {mesh['median_ns'] / 1e3:.2f} us, p99 {mesh['p99_ns'] / 1e3:.2f} us (at most {most})")
    print(f"  force within {mesh['worst_angle_mrad']:.1f} mrad of the ball's normal (half angle of a facet: 14.0); along the motion, without friction, of 1 N: "
          f"{abs(mesh['tangential_mean']):.5f} N in the mean (at most 0.001), {mesh['tangential_ripple']:.4f} N from tick to tick")
    for points, most, ticks in ((1, 0.3, 200000), (1000, 20, 20000)):
        volume = ours[f"TouchVolume/{points}/iterations:{ticks}"]
        title = f"volume of 256^3 values, {points} point" + "s" * (points > 1)
        print(f"{title:64} median {volume['median_ns'] / 1e3:.2f} us, p99 {volume['p99_ns'] / 1e3:.2f} us (median at most {most})")
    for kept, title, most in ((0, "clay, its surface and a press", 0.2), (1, "the same, its volume kept", 0.3)):
        clay = ours[f"PressClay/{kept}/iterations:200000"]
        print(f"{title:64} median {clay['median_ns'] / 1e3:.2f} us, p99 {clay['p99_ns'] / 1e3:.2f} us (median at most {most})")
    clock = {jobs: rate for jobs, (rate, _) in corpus.items()}
    print(f"\ncorpus run, spatial, {CORPUS} recordings of 2 s at 10 kHz: {clock[1]:.0f} a second by one job (at least 60), {clock[2]:.0f} by two, "
          f"{clock[2] / clock[1]:.2f} times (at least 1.9); a second of CPU makes {corpus[1][1]:.0f}, with two jobs {corpus[2][1]:.0f}")
    print(f"\npeak memory above an idle process ({used['idle_mb']:.0f} MB):")
    for what, mb in used["above_idle_mb"].items():
        print(f"  {what:24} {mb:6.1f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tactograph")
    parser.add_argument("benches")
    parser.add_argument("-o", "--output", help="also write the figures as JSON")
    arguments = parser.parse_args()
    ours, theirs = medians(arguments.benches), scipy_columns()
    missing = [stage for stage in (*STAGES, *PLACES) if stage not in ours]
    if missing:
        raise SystemExit(f"table.py: no benchmark is named {', '.join(missing)}")
    tactograph = os.path.abspath(arguments.tactograph)
    used, corpus = memory(tactograph), corpus_rates(tactograph)
    print_table(ours, theirs, used, corpus)
    if arguments.output:
        with open(arguments.output, "w", encoding="utf-8") as file:
            json.dump({"here": ours, "scipy_ms": theirs, "memory": used, "corpus_per_s": corpus}, file, indent=1)


if __name__ == "__main__":
    main()
