"""bench/scripts/pair-picture draws both bodies and the distance between them.

usage: pair_picture_test.py SIXDOF

Exits with 77 (a skipped test) where Chromium, h5py or the page's libraries are missing.
"""

import importlib.util
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import find_chromium  # noqa: E402

SIXDOF = sys.argv[1]
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench" / "scripts" / "pair-picture"
SKIPPED = 77


def pixels_of(png):
    """Width, and red, green, blue of every pixel, of a PNG with 8 bits a channel."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    packed, place = b"", 8
    while place < len(png):
        (length,) = struct.unpack(">I", png[place:place + 4])
        kind, data = png[place + 4:place + 8], png[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[:10])
            assert depth == 8 and colour in (2, 6)
            size = 3 if colour == 2 else 4
        elif kind == b"IDAT":
            packed += data
        place += 12 + length
    raw, before, pixels = zlib.decompress(packed), bytes(width * size), []
    for y in range(height):
        start = y * (width * size + 1)
        line = bytearray(raw[start + 1:start + 1 + width * size])
        for i, value in enumerate(line):
            left = line[i - size] if i >= size else 0
            corner = before[i - size] if i >= size else 0
            nearest = min((abs(before[i] - corner), 0, left), (abs(left - corner), 1, before[i]),
                          (abs(left + before[i] - 2 * corner), 2, corner))[2]
            line[i] = value + (0, left, before[i], (left + before[i]) // 2, nearest)[raw[start]] & 255
        pixels += [tuple(line[i:i + 3]) for i in range(0, len(line), size)]
        before = bytes(line)
    return width, pixels


def main():
    if find_chromium() is None or importlib.util.find_spec("h5py") is None:
        print("skipped: no Chromium or no h5py here (cmake/setup report installs them)")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"SIXDOF_CACHE": str(pathlib.Path(folder, "cache"))}
        made, picture = pathlib.Path(folder, "set.h5"), pathlib.Path(folder, "pair.png")
        subprocess.run([SIXDOF, "generate", "--a", "cone-1k", "--b", "torus-1k", "--grid", "90", "--distances", "10", "-o", str(made)],
                       check=True, capture_output=True, env=environment)
        done = subprocess.run([sys.executable, "-B", str(SCRIPT), str(made), "distance/10", "0", "0", "--program", SIXDOF, "-o", str(picture)],
                              capture_output=True, text=True, check=False, env=environment)
        if "cmake/setup report" in done.stderr:
            print("skipped:", done.stderr)
            sys.exit(SKIPPED)
        assert done.returncode == 0, done.stderr
        width, pixels = pixels_of(picture.read_bytes())
    assert width == 900, width
    share = {name: sum(map(is_it, pixels)) / len(pixels) for name, is_it in {
        "white": lambda p: min(p) > 250,
        "grey": lambda p: max(p) - min(p) < 30 and 60 < p[0] < 220,
        "sand": lambda p: 35 < p[0] - p[2] < 90,
        "red": lambda p: p[0] > p[2] + 100}.items()}
    assert share["white"] > 0.2 and share["grey"] > 0.05 and share["sand"] > 0.05 and share["red"] > 0.001, share


if __name__ == "__main__":
    main()
