#!/usr/bin/env python3
"""Draws what `run.py --large --json FILE` measures: processor seconds against places, both on
logarithmic scales, with a line along which they grow alike.

    draw_cost.py FILE PICTURE.svg"""

import json
import math
import pathlib
import sys

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 520, 330, 60, 16, 44
DECADES_X, DECADES_Y = (3, 7), (-3, 3)


def place(places, seconds):
    x = (math.log10(places) - DECADES_X[0]) / (DECADES_X[1] - DECADES_X[0])
    y = (math.log10(seconds) - DECADES_Y[0]) / (DECADES_Y[1] - DECADES_Y[0])
    return LEFT + x * (WIDTH - LEFT - 20), HEIGHT - BOTTOM - y * (HEIGHT - BOTTOM - TOP)


def text(x, y, words, anchor="middle", color="#444"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def line(points, color, dash=""):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.5"{dashes}/>'


def curve(rows, key, color, name):
    known = [(row["places"], row[key]) for row in rows if row.get(key, 0) > 0]
    points = [place(*pair) for pair in known]
    dots = [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{color}"/>' for x, y in points]
    x, y = points[-1]
    return [line(points, color), *dots, text(x - 8, y - 8, name, "end", color)]


def main():
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text())
    parts = []
    for power in range(DECADES_X[0], DECADES_X[1] + 1):
        x, bottom = place(10**power, 10 ** DECADES_Y[0])
        parts.append(line([(x, bottom), place(10**power, 10 ** DECADES_Y[1])], "#ddd"))
        parts.append(text(x, bottom + 18, f'10<tspan dy="-5" font-size="9">{power}</tspan>'))
    for power in range(DECADES_Y[0], DECADES_Y[1] + 1):
        x, y = place(10 ** DECADES_X[0], 10**power)
        parts.append(line([(x, y), place(10 ** DECADES_X[1], 10**power)], "#ddd"))
        parts.append(text(x - 8, y + 4, f"{10.0**power:g} s", "end"))
    parts.append(line([place(1e3, 0.001), place(1e7, 10)], "#999", "4 4"))
    parts.append(text(*place(4e4, 0.02), "1 \u00b5s for each place", "start", "#888"))
    parts.append(text((LEFT + WIDTH - 20) / 2, HEIGHT - 8, "places"))
    parts += curve(rows, "clough_tocher", "#b5651d", "Clough-Tocher (SciPy)")
    parts += curve(rows, "processor_seconds", "#1f5fa8", "bandvox fit")
    pathlib.Path(sys.argv[2]).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )


if __name__ == "__main__":
    main()
