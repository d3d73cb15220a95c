"""Makes the pictures of docs/gallery.md: runs the programs, and turns the plots they leave into small PNG files.

python3 docs/gallery/build.py [NAME ...]    all, or those named; needs cargo and rsvg-convert
python3 docs/gallery/build.py NAME=FILE     a plot that is there already
"""

import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
# Pixels of a plot's unit: fewer blur the ends of colour bars.
ZOOM = "1.25"

# Program of crates/validation: the plot that it leaves, and the options that suit a gallery.
PICTURES = {
    "cellular_filler": ("c1.5mm_mu1e-3/sections.svg", []),
    "channel": ("poiseuille.svg", []),
    "dam_break": ("frame_00020.svg", []),
    "elastic_gate": ("gate.svg", []),
    "elastic_plate": ("plate.svg", []),
    "hydrostatic": ("column.svg", []),
    "hypervelocity": ("cloud.svg", []),
    "lid_driven_cavity": ("cavity_100.svg", []),
    "rod_impact": ("figure1.svg", []),
    "rubber_rings": ("rings.svg", []),
    "sloshing_roll": ("frame_00004.svg", ["--quick"]),
    "sloshing_tank": ("particles_38ms.svg", []),
    "square_patch": ("patch.svg", []),
    "standing_wave": ("wave.svg", []),
    "taylor_bar": ("taylor_bar.svg", []),
    "taylor_green": ("vortices.svg", []),
    "turek_hron": ("flow.svg", ["--quick"]),
    "viscosity_frontier": ("viscosity_frontier.svg", ["--quick"]),
    "water_on_plate": ("plate.svg", ["--quick"]),
}

# Example, which takes no options: the plot that it leaves.
EXAMPLES = {"falling_drop": "splash.svg"}


def pixels(png):
    """Rows of (red, green, blue) of a PNG file of 8 bits without interlacing."""
    data, at, packed = png, 8, b""
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        at += 12 + size
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", content[:10])
        elif kind == b"IDAT":
            packed += content
    step = {2: 3, 6: 4}[colour]
    raw, line = zlib.decompress(packed), width * step
    above, rows = bytearray(line), []
    for y in range(height):
        start = y * (line + 1)
        how, row = raw[start], bytearray(raw[start + 1 : start + 1 + line])
        for x in range(line):
            left = row[x - step] if x >= step else 0
            corner = above[x - step] if x >= step else 0
            guess = left + above[x] - corner
            near = min((left, above[x], corner), key=lambda value: abs(guess - value))
            row[x] = (row[x] + [0, left, above[x], (left + above[x]) // 2, near][how]) & 255
        rows.append([tuple(row[x : x + 3]) for x in range(0, line, step)])
        above = row
    return rows


def written(rows):
    """A PNG file of these rows, in full colour: each row by the filter that leaves the smallest numbers."""
    step, line = 3, 3 * len(rows[0])
    above, lines = bytes(line), []
    for pixels_of_row in rows:
        row = bytes(v for p in pixels_of_row for v in p)
        left = bytes(step) + row[:-step]
        corner = bytes(step) + above[:-step]

        def paeth(a, b, c):
            guess = a + b - c
            return min((a, b, c), key=lambda value: abs(guess - value))

        guesses = [
            bytes(line),
            left,
            above,
            bytes((a + b) // 2 for a, b in zip(left, above)),
            bytes(paeth(a, b, c) for a, b, c in zip(left, above, corner)),
        ]
        filtered = [bytes((v - g) & 255 for v, g in zip(row, guess)) for guess in guesses]
        best = min(range(5), key=lambda how: sum(min(v, 256 - v) for v in filtered[how]))
        lines.append(bytes([best]) + filtered[best])
        above = row

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    body = [(b"IHDR", header), (b"IDAT", zlib.compress(b"".join(lines), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(kind, content) for kind, content in body)


def check_bar(plot, rows):
    """Fails unless the ends of a plot's colour bar, which is 12 wide, are in the picture as the plot has them."""
    fills = re.findall(r'<rect [^>]*width="12" [^>]*fill="#([0-9a-f]{6})"', plot.read_text(encoding="utf-8"))
    colours = {p for row in rows for p in row}
    for fill in {fills[0], fills[-1]} if fills else ():
        wanted = tuple(bytes.fromhex(fill))
        nearest = min(colours, key=lambda p: sum(abs(a - b) for a, b in zip(p, wanted)))
        if max(abs(a - b) for a, b in zip(nearest, wanted)) > 2:
            sys.exit(f"{plot}: the end #{fill} of its colour bar became {nearest}")


def main(names):
    for name in names or [*PICTURES, *EXAMPLES]:
        name, _, plot = name.partition("=")
        if not plot and name in EXAMPLES:
            cargo = ["cargo", "run", "--release", "--all-features", "--example", name]
            subprocess.run(cargo, cwd=ROOT, check=True)
            plot = ROOT / "out" / name / EXAMPLES[name]
        elif not plot:
            file, options = PICTURES[name]
            out = ROOT / "out" / "gallery" / name
            cargo = ["cargo", "validate", name, "--"]
            subprocess.run([*cargo, *options, "--out", out], cwd=ROOT, check=True)
            plot = out / file
        convert = ["rsvg-convert", "--zoom", ZOOM, "--background-color", "white", plot]
        png = subprocess.run(convert, capture_output=True, check=True).stdout
        rows = pixels(png)
        small = written(rows)
        check_bar(Path(plot), pixels(small))
        (HERE / f"{name}.png").write_bytes(small)
        print(name, len(small), "bytes")


main(sys.argv[1:])
