#!/usr/bin/env python3
"""How fast paths converge: Lambent and Mitsuba 3 on the same boxes, error against time.

Every program renders each scene with 1, 4, 16, ... samples a pixel; its error is the root mean square of the
difference from its own converged picture, over that picture's mean. The converged pictures are compared with
each other, too, pixel by pixel: z is the difference over its standard error, so that a mean square near 1 says
that the two compute the same. script/converge calls this.

Mitsuba is the module `mitsuba` (pip install mitsuba).
"""

import argparse
import importlib
import importlib.util
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time

import numpy

import svg

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = 192
REFERENCE = 4096


def box(light_side, shiny):
    """A Cornell box: corners of quads, what they are made of, and a lamp in the ceiling."""
    white, red, green = [0.73] * 3, [0.63, 0.06, 0.05], [0.14, 0.45, 0.09]
    quads = [
        ([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], white),
        ([[-1, 2, 1], [-1, 2, -1], [1, 2, -1], [1, 2, 1]], white),
        ([[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], white),
        ([[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]], red),
        ([[1, 0, 1], [1, 2, 1], [1, 2, -1], [1, 0, -1]], green),
    ]
    turn, (x, z), half, high = math.radians(18), (-0.35, -0.3), 0.3, 1.2
    corner = [(x + math.cos(turn) * a + math.sin(turn) * b, z - math.sin(turn) * a + math.cos(turn) * b)
              for a, b in ((-half, -half), (half, -half), (half, half), (-half, half))]
    quads.append(([[px, high, pz] for px, pz in reversed(corner)], white))
    for i in range(4):
        (ax, az), (bx, bz) = corner[i], corner[(i + 1) % 4]
        quads.append(([[bx, 0, bz], [ax, 0, az], [ax, high, az], [bx, high, bz]], white))
    return {"quads": quads, "light": light_side, "intensity": 1.2,
            "ball": {"center": [0.4, 0.35, 0.3], "radius": 0.35, "roughness": 0.3 if shiny else None}}


SCENES = {"matt": box(0.5, False), "small lamp, brass": box(0.1, True)}
BRASS = [0.9, 0.7, 0.4]


def lambent_scene(scene, depth):
    def numbers(values):
        return "[" + ", ".join(f"{v:.9g}" for v in values) + "]"

    ball = scene["ball"]
    material = ("{diffuse: 0.73}" if ball["roughness"] is None else
                f"{{metallic_roughness: {{base_color: {numbers(BRASS)}, metallic: 1, roughness: {ball['roughness']}}}}}")
    s = scene["light"]
    text = f"""lambent: 1
camera: {{eye: [0, 1, 3.9], target: [0, 1, 0], fov: 38}}
image: {{size: [{SIZE}, {SIZE}]}}
integrator: {{path: {{max_depth: {depth}, roulette_depth: {depth}}}}}
lights: [{{name: lamp, rectangle: {{center: [0, 1.98, 0], u: [{s}, 0, 0], v: [0, 0, {s}], intensity: {scene["intensity"]}}}}}]
objects:
  - {{sphere: {{center: {numbers(ball["center"])}, radius: {ball["radius"]}}}, material: {material}}}
"""
    for corners, color in scene["quads"]:
        text += f"  - {{polygon: {{vertices: [{', '.join(numbers(c) for c in corners)}]}}, material: {{diffuse: {numbers(color)}}}}}\n"
    return text


class Lambent:
    name = "Lambent"

    def __init__(self, program, scratch, threads):
        self.program, self.scratch, self.threads = program, scratch, threads

    def version(self):
        return subprocess.run([self.program, "--version"], capture_output=True, text=True, check=True).stdout.strip()

    def prepare(self, scene, depth):
        self.path = os.path.join(self.scratch, "scene.yaml")
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(lambent_scene(scene, depth))

    def render(self, samples, seed):
        picture, stats = os.path.join(self.scratch, "picture.exr"), os.path.join(self.scratch, "stats.json")
        subprocess.run([self.program, "render", self.path, "-o", picture, "--samples", str(samples), "--quiet",
                        "--threads", str(self.threads), "--stats", stats, "--set", f"integrator.path.seed={seed}"],
                       check=True)
        with open(stats, encoding="utf-8") as file:
            return read_exr(picture), json.load(file)["seconds"]["render"]


class Mitsuba:
    """Its fastest variants for a processor: with LLVM, compiled before the clock starts; else the scalar one."""
    name = "Mitsuba"

    def __init__(self, threads):
        self.mi = importlib.import_module("mitsuba")
        self.mi.set_variant("llvm_ad_rgb" if self.has_llvm() else "scalar_rgb")
        if self.mi.variant().startswith("llvm"):
            importlib.import_module("drjit").set_thread_count(threads)

    def has_llvm(self):
        try:
            self.mi.set_variant("llvm_ad_rgb")
            importlib.import_module("drjit").llvm.Float(1) + 1
            return True
        except Exception:  # whatever it is that LLVM lacks
            return False

    def version(self):
        return f"Mitsuba {self.mi.__version__}, {self.mi.variant()}"

    def prepare(self, scene, depth):
        mi = self.mi
        look_at = mi.ScalarTransform4f().look_at(origin=[0, 1, 3.9], target=[0, 1, 0], up=[0, 1, 0])

        def rgb(color):
            return {"type": "rgb", "value": list(color)}

        ball = scene["ball"]
        matt = {"type": "diffuse", "reflectance": rgb([0.73] * 3)}
        brass = {"type": "roughconductor", "distribution": "ggx", "alpha": (ball["roughness"] or 0) ** 2,
                 "material": "none", "specular_reflectance": rgb(BRASS)}
        s = scene["light"] / 2
        radiance = math.pi * scene["intensity"] / (2 * s) ** 2
        to_ceiling = mi.ScalarTransform4f().translate([0, 1.98, 0]).rotate([1, 0, 0], 90).scale([s, s, 1])
        tree = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": depth + 1, "rr_depth": depth + 1},
            "sensor": {"type": "perspective", "fov": 38, "to_world": look_at,
                       "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"},
                                "component_format": "float32", "pixel_format": "rgb"},
                       "sampler": {"type": "independent"}},
            "lamp": {"type": "rectangle", "to_world": to_ceiling,
                     "bsdf": {"type": "diffuse", "reflectance": rgb([0, 0, 0])},
                     "emitter": {"type": "area", "radiance": rgb([radiance] * 3)}},
            "ball": {"type": "sphere", "center": ball["center"], "radius": ball["radius"],
                     "bsdf": matt if ball["roughness"] is None else brass},
        }
        for number, (corners, color) in enumerate(scene["quads"]):
            mesh = mi.Mesh(f"quad{number}", 4, 2)
            parameters = mi.traverse(mesh)
            parameters["vertex_positions"] = [float(v) for corner in corners for v in corner]
            parameters["faces"] = [0, 1, 2, 0, 2, 3]
            parameters.update()
            path = os.path.join(tempfile.gettempdir(), f"lambent-converge-{os.getpid()}-{number}.ply")
            mesh.write_ply(path)
            tree[f"quad{number}"] = {"type": "ply", "filename": path, "face_normals": True,
                                     "bsdf": {"type": "twosided",
                                              "inner": {"type": "diffuse", "reflectance": rgb(color)}}}
        self.scene = mi.load_dict(tree)
        for number in range(len(scene["quads"])):
            os.remove(os.path.join(tempfile.gettempdir(), f"lambent-converge-{os.getpid()}-{number}.ply"))

    def render(self, samples, seed):
        def once():
            return numpy.array(self.mi.render(self.scene, spp=samples, seed=seed)).astype(float)

        if self.mi.variant().startswith("llvm"):
            once()  # compiles its kernels
        start = time.perf_counter()
        picture = once()
        return picture, time.perf_counter() - start


def read_exr(path):
    """R, G and B of an EXR."""
    mi = importlib.import_module("mitsuba")
    if mi.variant() is None:
        mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return numpy.array(bitmap).astype(float)


def error_of(picture, reference):
    return float(numpy.sqrt(numpy.mean((picture - reference) ** 2)) / numpy.mean(reference))


def z_test(a, b):
    """Of two lists of pictures: the mean square of the pixels' difference over its standard error (1 where both
    compute the same), and the difference of the means as a share."""
    mean_a, mean_b = numpy.mean(a, axis=0), numpy.mean(b, axis=0)
    variance = numpy.var(a, axis=0, ddof=1) / len(a) + numpy.var(b, axis=0, ddof=1) / len(b)
    seen = variance > 0
    z = (mean_a - mean_b)[seen] / numpy.sqrt(variance[seen])
    # Student's t of so few pictures has a variance of its own: n / (n - 2), n = len(a) + len(b) - 2.
    n = len(a) + len(b) - 2
    return float(numpy.mean(z**2) * (n - 2) / n), float(numpy.mean(mean_a) / numpy.mean(mean_b) - 1)


def samples_for(points, wanted):
    """Seconds that an error takes, between the points measured, in logarithms."""
    errors, seconds = [math.log(p["error"]) for p in points], [math.log(p["seconds"]) for p in points]
    for i in range(len(points) - 1):
        if errors[i] >= math.log(wanted) >= errors[i + 1]:
            share = (errors[i] - math.log(wanted)) / (errors[i] - errors[i + 1])
            return math.exp(seconds[i] + share * (seconds[i + 1] - seconds[i]))
    return None


def measure(programs, scene, depth, quick):
    most = 256 if quick else 1024
    pictures = 8
    result = {}
    for program in programs:
        program.prepare(scene, depth)
        # Converged: the mean of several pictures, which also say how far each is off.
        many = [program.render((REFERENCE // 8 if quick else REFERENCE) // pictures, 1000 + i)[0] for i in range(pictures)]
        points, samples = [], 4
        while samples <= most:
            runs = [program.render(samples, seed) for seed in range(1 if quick else 3)]
            points.append({"samples": samples, "seconds": statistics.median(r[1] for r in runs),
                           "error": statistics.mean(error_of(r[0], numpy.mean(many, axis=0)) for r in runs)})
            samples *= 4
        result[program.name] = {"points": points, "many": many}
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--quick", action="store_true", help="fewer samples, one run of each")
    parser.add_argument("--output", required=True, help="folder of convergence.md and pictures/")
    arguments = parser.parse_args()
    if importlib.util.find_spec("mitsuba") is None:
        sys.exit("converge: this needs Mitsuba 3 and numpy: pip install mitsuba numpy")
    threads = os.cpu_count()
    depth = 16
    page = ["# How paths converge", "", "<!-- Written by script/converge from what it measured; do not edit. -->", "",
            "The same boxes by several programs: a Cornell box of matt walls, a block and a ball; one lamp in the ceiling, "
            "large or small. Paths of up to "
            f"{depth} rays, no Russian roulette, {SIZE} x {SIZE} pixels, box filter, {threads} threads. "
            "An error is the root mean square of the difference from the program's own converged picture, over its mean. "
            "Agreement is by pixel: z is the difference of the converged pictures over its standard error, so that the mean "
            "of its squares is 1 where both compute the same.", ""]
    with tempfile.TemporaryDirectory() as scratch:
        programs = [Lambent(arguments.program, scratch, threads), Mitsuba(threads)]
        page += ["; ".join(p.version() for p in programs) + f"; {platform.machine()}.", ""]
        for name, scene in SCENES.items():
            measured = measure(programs, scene, depth, arguments.quick)
            page += [f"## {name.capitalize()}", "", "| program | samples | seconds | error |", "|---|---|---|---|"]
            for who, got in measured.items():
                page += [f"| {who} | {p['samples']} | {p['seconds']:.3g} | {100 * p['error']:.2f} % |" for p in got["points"]]
            ours = measured["Lambent"]
            page.append("")
            for who, got in measured.items():
                if who == "Lambent":
                    continue
                wanted = ours["points"][len(ours["points"]) // 2]["error"]
                theirs, mine = samples_for(got["points"], wanted), samples_for(ours["points"], wanted)
                z, bias = z_test(ours["many"], got["many"])
                page.append(f"{who}: mean z squared {z:.3f}, means differ by {100 * bias:+.3f} %."
                            + (f" Time to an error of {100 * wanted:.2f} %: {theirs / mine:.2f} times Lambent's."
                               if theirs and mine else ""))
            page.append("")
            file = "converge-" + "".join(c if c.isalnum() else "-" for c in name) + ".svg"
            os.makedirs(os.path.join(arguments.output, "pictures"), exist_ok=True)
            curves = [(who, [(p["seconds"], p["error"], p["error"], p["error"]) for p in got["points"]])
                      for who, got in measured.items()]
            with open(os.path.join(arguments.output, "pictures", file), "w", encoding="utf-8") as out:
                out.write(svg.chart(f"{name}: error against time", "seconds", "error", curves))
            page += [f"![{name}: error against time](pictures/{file})", ""]
    with open(os.path.join(arguments.output, "convergence.md"), "w", encoding="utf-8") as out:
        out.write("\n".join(page))
    print("\n".join(page))


if __name__ == "__main__":
    main()
