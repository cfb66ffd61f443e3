#!/usr/bin/env python3
"""Measures everything that docs/benchmarks.md shows. script/bench builds what this needs, and calls it."""

import argparse
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import report

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)


class Trouble(Exception):
    """A program that did not do what it was asked to."""


def run(command, cwd=None, accept=(0,)):
    """Runs a program to its end. What it said, the time of the whole process, and its largest memory."""
    with tempfile.TemporaryFile() as said:
        start = time.perf_counter()
        process = subprocess.Popen(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode(errors="replace")
    if process.returncode not in accept:
        raise Trouble(f"{' '.join(command)}\nended with {process.returncode}:\n{text[-2000:]}")
    return {"wall": seconds, "peak": usage.ru_maxrss * 1024, "text": text, "code": process.returncode}


def times(values):
    return {"median": statistics.median(values), "min": min(values), "max": max(values), "all": values}


def found(pattern, text, whose):
    match = re.findall(pattern, text)
    if not match:
        raise Trouble(f"{whose} did not say how long it took:\n{text[-2000:]}")
    return float(match[-1])


# ---- the programs that are measured


class Lambent:
    def __init__(self, build, scratch, threads):
        self.program = os.path.join(build, "lambent")
        self.bare_rays = os.path.join(build, "bench", "bare_rays")
        self.kernels = os.path.join(build, "bench", "kernels_bench")
        self.big_model = os.path.join(build, "bench", "big_model")
        self.scratch, self.threads = scratch, threads

    def render(self, scene, *options, threads=None):
        stats = os.path.join(self.scratch, "stats.json")
        done = run([self.program, "render", scene, "-o", os.path.join(self.scratch, "lambent.png"), "--quiet",
                    "--threads", str(threads or self.threads), "--stats", stats, *options])
        with open(stats, encoding="utf-8") as file:
            said = json.load(file)
        return {"render": said["seconds"]["render"], "build": said["seconds"]["build"], "load": said["seconds"]["parse"],
                "rays": said["rays"], "isa": said["isa"], "wall": done["wall"], "peak": done["peak"]}

    def bare(self, scene, *options):
        out = os.path.join(self.scratch, "bare.json")
        arguments = list(options)
        if "--threads" not in arguments:
            arguments += ["--threads", str(self.threads)]
        run([self.bare_rays, scene, "--json", out, *arguments])
        with open(out, encoding="utf-8") as file:
            return json.load(file)


class PovRay:
    name = "POV-Ray"
    program = "povray"

    def version(self):
        return re.search(r"POV-Ray (\d[\d.]*\d)", run(["povray", "--version"])["text"]).group(1)

    def render(self, folder, scene, samples, threads, out):
        # 16 samples: the 4 x 4 grid of the non-adaptive method, in every pixel, without jitter.
        smooth = ["-A"] if samples == 1 else ["+A0.0", "+AM1", f"+R{round(samples**0.5)}", "-J"]
        done = run(["povray", f"+I{scene}.pov", f"+O{out}.png", "+W1280", "+H720", "-D", f"+WT{threads}",
                    "File_Gamma=srgb", *smooth], cwd=folder)
        return found(r"Trace Time:.*\(([\d.]+) seconds\)", done["text"], self.name), done


class Tachyon:
    name = "Tachyon"
    program = "tachyon"

    def version(self):
        return re.search(r"([0-9][\w.]+)", run(["tachyon", "-version"], accept=range(256))["text"]).group(1)

    def render(self, folder, scene, samples, threads, out):
        done = run(["tachyon", f"{scene}.dat", "-numthreads", str(threads), "-shade_phong", "-aasamples",
                    str(samples - 1), "-format", "PPM", "-o", f"{out}.ppm"], cwd=folder)
        return found(r"Ray Tracing Time:\s*([\d.]+) seconds", done["text"], self.name), done


class Cycles:
    name = "Cycles"
    program = "blender"

    def version(self):
        return re.search(r"Blender ([\d.]+)", run(["blender", "--version"])["text"]).group(1)

    def render(self, folder, scene, samples, threads, out):
        done = run(["blender", "-b", "--factory-startup", "-noaudio", "--debug-cycles", "--python-exit-code", "1",
                    "--python", os.path.join(HERE, "render_with_cycles.py"), "--", os.path.join(folder, f"{scene}.json"),
                    f"{out}.png", str(samples), str(threads)])
        return found(r"Render time \(without synchronization\): ([\d.]+)", done["text"], self.name), done


# ---- what is measured

COMPARED = ("flake", "flake_mirror", "knot", "knot_mirror")


def compare(bench, lambent, peers, folder, quick):
    """Lambent, the bare queries of its rays, and each peer in turn; round by round."""
    cases = {}
    for samples in (1, 16):
        for turn in range(3):
            for scene in COMPARED:
                rounds = 1 if quick else 3 if samples == 1 else 1 if scene.endswith("_mirror") else 2
                if turn >= rounds or quick and samples > 1 and scene.endswith("_mirror"):
                    continue
                case = cases.setdefault(f"{scene}/{samples}", {"lambent": [], "bare": [], "peers": {}})
                bench.say(f"{scene}, {samples} sample{'s' if samples > 1 else ''}, round {turn + 1} of {rounds}")
                path = os.path.join(folder, f"{scene}.yaml")
                case["lambent"].append(lambent.render(path, "--samples", str(samples)))
                # All variants of Embree once; then those that win.
                variants = ["--runs", "2" if samples > 1 else "3", *(["--few"] if samples > 1 or turn > 0 else [])]
                case["bare"].append(lambent.bare(path, "--set", f"image.samples={samples}", *variants))
                for peer in peers:
                    if quick and samples > 1:
                        continue
                    seconds, done = peer.render(folder, scene, samples, lambent.threads,
                                                os.path.join(folder, f"{scene}_{peer.program}"))
                    case["peers"].setdefault(peer.name, []).append(
                        {"render": seconds, "wall": done["wall"], "peak": done["peak"]})
    return cases


def point(x, bare):
    return {"x": x, "frame": bare["lambent"]["seconds"], "bare_robust": bare["bare_robust"]["seconds"],
            "own_queries": bare["own_queries"]["seconds"], "rays": bare["rays"], "build": bare["lambent"]["build_seconds"],
            "bytes": bare["bytes"]}


def curves(bench, lambent, folder, quick):
    at = {name: os.path.join(folder, f"{name}.yaml") for name in ("flake", "knot", "between_mirrors")}
    runs = ["--few", "--runs", "2" if quick else "3"]
    found_points = {}

    def measure(curve, x, scene, *options):
        bench.say(f"{curve}: {x}")
        found_points.setdefault(curve, []).append(point(x, lambent.bare(scene, *runs, *options)))

    for triangles in bench.triangles:
        measure("triangles", triangles, os.path.join(folder, f"knot_{triangles}.yaml"))
    for width, height in ((320, 180), (640, 360), (1280, 720), (2560, 1440), (3840, 2160))[:3 if quick else 5]:
        for scene in ("flake", "knot"):
            measure(f"pixels, {scene}", width * height, at[scene], "--set", f"image.size=[{width}, {height}]")
    for samples in (1, 2, 4) if quick else (1, 2, 4, 8, 16):
        for scene in ("flake", "knot"):
            measure(f"samples, {scene}", samples, at[scene], "--set", f"image.samples={samples}")
    for lights in bench.lights:
        measure("lights", lights, os.path.join(folder, f"lights_{lights}.yaml"))
    for depth in range(1, 9):
        measure("depth", depth, at["between_mirrors"], "--set", f"integrator.whitted.max_depth={depth}")
    return found_points


def threads_curve(bench, lambent, folder, quick):
    """One thread, two, and so on to all there are; interleaved, as this is a ratio that must be right."""
    counts = sorted({1, *(2**i for i in range(1, 10) if 2**i < bench.cores), bench.cores})
    result = {}
    for scene in ("flake", "knot"):
        bench.say(f"threads, {scene}")
        runs = {n: [] for n in counts}
        for _ in range(3 if quick else 7):
            for n in counts:
                one = lambent.render(os.path.join(folder, f"{scene}.yaml"), "--samples", "4", threads=n)
                runs[n].append(one["render"])
        result[scene] = [{"x": n, "frame": times(runs[n])} for n in counts]
    return result


def kernels(bench, lambent, quick):
    bench.say("kernels")
    run([lambent.kernels, "--benchmark_format=json", "--benchmark_repetitions=3",
                f"--benchmark_min_time={0.05 if quick else 0.2}", "--benchmark_out=" +
                os.path.join(lambent.scratch, "kernels.json")])
    with open(os.path.join(lambent.scratch, "kernels.json"), encoding="utf-8") as file:
        measured = json.load(file)
    lanes = dict(line.split() for line in run([lambent.kernels, "--list"])["text"].splitlines())
    parts = {name: {"lanes": int(n), "seconds": []} for name, n in lanes.items()}
    for one in measured["benchmarks"]:
        if one["run_type"] == "iteration":
            parts[one["run_name"]]["seconds"].append(one["per_lane"])
    isa = measured["context"]["isa"]
    if not shutil.which("valgrind"):
        bench.say("valgrind is not there: instructions are not counted")
        return {"isa": isa, "counted_isa": None, "parts": parts}
    counted = "avx2" if isa == "avx512" else isa  # valgrind knows no AVX-512
    for name, part in parts.items():
        bench.say(f"instructions of {name}")
        steps = 1 if part["lanes"] > 1000 else 2000

        def instructions(n, name=name):
            said = run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", lambent.kernels, "--isa",
                        counted, "--count", name, str(n)])["text"]
            return int(re.search(r"I\s+refs:\s+([\d,]+)", said).group(1).replace(",", ""))
        part["instructions"] = (instructions(2 * steps) - instructions(steps)) / (steps * part["lanes"])
    return {"isa": isa, "counted_isa": counted, "parts": parts}


def data_folder():
    """The files of others, as the tests look for them."""
    folder = os.environ.get("LAMBENT_DATA") or os.path.join(os.path.dirname(ROOT), "shared", "data")
    return folder if os.path.isdir(folder) else None


def others_scenes(bench, lambent, quick):
    """Haines' SPD and the FlightHelmet, where they are found; and why not, where they cannot be read."""
    folder = data_folder()
    if not folder:
        bench.say("the data of others is not here (LAMBENT_DATA): no SPD, no FlightHelmet")
        return None
    result = {}
    spd = os.path.join(folder, "nff", "spd")
    names = ("balls_s4_c", "gears_s4_c", "mount_s6_c", "rings_s7_c", "teapot_s12_c", "tetra_s6_c", "tree_s11_c")
    scenes = {name: os.path.join(spd, name + ".nff") for name in names}
    helmet = [os.path.join(at, name) for at, _, files in os.walk(folder) for name in files
              if re.fullmatch(r"FlightHelmet\.(obj|gltf|glb)", name)]
    if helmet:
        scenes["FlightHelmet"] = min(helmet, key=lambda path: path.endswith("gltf"))
    for name, path in scenes.items():
        if not os.path.exists(path):
            continue
        bench.say(name)
        one = result.setdefault(name, {})
        # Coloured shadows ask more than one query for each shadow ray; here each ray is one query, for all.
        plain = ["--set", "integrator.whitted.colored_shadows=false"]
        try:
            one["lambent"] = [lambent.render(path, *plain) for _ in range(1 if quick else 3)]
        except Trouble:
            one["trouble"] = "Lambent cannot read this file"
            continue
        try:
            one["bare"] = lambent.bare(path, "--few", "--runs", "3", *plain)
        except Trouble as trouble:
            one["trouble"] = str(trouble).strip().rsplit("\n", 1)[-1].removeprefix("bare_rays: ")
    return result


def memory(bench, lambent, folder):
    bench.say("memory")
    knot = os.path.join(folder, "knot.yaml")
    only = {}
    for side in ("lambent", "embree"):
        only[side] = lambent.bare(knot, "--only", side)
    return {"whole_process": lambent.render(knot)["peak"], "lambent": only["lambent"], "embree": only["embree"]}


def layers(bench, lambent, folder, quick):
    """What keeping the colours' parts apart costs: render times, the files' encoding left out."""
    result = {}
    for scene in ("flake", "flake_mirror", "knot"):
        bench.say(f"layers, {scene}")
        path = os.path.join(folder, scene + ".yaml")
        exr = os.path.join(lambent.scratch, "layers.exr")
        result[scene] = [{"without": lambent.render(path)["render"],
                          "with": lambent.render(path, "--layers", "-o", exr)["render"]} for _ in range(2 if quick else 7)]
    return result


def big(bench, lambent, folder, quick):
    """A model file of a million triangles: reading it, building its tree, and the memory of the whole."""
    bench.say("big model")
    path = os.path.join(folder, "big.obj")
    out = os.path.join(lambent.scratch, "big.json")
    run([lambent.big_model, path, "--json", out, "--runs", "2" if quick else "7"])
    with open(out, encoding="utf-8") as file:
        measured = json.load(file)
    measured["file_bytes"] = os.path.getsize(path)
    measured["render"] = lambent.render(path)
    return measured


def startup(bench, lambent, folder):
    bench.say("one sphere, whole process")
    out = os.path.join(lambent.scratch, "one_sphere.png")
    return times([run([lambent.program, "render", os.path.join(folder, "one_sphere.yaml"), "-o", out, "--quiet"])["wall"]
                  for _ in range(20)])


def machine(build):
    """What it is measured on; nothing that names the machine."""
    def first(path, pattern, otherwise):
        try:
            with open(path, encoding="utf-8") as file:
                match = re.search(pattern, file.read(), re.M)
            return match.group(1) if match else otherwise
        except OSError:
            return otherwise

    compiler = first(os.path.join(build, "CMakeCache.txt"), r"^CMAKE_CXX_COMPILER:\w+=(.*)$", "c++")
    return {
        "processor": first("/proc/cpuinfo", r"^model name\s*: (.*)$", platform.machine()),
        "cores": len(os.sched_getaffinity(0)),
        "memory_bytes": int(first("/proc/meminfo", r"^MemTotal:\s*(\d+) kB", "0")) * 1024,
        "system": first("/etc/os-release", r'^PRETTY_NAME="?([^"\n]*)', platform.system()),
        "compiler": run([compiler, "--version"])["text"].splitlines()[0],
        "load_before": os.getloadavg()[0],
    }


PARTS = ("startup", "big", "cases", "layers", "memory", "threads", "others", "curves", "kernels")


class Bench:
    def __init__(self, quick):
        self.cores = len(os.sched_getaffinity(0))
        self.start = time.monotonic()
        self.triangles = [1000, 10_000, 100_000, 1_000_000] + ([] if quick else [10_000_000])
        self.lights = [1, 10, 100] if quick else [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]

    def say(self, text):
        minutes, seconds = divmod(int(time.monotonic() - self.start), 60)
        print(f"{minutes:3}:{seconds:02} {text}", flush=True)


def main():
    parser = argparse.ArgumentParser(prog="script/bench", allow_abbrev=False)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--no-curves", action="store_true")
    parser.add_argument("--again", action="append", choices=PARTS)
    parser.add_argument("-o", metavar="DIR", dest="out")
    parser.add_argument("--build", help=argparse.SUPPRESS)
    parser.add_argument("--check-arguments", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.check_arguments:
        return 0
    bench = Bench(options.quick)
    folder = os.path.join(options.build, "scenes")
    scratch = os.path.join(options.build, "scratch")
    os.makedirs(scratch, exist_ok=True)

    peers = []
    if not options.no_peers:
        for peer in (Tachyon(), PovRay(), Cycles()):
            if shutil.which(peer.program):
                peers.append(peer)
            else:
                bench.say(f"{peer.name} is not there and is left out; script/bootstrap --peers installs it")

    bench.say("scenes")
    make = [sys.executable, os.path.join(HERE, "make_scenes.py"), folder, *(["--peers"] if peers else [])]
    if not options.no_curves:
        make += ["--triangles", *map(str, bench.triangles), "--lights", *map(str, bench.lights)]
    run(make)

    lambent = Lambent(options.build, scratch, bench.cores)
    results = {"machine": machine(options.build), "quick": options.quick,
               "peers": {peer.name: peer.version() for peer in peers}}
    path = os.path.join(options.build, "results.json")

    def keep(name, measured):
        """After each part, so that a run that is broken off has not been for nothing."""
        results[name] = measured
        if not options.again:
            results["minutes"] = (time.monotonic() - bench.start) / 60
        with open(path, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)

    measure = {
        "startup": lambda: startup(bench, lambent, folder),
        "big": lambda: big(bench, lambent, folder, options.quick),
        "cases": lambda: compare(bench, lambent, peers, folder, options.quick),
        "layers": lambda: layers(bench, lambent, folder, options.quick),
        "memory": lambda: memory(bench, lambent, folder),
        "threads": lambda: threads_curve(bench, lambent, folder, options.quick),
        "others": lambda: others_scenes(bench, lambent, options.quick),
        "curves": lambda: None if options.no_curves else curves(bench, lambent, folder, options.quick),
        "kernels": lambda: kernels(bench, lambent, options.quick),
    }
    if options.again:
        with open(path, encoding="utf-8") as file:
            results = json.load(file)
    for name in PARTS:
        if not options.again or name in options.again:
            keep(name, measure[name]())
    out = options.out or (os.path.join(options.build, "report") if options.quick else os.path.join(ROOT, "docs"))
    report.write(results, out, os.path.join(HERE, "notes.md"))
    bench.say(f"{path}, {os.path.join(out, 'benchmarks.md')}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Trouble as trouble:
        print(f"bench: {trouble}", file=sys.stderr)
        sys.exit(1)
