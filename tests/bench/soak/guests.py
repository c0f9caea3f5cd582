"""Guests of a gateway, as a page in a browser is one: they come in, acknowledge what comes, and come back by ticket."""
import asyncio
import logging
import os
import random
import ssl
import struct

PROTOCOL_VERSION = 2  # kProtocolVersion of render_client/link/subscribe/remote_session.h
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
AGAIN_S = 0.5
logging.getLogger("asyncio").setLevel(logging.ERROR)  # what is written to a lost line is not worth a word


def varint(n):
    return bytes([n]) if n < 128 else bytes([n & 127 | 128]) + varint(n >> 7)


def field(number, value):
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def read_varint(data, at):
    value = shift = 0
    while True:
        value |= (data[at] & 127) << shift
        shift, at = shift + 7, at + 1
        if data[at - 1] < 128:
            return value, at


def texts(data):
    """{number: bytes} of a message's fields that have a length; numbers are passed over."""
    found, at = {}, 0
    while at < len(data):
        key, at = read_varint(data, at)
        size, at = read_varint(data, at)
        if key & 7 == 2:
            found[key >> 3] = data[at:at + size]
            at += size
    return found


def masked_frame(payload, opcode=BINARY):
    mask, n = os.urandom(4), len(payload)
    head = bytes([128 | opcode]) + (bytes([128 | n]) if n < 126 else bytes([254]) + struct.pack(">H", n))
    return head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))


def any_certificate():
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


class Guest:
    def __init__(self, port, token, context):
        self.port, self.token, self.context = port, token.encode(), context
        self.ticket, self.is_in, self.came, self.received, self.refusal = b"", False, 0, 0, ""

    async def live(self):
        while not self.refusal:
            writer = None
            try:
                reader, writer = await asyncio.open_connection("127.0.0.1", self.port, ssl=self.context)
                await self.say_hello(reader, writer)
                while True:
                    await self.take(await self.message(reader, writer), writer)
            except (OSError, EOFError, ValueError, asyncio.LimitOverrunError):
                pass
            finally:
                self.is_in = False
                if writer:
                    writer.transport.abort()
            await asyncio.sleep(AGAIN_S * (1 + random.random()))

    async def say_hello(self, reader, writer):
        writer.write((f"GET /session HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nUpgrade: websocket\r\n"
                      "Connection: Upgrade\r\nSec-WebSocket-Key: c29ha2luZyBndWVzdHMhIQ==\r\n"
                      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: bonemill.v1\r\n\r\n").encode())
        if b" 101 " not in await reader.readuntil(b"\r\n\r\n"):
            raise ValueError("no WebSocket")
        hello = field(1, self.ticket or self.token) + field(5, b"browser") + field(6, PROTOCOL_VERSION)
        writer.write(masked_frame(field(1, hello)))

    async def message(self, reader, writer):
        whole = b""
        while True:
            first, second = await reader.readexactly(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", await reader.readexactly(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", await reader.readexactly(8))[0]
            payload, opcode = await reader.readexactly(size), first & 15
            if opcode == CLOSE:
                raise EOFError
            if opcode == PING:
                writer.write(masked_frame(payload, PONG))
            elif opcode != PONG:
                whole += payload
                if first & 128:
                    return whole

    async def take(self, message, writer):
        self.received = len(message) + (self.received if self.is_in else 0)
        kind = message[0] >> 3
        if kind == 1:
            self.ticket, self.is_in = texts(texts(message)[1]).get(1, self.ticket), True
            self.came += 1
        elif kind == 2:
            refusal = next(iter(texts(message).values()))
            if b"\x10\x01" in refusal[-2:]:  # is_final
                self.refusal = texts(refusal).get(1, b"?").decode(errors="replace")
        writer.write(masked_frame(field(5, field(1, self.received))))
        await writer.drain()


class Crowd:
    """All of them, in the event loop that makes it."""

    def __init__(self, port, tokens):
        context = any_certificate()
        self.guests = [Guest(port, token, context) for token in tokens]
        self.tasks = []

    async def __aenter__(self):
        for guest in self.guests:
            self.tasks.append(asyncio.create_task(guest.live()))
            await asyncio.sleep(0.01)
        return self

    async def __aexit__(self, *_):
        for task in self.tasks:
            task.cancel()
        await asyncio.gather(*self.tasks, return_exceptions=True)

    def count_in(self):
        return sum(guest.is_in for guest in self.guests)

    def refusals(self):
        return [guest.refusal for guest in self.guests if guest.refusal]

    async def await_all_in(self, limit_s):
        """Returns seconds, or None when some were not in by then."""
        loop = asyncio.get_running_loop()
        start = loop.time()
        while loop.time() < start + limit_s:
            if self.count_in() == len(self.guests):
                return loop.time() - start
            await asyncio.sleep(0.05)
        return None
