"""Pictures as the comparison needs them: decoding PNG, and telling classes of surfaces apart."""

import struct
import zlib


def _unfilter(kind, row, above, step):
    """Undoes one of PNG's five row filters in place (PNG specification, section 9)."""
    if kind == 1:
        for i in range(step, len(row)):
            row[i] = (row[i] + row[i - step]) & 255
    elif kind == 2:
        for i, up in enumerate(above):
            row[i] = (row[i] + up) & 255
    elif kind == 3:
        for i, up in enumerate(above):
            left = row[i - step] if i >= step else 0
            row[i] = (row[i] + ((left + up) >> 1)) & 255
    elif kind == 4:
        for i, up in enumerate(above):
            left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
            guess = left + up - corner
            far_left, far_up, far_corner = abs(guess - left), abs(guess - up), abs(guess - corner)
            if far_left <= far_up and far_left <= far_corner:
                near = left
            else:
                near = up if far_up <= far_corner else corner
            row[i] = (row[i] + near) & 255
    elif kind != 0:
        raise ValueError(f"PNG row filter {kind}")


def read_png(path):
    """(width, height, rows of RGB bytes) of an 8- or 16-bit true-colour PNG without interlacing; 16 bits are cut to 8."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path}: not a PNG file")
    at, packed = 8, b""
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
    channels = {2: 3, 6: 4}.get(colour)
    if channels is None or depth not in (8, 16) or interlace:
        raise ValueError(f"{path}: only 8- or 16-bit RGB(A) without interlacing is read")
    step = channels * depth // 8
    stride, raw = step * width, zlib.decompress(packed)
    rows, above = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = bytearray(raw[start + 1 : start + 1 + stride])
        _unfilter(raw[start], row, above, step)
        above = row
        rgb = bytearray(3 * width)
        for channel in range(3):
            rgb[channel::3] = row[channel * depth // 8 :: step]
        rows.append(bytes(rgb))
    return width, height, rows


def classes(picture):
    """One small number a pixel: which of red, green and blue are strong. 0 is the background. A class survives being
    dimmed, by light lost in glass for example, as long as its hue does."""
    width, height, rows = picture
    table = []
    for row in rows:
        line = bytearray(width)
        for x in range(width):
            r, g, b = row[3 * x], row[3 * x + 1], row[3 * x + 2]
            top = max(r, g, b)
            if top >= 32:
                line[x] = (2 * r > top) + 2 * (2 * g > top) + 4 * (2 * b > top)
        table.append(bytes(line))
    return table


def edge_pixels(table):
    """Set of (x, y) that have a pixel of another class among their eight neighbours, and the length of all edges between
    classes, in pixels: the number of pairs of neighbours, across or down, that differ."""
    height, width = len(table), len(table[0])
    edges, length = set(), 0
    for y in range(height):
        for x in range(width):
            own = table[y][x]
            for dx, dy in ((1, 0), (0, 1), (1, 1), (-1, 1)):
                if 0 <= x + dx < width and y + dy < height and table[y + dy][x + dx] != own:
                    edges.add((x, y))
                    edges.add((x + dx, y + dy))
                    length += dx * dy == 0
    return edges, length


class Comparison:
    """How far two pictures of classes agree. See README.md for where the bound comes from."""

    #: A program's silhouette is allowed to be this far off, in pixels, if not said otherwise.
    SILHOUETTE_ERROR = 1e-4

    def __init__(self, ours, theirs, silhouette_error=SILHOUETTE_ERROR):
        self.hits_ours = sum(len(row) - row.count(0) for row in ours)
        self.hits_theirs = sum(len(row) - row.count(0) for row in theirs)
        self.pixels = sum(len(row) for row in ours)
        edges, self.edge_length = edge_pixels(theirs)
        differing = [
            (x, y)
            for y, (a, b) in enumerate(zip(ours, theirs))
            if a != b
            for x in range(len(a))
            if a[x] != b[x]
        ]
        self.differing = len(differing)
        self.off_edge = [place for place in differing if place not in edges]
        self.places = differing[:10]
        expected = 2.0 * silhouette_error * self.edge_length
        self.bound = int(expected + 4.0 * expected**0.5 + 1.0)

    @property
    def agrees(self):
        return self.differing <= self.bound and not self.off_edge
