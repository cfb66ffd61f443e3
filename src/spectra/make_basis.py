#!/usr/bin/env python3
"""Makes basis.inc: three smooth reflectances R, G and B, at least 0 and with R + G + B = 1 at every wavelength, that look in D65's
light like the primaries of sRGB. The method is that of Mallett and Yuksel, Spectral primary decomposition for rendering with sRGB
reflectance, EGSR 2019; the numbers are our own: they keep the sum of squared steps from sample to sample small.

    src/spectra/make_basis.py > src/spectra/basis.inc

reads observer.inc beside it, and needs nothing but Python. The build does not run it.
"""
import pathlib
import re

here = pathlib.Path(__file__).parent
rows = [[float(x) for x in re.findall(r"[-+.\de]+", line)]
        for line in (here / "observer.inc").read_text().splitlines() if line.startswith("{")]
count = len(rows)

# What a reflectance adds to X, Y, Z of its colour in D65; Y of white is 1.
xyz = [[row[c] * row[4] for row in rows] for c in (1, 2, 3)]
scale = 1 / sum(xyz[1])
xyz = [[scale * x for x in row] for row in xyz]


def solve(a, b):
    """x with a x = b, by elimination with pivots."""
    n = len(b)
    m = [row[:] + [value] for row, value in zip(a, b)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(m[r][i]))
        m[i], m[pivot] = m[pivot], m[i]
        for r in range(i + 1, n):
            factor = m[r][i] / m[i][i]
            if factor != 0:
                top, low = m[i], m[r]
                for c in range(i, n + 1):
                    low[c] -= factor * top[c]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (m[i][n] - sum(m[i][c] * x[c] for c in range(i + 1, n))) / m[i][i]
    return x


def rgb_from_xyz():
    """The matrix by the primaries of IEC 61966-2-1; white is what the table makes of D65."""
    chromaticities = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)]
    primaries = [[x / y, 1, (1 - x - y) / y] for x, y in chromaticities]
    shares = solve([[p[c] for p in primaries] for c in range(3)], [sum(row) for row in xyz])
    columns = [[shares[p] * primaries[p][c] for p in range(3)] for c in range(3)]
    inverse = [solve(columns, [1.0 if i == k else 0.0 for i in range(3)]) for k in range(3)]
    return [[inverse[k][p] for k in range(3)] for p in range(3)]


matrix = rgb_from_xyz()
rgb = [[sum(matrix[p][c] * xyz[c][i] for c in range(3)) for i in range(count)] for p in range(3)]

# The unknowns are R, then G; B = 1 - R - G. Least squares of steps under equations, by its Lagrangian; samples that
# fall below 0 are held there, until none falls.
variables = 2 * count
hessian = [[0.0] * variables for _ in range(variables)]


def add_step(signs):
    for i, si in signs:
        for j, sj in signs:
            hessian[i][j] += si * sj


for i in range(count - 1):
    add_step([(i, -1), (i + 1, 1)])
    add_step([(count + i, -1), (count + i + 1, 1)])
    add_step([(i, -1), (i + 1, 1), (count + i, -1), (count + i + 1, 1)])

equations = [([0.0] * (which * count) + rgb[c] + [0.0] * ((1 - which) * count), float(c == which))
             for which in range(2) for c in range(3)]
held = set()  # (0 R, 1 G, 2 B; sample)
while True:
    constraints = list(equations)
    for which, i in sorted(held):
        row = [0.0] * variables
        if which < 2:
            row[which * count + i] = 1.0
        else:
            row[i] = row[count + i] = 1.0
        constraints.append((row, float(which == 2)))
    n = variables + len(constraints)
    system = [hessian[i] + [row[i] for row, _ in constraints] for i in range(variables)]
    system += [row + [0.0] * len(constraints) for row, _ in constraints]
    x = solve(system, [0.0] * variables + [value for _, value in constraints])
    basis = [x[:count], x[count:variables], [1 - a - b for a, b in zip(x[:count], x[count:variables])]]
    fallen = {(which, i) for which in range(3) for i in range(count) if basis[which][i] < -1e-9} - held
    if not fallen:
        break
    held |= fallen

print("// Written by make_basis.py. Wavelength in nm, R, G; B = 1 - R - G.")
for i in range(count):
    print("{%g, %.7f, %.7f}," % (rows[i][0], max(0.0, basis[0][i]), max(0.0, basis[1][i])))
