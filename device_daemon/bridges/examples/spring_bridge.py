#!/usr/bin/env python3
"""An example of a bridge (docs/howto/bridges.md): Python's standard library, no other file of this project. The device is a
mass on a spring, which the host's force moves; put your own device where it says DEVICE.

  ./spring_bridge.py [PORT]     0, the default, takes any free port

Frames and units are those of docs/howto/bridges.md."""
import math
import signal
import socket
import struct
import sys
import time
import zlib

DESCRIBE_REQUEST, DESCRIBE, POSE_STATE, POSE_COMMAND = 3, 4, 5, 6
LENGTHS = {DESCRIBE_REQUEST: 40, POSE_COMMAND: 80}
OFF, READY, SWITCHED_ON, ENABLED, FAULT = 0x40, 0x21, 0x23, 0x27, 0x08
GIVES_FORCE, IS_SIMULATED = 1, 16  # DEVICE: an arm with a motor or a hand is not simulated
MAX_FORCE = 10  # N
NAN = math.nan


class SpringBridge:
    def __init__(self, port):
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.bind(("127.0.0.1", port))
        self.udp.setblocking(False)
        self.host, self.session, self.sent, self.newest, self.heard = None, 0, 0, 0, -math.inf
        self.status, self.faults, self.first_fault, self.last_control = OFF, 0, 0, 0
        self.wrench, self.commanded = (0.0,) * 3, -math.inf
        self.share = 0  # of the wrench that is given: it comes and goes within 20 ms
        self.position, self.velocity = [0.0] * 3, [0.0] * 3
        self.watchdog = 0.005  # s
        self.shall_end = False

    def send(self, kind, body):
        """The body is what lies between header and CRC."""
        self.sent = (self.sent + 1) & 0xFFFFFFFF
        packet = struct.pack("<4sBBHII", b"BCML", 1, kind, 16 + len(body) + 4, self.session, self.sent) + body
        self.udp.sendto(packet + struct.pack("<I", zlib.crc32(packet)), self.host)

    def describe(self):
        somebodys_own = 5
        self.send(DESCRIBE, struct.pack("<IIQ48s8dIII", 0, GIVES_FORCE | IS_SIMULATED, 0, b"spring (example in Python)",
                                        MAX_FORCE, 0, 0, 0, 0.1, 0, 0, 0, round(self.watchdog * 1e6), 1000, somebodys_own))

    def send_state(self):
        closed_enabled_homed, leaving, powered_remote = 1 | 2 | 4, 32, 0x210
        torque_or_none = 10 if self.status == ENABLED else 0
        age_10us = min((time.monotonic() - self.commanded) * 1e5, 65535)
        self.send(POSE_STATE, struct.pack(
            "<IIQHBBIIHH7d6fIf6fI", self.newest, closed_enabled_homed | (leaving if self.shall_end else 0),
            time.monotonic_ns(), self.status | powered_remote, torque_or_none, 0, self.first_fault, self.faults,
            int(age_10us), 0,
            *self.position, 1, 0, 0, 0, *[NAN] * 6, 0, 0, *[NAN] * 6, 0))

    def obey(self, packet):
        """The state machine of CiA 402, as far as it is needed."""
        control, = struct.unpack_from("<H", packet, 32)
        resets = control & 0x80 and not self.last_control & 0x80
        self.last_control = control
        wrench = struct.unpack_from("<6f", packet, 48)
        if not all(map(math.isfinite, wrench)):
            wrench = (0.0,) * 6
        fitting = MAX_FORCE / max(MAX_FORCE, math.hypot(*wrench[:3]))
        self.wrench = tuple(fitting * force for force in wrench[:3])
        self.commanded = time.monotonic()
        if self.status == FAULT:
            if resets and not self.faults:
                self.status, self.first_fault = OFF, 0
        elif not control & 2 or not control & 4:
            self.status = OFF
        elif control & 15 == 6:
            self.status = READY
        elif control & 15 == 7 and self.status != OFF:
            self.status = SWITCHED_ON
        elif control & 15 == 15 and self.status == SWITCHED_ON:
            self.status = ENABLED

    def take(self, packet, source):
        if len(packet) < 20 or packet[:5] != b"BCML\x01" or zlib.crc32(packet[:-4]) != struct.unpack("<I", packet[-4:])[0]:
            return
        kind, length, session, number = struct.unpack_from("<BHII", packet, 5)
        if length != len(packet) or LENGTHS.get(kind) != length:
            return
        is_ours = source == self.host and session == self.session
        is_new = 0 < (number - self.newest) & 0xFFFFFFFF < 0x80000000
        if kind == DESCRIBE_REQUEST and not is_ours:
            if time.monotonic() - self.heard <= (self.watchdog if source == self.host else 1):
                return  # there is another host
            self.host, self.session, self.commanded = source, session, -math.inf
            wish_us, = struct.unpack_from("<I", packet, 24)
            self.watchdog = min(max(wish_us or 5000, 2000), 30000) * 1e-6
            self.status = self.status if self.status == FAULT else OFF
        elif not is_ours or not is_new:
            return
        self.newest, self.heard = number, time.monotonic()
        if kind == DESCRIBE_REQUEST:
            self.describe()
        else:
            self.obey(packet)

    def watch(self):
        is_silent = time.monotonic() - self.heard > self.watchdog
        self.faults = int(is_silent and (self.faults != 0 or self.status not in (OFF, FAULT)))
        if self.faults and self.status != FAULT:
            self.status, self.first_fault = FAULT, self.faults

    def period(self):
        try:
            while True:
                self.take(*self.udp.recvfrom(256))
        except BlockingIOError:
            pass
        self.watch()
        self.share = min(1, self.share + 0.05) if self.status == ENABLED else max(0, self.share - 0.05)
        for i in range(3):  # DEVICE: read the pose, give the share of the force
            force = self.share * self.wrench[i]
            self.velocity[i] += 0.001 * (force - 200 * self.position[i] - 2 * self.velocity[i]) / 0.1
            self.position[i] += 0.001 * self.velocity[i]
        if self.host:
            self.send_state()

    def end(self, *_):
        self.shall_end = True


def main():
    bridge = SpringBridge(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    signal.signal(signal.SIGTERM, bridge.end)
    signal.signal(signal.SIGINT, bridge.end)
    print(f"listening on 127.0.0.1:{bridge.udp.getsockname()[1]}", flush=True)
    wake = time.monotonic()
    while not bridge.shall_end:
        wake = max(wake + 0.001, time.monotonic() - 0.02)
        time.sleep(max(0, wake - time.monotonic()))
        bridge.period()
    for _ in range(20):  # the host hears that it leaves, also when a packet is lost
        bridge.period()
        time.sleep(0.001)


if __name__ == "__main__":
    main()
