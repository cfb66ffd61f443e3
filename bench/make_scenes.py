#!/usr/bin/env python3
"""The scenes of the benchmark: a sphere flake and a torus knot on a plane, for Lambent and for its peers.

    bench/make_scenes.py FOLDER [--triangles N ...] [--lights N ...] [--peers]

Writes FOLDER/NAME.yaml for Lambent; with --peers also NAME.pov (POV-Ray), NAME.dat (Tachyon) and NAME.json
(bench/render_with_cycles.py reads it) for the scenes that are compared. All of them say the same: camera, lights,
shapes, and materials as alike as the programs allow. FOLDER/big.obj is a model file as exporters write them, of a
million triangles. Meshes that are there already are not written again.
"""

import argparse
import array
import json
import math
import os
import sys

# ---- vectors


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scaled(s, a):
    return (s * a[0], s * a[1], s * a[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(1 / math.sqrt(dot(a, a)), a)


def across(a):
    """Two unit vectors that make a right-handed frame with a."""
    u = unit(cross(a, (1, 0, 0) if abs(a[0]) < 0.5 else (0, 1, 0)))
    return u, cross(a, u)


# ---- the sphere flake (Haines, A proposal for standard graphics environments, 1987)


def sphere_flake(depth, center=(0.0, 0.0, 0.0), radius=0.5, axis=(0.0, 0.0, 1.0)):
    """A sphere and on it nine flakes of a third its size, where close packing puts them: six around, three on top."""
    yield center, radius
    if depth == 0:
        return
    u, v = across(axis)
    top = math.sqrt(2 / 3)
    for height, azimuths in ((0, range(0, 360, 60)), (top, range(30, 360, 120))):
        for azimuth in azimuths:
            a, ring = math.radians(azimuth), math.sqrt(1 - height * height)
            way = add(scaled(height, axis), add(scaled(ring * math.cos(a), u), scaled(ring * math.sin(a), v)))
            yield from sphere_flake(depth - 1, add(center, scaled(radius * 4 / 3, way)), radius / 3, way)


# ---- the torus knot


class Knot:
    """A tube around the (2, 3) torus knot: a grid of vertices, closed both ways; two triangles for each of its cells."""

    def __init__(self, triangles, tube=0.55):
        self.along = max(8, round(math.sqrt(triangles / 2 * 9)))  # the knot is about nine times as long as it is round
        self.around = max(3, round(triangles / 2 / self.along))
        self.tube = tube

    def vertices(self):
        """Position and unit normal of each."""
        circle = [(math.cos(2 * math.pi * j / self.around), math.sin(2 * math.pi * j / self.around))
                  for j in range(self.around)]
        for i in range(self.along):
            u = 2 * math.pi * i / self.along
            out = 2 + math.cos(3 * u)
            (x, y), z = (out * math.cos(2 * u), out * math.sin(2 * u)), math.sin(3 * u)
            d_out = -3 * math.sin(3 * u)
            tangent = unit((d_out * math.cos(2 * u) - 2 * y, d_out * math.sin(2 * u) + 2 * x, 3 * math.cos(3 * u)))
            b = unit(cross(tangent, (x, y, z)))
            n = cross(b, tangent)
            for c, s in circle:
                nx, ny, nz = c * n[0] + s * b[0], c * n[1] + s * b[1], c * n[2] + s * b[2]
                yield x + self.tube * nx, y + self.tube * ny, z + self.tube * nz, nx, ny, nz

    def triangles(self):
        """Three vertex numbers each, from 0; counter-clockwise seen from outside."""
        along, around = self.along, self.around
        for i in range(along):
            here, next_ring = i * around, (i + 1) % along * around
            for j in range(around):
                k = (j + 1) % around
                yield here + j, next_ring + j, next_ring + k
                yield here + j, next_ring + k, here + k


def write_whole(path, write):
    """A file that is there is complete: it gets its name when it is written."""
    if os.path.exists(path):
        return
    with open(path + ".part", "wb") as file:
        write(file)
    os.replace(path + ".part", path)


def in_chunks(items, size=20000):
    chunk = []
    for item in items:
        chunk.append(item)
        if len(chunk) == size:
            yield chunk
            chunk = []
    if chunk:
        yield chunk


def write_lines(file, line, items):
    for chunk in in_chunks(items):
        file.write((line * len(chunk) % tuple(x for item in chunk for x in item)).encode())


def write_obj(knot, file):
    write_lines(file, "v %.6f %.6f %.6f\nvn %.6f %.6f %.6f\n", knot.vertices())
    write_lines(file, "f %d//%d %d//%d %d//%d\n",
                ((a + 1, a + 1, b + 1, b + 1, c + 1, c + 1) for a, b, c in knot.triangles()))


def write_binary(knot, file):
    """Counts of vertices and triangles, the vertices' coordinates, the triangles; 32 bits each."""
    array.array("I", (knot.along * knot.around, 2 * knot.along * knot.around)).tofile(file)
    for chunk in in_chunks(knot.vertices()):
        array.array("f", (x for v in chunk for x in v[:3])).tofile(file)
    for chunk in in_chunks(knot.triangles()):
        array.array("I", (x for t in chunk for x in t)).tofile(file)


def write_mesh2(knot, file):
    count = knot.along * knot.around
    file.write(b"mesh2 { vertex_vectors { %d\n" % count)
    write_lines(file, ",<%.6f,%.6f,%.6f>\n", (v[:3] for v in knot.vertices()))
    file.write(b"} normal_vectors { %d\n" % count)
    write_lines(file, ",<%.6f,%.6f,%.6f>\n", (v[3:] for v in knot.vertices()))
    file.write(b"} face_indices { %d\n" % (2 * count))
    write_lines(file, ",<%d,%d,%d>\n", knot.triangles())
    file.write(b"}")


def write_stri(knot, file):
    v = [(-x, y, z, -nx, ny, nz) for x, y, z, nx, ny, nz in knot.vertices()]
    line = "STRI V0 %.6f %.6f %.6f V1 %.6f %.6f %.6f V2 %.6f %.6f %.6f " \
           "N0 %.6f %.6f %.6f N1 %.6f %.6f %.6f N2 %.6f %.6f %.6f object\n"
    write_lines(file, line, (v[a][:3] + v[b][:3] + v[c][:3] + v[a][3:] + v[b][3:] + v[c][3:]
                             for a, b, c in knot.triangles()))


# ---- scenes: plain dictionaries; `object` is the material of the spheres or the mesh, `floor` the plane's

FLAKE_MATERIAL = {"ambient": [0.05, 0.05, 0.05], "diffuse": [0.6, 0.5, 0.35], "specular": 0.5, "shininess": 32,
                  "reflect": 0}
KNOT_MATERIAL = {"ambient": [0.08, 0.03, 0.01], "diffuse": [0.8, 0.3, 0.1], "specular": 0.5, "shininess": 32,
                 "reflect": 0}
FLOOR = {"ambient": [0.1, 0.1, 0.1], "diffuse": [0.6, 0.6, 0.6], "specular": 0, "shininess": 32, "reflect": 0}


def flake_scene():
    return {
        "camera": {"eye": [2.1, 1.3, 1.7], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 45},
        "lights": [{"position": [4, 3, 2], "intensity": 0.6}, {"position": [1, -4, 4], "intensity": 0.5}],
        "object": dict(FLAKE_MATERIAL), "floor": dict(FLOOR), "floor_height": -0.5,
        "spheres": [[*center, radius] for center, radius in sphere_flake(4)], "max_depth": 1,
    }


def knot_scene(triangles):
    return {
        "camera": {"eye": [0.6, -1.2, 3.0], "target": [0.3, 0.0, 0.0], "up": [0, 1, 0], "fov": 40},
        "lights": [{"position": [5, 6, 9], "intensity": 0.7}, {"position": [-6, -2, 8], "intensity": 0.4}],
        "object": dict(KNOT_MATERIAL), "floor": dict(FLOOR), "floor_height": -1.8,
        "mesh": f"knot_{triangles}", "max_depth": 1,
    }


def with_mirrors(scene):
    scene["object"]["reflect"] = 0.3
    scene["max_depth"] = 5
    return scene


def with_lights(scene, count):
    """`count` lights on a half dome, that together are as bright as one."""
    golden = math.pi * (3 - math.sqrt(5))
    scene["lights"] = []
    for i in range(count):
        z = 0.2 + 0.8 * (i + 0.5) / count
        ring, a = math.sqrt(1 - z * z), golden * i
        scene["lights"].append({"position": [6 * ring * math.cos(a), 6 * ring * math.sin(a), 6 * z],
                                "intensity": 1 / count})
    return scene


def between_mirrors(scene):
    """Two mirrors that face each other, with the flake between: every ray that meets one goes on to the other."""
    scene["object"]["reflect"] = 0.3
    scene["max_depth"] = 8
    scene["camera"] = {"eye": [1.35, -1.5, 0.75], "target": [-1.5, 0.7, 0.1], "up": [0, 0, 1], "fov": 60}
    scene["mirrors"] = [{"point": [-1.6, 0, 2.5], "normal": [1, 0, 0], "size": [16, 6]},
                        {"point": [1.6, 0, 2.5], "normal": [-1, 0, 0], "size": [16, 6]}]
    return scene


# ---- one writer for each program


def write_yaml(scene, size, path):
    def material(name, m):
        return "  - {name: %s, %s}\n" % (name, ", ".join(f"{k}: {v}" for k, v in m.items()))

    camera = scene["camera"]
    lines = [
        "lambent: 1\n",
        "camera: {eye: %(eye)s, target: %(target)s, up: %(up)s, fov: %(fov)s}\n" % camera,
        f"image: {{size: [{size[0]}, {size[1]}], samples: 1}}\n",
        "illumination: {model: phong, attenuation: none, ambient: [1, 1, 1], ambient_attenuation: none}\n",
        f"integrator: {{whitted: {{max_depth: {scene['max_depth']}}}}}\n",
        "lights:\n",
        *("  - {point: {position: %(position)s, intensity: %(intensity)s}}\n" % light for light in scene["lights"]),
        "materials:\n",
        material("object", scene["object"]), material("floor", scene["floor"]),
        "  - {name: mirror, ambient: 0, diffuse: 0.05, reflect: 0.9}\n" if "mirrors" in scene else "",
        "objects:\n",
        f"  - {{plane: {{point: [0, 0, {scene['floor_height']}], normal: [0, 0, 1]}}, material: floor}}\n",
        *("  - {plane: {point: %(point)s, normal: %(normal)s, size: %(size)s}, material: mirror}\n" % m
          for m in scene.get("mirrors", [])),
        *("  - {sphere: {center: [%.9g, %.9g, %.9g], radius: %.9g}, material: object}\n" % tuple(s)
          for s in scene.get("spheres", [])),
    ]
    if "mesh" in scene:
        lines.append(f"  - {{mesh: {{file: {scene['mesh']}.obj}}, material: object}}\n")
    with open(path, "w", encoding="ascii") as file:
        file.writelines(lines)


def write_pov(scene, size, path):
    def vector(v):
        return "<%.9g, %.9g, %.9g>" % tuple(v)

    def texture(m):
        # POV-Ray's ambient light is a factor on the pigment.
        ambient = [a / d for a, d in zip(m["ambient"], m["diffuse"])]
        return (f"texture {{ pigment {{ color rgb {vector(m['diffuse'])} }} finish {{ ambient {vector(ambient)} "
                f"diffuse 1 phong {m['specular']} phong_size {m['shininess']} reflection {m['reflect']} }} }}")

    c = scene["camera"]
    aspect = size[0] / size[1]
    angle = 2 * math.degrees(math.atan(aspect * math.tan(math.radians(c["fov"] / 2))))
    with open(path, "w", encoding="ascii") as file:
        # adc_bailout 0: rays are followed to the full depth, as by everyone else. `right` points to -x, for a
        # right-handed world.
        file.write("#version 3.7;\nglobal_settings { assumed_gamma 1 ambient_light rgb 1 adc_bailout 0 "
                   f"max_trace_level {scene['max_depth']} }}\n"
                   f"camera {{ perspective location {vector(c['eye'])} sky {vector(c['up'])} up y "
                   f"right -{aspect:.9g}*x angle {angle:.9g} look_at {vector(c['target'])} }}\n")
        for light in scene["lights"]:
            file.write(f"light_source {{ {vector(light['position'])}, rgb {light['intensity']:.9g} }}\n")
        file.write(f"plane {{ z, {scene['floor_height']} {texture(scene['floor'])} }}\n")
        if "spheres" in scene:
            file.write(f"#declare look = {texture(scene['object'])}\n")
            for s in scene["spheres"]:
                file.write(f"sphere {{ {vector(s[:3])}, {s[3]:.9g} texture {{ look }} }}\n")
        else:
            file.write(f'#include "{scene["mesh"]}.inc"\n{texture(scene["object"])} }}\n')


def write_dat(scene, size, path):
    # Tachyon's world is left-handed: x is turned round, in everything.
    def vector(v):
        return "%.9g %.9g %.9g" % (-v[0], v[1], v[2])

    def color(c):
        return "%.9g %.9g %.9g" % tuple(c)

    def texture(m):
        # Tachyon has one colour for all terms: the ambient term is that of the strongest channel.
        largest = max(m["diffuse"])
        return (f"AMBIENT {max(m['ambient']) / largest:.9g} DIFFUSE {largest:.9g} SPECULAR {m['reflect']} OPACITY 1 "
                f"PHONG PLASTIC {m['specular']} PHONG_SIZE {m['shininess']} "
                f"COLOR {color([x / largest for x in m['diffuse']])} TEXFUNC 0")

    c = scene["camera"]
    view = unit(add(c["target"], scaled(-1, c["eye"])))
    with open(path, "wb") as file:
        def say(text):
            file.write((text + "\n").encode())
        zoom = 1 / (2 * math.tan(math.radians(c["fov"] / 2)))
        say(f"BEGIN_SCENE\nRESOLUTION {size[0]} {size[1]}\nCAMERA\nZOOM {zoom:.9g}\n"
            f"ASPECTRATIO 1\nANTIALIASING 0\nRAYDEPTH {scene['max_depth']}\nCENTER {vector(c['eye'])}\n"
            f"VIEWDIR {vector(view)}\nUPDIR {vector(c['up'])}\nEND_CAMERA\nBACKGROUND 0 0 0")
        for light in scene["lights"]:
            i = light["intensity"]
            say(f"LIGHT CENTER {vector(light['position'])} RAD 0.0001 COLOR {color([i, i, i])}")
        say(f"TEXDEF object {texture(scene['object'])}\nTEXDEF floor {texture(scene['floor'])}")
        say(f"PLANE CENTER 0 0 {scene['floor_height']} NORMAL 0 0 1 floor")
        for s in scene.get("spheres", []):
            say(f"SPHERE CENTER {vector(s[:3])} RAD {s[3]:.9g} object")
        if "mesh" in scene:
            write_stri(Knot(int(scene["mesh"].split("_")[1])), file)
        say("END_SCENE")


def write_json(scene, size, path):
    with open(path, "w", encoding="ascii") as file:
        json.dump({**scene, "size": list(size)}, file)


# ---- a model file, for reading


def write_waves(sides, file):
    """A square of 2 x 2 in waves, cut into sides x sides quadrangles of two triangles each; with everything."""
    def rows(line):
        for j in range(sides + 1):
            file.write("".join(line(i / sides, j / sides) for i in range(sides + 1)).encode())

    def normal(u, v):
        x, _, z = unit((-0.5 * math.cos(20 * u) * math.cos(17 * v), 1, 0.425 * math.sin(20 * u) * math.sin(17 * v)))
        return f"vn {x:.4f} {math.sqrt(1 - x * x - z * z):.4f} {z:.4f}\n"

    file.write(b"o waves\n")
    rows(lambda u, v: f"v {2 * u - 1:.6f} {0.05 * math.sin(20 * u) * math.cos(17 * v):.6f} {2 * v - 1:.6f}\n")
    rows(lambda u, v: f"vt {u:.6f} {v:.6f}\n")
    rows(normal)
    for j in range(sides):
        lines = []
        for i in range(sides):
            a = j * (sides + 1) + i + 1
            b, c, d = (f"{k}/{k}/{k}" for k in (a + 1, a + sides + 1, a + sides + 2))
            lines.append(f"f {a}/{a}/{a} {c} {d}\nf {a}/{a}/{a} {d} {b}\n")
        file.write("".join(lines).encode())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--triangles", type=int, nargs="*", default=[], help="more knots, of so many triangles")
    parser.add_argument("--lights", type=int, nargs="*", default=[], help="flakes under so many lights")
    parser.add_argument("--compared", type=int, default=1_000_000, help="triangles of the knot that is compared")
    parser.add_argument("--peers", action="store_true", help="for the other programs, too")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)

    def at(name):
        return os.path.join(options.folder, name)

    def write_knot(triangles, peers):
        knot = Knot(triangles)
        write_whole(at(f"knot_{triangles}.obj"), lambda file: write_obj(knot, file))
        if peers:
            write_whole(at(f"knot_{triangles}.inc"), lambda file: write_mesh2(knot, file))
            write_whole(at(f"knot_{triangles}.bin"), lambda file: write_binary(knot, file))

    size = (1280, 720)
    compared = {"flake": flake_scene(), "flake_mirror": with_mirrors(flake_scene()),
                "knot": knot_scene(options.compared), "knot_mirror": with_mirrors(knot_scene(options.compared))}
    write_knot(options.compared, options.peers)
    for name, scene in compared.items():
        write_yaml(scene, size, at(name + ".yaml"))
        if options.peers:
            write_pov(scene, size, at(name + ".pov"))
            write_dat(scene, size, at(name + ".dat"))
            write_json(scene, size, at(name + ".json"))
    write_whole(at("big.obj"), lambda file: write_waves(708, file))
    for triangles in options.triangles:
        write_knot(triangles, False)
        write_yaml(knot_scene(triangles), size, at(f"knot_{triangles}.yaml"))
    for lights in options.lights:
        write_yaml(with_lights(flake_scene(), lights), (320, 180), at(f"lights_{lights}.yaml"))
    write_yaml(between_mirrors(flake_scene()), size, at("between_mirrors.yaml"))
    with open(at("one_sphere.yaml"), "w", encoding="ascii") as file:
        file.write("lambent: 1\ncamera: {eye: [0, 1, 4], target: [0, 0, 0]}\nimage: {size: [64, 64]}\n"
                   "lights: [{point: {position: [3, 4, 4], intensity: 5}}]\n"
                   "objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: {diffuse: [0.8, 0.2, 0.1]}}]\n")


if __name__ == "__main__":
    sys.exit(main())
