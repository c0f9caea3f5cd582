#!/usr/bin/env python3
"""Measures what a peer of bonemill_igtl gets: rates, ages of poses, bytes (docs/measurements.md).

  tests/bench/igtl_peer.py PORT SECONDS [image]

Prints one line of JSON. An age is from the server's stamp to the end of reading, by the wall clock of one PC."""
import json
import socket
import struct
import sys
import time


def percentile(values, percent):
    values = sorted(values)
    return values[min(len(values) - 1, int(len(values) * percent / 100))] if values else None


def read_exactly(line, count):
    data = bytearray()
    while len(data) < count:
        piece = line.recv(min(1 << 20, count - len(data)))
        if not piece:
            raise SystemExit("the line has ended")
        data += piece
    return bytes(data)


def frame_of(line):
    header = read_exactly(line, 58)
    _, kind, device, stamp, size, _ = struct.unpack(">H12s20sQQQ", header)
    read_exactly(line, size)
    return kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode(), stamp / 2**32, 58 + size


def main():
    port, seconds, wants_image = int(sys.argv[1]), float(sys.argv[2]), "image" in sys.argv[3:]
    line = socket.create_connection(("127.0.0.1", port))
    begin = time.time()
    ages_ms, counts, sizes, last_new_piece, pieces = [], {}, {}, 0, set()
    image_s, asked = None, None
    while time.time() < begin + seconds:
        if wants_image and asked is None and time.time() > begin + seconds / 2:
            line.sendall(struct.pack(">H12s20sQQQ", 1, b"GET_IMAGE", b"", 0, 0, 0))
            asked = time.time()
        kind, device, stamp, size = frame_of(line)
        now = time.time()
        counts[kind] = counts.get(kind, 0) + 1
        sizes[kind] = sizes.get(kind, 0) + size
        if device == "bonemill_tool":
            ages_ms.append((now - stamp) * 1e3)
        if kind == "POLYDATA" and device not in pieces:
            pieces.add(device)
            last_new_piece = now - begin
        if kind == "IMAGE":
            image_s = now - asked
    print(json.dumps({
        "seconds": seconds, "poses_per_s": len(ages_ms) / seconds, "pieces": len(pieces),
        "all_pieces_after_s": round(last_new_piece, 3), "messages": counts, "kib": {k: v >> 10 for k, v in sizes.items()},
        "pose_age_ms": {str(p): round(percentile(ages_ms, p), 2) for p in (50, 99)} if ages_ms else None,
        "image_after_s": round(image_s, 2) if image_s else None}))


if __name__ == "__main__":
    main()
