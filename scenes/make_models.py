#!/usr/bin/env python3
"""Writes what is computed in scenes/: models/petal_*.obj, models/checker.*, images/*, dahlia.yaml and fullerene.yaml.

Run it anywhere: python3 scenes/make_models.py. It needs the standard library alone, and the same numbers come out
every time; they are rounded, so that the last bits of a machine's sine do not show.
"""

import itertools
import math
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent
GOLDEN_ANGLE = 180 * (3 - math.sqrt(5))  # degrees; leaves that follow each other at this angle never line up


def number(x, digits=4):
    """As short as can be: no zeros at the end, and no minus before a zero."""
    text = f"{x:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def numbers(values, digits=4):
    return "[" + ", ".join(number(v, digits) for v in values) + "]"


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def times(s, a):
    return tuple(s * x for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(sum(x * x for x in a))


def unit(a):
    return times(1 / length(a), a)


def mix(a, b, t):
    return tuple((1 - t) * x + t * y for x, y in zip(a, b))


def write(name, lines):
    path = HERE / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n")
    print(f"{path.relative_to(HERE.parent)}: {path.stat().st_size / 1000:.0f} kB")


# ---- a surface over a grid ---------------------------------------------------------------------------------------------


def grid_obj(title, surface, columns, rows):
    """An OBJ of surface(u, v), u and v from 0 to 1, with the normals of the surface itself."""
    lines = [f"# {title}", "# Written by scenes/make_models.py."]
    normals = []
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            lines.append("v " + " ".join(number(x, 5) for x in surface(u, v)))
            # Differences are taken over a step that stays inside the square.
            h = 1e-4
            u0, u1, v0, v1 = max(u - h, 0), min(u + h, 1), max(v - h, 0), min(v + h, 1)
            du = times(1 / (u1 - u0), sub(surface(u1, v), surface(u0, v)))
            dv = times(1 / (v1 - v0), sub(surface(u, v1), surface(u, v0)))
            normals.append(unit(cross(du, dv)))
    lines += ["vn " + " ".join(number(x) for x in n) for n in normals]
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            corners = (a, a + 1, a + columns + 2, a + columns + 1)
            lines.append("f " + " ".join(f"{c}//{c}" for c in corners))
    return lines


# ---- the dahlia --------------------------------------------------------------------------------------------------------


def petal(cup, curl):
    """A petal of length 1 along +x, y up: `cup` rolls its edges up, `curl` bends its tip up (or down, where negative)."""

    def surface(u, v):
        side = 2 * v - 1
        # Narrow at the root, widest past the middle, with a soft point; never quite 0, so that there is a normal.
        half_width = 0.012 + 0.235 * math.sin(math.pi * min(1, 0.08 + 0.92 * u**1.15)) ** 0.72 * (1 - 0.18 * u)
        angle = side * cup * (1.15 - 0.55 * u)  # across the petal lies an arc of this angle
        z = half_width * math.sin(angle) / cup
        rise = half_width * (1 - math.cos(angle)) / cup
        pleats = 0.006 * math.cos(5 * math.pi * side) * math.sin(math.pi * u) ** 0.6
        bend = curl * u  # along the petal too, of an angle that grows
        x = math.sin(bend) / curl
        y = (1 - math.cos(bend)) / curl
        out = rise + pleats
        return (x - out * math.sin(bend), y + out * math.cos(bend), -z)

    return surface


PETALS = {"inner": petal(1.15, 0.95), "middle": petal(1.0, 0.35), "outer": petal(0.85, -0.35)}
PETAL_COUNT = 233  # a Fibonacci number: so many seeds close the spirals

DAHLIA_HEAD = """\
# yaml-language-server: $schema=../docs/lambent.schema.json
#
# A dahlia on a polished table: 233 petals, each an instance of one of three small meshes, one golden angle after the
# other. Written by scenes/make_models.py; change that, not this file.

lambent: 1
camera: {eye: [0, 3.9, 3.9], target: [0, 0.27, 0.12], fov: 31}
image: {size: [1280, 720], samples: 16}
illumination: {model: phong, attenuation: 1/r, ambient_attenuation: 1/R, ambient: [5.5, 5.5, 6]}
background: [0.006, 0.009, 0.014]
lights:"""


def dahlia():
    lines = [DAHLIA_HEAD]
    # A lamp of some size is many points: the shadows get soft edges.
    key, key_radius, points = (-2.7, 5.2, 1.9), 0.8, 12
    for i in range(points):
        radius = key_radius * math.sqrt((i + 0.5) / points)
        angle = math.radians(i * GOLDEN_ANGLE)
        position = add(key, (radius * math.cos(angle), 0.3 * radius * math.sin(angle), radius * math.sin(angle)))
        lines.append(f"  - {{name: key {i + 1}, point: {{position: {numbers(position)}, color: [1, 0.92, 0.8], intensity: {number(8.4 / points)}}}}}")
    lines.append("  - {name: rim, spot: {position: [3.6, 2.4, -3.4], target: [0, 0.5, 0], angle: 70, softness: 1, color: [0.62, 0.75, 1], intensity: 4}}")
    lines.append("  - {name: fill, point: {position: [3.5, 4, 4.5], color: [0.8, 0.85, 1], intensity: 1.8}}")

    lines.append("materials:")
    steps = 16
    young, grown, old = (0.92, 0.50, 0.10), (0.86, 0.13, 0.10), (0.50, 0.025, 0.16)
    for i in range(steps):
        t = i / (steps - 1)
        color = mix(young, grown, t / 0.4) if t < 0.4 else mix(grown, old, (t - 0.4) / 0.6)
        lines.append(
            f"  - {{name: petal {i}, ambient: {numbers(times(0.075, color))}, diffuse: {numbers(color, 3)}, "
            f"specular: 0.22, shininess: 22}}"
        )
    lines.append("  - {name: table, ambient: [0.003, 0.004, 0.005], diffuse: [0.028, 0.034, 0.042], reflect: 0.3}")

    lines.append("objects:")
    lines.append("  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: table}")
    for i in range(PETAL_COUNT):
        t = (i + 0.5) / PETAL_COUNT  # 0 in the heart of the flower, 1 at its rim
        kind = "inner" if t < 0.22 else "middle" if t < 0.62 else "outer"
        size = 0.24 + 0.98 * t**0.62
        tilt = 84 - 88 * t**0.62  # from upright to lying
        root = 0.30 * math.sqrt(t)
        height = 0.78 - 0.52 * t**1.25
        # A little unlike each other, by sines that no spiral shares.
        size *= 1 + 0.045 * math.sin(12.9898 * i)
        tilt += 3.5 * math.sin(78.233 * i)
        twist = 9 * math.sin(37.719 * i)
        material = min(steps - 1, int(t**0.8 * steps))
        lines.append(
            f"  - {{mesh: {{file: models/petal_{kind}.obj}}, material: petal {material}, transform: "
            f"[{{scale: {number(size)}}}, {{rotate: {{axis: x, degrees: {number(twist, 2)}}}}}, "
            f"{{rotate: {{axis: z, degrees: {number(tilt, 2)}}}}}, {{translate: {numbers((root, height, 0))}}}, "
            f"{{rotate: {{axis: y, degrees: {number(i * GOLDEN_ANGLE % 360, 2)}}}}}]}}"
        )
    return lines


# ---- the fullerene -----------------------------------------------------------------------------------------------------

SINGLE, DOUBLE = 1.458, 1.401  # lengths of the two kinds of bond in C60, in angstroms

FULLERENE_HEAD = """\
# yaml-language-server: $schema=../docs/lambent.schema.json
#
# The molecule C60 as spheres and cylinders, from the geometry of the icosahedron: each of its twelve corners is cut off
# where the bonds get their measured lengths, 1.458 angstroms around the pentagons and 1.401 between them. A lamp inside
# throws the pattern of the bonds on the walls. Written by scenes/make_models.py; change that, not this file.

lambent: 1
camera: {eye: [5.2, 8.2, 19.5], target: [0.2, 4.35, -1.5], fov: 33}
image: {size: [1280, 720], samples: 16}
illumination: {model: blinn_phong, attenuation: 1/r, ambient_attenuation: 1/R, ambient: [20, 20, 22]}
background: [0.01, 0.012, 0.016]
lights:
  - {name: lamp, point: {position: [0, 4.9, 0], color: [1, 0.78, 0.48], intensity: 7}}
  - {name: window, spot: {position: [12, 16, 14], target: [0, 4, 0], angle: 46, softness: 0.6, color: [0.75, 0.86, 1], intensity: 9}}
materials:
  - {name: carbon, ambient: 0.012, diffuse: [0.13, 0.14, 0.16], specular: 0.55, shininess: 60, reflect: 0.06}
  - {name: single, ambient: 0.02, diffuse: [0.30, 0.31, 0.33], specular: 0.4, shininess: 40}
  - {name: double, ambient: [0.05, 0.03, 0.006], diffuse: [0.75, 0.42, 0.07], specular: 0.5, shininess: 40}
  # The lamp's globe shines by itself and lets all light through, so that the lamp inside it is not blocked.
  - {name: globe, ambient: 0, diffuse: 0, transmit: 1, ior: 1, emission: [0.55, 0.36, 0.16]}
  - {name: wall, ambient: 0.022, diffuse: [0.62, 0.60, 0.57]}
  - {name: floor, ambient: 0.02, diffuse: [0.50, 0.48, 0.46], reflect: 0.12}
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: floor}
  - {plane: {point: [0, 0, -7], normal: [0, 0, 1]}, material: wall}
  - {plane: {point: [-9, 0, 0], normal: [1, 0, 0]}, material: wall}
  - {sphere: {center: [0, 4.9, 0], radius: 0.55}, material: globe}"""


def fullerene():
    phi = (1 + math.sqrt(5)) / 2
    corners = [p for a, b in itertools.product((1, -1), (phi, -phi)) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    edges = [(a, b) for a, b in itertools.permutations(corners, 2) if abs(length(sub(a, b)) - 2) < 1e-9]
    # Two edges of a triangle, cut at the share s from a shared corner, leave a pentagon's side of s and a hexagon's of 1 - 2s.
    s = SINGLE / (2 * SINGLE + DOUBLE)
    scale = (2 * SINGLE + DOUBLE) / 2
    atoms = {(a, b): times(scale, mix(a, b, s)) for a, b in edges}
    bonds = []
    for (one, p), (two, q) in itertools.combinations(atoms.items(), 2):
        if abs(length(sub(p, q)) - SINGLE) < 1e-6:
            bonds.append((p, q, "single"))
        elif abs(length(sub(p, q)) - DOUBLE) < 1e-6:
            bonds.append((p, q, "double"))
    assert len(atoms) == 60 and len(bonds) == 90
    place = "transform: [{rotate: {axis: [1, 0.3, 0.2], degrees: 17}}, {translate: [0, 4.9, 0]}]"
    lines = [FULLERENE_HEAD]
    for p in atoms.values():
        lines.append(f"  - {{sphere: {{center: {numbers(p)}, radius: 0.36}}, material: carbon, {place}}}")
    for p, q, kind in bonds:
        radius = "0.13" if kind == "single" else "0.17"
        lines.append(f"  - {{cylinder: {{from: {numbers(p)}, to: {numbers(q)}, radius: {radius}}}, material: {kind}, {place}}}")
    return lines


# ---- a floor of squares ------------------------------------------------------------------------------------------------


def checker(squares):
    """A square floor of two materials, as Whitted's was: each square has a side of 1, the middle is at 0."""
    lines = ["# A checkered floor.", "# Written by scenes/make_models.py.", "mtllib checker.mtl"]
    for j in range(squares + 1):
        for i in range(squares + 1):
            lines.append(f"v {number(i - squares / 2)} 0 {number(j - squares / 2)}")
    for parity, material in enumerate(("light_square", "dark_square")):
        lines.append(f"usemtl {material}")
        for j, i in itertools.product(range(squares), repeat=2):
            if (i + j) % 2 == parity:
                a = j * (squares + 1) + i + 1
                lines.append(f"f {a} {a + squares + 1} {a + squares + 2} {a + 1}")
    return lines


CHECKER_MATERIALS = """\
# The squares of checker.obj, plain.
# Written by scenes/make_models.py.
newmtl light_square
Ka 0.08 0.08 0.08
Kd 0.7 0.7 0.7
illum 1
newmtl dark_square
Ka 0.02 0.02 0.02
Kd 0.15 0.15 0.15
illum 1"""


# ---- images --------------------------------------------------------------------------------------------------------------


def png(width, height, channels, pixel):
    """An 8-bit PNG; pixel(x, y) gives `channels` whole numbers."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def rgbe(color):
    """A colour as Radiance's pictures hold it: three mantissas and the exponent that they share."""
    largest = max(color)
    if largest < 1e-9:
        return bytes(4)
    exponent = math.frexp(largest)[1]
    scale = 256 / 2**exponent
    return bytes([min(int(c * scale), 255) for c in color] + [exponent + 128])


TILE = 64  # texels


def tile_edge(x, y):
    """How far a texel is from the nearest joint, in texels."""
    return min(x % TILE, TILE - 1 - x % TILE, y % TILE, TILE - 1 - y % TILE)


def tile_color(x, y):
    """Two by two tiles, two light and two dark, with pale joints; a little of each tile's own."""
    if tile_edge(x, y) < 2:
        return (196, 188, 176)
    i, j = x // TILE, y // TILE
    grain = 6 * math.sin(0.9 * x + 2.3 * i) * math.sin(0.7 * y + 1.7 * j)
    base = (206, 196, 178) if (i + j) % 2 else (92, 104, 112)
    return tuple(int(round(c + grain)) for c in base)


def tile_height(x, y):
    """The joints lie deeper, and tiles are a little round at their edges."""
    return (int(round(255 * min(max(tile_edge(x, y) - 1, 0) / 5, 1) ** 0.5)),)


def studio_sky(x, y, width, height):
    """A grey studio: a bright panel above to the left, a softer one to the right, and a floor that is darker."""
    longitude, latitude = 360 * (x + 0.5) / width - 180, 90 - 180 * (y + 0.5) / height

    def panel(at_longitude, at_latitude, wide, high, soft):
        across = max(abs(longitude - at_longitude) - wide, 0) / soft
        up = max(abs(latitude - at_latitude) - high, 0) / soft
        return math.exp(-(across**2) - up**2)

    base = 0.16 + 0.22 * (latitude + 90) / 180
    key, fill, rim = panel(-60, 42, 22, 16, 4), panel(70, 25, 16, 24, 5), panel(170, 30, 30, 8, 6)
    return tuple(base * t + 7 * key * k + 2.2 * fill * f + 3 * rim for t, k, f in
                 zip((0.95, 1, 1.06), (1, 0.96, 0.88), (0.85, 0.93, 1)))


def hdr(width, height, color):
    """A Radiance picture without run lengths."""
    head = f"#?RADIANCE\n# Written by scenes/make_models.py.\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    return head.encode() + b"".join(rgbe(color(x, y, width, height)) for y in range(height) for x in range(width))


def main():
    (HERE / "images").mkdir(exist_ok=True)
    (HERE / "images/tiles.png").write_bytes(png(2 * TILE, 2 * TILE, 3, tile_color))
    (HERE / "images/tiles_height.png").write_bytes(png(2 * TILE, 2 * TILE, 1, tile_height))
    (HERE / "images/studio.hdr").write_bytes(hdr(256, 128, studio_sky))
    for name, surface in PETALS.items():
        write(f"models/petal_{name}.obj", grid_obj(f"A petal of a dahlia, {name} ring.", surface, 40, 24))
    write("models/checker.obj", checker(24))
    write("models/checker.mtl", [CHECKER_MATERIALS])
    write("dahlia.yaml", dahlia())
    write("fullerene.yaml", fullerene())


if __name__ == "__main__":
    main()
