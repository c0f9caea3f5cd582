#!/usr/bin/env python3
"""A stand-in for Haply's Inverse Service, after its public documentation: one state for each message.

It prints its port, serves one client after the other, and does what STAND_IN says: words such as
"delay_ms=2 silent_at=300". STAND_IN_RECORD names the file of the commands that came."""
import base64
import hashlib
import json
import math
import os
import socket
import struct
import sys
import time

WORDS = dict((word.split("=") + ["1"])[:2] for word in os.environ.get("STAND_IN", "").split())
RECORD = open(os.environ["STAND_IN_RECORD"], "a", buffering=1, encoding="ascii")
FORCE_NAME = "values" if "old" in WORDS else "vector"


def reached(word, count):
    return word in WORDS and count >= float(WORDS[word])


def receive_exactly(client, count):
    data = b""
    while len(data) < count:
        more = client.recv(count - len(data))
        if not more:
            raise ConnectionError
        data += more
    return data


def shake_hands(client):
    request = b""
    while b"\r\n\r\n" not in request:
        request += receive_exactly(client, 1)
    lines = dict(line.split(": ", 1) for line in request.decode().split("\r\n") if ": " in line)
    key = next(value for name, value in lines.items() if name.lower() == "sec-websocket-key")
    accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
    client.sendall(f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                   f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode())


def send_frame(client, text, is_last=True, opcode=1):
    data = text.encode()
    head = bytes([(0x80 if is_last else 0) | opcode])
    head += bytes([len(data)]) if len(data) < 126 else bytes([126]) + struct.pack(">H", len(data))
    client.sendall(head + data)


def send(client, text):
    if "fragments" in WORDS:
        send_frame(client, text[:40], is_last=False)
        send_frame(client, text[40:], opcode=0)
    else:
        send_frame(client, text)


def receive(client):
    """The next text; nothing when the client closes."""
    first, second = receive_exactly(client, 2)
    length = second & 0x7F
    if length == 126:
        length = struct.unpack(">H", receive_exactly(client, 2))[0]
    mask = receive_exactly(client, 4)
    data = bytes(byte ^ mask[i % 4] for i, byte in enumerate(receive_exactly(client, length)))
    return data.decode() if first & 0x0F == 1 else None


def vector(x, y, z):
    return {"x": x, "y": y, "z": z}


def grips():
    turn = {"orientation": {"w": math.sqrt(0.5), "x": math.sqrt(0.5), "y": 0, "z": 0}}
    if "wired" in WORDS:
        return {"verse_grip": [{"device_id": "61548", "state": {**turn, "button": True}}]}
    if "wireless" in WORDS:
        return {"wireless_verse_grip": [{"device_id": "7", "state": {**turn, "buttons": {"a": False, "b": True}}}]}
    return {"verse_grip": []}


def inventory():
    arm = {"device_id": "049D", "config": {"type": "inverse3", "gravity_compensation": {"enabled": True}},
           "state": {"cursor_position": vector(0.01, -0.10, 0.18), "cursor_velocity": vector(0.1, 0.2, 0.3)},
           "status": {"calibrated": "uncalibrated" not in WORDS, "in_use": False, "power_supply": True, "ready": True,
                      "started": True}}
    return {"session_id": 7, "inverse3": [] if "no_device" in WORDS else [arm], **grips()}


def state(count):
    if reached("unplugged_at", count):
        return {"inverse3": []}
    if "partial" in WORDS and count % 3:
        return {"inverse3": [{"device_id": "049D"}]}
    full = inventory()
    del full["inverse3"][0]["config"]
    if reached("nonsense_at", count):
        full["inverse3"][0]["state"]["cursor_position"] = vector("here", None, 1)
    return full


def record(message):
    if "session" in message:
        RECORD.write("session\n")
    for arm in message.get("inverse3", []):
        for name, value in arm["commands"].items():
            if name == "set_cursor_force" and FORCE_NAME in value:
                force = value[FORCE_NAME]
                RECORD.write(f"force {force['x']} {force['y']} {force['z']}\n")
            elif name == "probe_position":
                RECORD.write("probe\n")
            else:
                RECORD.write("unknown\n")


def serve(client):
    shake_hands(client)
    send(client, json.dumps(inventory()))
    count = 0
    while (text := receive(client)) is not None:
        count += 1
        record(json.loads(text))
        time.sleep(float(WORDS.get("delay_ms", 0)) / 1000)
        if reached("closes_at", count):
            return
        if reached("garbage_at", count) and count % 10 == 0:
            send(client, "{ no json")
        elif not reached("silent_at", count):
            send(client, json.dumps(state(count)))


def main():
    listener = socket.create_server(("127.0.0.1", 0))
    print(listener.getsockname()[1], flush=True)
    while True:
        client, _ = listener.accept()
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        try:
            serve(client)
        except ConnectionError:
            pass
        client.close()
        RECORD.write("close\n")


if __name__ == "__main__":
    sys.exit(main())
