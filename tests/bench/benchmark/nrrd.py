"""Volumes as NRRD files: 16 bit, little-endian, x fastest, spacing in mm along the axes of left-posterior-superior."""
import gzip
import zlib

import numpy as np

TYPES = {"uint16": "<u2", "unsigned short": "<u2", "ushort": "<u2", "int16": "<i2", "short": "<i2", "signed short": "<i2"}


def write(path, values, voxel, origin):
    """`values` is (x, y, z) of uint16, `voxel` and `origin` are metres."""
    mm = 1e3 * voxel
    head = ["NRRD0004", "type: uint16", "dimension: 3", "space: left-posterior-superior",
            "sizes: " + " ".join(str(n) for n in values.shape),
            f"space directions: ({mm!r},0,0) (0,{mm!r},0) (0,0,{mm!r})", "kinds: domain domain domain", "endian: little",
            "encoding: raw", "space origin: (" + ",".join(repr(float(1e3 * o)) for o in origin) + ")"]
    with open(path, "wb") as file:
        file.write(("\n".join(head) + "\n\n").encode())
        file.write(values.astype("<u2").tobytes(order="F"))


def read(path):
    """Values (x, y, z), spacing of each axis and origin in metres. Raises ValueError for what `write` would not have written."""
    try:
        return _read(path)
    except (EOFError, IndexError, KeyError, ValueError, zlib.error) as error:
        raise ValueError(f"{path.name} is no such NRRD: {error}") from error


def _read(path):
    head, body = path.read_bytes().split(b"\n\n", 1)
    lines = [line.split(": ", 1) for line in head.decode().splitlines()[1:] if not line.startswith("#")]
    fields = {name: value for name, value in lines}
    data = gzip.decompress(body) if fields["encoding"] in ("gzip", "gz") else body
    shape = [int(n) for n in fields["sizes"].split()]
    vectors = np.array([[float(n) for n in v.strip("()").split(",")] for v in fields["space directions"].split()])
    origin = np.array([float(n) for n in fields["space origin"].strip("()").split(",")])
    if fields["type"] not in TYPES or fields.get("endian", "little") != "little" or np.abs(vectors - np.diag(np.diag(vectors))).max():
        raise ValueError("not 16 bit, little-endian, along the axes")
    array = np.frombuffer(data, TYPES[fields["type"]]).reshape(shape, order="F")
    return array, np.diag(vectors) / 1e3, origin / 1e3
