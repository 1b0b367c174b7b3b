"""Small files of scans that are whole: DICOM, and stacks of images. Used by broken_samples."""

import base64
import struct
import zlib

# 8 x 8 grey pixels.
JPEG = base64.b64decode(
    "/9j/2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeXBk"
    "eFxlZ2P/wAALCAAIAAgBAREA/8QAHwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/8QAtRAAAgEDAwIEAwUF"
    "BAQAAAF9AQIDAAQRBRIhMUEGE1FhByJxFDKBkaEII0KxwRVS0fAkM2JyggkKFhcYGRolJicoKSo0NTY3ODk6Q0RF"
    "RkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLD"
    "xMXGx8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/9oACAEBAAA/AOM+3/8ATL/x7/61f//Z")
IMPLICIT, EXPLICIT, DEFLATED, BIG_ENDIAN, JPEG_BASELINE, RLE = (
    b"1.2.840.10008.1.2" + end for end in (b"", b".1", b".1.99", b".2", b".4.50", b".5"))
LONG = (b"OB", b"OW", b"SQ", b"UN")
ENDLESS = 2**32 - 1


class Writer:
    """Writes elements of a DICOM file."""

    def __init__(self, explicit=True, order="<"):
        self.explicit, self.order = explicit, order

    def element(self, group, number, kind, value, length=None):
        if isinstance(value, int):
            value = struct.pack(self.order + "H", value)
        value += (b"\0" if kind in (b"UI", *LONG) else b" ") * (len(value) % 2)
        length = len(value) if length is None else length
        head = struct.pack(self.order + "HH", group, number)
        if not self.explicit:
            head += struct.pack(self.order + "I", length)
        elif kind in LONG:
            head += kind + struct.pack(self.order + "HI", 0, length)
        else:
            head += kind + struct.pack(self.order + "H", length)
        return head + value

    def bare(self, number, value, length=None):
        """An item, or the end of one or of a sequence."""
        length = len(value) if length is None else length
        return struct.pack(self.order + "HHI", 0xfffe, number, length) + value

    def sequence(self, group, number, items):
        inside = b"".join(self.bare(0xe000, i, ENDLESS) + self.bare(0xe00d, b"") for i in items)
        return self.element(group, number, b"SQ", inside + self.bare(0xe0dd, b""), ENDLESS)


def packed_by_runs(values):
    """Two segments, of high and of low bytes, each a run of bytes as they are."""
    parts = []
    for byte in (1, 0):
        part = bytes(v >> 8 * byte & 255 for v in values)
        part = bytes([len(part) - 1]) + part
        parts.append(part + b"\0" * (len(part) % 2))
    places = [64, 64 + len(parts[0])]
    return struct.pack("<16I", len(parts), *places, *[0] * 13) + b"".join(parts)


def pixels(writer, syntax, side, frames):
    values = range(0, 100 * side * side, 100)
    if syntax in (JPEG_BASELINE, RLE):
        part = JPEG if syntax == JPEG_BASELINE else packed_by_runs(values)
        part += b"\0" * (len(part) % 2)
        inside = writer.bare(0xe000, b"") + frames * writer.bare(0xe000, part)
        return writer.element(0x7fe0, 0x10, b"OB", inside + writer.bare(0xe0dd, b""), ENDLESS)
    return writer.element(0x7fe0, 0x10, b"OW",
                          struct.pack(f"{writer.order}{side * side}H", *values) * frames)


def place(writer, z):
    return writer.element(0x20, 0x32, b"DS", b"0\\0\\%d" % z)


def orientation(writer):
    return writer.element(0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0")


def spacing(writer):
    return writer.element(0x28, 0x30, b"DS", b"0.5\\0.5")


def dicom(syntax=EXPLICIT, z=0, frames=1):
    """A slice, or a solid whose frames are described in sequences."""
    head = Writer()
    meta = (head.element(2, 1, b"OB", b"\0\1") +
            head.element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2") +
            head.element(2, 3, b"UI", b"1.2.3.4") + head.element(2, 16, b"UI", syntax))
    w = Writer(syntax != IMPLICIT, ">" if syntax == BIG_ENDIAN else "<")
    is_jpeg = syntax == JPEG_BASELINE
    side, bits = (8, 8) if is_jpeg else (4, 16)
    body = (w.element(8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.2") +
            w.element(8, 0x18, b"UI", b"1.2.3.4.%d" % z) + w.element(8, 0x60, b"CS", b"CT") +
            w.element(0x20, 0xd, b"UI", b"1.2.3") + w.element(0x20, 0xe, b"UI", b"1.2.3.1"))
    if frames == 1:
        body += place(w, z) + orientation(w)
    body += w.element(0x28, 2, b"US", 1) + w.element(0x28, 4, b"CS", b"MONOCHROME2")
    if frames > 1:
        body += w.element(0x28, 8, b"IS", b"%d" % frames)
    body += w.element(0x28, 0x10, b"US", side) + w.element(0x28, 0x11, b"US", side)
    if frames == 1:
        body += spacing(w)
    body += (w.element(0x28, 0x100, b"US", bits) + w.element(0x28, 0x101, b"US", bits) +
             w.element(0x28, 0x102, b"US", bits - 1) + w.element(0x28, 0x103, b"US", 0) +
             w.element(0x28, 0x1052, b"DS", b"-10") + w.element(0x28, 0x1053, b"DS", b"2"))
    if frames > 1:
        shared = (w.sequence(0x20, 0x9116, [orientation(w)]) +
                  w.sequence(0x28, 0x9110, [spacing(w)]))
        each = [w.sequence(0x20, 0x9113, [place(w, i)]) for i in range(frames)]
        body += w.sequence(0x5200, 0x9229, [shared]) + w.sequence(0x5200, 0x9230, each)
    body += pixels(w, syntax, side, frames)
    if syntax == DEFLATED:
        packer = zlib.compressobj(wbits=-15)
        body = packer.compress(body) + packer.flush()
    return (bytes(128) + b"DICM" + head.element(2, 0, b"UL", struct.pack("<I", len(meta))) + meta +
            body)


def tiff(way="none", tiled=False, pages=1, order="<"):
    """Pages of 16 x 16 numbers of 16 bits, in 4 strips or in one tile."""
    code = {"none": 1, "zip": 8, "packbits": 32773}[way]
    rows = [struct.pack(order + "16H", *(4000 * ((x + y) % 16) for x in range(16)))
            for y in range(16)]
    parts = [b"".join(rows)] if tiled else [b"".join(rows[i:i + 4]) for i in range(0, 16, 4)]
    if way == "zip":
        parts = [zlib.compress(part) for part in parts]
    elif way == "packbits":
        parts = [b"".join(bytes([len(row) - 1]) + row
                          for row in (part[i:i + 32] for i in range(0, len(part), 32)))
                 for part in parts]
    data = struct.pack(order + "2sHI", b"II" if order == "<" else b"MM", 42, 8)
    for page in range(pages):
        layout = ([(322, 3, 16), (323, 3, 16), (324, 4, "places"), (325, 4, "lengths")] if tiled
                  else [(273, 4, "places"), (278, 3, 4), (279, 4, "lengths")])
        entries = sorted([(256, 3, 16), (257, 3, 16), (258, 3, 16), (259, 3, code), (262, 3, 1),
                          (277, 3, 1), (339, 3, 1), *layout])
        table = len(data) + 2 + 12 * len(entries) + 4
        values = table + 8 * len(parts)
        places = [values + sum(map(len, parts[:i])) for i in range(len(parts))]
        numbers = {"places": (table, places),
                   "lengths": (table + 4 * len(parts), [len(part) for part in parts])}
        data += struct.pack(order + "H", len(entries))
        for tag, kind, value in entries:
            count = 1
            if isinstance(value, str):
                at, many = numbers[value]
                count, value = len(many), many[0] if len(many) == 1 else at
            form = "HHIHH" if kind == 3 else "HHII"
            data += struct.pack(order + form, tag, kind, count, value, *([0] if kind == 3 else []))
        end = values + sum(map(len, parts))
        data += struct.pack(order + "I", end + end % 2 if page + 1 < pages else 0)
        data += b"".join(struct.pack(f"{order}{len(many)}I", *many)
                         for _, many in numbers.values())
        data += b"".join(parts) + b"\0" * (end % 2)
    return data
