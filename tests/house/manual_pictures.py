#!/usr/bin/env python3
"""The pictures of the manual's pages on solids and on blends: each is what the program draws of the page's first example.

    manual_pictures.py RAYMO docs/manual            fails where a picture is not that
    manual_pictures.py RAYMO docs/manual --renew    draws anew what is not

A picture is the same, bit for bit, for any instruction set and any number of threads. What may differ from machine to machine
is the last digit of a tangent or a power in the C library: it moves a ray by a rounding, and shows only where a ray passes an
edge as closely as that. So a few pixels may differ; any change of drawing changes far more. Packed bytes are not compared,
for what packs them best depends on the processor.
"""

import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
from picture import read_png  # pylint: disable=wrong-import-position

OTHERS = ["blends.md"]  # pages beside those on solids
SIZE = (480, 320)
MOST_BYTES = 60_000
MOST_PIXELS = SIZE[0] * SIZE[1] // 10_000


def first_example(page):
    """The page's first program; None where it has none."""
    lines = page.read_text(encoding="utf-8").split("\n")
    if "```raymo" not in lines:
        return None
    begin = lines.index("```raymo") + 1
    return "\n".join(lines[begin : lines.index("```", begin)]) + "\n"


def draw(raymo, program, picture):
    """Draws the program; the text of what went wrong, or None."""
    done = subprocess.run([raymo, "render", "-", "-o", picture, "--size", f"{SIZE[0]}x{SIZE[1]}", "--quiet"],
                          input=program, text=True, capture_output=True, check=False)
    return None if done.returncode == 0 else f"exit code {done.returncode}\n{done.stderr}"


def differing_pixels(one, other):
    """In how many pixels two pictures differ; all of them where they are not of one size."""
    if one.read_bytes() == other.read_bytes():
        return 0
    (width, height, rows), (other_width, other_height, other_rows) = read_png(one), read_png(other)
    if (width, height) != (other_width, other_height):
        return width * height
    return sum(row[3 * x : 3 * x + 3] != other_row[3 * x : 3 * x + 3]
               for row, other_row in zip(rows, other_rows) if row != other_row for x in range(width))


def fault(raymo, page, picture, fresh, renew):
    """What is wrong with the picture of a page, or None. `fresh` is a file for what is drawn now."""
    program = first_example(page)
    if program is None:
        return f"{page}: has no example to draw"
    trouble = draw(raymo, program, fresh)
    if trouble:
        return f"{page}: its first example can not be drawn: {trouble}"
    if not picture.exists() or differing_pixels(picture, fresh) > MOST_PIXELS:
        if not renew:
            return f"{picture}: is not what the program draws of {page.name}: run `make docs` and look at it"
        picture.parent.mkdir(exist_ok=True)
        picture.write_bytes(fresh.read_bytes())
        print(picture)
    if picture.stat().st_size > MOST_BYTES:
        return f"{picture}: has {picture.stat().st_size} bytes, more than {MOST_BYTES}: choose a plainer example"
    return None


def main():
    raymo, manual, renew = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:] == ["--renew"]
    pages = sorted((manual / "solids").glob("*.md"))
    faults = [] if pages else [f"{manual / 'solids'}: has no pages"]
    pages += [manual / page for page in OTHERS]
    with tempfile.TemporaryDirectory(prefix="raymo-manual-") as folder:
        for page in pages:
            faults.append(fault(raymo, page, manual / "pictures" / f"{page.stem}.png",
                                pathlib.Path(folder) / "fresh.png", renew))
    for picture in sorted((manual / "pictures").glob("*.png")):
        if picture.stem not in [page.stem for page in pages]:
            faults.append(f"{picture}: belongs to no page")
    faults = [text for text in faults if text]
    for text in faults:
        print(text, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
