#!/usr/bin/env python3
"""How fast paths converge: Lambent, Mitsuba 3 and Blender's Cycles on the same scenes, error against time; and whether
they compute the same.

Each program renders each scene (converge_scenes.py) some times with many samples a pixel and other seeds each time. The
means of these pictures are compared pixel by pixel: z is the difference over its standard error, so that a mean square
near 1 says that two programs compute the same. All of these together are the converged reference; the error of a
picture of fewer samples is the root mean square of its difference from the reference, over the reference's mean.
script/converge calls this.

Mitsuba (pip install mitsuba) and Cycles (pip install bpy) run in processes of their own, converge_mitsuba.py and
converge_cycles.py, with the Pythons that PYTHON_MITSUBA and PYTHON_CYCLES name.
"""

import argparse
import json
import math
import os
import platform
import re
import resource
import statistics
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy

import svg
from converge_scenes import SCENES

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = 96  # pixels
TILE = 12
CONVERGED = 8  # pictures


def lambent_scene(scene):
    """The scene as Lambent's file: JSON is YAML."""
    def material_of(m):
        if "metal" in m:
            return {"metallic_roughness": {"base_color": 1, "metallic": 1, "roughness": m["metal"]}}
        if "glass" in m:
            return {"glass": {"ior": m["glass"]}}
        return {"ambient": 0, "diffuse": m.get("matt", 0), "reflect": m.get("mirror", 0), "emission": m.get("shines", 0)}

    # A lamp's color is what the whole of it gives on its axis from afar: its radiance is pi color / area.
    lights = []
    for lamp in scene["lamps"]:
        area = numpy.linalg.norm(numpy.cross(lamp["u"], lamp["v"]))
        lights.append({"rectangle": {"center": lamp["center"], "u": lamp["u"], "v": lamp["v"],
                                     "color": [c * area / math.pi for c in lamp["radiance"]]}})
    if scene["sun"]:
        lights.append({"directional": {"direction": [-v for v in scene["sun"]["to"]],
                                       "color": [c / math.pi for c in scene["sun"]["irradiance"]]}})
    return {
        "lambent": 1,
        "camera": {"eye": scene["eye"], "target": scene["target"], "fov": scene["fov"]},
        "image": {"size": [SIZE, SIZE]},
        "integrator": {"path": {"max_depth": scene["depth"], "roulette_depth": scene["depth"]}},
        "background": scene["sky"],
        "lights": lights,
        "objects": [{"mesh": {"vertices": thing["vertices"], "triangles": thing["faces"]},
                     "material": material_of(thing["material"])} for thing in scene["things"]],
    }


class Lambent:
    name = "Lambent"

    def __init__(self, program, scratch, threads):
        self.program, self.scratch, self.threads = program, scratch, threads
        said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
        self.version = said.splitlines()[0].strip()

    def prepare(self, scene):
        self.path = os.path.join(self.scratch, "scene.yaml")
        with open(self.path, "w", encoding="utf-8") as file:
            json.dump(lambent_scene(scene), file)

    def render(self, samples, seed):
        picture, stats = os.path.join(self.scratch, "picture.exr"), os.path.join(self.scratch, "stats.json")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([self.program, "render", self.path, "-o", picture, "--samples", str(samples), "--quiet",
                        "--threads", str(self.threads), "--stats", stats, "--set", f"integrator.path.seed={seed}"],
                       check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(stats, encoding="utf-8") as file:
            seconds = json.load(file)["seconds"]["render"]
        return read_exr(picture), seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def close(self):
        pass


class Peer:
    def __init__(self, name, script, python, scratch, threads):
        self.name, self.scratch, self.threads = name, scratch, threads
        self.process = subprocess.Popen([python, os.path.join(HERE, script), str(threads)], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.version = self.answer()["version"]

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"converge: {self.name} has ended without an answer")
        return json.loads(line)

    def ask(self, what):
        print(json.dumps(what), file=self.process.stdin, flush=True)
        return self.answer()

    def prepare(self, scene):
        self.ask({"scene": scene, "size": SIZE})

    def render(self, samples, seed):
        path = os.path.join(self.scratch, f"{self.name}.npy")
        told = self.ask({"samples": samples, "seed": seed, "picture": path})
        return numpy.load(path), told["seconds"], told["cpu"]

    def close(self):
        self.process.stdin.close()
        self.process.wait()


PEERS = [("Mitsuba", "converge_mitsuba.py", "mitsuba", "PYTHON_MITSUBA"),
         ("Cycles", "converge_cycles.py", "bpy", "PYTHON_CYCLES")]


def has_modules(python, *modules):
    try:
        return subprocess.run([python, "-c", f"import {', '.join(modules)}"], capture_output=True,
                              check=False).returncode == 0
    except OSError:  # there is no such program
        return False


def start_peers(scratch, threads):
    found = []
    for name, script, module, variable in PEERS:
        python = os.environ.get(variable) or sys.executable
        if has_modules(python, "numpy", module):
            found.append(Peer(name, script, python, scratch, threads))
        else:
            print(f"converge: without {name}: {python} has no modules {module} and numpy (pip install {module} numpy; "
                  f"{variable} names the Python that has them)", file=sys.stderr)
    return found


def read_exr(path):
    """R, G and B of an EXR of lines, as Lambent writes them: float, not compressed or with ZIP."""
    with open(path, "rb") as file:
        data = file.read()
    at, head = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)[:2] + [None]
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        head[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    channels = [(m[1].decode(), struct.unpack("<i", m[2])[0]) for m in
                re.finditer(rb"([^\0]+)\0(....)\x00\0\0\0.{8}", head[b"channels"], re.DOTALL)]
    x0, y0, x1, y1 = struct.unpack("<4i", head[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = head[b"compression"][0]
    if any(kind != 2 for _, kind in channels) or compression not in (0, 2, 3):
        sys.exit(f"converge: {path} is not an EXR of floats, plain or zipped")
    lines = 16 if compression == 3 else 1
    blocks = -(-height // lines)
    picture = numpy.empty((height, len(channels), width), dtype="<f4")
    for offset in struct.unpack_from(f"<{blocks}Q", data, at + 1):
        y, size = struct.unpack_from("<2i", data, offset)
        first, count = y - y0, min(lines, height - (y - y0))
        raw, full = data[offset + 8:offset + 8 + size], count * len(channels) * width * 4
        if size < full:  # zipped: differences of bytes, those of the even places first
            steps = numpy.frombuffer(zlib.decompress(raw), dtype=numpy.uint8).astype(numpy.int64)
            steps[1:] -= 128
            spread = numpy.cumsum(steps).astype(numpy.uint8)
            mixed = numpy.empty_like(spread)
            half = (len(spread) + 1) // 2
            mixed[0::2], mixed[1::2] = spread[:half], spread[half:]
            raw = mixed.tobytes()
        picture[first:first + count] = numpy.frombuffer(raw, dtype="<f4").reshape(count, len(channels), width)
    names = [name for name, _ in channels]
    return numpy.stack([picture[:, names.index(c)] for c in "RGB"], axis=-1).astype(float)


def squared_error(picture, reference, variance):
    """The mean of the squares of the relative errors of the pixels, without the error that the reference itself has left.
    A tenth of the mean is added to what is divided by, in squares, so that dark pixels do not count without bounds. What
    the reference has left is an estimate, too: a tenth of what is measured counts in any case."""
    scale = reference**2 + (0.1 * numpy.mean(reference)) ** 2
    measured, left = numpy.mean((picture - reference) ** 2 / scale), numpy.mean(variance / scale)
    return float(max(measured - left, 0.1 * measured))


def pooled(converged):
    """The mean of all programs' converged pictures, each counting by how sure it is; and the variance of its pixels."""
    certainty = {who: 1 / numpy.mean(numpy.var(pictures, axis=0, ddof=1)) for who, pictures in converged.items()}
    whole = sum(certainty.values())
    mean, variance = 0, 0
    for who, pictures in converged.items():
        share = certainty[who] / whole
        mean = mean + share * numpy.mean(pictures, axis=0)
        variance = variance + share**2 * numpy.var(pictures, axis=0, ddof=1) / len(pictures)
    return mean, variance


def z_scores(a, b):
    """Of two lists of pictures, for each pixel and channel: the difference of their means over its standard error."""
    mean_a, mean_b = numpy.mean(a, axis=0), numpy.mean(b, axis=0)
    variance = numpy.var(a, axis=0, ddof=1) / len(a) + numpy.var(b, axis=0, ddof=1) / len(b)
    seen = variance > 0
    return (mean_a - mean_b)[seen] / numpy.sqrt(variance[seen])


# Of Student's t of so few pictures, which z is where two programs compute the same: by numerical integration, the mean
# square, each square counting no more than MOST, and the share beyond 3.
MOST = 16


def expected_of_z():
    freedom = 2 * CONVERGED - 2
    t = numpy.linspace(-200, 200, 400001)
    density = (1 + t**2 / freedom) ** (-(freedom + 1) / 2)
    density /= numpy.sum(density)
    return float(numpy.sum(density * numpy.minimum(t**2, MOST))), float(numpy.sum(density[numpy.abs(t) > 3]))


def z_squared(a, b):
    """Their mean square, 1 where both compute the same. Some pixels hardly vary at all, as the rim of a surface that
    nearly fills them: lest a few of them decide, squares count up to MOST."""
    return float(numpy.mean(numpy.minimum(z_scores(a, b) ** 2, MOST)) / expected_of_z()[0])


def beyond_three(a, b):
    return float(numpy.mean(numpy.abs(z_scores(a, b)) > 3))


def tiles_of(pictures):
    p = numpy.array(pictures)
    n = p.shape[1] // TILE
    return p.reshape(len(p), n, TILE, n, TILE, 3).mean(axis=(2, 4))


def difference_of_means(a, b):
    """Of the whole pictures, as a share, and its standard error."""
    a, b = numpy.mean(a, axis=(1, 2, 3)), numpy.mean(b, axis=(1, 2, 3))
    error = math.sqrt(numpy.var(a, ddof=1) / len(a) + numpy.var(b, ddof=1) / len(b))
    return float((numpy.mean(a) - numpy.mean(b)) / numpy.mean(b)), float(error / numpy.mean(b))


def ratio_at_equal_error(theirs, ours, key):
    """By how much more time they take than we, at equal errors: the mean of the logarithm's difference over all errors
    that both have reached, and the least and the most."""
    def line(points):
        points = sorted(points, key=lambda p: p["error"])
        return [math.log(p["error"]) for p in points], [math.log(p[key]) for p in points]

    (their_errors, their_times), (our_errors, our_times) = line(theirs), line(ours)
    low, high = max(their_errors[0], our_errors[0]), min(their_errors[-1], our_errors[-1])
    if low >= high:
        return None
    at = numpy.linspace(low, high, 33)
    ratios = numpy.interp(at, their_errors, their_times) - numpy.interp(at, our_errors, our_times)
    return [math.exp(v) for v in (numpy.mean(ratios), min(ratios), max(ratios))]


def plan(program, budget):
    """How many samples a pixel, a power of two, fit the budget of seconds."""
    samples, seconds = 4, 0
    while samples < 64 and seconds < 0.2:
        samples *= 4
        seconds = program.render(samples, 1)[2] / program.threads
    return 2 ** max(int(math.log2(samples * budget / seconds)), 4)


def measure(programs, scene, budget, rounds):
    most, converged, points = {}, {}, {}
    for program in programs:
        program.prepare(scene)
        most[program.name] = plan(program, budget)
    # In turn, so that whatever else the machine does meets all of them.
    for i in range(CONVERGED):
        for program in programs:
            converged.setdefault(program.name, []).append(program.render(most[program.name], 1000 + i)[0])
    reference, variance = pooled(converged)
    for program in programs:
        ladder = [most[program.name] // 2]
        while ladder[-1] >= 8 and len(ladder) < 4:
            ladder.append(ladder[-1] // 4)
        points[program.name] = []
        for samples in reversed(ladder):
            points[program.name].append({"samples": samples, "seconds": [], "cpu": [], "squares": []})
    for i in range(rounds):
        for program in programs:
            for point in points[program.name]:
                picture, seconds, cpu = program.render(point["samples"], 10 + i)
                point["seconds"].append(seconds)
                point["cpu"].append(cpu)
                point["squares"].append(squared_error(picture, reference, variance))
    for line in points.values():
        for point in line:
            squares = point.pop("squares")
            point["error"] = math.sqrt(statistics.mean(squares))
            point["low"], point["high"] = math.sqrt(min(squares)), math.sqrt(max(squares))
            point["seconds"], point["cpu"] = min(point["seconds"]), min(point["cpu"])
    return most, converged, points


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--quick", action="store_true", help="fewer samples, fewer rounds")
    parser.add_argument("--scenes", help="only those whose name contains this")
    parser.add_argument("--keep", action="store_true",
                        help="leave the converged pictures beside the page, as NumPy's files")
    parser.add_argument("--output", required=True, help="folder of convergence.md and pictures/")
    arguments = parser.parse_args()
    threads = os.cpu_count()
    budget, rounds = (1, 2) if arguments.quick else (5, 3)
    with tempfile.TemporaryDirectory() as scratch:
        peers = start_peers(scratch, threads)
        if not peers:
            sys.exit("converge: neither Mitsuba nor Cycles is here")
        programs = [Lambent(arguments.program, scratch, threads)] + peers
        results = {}
        for name, scene in SCENES.items():
            if not arguments.scenes or arguments.scenes.lower() in name.lower():
                results[name] = measure(programs, scene, budget, rounds)
                print(f"{name}: done", file=sys.stderr)
                if arguments.keep:
                    numpy.savez(os.path.join(arguments.output, f"{link(name)}.npz"), **results[name][1])
        for program in programs:
            program.close()
    write(arguments.output, programs, results, threads)


def link(text):
    return re.sub("[^a-z]+", "-", text.lower()).strip("-")


def write(output, programs, results, threads):
    peers = [p.name for p in programs[1:]]
    expected_beyond = expected_of_z()[1]
    agreement, speed, parts = [], [], []
    for name, (most, converged, points) in results.items():
        for who in peers:
            a, b = converged["Lambent"], converged[who]
            difference, error = difference_of_means(a, b)
            samples = f"{CONVERGED * most['Lambent']}, {CONVERGED * most[who]}"
            agreement.append(f"| {name} | {who} | {samples} | {z_squared(a, b):.3f} | "
                             f"{100 * beyond_three(a, b):.2f} % | {z_squared(tiles_of(a), tiles_of(b)):.3f} | "
                             f"{100 * difference:+.3f} % | {100 * error:.3f} % |")
            cells = []
            for key in ("seconds", "cpu"):
                ratio = ratio_at_equal_error(points[who], points["Lambent"], key)
                cells.append("no error in common" if ratio is None else
                             f"{ratio[0]:.2f} ({ratio[1]:.2f} to {ratio[2]:.2f})")
            speed.append(f"| {name} | {who} | {cells[0]} | {cells[1]} |")
        file = f"converge-{link(name)}.svg"
        os.makedirs(os.path.join(output, "pictures"), exist_ok=True)
        curves = [(who, [(p["seconds"], 100 * p["error"], 100 * p["low"], 100 * p["high"]) for p in line])
                  for who, line in points.items()]
        with open(os.path.join(output, "pictures", file), "w", encoding="utf-8") as out:
            out.write(svg.chart(f"{name}: error against time", "seconds", "error, percent", curves))
        parts += [f"## {name}", "", f"![{name}: error against time](pictures/{file})", "",
                  "| program | samples | seconds | CPU seconds | error |", "|---|---|---|---|---|"]
        parts += [f"| {who} | {p['samples']} | {p['seconds']:.3f} | {p['cpu']:.3f} | {100 * p['error']:.2f} % |"
                  for who, line in points.items() for p in line]
        parts.append("")
    page = f"""# How paths converge

<!-- Written by script/converge from what it measured; do not edit. -->

Lambent's `path` against {" and ".join(peers)}, on the same scenes: whether they compute the same, and how long they
take to the same error. `script/converge` measures all that stands here, on your machine too.
{"; ".join(p.version for p in programs)}; {platform.machine()}, {threads} threads each, {SIZE} x {SIZE} pixels.

**Equal settings.** The scenes (`bench/converge_scenes.py`) hold only what all programs can express exactly: flat
triangles, Lambert's matt surfaces, perfect mirrors and glass, a smooth GGX metal, rectangular lamps, meshes that
shine, an even sky, a sun without extent. Paths have the same number of rays and no Russian roulette; box filter; no
clamping, no denoising, no adaptive samples. Each program looks for light in its own way, and takes its own random
numbers: Mitsuba multijittered ones, of its samplers that with the least noise here, Cycles its Sobol points from the
65536th on, as its first sample goes through the centre of every pixel, so that edges would be off in all its pictures.

**Agreement.** {CONVERGED} pictures of each program with other seeds. For each pixel and channel z is the difference
of the means over its standard error. Where two programs compute the same, the mean of z squared is 1 (Student's t is
allowed for, squares count up to {MOST}), and |z| is above 3 in {100 * expected_beyond:.1f} % of the pixels. The same
of the means over tiles of {TILE} x {TILE} pixels, which have less noise, so that less is hidden in it; and the
difference of the whole pictures' means, with its standard error. One thing is known to differ: Lambent makes up for the light
that a microfacet metal loses, which is below 0.05 % where alpha = 0.01.

| scene | Lambent and | samples | z squared | beyond 3 | z squared of tiles | means differ by | standard error |
|---|---|---|---|---|---|---|---|
{chr(10).join(agreement)}

**Speed.** An error is the root mean square over the pixels of the relative difference from the reference, the mean of
all programs' pictures above, each counting as its noise allows; the error that the reference has left is taken off.
(To what is divided by, a tenth of the mean is added in squares.) Below stands how much longer than Lambent the other
program takes to the same error, above 1 where Lambent is faster: the geometric mean over all errors that both reach,
and the least and the most. Seconds are each program's own for rendering, without reading the scene and building
trees: Lambent's `seconds.render`, Cycles' render time without synchronization (as its EXR files tell), the call of
`render` in Mitsuba, whose kernels are compiled before. CPU seconds are those that the process was charged with by the
operating system, for Lambent and Cycles with all that it did; they say more where others use the machine at the same
time. Each is the least of the rounds.

| scene | against | time at equal error | CPU time at equal error |
|---|---|---|---|
{chr(10).join(speed)}

""" + "\n".join(parts)
    with open(os.path.join(output, "convergence.md"), "w", encoding="utf-8") as out:
        out.write(page.rstrip("\n") + "\n")
    print(page)


if __name__ == "__main__":
    main()
