"""Runs the program in a folder of its own; what the tests of the command line share."""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM = ""

# A cup and a ball beside it; the leaves are at fixed places in the text.
CUP = """\
param height = 60 in 10..200
let body = cylinder(20, height) - cylinder(18, height).move(z: 2)
part cup = body.paint("tomato")
part ball = sphere(5).move(50, 0, 10)
view front = camera(eye: (0, -300, 80), look_at: (0, 0, 30), angle: 20)
view above = camera(eye: (0, 0, 300), look_at: (0, 0, 0), up: (0, 1, 0), angle: 20)
"""

# Takes long to draw: glass in glass, many rays for each pixel.
SLOW = """\
let glassy = union([for i in 0..<400: sphere(9).move(10 * (i % 20), 10 * floor(i / 20), 0)])
part all = glassy.paint(glass())
"""


class CommandLine(unittest.TestCase):
    """A test case whose files live in a temporary folder, the working folder of every run."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="raymo-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.write("cup.raymo", CUP)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text, encoding="utf-8")
        return path

    def command(self, *arguments):
        return [PROGRAM, *[str(a) for a in arguments]]

    def environment(self, **more):
        return {**{k: v for k, v in os.environ.items() if k != "NO_COLOR"}, **more}

    def run_raymo(self, *arguments, stdin=b"", code=0, timeout=120, env=None):
        """Runs the program; the exit code must be as expected. The result's stdout and stderr are texts."""
        if isinstance(stdin, str):
            stdin = stdin.encode()
        done = subprocess.run(self.command(*arguments), input=stdin, capture_output=True, cwd=self.folder,
                              timeout=timeout, env=env or self.environment(), check=False)
        done.raw = done.stdout
        done.stdout = done.stdout.decode("utf-8", "replace")
        done.stderr = done.stderr.decode("utf-8", "replace")
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout[:2000]}\n{done.stderr[:4000]}")
        return done

    def start(self, *arguments, **options):
        return subprocess.Popen(self.command(*arguments), cwd=self.folder, env=self.environment(), **options)

    def files(self):
        """Everything in the folder, hidden files too."""
        return sorted(str(p.relative_to(self.folder)) for p in self.folder.rglob("*"))


def png_size(data):
    """Width and height of a PNG whose structure and checksums are right."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise AssertionError("not a PNG")
    place, size, pixels, kind = 8, None, b"", b""
    while place < len(data):
        (length,) = struct.unpack(">I", data[place:place + 4])
        kind = data[place + 4:place + 8]
        body = data[place + 8:place + 8 + length]
        (checksum,) = struct.unpack(">I", data[place + 8 + length:place + 12 + length])
        if zlib.crc32(kind + body) != checksum:
            raise AssertionError(f"wrong checksum of {kind}")
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            pixels += body
        place += 12 + length
    if kind != b"IEND" or place != len(data):
        raise AssertionError("the PNG does not end where it should")
    zlib.decompress(pixels)
    return size


def main():
    global PROGRAM
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    sys.modules["command_line"].PROGRAM = PROGRAM
    unittest.main(module="__main__", verbosity=1)
