"""Scenes that Lambent, Mitsuba 3 and Cycles can all express exactly, as plain data.

A scene holds
  eye, target, fov   of the camera; degrees, up and down and across, as pictures are square; up is y
  depth              how many rays a path may have, the one from the eye included
  sky                radiance from all around
  sun                {"to": unit vector towards it, "irradiance": on what faces it}, or None
  lamps              {"center", "u", "v": sides, "radiance"}: rectangles that shine where u x v points. Nothing stands
                     behind them, and where there are some the sky is black: lamps of Cycles hide nothing
  things             {"vertices", "faces": triangles, "material"}: flat faces, without smooth normals
Materials are {"matt": color}, {"metal": roughness} (GGX, alpha = roughness^2, which reflects all light; smooth enough
that what microfacets lose is below the noise, as only some programs make up for it), {"mirror": color} and
{"glass": index}, both perfectly smooth, and {"shines": radiance}, which reflects nothing.
"""

import array
import math


def thing(vertices, faces, **material):
    # Everybody gets the same bits: numbers of single precision.
    return {"vertices": [list(array.array("f", v)) for v in vertices], "faces": faces, "material": material}


def quad(corners, **material):
    return thing(corners, [[0, 1, 2], [0, 2, 3]], **material)


def block(center, half, low, high, degrees, **material):
    """A box that is turned about y; with its bottom where it stands in the air."""
    turn, (x, z) = math.radians(degrees), center
    ring = [(x + math.cos(turn) * a + math.sin(turn) * b, z - math.sin(turn) * a + math.cos(turn) * b)
            for a, b in ((-half, -half), (-half, half), (half, half), (half, -half))]
    vertices = [[px, low, pz] for px, pz in ring] + [[px, high, pz] for px, pz in ring]
    faces = [[4, 5, 6], [4, 6, 7]]
    for i in range(4):
        j = (i + 1) % 4
        faces += [[i, j, j + 4], [i, j + 4, i + 4]]
    if low > 0:
        faces += [[0, 2, 1], [0, 3, 2]]
    return thing(vertices, faces, **material)


def ball(center, radius, times, **material):
    """An octahedron whose faces are divided into four, some times, and pushed out to the sphere."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    for _ in range(times):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                sum_of = [p + q for p, q in zip(points[a], points[b])]
                length = math.sqrt(sum(v * v for v in sum_of))
                middles[key] = len(points)
                points.append(tuple(v / length for v in sum_of))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        faces = finer
    return thing([[c + radius * v for c, v in zip(center, p)] for p in points], faces, **material)


def lamp(center, u, v, radiance):
    return {"center": center, "u": u, "v": v, "radiance": radiance}


def scene(things, eye, target, fov, depth, lamps=(), sky=(0, 0, 0), sun=None):
    return {"eye": list(eye), "target": list(target), "fov": fov, "depth": depth, "sky": list(sky), "sun": sun,
            "lamps": list(lamps), "things": things}


WHITE, RED, GREEN = [0.73] * 3, [0.63, 0.06, 0.05], [0.14, 0.45, 0.09]


def box(side, power, tall, short):
    """A Cornell box, open at the front, with a square hole in its ceiling that a lamp fills."""
    half = side / 2
    things = [
        quad([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], matt=WHITE),
        quad([[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]], matt=WHITE),
        quad([[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]], matt=RED),
        quad([[1, 0, 1], [1, 2, 1], [1, 2, -1], [1, 0, -1]], matt=GREEN),
    ]
    for x0, x1, z0, z1 in ((-1, -half, -1, 1), (half, 1, -1, 1), (-half, half, -1, -half), (-half, half, half, 1)):
        things.append(quad([[x0, 2, z0], [x1, 2, z0], [x1, 2, z1], [x0, 2, z1]], matt=WHITE))
    things.append(block((-0.35, -0.3), 0.3, 0, 1.2, 18, **tall))
    things.append(block((0.35, 0.35), 0.3, 0, 0.6, -17, **short))
    return scene(things, (0, 1, 3.9), (0, 1, 0), 38, 16,
                 [lamp([0, 2, 0], [side, 0, 0], [0, 0, side], [power / side**2] * 3)])


def glass():
    """A cut glass ball, a mirror and a matt block under a lamp as large as a window."""
    things = [
        quad([[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], matt=[0.6, 0.6, 0.55]),
        quad([[-4, 0, -2.5], [4, 0, -2.5], [4, 4, -2.5], [-4, 4, -2.5]], matt=[0.35, 0.45, 0.6]),
        ball([-0.1, 0.71, 0.4], 0.7, 3, glass=1.5),
        block((1.3, -0.6), 0.5, 0, 1.3, 25, mirror=[0.9, 0.85, 0.8]),
        block((-1.4, -0.7), 0.45, 0, 1, 10, matt=[0.7, 0.25, 0.15]),
    ]
    return scene(things, (0, 1.7, 5.2), (0, 0.6, 0), 40, 32,
                 [lamp([-0.5, 4, 1], [2.5, 0, 0], [0, 0, 2.5], [3] * 3)])


def sky():
    """Matt blocks and a cut mirror in the open, under an even sky and the sun."""
    to_sun = [0.48, 0.6, 0.64]
    things = [
        quad([[-20, 0, 20], [20, 0, 20], [20, 0, -20], [-20, 0, -20]], matt=[0.5, 0.45, 0.4]),
        ball([0.75, 0.6, 0.5], 0.6, 2, mirror=[0.9, 0.85, 0.7]),
        block((-0.8, 0), 0.5, 0, 1.6, 30, matt=[0.7, 0.7, 0.7]),
        block((0.3, -1.2), 0.4, 0, 0.9, 55, matt=[0.2, 0.4, 0.7]),
    ]
    return scene(things, (0.3, 1.6, 5), (0, 0.6, 0), 36, 16, sky=[0.5, 0.7, 1],
                 sun={"to": to_sun, "irradiance": [2.5, 2.3, 2]})


def lanterns():
    """A hundred small lamps over a yard of pillars, of several colours and strengths."""
    things = [quad([[-6, 0, 6], [6, 0, 6], [6, 0, -6], [-6, 0, -6]], matt=[0.6] * 3)]
    for i in range(5):
        for j in range(5):
            things.append(block((2 * i - 4 + 0.3 * math.sin(7 * i + 3 * j), 2 * j - 4), 0.35, 0,
                                0.6 + 0.3 * ((3 * i + 2 * j) % 4), 13 * i + 29 * j, matt=WHITE))
    colors = ([1, 0.7, 0.4], [1, 0.9, 0.8], [0.4, 0.6, 1])
    for i in range(10):
        for j in range(10):
            strength = 1 + (7 * i + 3 * j) % 5
            at = [1.1 * i - 4.95 + 0.2 * math.sin(5 * i + j), 0.35 + 0.35 * ((i + 2 * j) % 5), 1.1 * j - 4.6]
            things.append(ball(at, 0.12, 0, shines=[strength * c for c in colors[(i + j) % 3]]))
    return scene(things, (0, 4.2, 8.5), (0, 0.5, 0), 42, 8)


SCENES = {
    "Cornell box": box(0.5, 4, {"matt": WHITE}, {"matt": WHITE}),
    "Metal in the box": box(0.5, 4, {"metal": 0.1}, {"matt": WHITE}),
    "Glass": glass(),
    "Sky and sun": sky(),
    "Hundred lanterns": lanterns(),
}
