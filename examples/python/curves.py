"""Learning curves of ppo.py as an SVG: mean return over wall time.

python curves.py lander1.json lander2.json --out curves.svg
"""

import argparse
import json

WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 720, 300, 60, 40, 24, 16
COLOURS = ["#1b6ca8", "#d1495b", "#2e933c", "#8d5a97", "#c77d0a", "#4a4a4a"]


def ticks(low, high, count=5):
    step = (high - low) / count
    power = 10 ** len(str(int(step))) / 10
    step = max(s * power for s in (1, 2, 5, 10) if s * power <= max(step, power)) or 1
    first = -(-low // step) * step
    return [first + i * step for i in range(int((high - first) / step) + 1)]


def main(argv=None):
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("files", nargs="+")
    p.add_argument("--out", default="curves.svg")
    o = p.parse_args(argv)
    runs = []
    for name in o.files:
        with open(name) as file:
            run = json.load(file)
        points = [(c["seconds"], c["return"]) for c in run["curve"] if c["return"] == c["return"]]
        runs.append((f"{run['task']}, seed {run['seed']}", points))
    xs = [x for _, points in runs for x, _ in points]
    ys = [y for _, points in runs for _, y in points]
    x1, y0, y1 = max(xs), max(min(ys), -400), max(ys) + 20
    across = lambda x: LEFT + (WIDTH - LEFT - RIGHT) * x / x1
    up = lambda y: HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * (max(y, y0) - y0) / (y1 - y0)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    for y in ticks(y0, y1):
        out.append(
            f'<path d="M{LEFT} {up(y):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
            f'<text x="{LEFT - 8}" y="{up(y) + 4:.1f}" text-anchor="end">{y:g}</text>'
        )
    for x in ticks(0, x1, 8):
        out.append(
            f'<text x="{across(x):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{x:g}</text>'
        )
    out.append(
        f'<text x="{(WIDTH + LEFT) / 2}" y="{HEIGHT - 6}" text-anchor="middle">wall time, s</text>'
        f'<text x="8" y="14">mean return of the last episodes</text>'
    )
    for i, (name, points) in enumerate(runs):
        line = " ".join(f"{across(x):.1f},{up(y):.1f}" for x, y in points)
        colour = COLOURS[i % len(COLOURS)]
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        out.append(
            f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - BOTTOM - 12 - 15 * (len(runs) - 1 - i)}" '
            f'text-anchor="end" fill="{colour}">{name}</text>'
        )
    with open(o.out, "w") as file:
        file.write("\n".join([*out, "</svg>", ""]))


if __name__ == "__main__":
    main()
