#!/usr/bin/env python3
"""Writes docs/benchmarks.md and its pictures from build/bench/results.json.

    bench/report.py build/bench/results.json DIR      the page again, without measuring again
"""

import json
import os
import statistics
import sys

import svg

SCENES = {"flake": "7,381 spheres", "flake_mirror": "7,381 spheres that reflect",
          "knot": "knot of a million triangles", "knot_mirror": "knot that reflects"}


def number(value, digits=3):
    """A number with so many digits that count, and no more."""
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    return f"{float(text):,.0f}" if "e" in text or abs(value) >= 10**digits else text


def spread(values, digits=3):
    """Median and, where there are several, the least and the most."""
    median = number(statistics.median(values), digits)
    if len(values) < 2:
        return median
    return f"{median} ({number(min(values), digits)} to {number(max(values), digits)})"


def mebibytes(value):
    return f"{number(value / 2**20)} MiB"


def ratios(case):
    """Of one case: frame over bare queries, round by round."""
    return {"bare_robust": [one["ratio_to_bare_robust"] for one in case["bare"]],
            "bare": [one["ratio_to_bare"] for one in case["bare"]],
            "own": [one["lambent"]["seconds"]["median"] / one["own_queries"]["seconds"]["median"]
                    for one in case["bare"]]}


def peer_ratios(case):
    """Each peer's render time over Lambent's, round by round."""
    ours = [one["render"] for one in case["lambent"]]
    return {name: [theirs["render"] / mine for theirs, mine in zip(runs, ours)]
            for name, runs in case["peers"].items()}


# ---- goals


def goal(what, limit, values, at_least=False, remark="not measured"):
    """A row of the table of goals; judged by the median."""
    bound = f"{'≥' if at_least else '≤'} {limit}"
    if not values:
        return [what, bound, remark, ""]
    median = statistics.median(values)
    met = median >= limit if at_least else median <= limit
    return [what, bound, spread(values), "met" if met else "**missed**"]


def goals(results):
    cases = results["cases"]
    rows = []

    def frame(what, limit, case, which="bare_robust"):
        rows.append(goal(what, limit, ratios(cases[case])[which] if case in cases else []))

    frame("knot, whole frame / bare robust Embree, 1 sample", 1.0, "knot/1")
    frame("the same, 16 samples", 1.15, "knot/16")
    frame("spheres, whole frame / bare Embree, 1 sample", 0.30, "flake/1")
    frame("the same, 16 samples", 0.30, "flake/16")
    frame("spheres with reflections, depth 5 / bare Embree", 0.35, "flake_mirror/1")

    for mirror, limit, text in ((False, 10, "every peer / Lambent, the closest of all"),
                                (True, 5, "the same, with reflections")):
        found = [(statistics.median(values), values, name, case) for case, measured in cases.items()
                 if ("_mirror" in case) == mirror for name, values in peer_ratios(measured).items()]
        if not found:
            rows.append(goal(text, limit, [], True, "no peers here"))
            continue
        _, values, name, case = min(found)
        scene, samples = case.split("/")
        rows.append(goal(f"{text}: {name}, {scene}, {samples} sample{'s' if samples != '1' else ''}", limit, values, True))

    two = {scene: {p["x"]: p["frame"]["all"] for p in line} for scene, line in results["threads"].items()}
    gains = {scene: [a / b for a, b in zip(line[1], line[2])] for scene, line in two.items() if 2 in line}
    rows.append(goal("2 threads / 1 thread, the less of knot and spheres", 1.9,
                     min(gains.values(), key=statistics.median) if gains else [], True, "one core only"))

    sizes = results["memory"]["lambent"]["bytes"]
    rows.append(goal("peak memory, knot / (vertices + indices + tree)", 1.15,
                     [results["memory"]["whole_process"] / sum(sizes.values())]))

    per_ray = {p["x"]: p["frame"]["median"] / (p["rays"]["eye"] + p["rays"]["scattered"] + p["rays"]["shadow"])
               for p in (results["curves"] or {}).get("triangles", [])}
    rows.append(goal("10,000,000 / 1,000 triangles, time per ray", 4,
                     [per_ray[10_000_000] / per_ray[1000]] if 10_000_000 in per_ray else []))
    big = results.get("big")
    if big:
        def against(side, other):
            return [one[side] / one[other] for one in big["runs"]]

        rows.append(goal("a million triangles from OBJ, parse / tinyobjloader's parse", 1.0,
                         against("lambent_parse", "tinyobj_parse")))
        rows.append(goal("the same, tree / Embree's own build", 1.0, against("lambent_build", "embree_build")))
    layers = {scene: [one["with"] / one["without"] for one in rounds] for scene, rounds in results["layers"].items()}
    dearest = max(layers, key=lambda scene: statistics.median(layers[scene]))
    rows.append(goal(f"`--layers` on / off, the dearest of {', '.join(layers)}: {dearest}", 1.3, layers[dearest]))
    rows.append(goal("a sphere at 64 x 64, whole process, ms", 30, [1000 * s for s in results["startup"]["all"]]))
    return rows


# ---- the page


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def machine_text(results):
    m = results["machine"]
    first = next(iter(results["cases"].values()))
    peers = ", ".join(f"{name} {version}" for name, version in results["peers"].items())
    bare = first["bare"][0]
    return (f"{m['processor']}, {m['cores']} cores, {number(m['memory_bytes'] / 2**30, 2)} GiB; {m['system']}; "
            f"{m['compiler']}; kernels: {first['lambent'][0]['isa']}; Embree {bare['embree']['version']}, "
            f"native packets up to {bare['embree']['native_packets_up_to']} rays"
            f"{'; ' + peers if peers else ''}. {m['cores']} threads for everybody. Load when it began: "
            f"{number(m['load_before'], 2)}; the whole took {number(results['minutes'], 2)} minutes"
            f"{', with `--quick`: one round of each' if results['quick'] else ''}.\n")


def frame_rows(cases):
    rows = []
    for name, case in cases.items():
        scene, samples = name.split("/")
        r = ratios(case)
        best = min(case["bare"], key=lambda one: one["bare_robust"]["seconds"]["median"])["bare_robust"]

        def seconds(side, case=case):
            return spread([one[side]["seconds"]["median"] for one in case["bare"]])
        coherent = ", coherent" if best["coherent"] else ""
        scattered = f", scattered {best['scattered']}" if case["bare"][0]["rays"]["scattered"] else ""
        rows.append([SCENES[scene], samples, seconds("lambent"), seconds("own_queries"), seconds("bare_robust"),
                     seconds("bare"), spread(r["bare_robust"]), spread(r["bare"]),
                     f"{best['width']} wide{coherent}{scattered}"])
    return rows


def variant_rows(case):
    """All variants of one run, robust and not side by side."""
    found = {}
    for v in case["bare"][0]["embree"]["variants"]:
        key = (v["width"], v["coherent"], v["scattered"])
        found.setdefault(key, {})[v["robust"]] = v["seconds"]["median"]
    return [[str(width), "yes" if coherent else "no", scattered, number(pair[True]), number(pair[False])]
            for (width, coherent, scattered), pair in found.items()]


def agreement_text(cases):
    worst = {"closest": [0, 0], "shadow": [0, 0]}
    rays = 0
    for case in cases.values():
        for one in case["bare"][:1]:
            for kind, most in worst.items():
                a = one["agreement"][kind]
                rays += a["rays"]
                most[0] = max(most[0], a["share_hit_or_not_differs"])
                most[1] = max(most[1], a["share_distance_differs_by_1e-4"])
    return (f"Over {number(rays / 1e6)} million rays: of the eye and scattered rays of a scene, at most "
            f"{number(worst['closest'][0], 2)} hit for one and not for the other, and {number(worst['closest'][1], 2)} "
            f"differ in their distance by more than 1e-4 of it; of the shadow rays, at most "
            f"{number(worst['shadow'][0], 2)} differ. (Planes end in Embree's world, a hundred times as far away as "
            "anything else lies; in ours they do not.)\n")


def peer_rows(cases):
    rows = []
    for name, case in cases.items():
        scene, samples = name.split("/")
        for peer, runs in case["peers"].items():
            rows.append([SCENES[scene], samples, peer, spread([one["render"] for one in runs]),
                         spread(peer_ratios(case)[peer]), spread([one["wall"] for one in runs]),
                         mebibytes(max(one["peak"] for one in runs))])
        mine = case["lambent"]
        rows.append([SCENES[scene], samples, "Lambent", spread([one["render"] for one in mine]), "",
                     spread([one["wall"] for one in mine]), mebibytes(max(one["peak"] for one in mine))])
    return rows


def others_rows(others):
    rows = []
    for name, one in others.items():
        lambent = [run["render"] for run in one.get("lambent", [])]
        rays = sum(one["lambent"][0]["rays"][k] for k in ("eye", "reflection", "refraction", "shadow")) if lambent else 0
        bare = one.get("bare")
        rows.append([name, number(rays / 1e6) if lambent else "", spread(lambent) if lambent else "",
                     number(bare["bare_robust"]["seconds"]["median"]) if bare else "",
                     number(bare["ratio_to_bare_robust"]) if bare else "", one.get("trouble", "")])
    return rows


def kernel_rows(kernels):
    rows = []
    for name, part in kernels["parts"].items():
        what, _, how = name.rpartition("/")
        rows.append([what.replace("model/", ""), "one by one" if how == "number" else "packets",
                     spread([s * 1e9 for s in part["seconds"]]),
                     number(part["instructions"]) if "instructions" in part else ""])
    return rows


def big_text(big):
    def seconds(side):
        return spread([one[side] for one in big["runs"]])

    rendered = big["render"]
    return (f"An OBJ file of {mebibytes(big['file_bytes'])}, {big['triangles']:,} triangles with normals and texture "
            "coordinates (`bench/big_model.cpp`, in turn, in one process): \"tinyobjloader\" is its `ObjReader`, from "
            "the file to its arrays, \"Embree\" a scene of medium quality over the same triangles, robust, from the "
            "first buffer to the committed tree. Ours reads a file piece by piece, and its tree is the one that the "
            "renderer takes for such a scene.\n\n" +
            table(["", "Lambent", "tinyobjloader", "Embree"],
                  [["parse", seconds("lambent_parse"), seconds("tinyobj_parse"), ""],
                   ["tree", seconds("lambent_build"), "", seconds("embree_build")]]) +
            f"\n`lambent render` of it, with the scene made for it: {number(rendered['load'])} s to load, "
            f"{number(rendered['build'])} s to build, {number(rendered['render'])} s to render; peak memory "
            f"{mebibytes(rendered['peak'])}.\n")


def figures(results):
    """name -> text of an SVG, what it shows."""
    def line(points, key):
        return [(p["x"], p[key]["median"], p[key]["min"], p[key]["max"]) for p in points]

    shown = {}
    curves = results["curves"] or {}

    def draw(name, title, x_title, parts, x_logarithmic=True):
        series = []
        for label, curve in parts:
            series.append((f"Lambent{label}", line(curves[curve], "frame")))
            series.append((f"bare Embree{label}", line(curves[curve], "bare_robust")))
        shown[name] = svg.chart(title, x_title, "seconds", series, x_logarithmic)

    if curves:
        draw("triangles", "Time against triangles", "triangles", [("", "triangles")])
        draw("pixels", "Time against pixels", "pixels", [(", spheres", "pixels, flake"), (", knot", "pixels, knot")])
        draw("samples", "Time against samples", "samples per pixel",
             [(", spheres", "samples, flake"), (", knot", "samples, knot")])
        draw("lights", "Time against lights", "lights", [("", "lights")])
        draw("depth", "Time against depth, between two mirrors", "max_depth", [("", "depth")], False)
    shown["threads"] = svg.chart("Time against threads", "threads", "seconds",
                                 [("spheres", line(results["threads"]["flake"], "frame")),
                                  ("knot", line(results["threads"]["knot"], "frame"))], False)
    return shown


def page(results, pictures, notes):
    cases = results["cases"]
    text = ["# How fast", "",
            "<!-- Written by script/bench from what it measured; do not edit. -->", "",
            "`script/bench` measures all that stands here, on your machine too: it makes the scenes, runs everybody "
            "in turn, "
            "several rounds, and writes this page. Ratios are taken within a round; where three numbers stand, they "
            "are the "
            "median of the rounds and, in brackets, the least and the most. Times are seconds.", "",
            machine_text(results),
            "## Goals", "", table(["what", "goal", "measured", ""], goals(results)),
            "## The whole frame against the bare queries of its rays", "",
            "`bench/bare_rays.cpp` renders a scene once and listens to the renderer: so it knows every eye ray, "
            "scattered ray and "
            "shadow ray that the picture asks, tile by tile. Then, in turn, the renderer renders the whole frame "
            "(rays, "
            "shading, film, picture; no loading, no building), and Embree answers the same rays and stores nothing but "
            "their distances: the same primitives (triangles; spheres as `SPHERE_POINT`; an infinite plane as two "
            "large "
            "triangles), a tree of medium quality, the same number of threads, each taking the next tile that is "
            "left. Its rays lie in "
            "memory beforehand in blocks of 16 as packets want them, consecutive rays of one kind and tile together, "
            "shadow "
            "rays sorted by light. \"Bare Embree\" is the fastest of all its variants, of those with its robust "
            "flag: 1, 4, 8 "
            "and 16 rays wide; eye and shadow rays flagged as coherent or not; scattered rays in packets or one by "
            "one. (After "
            "two runs a variant 1.4 times slower than the best is let go; after the first round, and at 16 samples, "
            "only "
            "those 8 and 16 wide and coherent are measured.) \"Our queries alone\" are "
            "Lambent's own, on the same rays in the same way.", "",
            table(["scene", "samples", "whole frame", "our queries alone", "bare Embree, robust", "bare Embree, not robust",
                   "frame / robust", "frame / not robust", "fastest robust variant"], frame_rows(cases)),
            "The scenes: 1280 x 720 pixels, 2 point lights, hard shadows, every eye ray hits; `reflect` 0.3 and "
            "depth 5 where they "
            "reflect. Every variant of Embree, knot, 1 sample:", "",
            table(["rays wide", "coherent", "scattered", "robust", "not robust"], variant_rows(cases["knot/1"])),
            "Only reading those rays from memory and storing a number for each takes "
            f"{number(cases['knot/1']['bare'][0]['reading_only']['seconds']['median'])} s of that.", "",
            "Do both see the same? " + agreement_text(cases)]
    if results["peers"]:
        text += ["## Other renderers", "",
                 "The same camera, lights and shapes, and materials as alike as each program allows "
                 "(`bench/make_scenes.py`); all "
                 "with all threads. \"Render\" is what the program itself calls so: POV-Ray's trace time, Tachyon's "
                 "ray tracing "
                 "time, Cycles' render time without synchronization, Lambent's `seconds.render` (picture included). "
                 "Whole "
                 "process and peak memory are the operating system's figures.", "",
                 "- POV-Ray at 16 samples: `+AM1 +R4 +A0.0`, 17 rays for each pixel; `adc_bailout 0`, so that no "
                 "reflection is "
                 "cut off.",
                 "- Tachyon: `-aasamples 15`, Phong highlights.",
                 "- Cycles, on the processor: point lights of size 0, no diffuse bounces, no denoiser. It is a path "
                 "tracer, and "
                 "chooses one light and one part of the material at random for each sample: less work, and noise.", "",
                 table(["scene", "samples", "program", "render", "render / Lambent's", "whole process", "peak memory"],
                       peer_rows(cases))]
    if results["others"]:
        text += ["## Scenes of others", "",
                 "Haines' Standard Procedural Databases and Khronos' FlightHelmet, where they are found "
                 "(`LAMBENT_DATA`). Shadows "
                 "are all or nothing here, so that one shadow ray is one query.", "",
                 table(["scene", "million rays", "whole frame", "bare Embree, robust", "ratio", "remark"],
                       others_rows(results["others"]))]
    text += ["## Curves", ""]
    what = {"triangles": "The knot from a thousand triangles on.", "pixels": "From 320 x 180 pixels on.",
            "samples": "Samples for each pixel.", "lights": "The flake at 320 x 180 pixels under more and more lights.",
            "depth": "Two mirrors that face each other, with the flake between them.",
            "threads": "4 samples for each pixel; median, least and most of the runs."}
    for name in pictures:
        text += [f"![{what[name]}](pictures/bench-{name}.svg)", "", what[name], ""]
    if not results["curves"]:
        text += ["The others were left out (`--no-curves`).", ""]
    sizes, whole = results["memory"]["lambent"]["bytes"], results["memory"]["whole_process"]
    text += ["## Memory", "",
             f"The knot: vertices and normals {mebibytes(sizes['vertices'])}, indices {mebibytes(sizes['indices'])}, "
             f"tree "
             f"{mebibytes(sizes['tree'])}, sum {mebibytes(sum(sizes.values()))}. The peak of `lambent render`, "
             f"reading the file "
             f"included, is {mebibytes(whole)}; that of Embree's tree alone over the same scene, built and with its "
             f"own copy of "
             f"the vertices, {mebibytes(results['memory']['embree']['peak_memory_bytes'])}.", ""]
    if results.get("big"):
        text += ["## A big model", "", big_text(results["big"])]
    kernels = results["kernels"]
    counted = f"; instructions by callgrind, {kernels['counted_isa']}" if kernels["counted_isa"] else ""
    text += ["## Kernels", "",
             f"Nanoseconds for each lane: a power, one light by each model, a ray query ({kernels['isa']}{counted}). "
             f"Queries: "
             "131,072 triangles and 1,000 spheres, 65,536 rays.", "",
             table(["part", "", "ns per lane", "instructions per lane"], kernel_rows(kernels))]
    if notes:
        text += ["## Where the time goes", "", notes.strip(), ""]
    return "\n".join(text).rstrip() + "\n"


def write(results, folder, notes_path):
    notes = ""
    if os.path.exists(notes_path):
        with open(notes_path, encoding="utf-8") as file:
            notes = file.read()
    pictures = figures(results)
    os.makedirs(os.path.join(folder, "pictures"), exist_ok=True)
    for name, text in pictures.items():
        with open(os.path.join(folder, "pictures", f"bench-{name}.svg"), "w", encoding="utf-8") as file:
            file.write(text)
    with open(os.path.join(folder, "benchmarks.md"), "w", encoding="utf-8") as file:
        file.write(page(results, pictures, notes))


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)
    write(results, sys.argv[2], os.path.join(os.path.dirname(os.path.abspath(__file__)), "notes.md"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
