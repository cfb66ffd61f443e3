"""Line charts with logarithmic axes, as SVG. No library: what is needed is small, and the files stay small and alike."""

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 720, 420
LEFT, RIGHT, TOP, BOTTOM = 70, 190, 44, 54
COLORS = ["#0a5ea8", "#c2410c", "#15803d", "#7e22ce", "#b45309", "#0f766e", "#be123c"]


class Axis:
    """Where a value lies between `start` and `end` in the picture; logarithmic unless it spans little."""

    def __init__(self, values, start, end, logarithmic=True):
        low, high = min(values), max(values)
        self.logarithmic = logarithmic and low > 0
        if self.logarithmic:
            low, high = math.log10(low), math.log10(high)
            low, high = math.floor(low * 2 + 1e-9) / 2, math.ceil(high * 2 - 1e-9) / 2
        else:
            low = min(low, 0)
        if high <= low:
            high = low + 1
        self.low, self.high, self.start, self.end = low, high, start, end

    def place(self, value):
        v = math.log10(value) if self.logarithmic else value
        return self.start + (v - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self):
        """The values that have a line and a label."""
        if not self.logarithmic:
            step = 10 ** math.floor(math.log10((self.high - self.low) / 2))
            while (self.high - self.low) / step > 8:
                step *= 2
            return [self.low + i * step for i in range(int((self.high - self.low) / step + 1e-9) + 1)]
        span = self.high - self.low
        steps = (1,) if span > 3 else (1, 3) if span > 1.5 else (1, 2, 5)
        found = [s * 10**e for e in range(math.floor(self.low), math.ceil(self.high) + 1) for s in steps]
        return [v for v in found if self.low - 1e-9 <= math.log10(v) <= self.high + 1e-9]


def label(value):
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size * 0.9999 and (size > 1e3 or value >= 1e4):
            return f"{value / size:.6g}{letter}"
    return f"{value:.6g}"


def chart(title, x_title, y_title, series, x_logarithmic=True):
    """series: a list of (name, [(x, y, y_low, y_high), ...]). Returns the text of an SVG file."""
    points = [p for _, line in series for p in line]
    x = Axis([p[0] for p in points], LEFT, WIDTH - RIGHT, x_logarithmic)
    y = Axis([v for p in points for v in p[1:]], HEIGHT - BOTTOM, TOP)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="sans-serif" font-size="12" fill="#222">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
        f'<text x="{LEFT}" y="24" font-size="15" font-weight="bold">{escape(title)}</text>',
    ]
    for v in x.ticks():
        at = x.place(v)
        out.append(f'<path d="M{at:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                   f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{label(v)}</text>')
    for v in y.ticks():
        at = y.place(v)
        out.append(f'<path d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{label(v)}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 14}" text-anchor="middle">{escape(x_title)}</text>'
               f'<text transform="translate(18 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">'
               f"{escape(y_title)}</text>")
    for i, (name, line) in enumerate(series):
        color = COLORS[i % len(COLORS)]
        path = " ".join(f"{'L' if j else 'M'}{x.place(p[0]):.1f} {y.place(p[1]):.1f}" for j, p in enumerate(line))
        out.append(f'<path d="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
        for p in line:
            px = x.place(p[0])
            out.append(f'<path d="M{px:.1f} {y.place(p[2]):.1f}V{y.place(p[3]):.1f}" stroke="{color}"/>'
                       f'<circle cx="{px:.1f}" cy="{y.place(p[1]):.1f}" r="3" fill="{color}"/>')
        at = TOP + 8 + 20 * i
        out.append(f'<path d="M{WIDTH - RIGHT + 14} {at}h22" stroke="{color}" stroke-width="2"/>'
                   f'<text x="{WIDTH - RIGHT + 42}" y="{at + 4}">{escape(name)}</text>')
    return "\n".join(out + ["</svg>", ""])
