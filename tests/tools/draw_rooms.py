"""Draws the rooms of the code and the arrows between them, from its #include lines.

Usage: draw_rooms.py SOURCE_DIR PICTURE.svg      writes the picture
       draw_rooms.py SOURCE_DIR PICTURE.svg --check   fails where the picture is not that of the sources

A box is a folder of the top level with its number of files and of lines; under its name stand the folders in it. An
arrow means that files of a box include files of the box that it points to. Arrows that follow from others are left out.
"""

import re
import sys
from pathlib import Path

ROOMS = ["common", "linear", "mesh", "plate", "mbs_export", "reduce", "plugin", "squeal", "sound", "scene", "cases", "report", "cli", "python"]  # fmt: skip
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
WIDTH, HEIGHT, LANE, GAP_X, GAP_Y, MARGIN = 190, 74, 10, 26, 46, 20


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".cpp", ".hpp", ".h"))


def rooms_of(root):
    """For each room: files, lines, rooms in it, and the rooms that its files include."""
    rooms = {}
    for name in (name for name in ROOMS if (root / name).is_dir()):
        files = sources(root / name)
        texts = [path.read_text() for path in files]
        included = {header.split("/")[0] for text in texts for header in INCLUDE.findall(text)}
        inside = [path.relative_to(root / name).parts for path in files]
        rooms[name] = {"files": len(files), "lines": sum(text.count("\n") for text in texts),
                       "inner": sorted({parts[0] for parts in inside if len(parts) > 1}),
                       "needs": {other for other in included if other in ROOMS and other != name}}  # fmt: skip
    return rooms


def reach(rooms, name, seen=None):
    """All rooms that a room needs, by way of others too."""
    seen = set() if seen is None else seen
    for other in rooms[name]["needs"]:
        if other not in seen:
            seen.add(other)
            reach(rooms, other, seen)
    return seen


def direct(rooms, name):
    """What a room needs and nothing else that it needs does."""
    needs = rooms[name]["needs"]
    return sorted(other for other in needs if not any(other in reach(rooms, via) for via in needs - {other}))


def levels(rooms):
    level = {}

    def of(name):
        if name not in level:
            level[name] = 1 + max((of(other) for other in rooms[name]["needs"]), default=-1)
        return level[name]

    for name in rooms:
        of(name)
    return level


def rows_of(rooms):
    """The boxes of each level from left to right, and between them the arrows (from, to, level) that pass it."""
    level = levels(rooms)
    rows = [[name for name in rooms if level[name] == k] for k in range(max(level.values()) + 1)]
    for name in rooms:
        for other in direct(rooms, name):
            for k in range(level[other] + 1, level[name]):
                rows[k].append((name, other, k))
    return rows


def width_of(item):
    return WIDTH if isinstance(item, str) else LANE


def places(rooms):
    """Left edge and top of each box and lane: near what it points to."""
    x, corners, level = {}, {}, levels(rooms)

    def wish(item):
        name, targets, k = (item, direct(rooms, item), level[item]) if isinstance(item, str) else (item[0], [item[1]], item[2])
        above = [x[(name, other, k - 1)] if (name, other, k - 1) in x else x[other] for other in targets]
        return sum(above) / len(above) if above else 0.0

    for k, row in enumerate(rows_of(rooms)):
        row.sort(key=wish)
        total = sum(width_of(item) + GAP_X for item in row) - GAP_X
        left = -total / 2
        for item in row:
            x[item] = left + width_of(item) / 2
            corners[item] = (left, MARGIN + k * (HEIGHT + GAP_Y))
            left += width_of(item) + GAP_X
    shift = MARGIN - min(left for left, _ in corners.values())
    return {item: (left + shift, top) for item, (left, top) in corners.items()}


def box(name, room, corner):
    x, y = corner
    inner = ", ".join(room["inner"])
    inner = inner if len(inner) < 36 else inner[:33] + "..."
    size = f"{room['files']} files, {room['lines']} lines"
    texts = [(24, 16, "bold", name), (44, 11, "normal", size), (61, 10, "normal", inner)]
    lines = [f'<rect x="{x:.0f}" y="{y:.0f}" width="{WIDTH}" height="{HEIGHT}" rx="6" fill="#f4f1ea" stroke="#444"/>']
    for dy, height, weight, text in texts:
        place = f'x="{x + WIDTH / 2:.0f}" y="{y + dy:.0f}"'
        lines.append(f'<text {place} font-size="{height}" font-weight="{weight}" text-anchor="middle">{text}</text>')
    return lines


def arrow(points):
    """From the top of one box, by way of lanes, to the bottom of another."""
    x, y = points[0]
    path = f"M{x:.0f},{y:.0f}"
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        bend = (y0 - y1) / 2
        path += f" C{x0:.0f},{y0 - bend:.0f} {x1:.0f},{y1 + bend:.0f} {x1:.0f},{y1:.0f}"
    return f'<path d="{path}" fill="none" stroke="#2a6f97" marker-end="url(#tip)"/>'


def way(name, other, corners, rows):
    """Points of an arrow: straight through the levels that it passes."""
    left, top = corners[name]
    points = [(left + WIDTH / 2, top)]
    for k in reversed(range(len(rows))):
        if (name, other, k) in corners:
            left, top = corners[(name, other, k)]
            points += [(left + LANE / 2, top + HEIGHT), (left + LANE / 2, top)]
    left, top = corners[other]
    return [*points, (left + WIDTH / 2, top + HEIGHT + 4)]


def picture(rooms):
    rows, corners = rows_of(rooms), places(rooms)
    width = MARGIN + max(left + width_of(item) for item, (left, _) in corners.items())
    height = 2 * MARGIN + len(rows) * (HEIGHT + GAP_Y) - GAP_Y
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" font-family="sans-serif">',
             '<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="6" refY="3" orient="auto">'
             '<path d="M0,0 L7,3 L0,6 z" fill="#2a6f97"/></marker></defs>',
             f'<rect width="{width:.0f}" height="{height}" fill="white"/>']  # fmt: skip
    for name in rooms:
        lines += [arrow(way(name, other, corners, rows)) for other in direct(rooms, name)]
    for name, room in rooms.items():
        lines += box(name, room, corners[name])
    return "\n".join([*lines, "</svg>", ""])


def shape(text):
    """Of a picture what a change within a room does not change."""
    return re.sub(r"\d+ files, \d+ lines", "", text)


if __name__ == "__main__":
    root, file = Path(sys.argv[1]), Path(sys.argv[2])
    drawn = picture(rooms_of(root))
    if "--check" not in sys.argv:
        file.write_text(drawn)
    elif shape(file.read_text()) != shape(drawn):
        sys.exit(f"{file} is not the picture of these sources; draw it anew: tests/tools/draw_rooms.py . {file}")
