"""Mutants of a recording, and what replay, export and assess make of them."""
import concurrent.futures
import os
import random
import selectors
import signal
import struct
import subprocess
import time

import laboratory

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 1, 2, 3, 4, 5, 6, 15
MOST_COST, SPARE_S = 2, 0.05  # of the whole file's processor time; what the clock of processor time may be off
HANGS_S = 60
WORKERS = 3 * os.cpu_count()  # a replay mostly waits
AGAIN = 3  # a dear one is tried so often again: on a busy PC the same work costs more


def records(data):
    at = 0
    while at + 9 <= len(data):
        kind, size = data[at], struct.unpack_from("<Q", data, at + 1)[0]
        yield kind, data[at + 9:at + 9 + size]
        at += 9 + size


def record(kind, content):
    return bytes([kind]) + struct.pack("<Q", len(content)) + content


def unpacked(journal):
    """The same messages as another program may write them: no chunks, no CRC, no index; no damage is found by a sum."""
    out = [MAGIC]
    for kind, content in records(journal[len(MAGIC):-len(MAGIC)]):
        if kind == CHUNK:
            size, = struct.unpack_from("<I", content, 28)
            packed = content[32 + size + 8:]
            if size > 0:
                packed = subprocess.run(["zstd", "-dc"], input=packed, stdout=subprocess.PIPE, check=True).stdout
            out += [record(*one) for one in records(packed) if one[0] in (SCHEMA, CHANNEL, MESSAGE)]
        elif kind in (HEADER, SCHEMA, CHANNEL):
            out.append(record(kind, content))
    out += [record(DATA_END, bytes(4)), record(FOOTER, bytes(20)), MAGIC]
    return b"".join(out)


def mutant(whole, chance):
    """A few bits, bytes or runs of bytes changed, put in or left out, or its end cut off."""
    data = bytearray(whole)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(data)) if chance.random() < 0.8 else chance.randrange(min(len(data), 4096))
        run = bytes(chance.randrange(256) for _ in range(chance.choice((1, 1, 4, 8, 64))))
        how = chance.randrange(6)
        if how == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif how == 1:
            data[at:at + len(run)] = run
        elif how == 2:
            data[at:at + 8] = chance.choice((b"\xff" * 8, bytes(8), b"\xff" * 7 + b"\x7f"))
        elif how == 3:
            data[at:at] = run
        elif how == 4:
            del data[at:at + chance.choice((1, 8, 1000))]
        elif chance.random() < 0.3:
            del data[max(at, 16):]
    return bytes(data)


def play(words, log):
    """A replay does not end by itself: it is over when the recording was looked through. Returns what it left with."""
    child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    end, said = time.monotonic() + HANGS_S, b""
    with selectors.DefaultSelector() as selector:
        selector.register(child.stdout, selectors.EVENT_READ)
        while b"looked through" not in said and time.monotonic() < end:
            if selector.select(0.2):
                more = os.read(child.stdout.fileno(), 65536)
                if not more:
                    break
                said += more
    hangs = time.monotonic() >= end
    os.kill(child.pid, signal.SIGKILL if hangs else signal.SIGTERM)  # Popen would take the processor time away
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    child.stdout.close()
    log.write(said)
    return "hangs" if hangs else child.returncode, usage.ru_utime + usage.ru_stime


def run(words, log):
    child = subprocess.Popen(["timeout", "-s", "KILL", str(HANGS_S), *words], stdin=subprocess.DEVNULL, stdout=log,
                             stderr=log)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    code = child.returncode if child.returncode < 0 or child.returncode <= 128 else 128 - child.returncode
    return "hangs" if code == -signal.SIGKILL else code, usage.ru_utime + usage.ru_stime


def one_run(lab, program, path, number):
    lab_program, out = os.path.join(lab.options.bin, "bonemill_lab"), f"{path}.out"
    with open(f"{path}.log", "wb") as log:
        if program == "replay":
            session = str(int(lab.session) + 1 + number)
            result = play([lab_program, "replay", path, "--speed", "16", "--session", session, "--domain",
                           str(lab.options.domain)], log)
        elif program == "export":
            result = run([lab_program, "session", "export", path, "--h5", out, "--csv", f"{out}.csv", "--traj",
                          f"{out}.in.csv"], log)
        else:
            result = run([lab_program, "session", "assess", path, "--out", f"{out}.assessed"], log)
    subprocess.run(["rm", "-rf", *(f"{out}{end}" for end in ("", ".csv", ".in.csv", ".assessed"))], check=True)
    return result


def try_one(lab, kind, whole, limits, number):
    """Returns [(program, code, what its cost is of the limit)]."""
    path = lab / f"{kind.replace(' ', '_')}_{number}.mcap"
    with open(path, "wb") as file:
        file.write(mutant(whole, random.Random(f"{lab.options.seed} {kind} {number}")))
    results = []
    for program, limit_s in limits.items():
        code, cost_s = one_run(lab, program, path, number)
        for _ in range(AGAIN):
            if cost_s > limit_s:
                cost_s = min(cost_s, one_run(lab, program, path, number)[1])
        results.append((program, code, cost_s / limit_s))
    if all(code in (0, 1, 2) and cost <= 1 for _, code, cost in results):
        os.remove(path)
        os.remove(f"{path}.log")
    return results


def try_kind(lab, kind, whole, count, say):
    limits = {}
    for program in ("replay", "export", "assess"):
        path = lab / f"whole_{kind.replace(' ', '_')}.mcap"
        with open(path, "wb") as file:
            file.write(whole)
        runs = [one_run(lab, program, path, 0) for _ in range(5)]
        if any(code != 0 for code, _ in runs):
            with open(f"{path}.log", errors="replace") as log:
                raise laboratory.Broken(f"{program} of the whole recording, {kind}: {runs}, {log.read()[-400:]}")
        limits[program] = MOST_COST * sorted(cost for _, cost in runs)[2] + SPARE_S
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        results = [one for many in pool.map(lambda number: try_one(lab, kind, whole, limits, number), range(count))
                   for one in many]
    bad = 0
    for program, limit_s in limits.items():
        codes = [code for name, code, _ in results if name == program]
        costs = [cost for name, _, cost in results if name == program]
        crashed = sum(code not in (0, 1, 2, "hangs") for code in codes)
        dear, hung = sum(cost > 1 for cost in costs), codes.count("hangs")
        bad += crashed + dear + hung
        say(f"{kind}: {program} of {count} mutants",
            f"{codes.count(0)} taken, {codes.count(1) + codes.count(2)} refused, {crashed} crashed, "
            f"{hung} hung, {dear} too dear; the dearest {MOST_COST * max(costs):.2f} times the "
            f"whole file's {(limit_s - SPARE_S) / MOST_COST:.2f} s")
    return bad


def try_mutants(lab, journal, say):
    half = max(1, lab.options.mutants // 2)
    bad = try_kind(lab, "recorded", journal, half, say) + try_kind(lab, "without CRC", unpacked(journal), half, say)
    if bad:
        kept = os.path.join(os.getcwd(), "soak_mutants")
        os.makedirs(kept, exist_ok=True)
        subprocess.run(f"cp '{lab.home}'/*.mcap '{lab.home}'/*.mcap.log '{kept}'", shell=True, check=True)
        raise laboratory.Broken(f"{bad} mutants; they are in {kept}")
