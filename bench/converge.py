#!/usr/bin/env python3
"""How fast paths converge: Lambent, Mitsuba 3 and Cycles on the same boxes, error against time.

Every program renders each scene with 1, 4, 16, ... samples a pixel; its error is the root mean square of the
difference from a converged picture, over that picture's mean. Mitsuba's and Cycles' converged pictures are
compared with Lambent's, too, pixel by pixel: z is the difference over its standard error, so that a mean square
near 1 says that the two compute the same. script/converge calls this.

Mitsuba is the module `mitsuba` (pip install mitsuba), Cycles the module `bpy` (pip install bpy); either is left out
where it is not there.
"""

import argparse
import importlib.util
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile

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

    def prepare(self, scene, depth):
        self.path = os.path.join(self.scratch, "scene.yaml")
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(lambent_scene(scene, depth))

    def render(self, samples, seed):
        picture, stats = os.path.join(self.scratch, "picture.exr"), os.path.join(self.scratch, "stats.json")
        # Another picture of the same: the camera's pixels moved by a whole scene would be one; here it is the
        # pattern, which begins later.
        subprocess.run([self.program, "render", self.path, "-o", picture, "--samples", str(samples), "--quiet",
                        "--threads", str(self.threads), "--stats", stats, "--set", f"integrator.path.seed={seed}"],
                       check=True)
        raw = os.path.join(self.scratch, "picture.raw")
        subprocess.run([self.program, "convert", picture, raw + ".exr"], check=True)
        with open(stats, encoding="utf-8") as file:
            return read_exr(picture), json.load(file)["seconds"]["render"]


def read_exr(path):
    """R, G, B of an EXR, by whichever of the peers can."""
    import mitsuba
    if mitsuba.variant() is None:
        mitsuba.set_variant("scalar_rgb")
    bitmap = mitsuba.Bitmap(path).convert(mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False)
    return numpy.array(bitmap)[..., :3].astype(float)
