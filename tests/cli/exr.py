# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Scanline EXR files, read (no compression or ZIP) and written (none) by hand: a judge that shares no code with gloam."""
import struct
import zlib

HALF, FLOAT = 1, 2
LINES = {0: 1, 2: 1, 3: 16}  # of a chunk, by compression: none, ZIPS, ZIP


def unzipped(data, size):
    if len(data) >= size:
        return data
    data = bytearray(zlib.decompress(data))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    middle = (len(data) + 1) // 2
    plain = bytearray(len(data))
    plain[0::2], plain[1::2] = data[:middle], data[middle:]
    return bytes(plain)


def read(path):
    """(width, height, {channel: [values by rows]}, {attribute: text})."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:4] == b"\x76\x2f\x31\x01", "not an EXR"
    at, header = 8, {}

    def name():
        nonlocal at
        end = data.index(0, at)
        text, at = data[at:end].decode(), end + 1
        return text

    while data[at]:
        key, kind = name(), name()
        size = struct.unpack_from("<i", data, at)[0]
        header[key] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    at += 1
    channels, listing, i = [], header["channels"][1], 0
    while listing[i]:
        end = listing.index(0, i)
        channels.append((listing[i:end].decode(), struct.unpack_from("<i", listing, end + 1)[0]))
        i = end + 17
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = LINES[header["compression"][1][0]]
    row_bytes = sum(width * (2 if kind == HALF else 4) for _, kind in channels)
    values = {channel: [0.0] * (width * height) for channel, _ in channels}
    for chunk in range((height + lines - 1) // lines):
        offset = struct.unpack_from("<Q", data, at + 8 * chunk)[0]
        first, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, height - (first - y0))
        plain, i = unzipped(data[offset + 8:offset + 8 + size], count * row_bytes), 0
        for y in range(first - y0, first - y0 + count):
            for channel, kind in channels:
                form = {0: "I", HALF: "e", FLOAT: "f"}[kind]
                values[channel][y * width:(y + 1) * width] = struct.unpack_from(f"<{width}{form}", plain, i)
                i += width * (2 if kind == HALF else 4)
    texts = {key: value.decode() for key, (kind, value) in header.items() if kind == "string"}
    return width, height, values, texts


def write(path, width, height, channels, attributes=None):
    """Floats, uncompressed: {channel: [values by rows]} or {channel: one value}."""
    def attribute(key, kind, value):
        return key.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = sorted(channels)
    listing = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", FLOAT, 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", listing) + attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    for key, text in (attributes or {}).items():
        head += attribute(key, "string", text.encode())
    head += b"\0"
    row = 4 * width * len(names)
    first = len(head) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (row + 8)) for y in range(height))
    body = b""
    for y in range(height):
        body += struct.pack("<ii", y, row)
        for name in names:
            values = channels[name]
            line = [values] * width if isinstance(values, (int, float)) else values[y * width:(y + 1) * width]
            body += struct.pack(f"<{width}f", *line)
    with open(path, "wb") as file:
        file.write(head + table + body)
