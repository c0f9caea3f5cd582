"""A session in folders of its own: its programs, what they hold, and what they leave behind."""
import array
import os
import re
import signal
import subprocess
import tempfile
import time

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
MARK = "BONEMILL_SOAK"
EDGE, VOXEL_MM = (40, 40, 24), 0.5
UPRIGHT = "q_WT { w: 0.70710678 x: 0.70710678 y: 0 z: 0 }"


class Broken(Exception):
    """Something that must hold does not."""


def write_scan(path):
    """A block of bone, its top face at z = 0, with 2 mm of air around."""
    nx, ny, nz = EDGE
    inside = [[5 <= n < edge - 5 for n in range(edge)] for edge in EDGE]
    values = array.array("h", (1200 if inside[0][x] and inside[1][y] and inside[2][z] else -1000
                               for z in range(nz) for y in range(ny) for x in range(nx)))
    corner = (-nx / 2 * VOXEL_MM, -ny / 2 * VOXEL_MM, -(nz - 5.5) * VOXEL_MM)
    head = ("NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\n"
            f"sizes: {nx} {ny} {nz}\nspace directions: ({VOXEL_MM},0,0) (0,{VOXEL_MM},0) (0,0,{VOXEL_MM})\n"
            f"space origin: ({corner[0]:g},{corner[1]:g},{corner[2]:g})\nkinds: domain domain domain\n"
            "endian: little\nencoding: raw\n\n")
    with open(path, "wb") as file:
        file.write(head.encode() + values.tobytes())


def waypoints(seconds):
    """To and fro in rows, each pass over the block a little deeper."""
    points, at, row = [(0, -6, -6, 6, False), (1, -6, -6, 2, False)], 1.0, 0
    while at < seconds:
        row += 1
        depth = 1.2 - 4 * at / max(seconds, 60)
        y = -6 + 0.8 * (row % 16)
        points.append((at + 0.3, 6 if row % 2 == 0 else -6, y, depth, True))
        at += 3
        points.append((at, -6 if row % 2 == 0 else 6, y, depth, True))
    return "\n".join(f"  waypoint {{ time_s: {t:g} p_WT_mm {{ x: {x:g} y: {y:g} z: {z:g} }} {UPRIGHT}"
                     f"{' remove: true' if mills else ''} phase: \"mill\" }}" for t, x, y, z, mills in points)


def write_scene(folder, seconds):
    path = os.path.join(folder, "block.textproto")
    write_scan(os.path.join(folder, "block.nrrd"))
    box = "box { center_mm { z: -1 } size_mm { x: 12 y: 12 z: 2 } }"
    with open(path, "w") as file:
        file.write(f"""name: "block"
volume {{ path: "block.nrrd" window_low: -1000 window_high: 2000 iso_value: 300 }}
tool {{
  name: "3 mm round"
  shape {{ sphere {{ radius_mm: 1.5 }} }}
  shape {{ capsule {{ from_mm {{ y: 0 }} to_mm {{ y: 14 }} radius_mm: 0.8 }} }}
  burr_radius_mm: 1.5 sdf_nodes_x: 28 sdf_nodes_y: 128 sdf_nodes_z: 28 sdf_spacing_mm: 0.15
}}
effects {{ time_removal {{ rate_density_per_s: 600 }} }}
device {{ p_WD_mm {{ x: 0 y: 0 z: 3 }} q_WD {{ w: 0.70710678 x: 0.70710678 y: 0 z: 0 }} }}
assessment {{
  zone {{ name: "the layer" role: TARGET shape {{ {box} }} }}
  gate {{ figure: "target.removed" at_least: 1 label: "Something is gone" }}
}}
simulated_operator {{
  hand_stiffness_n_per_m: 1000
{waypoints(seconds)}
}}
""")
    return path


def marked(mark):
    """{pid: name} of the living processes that come from this laboratory."""
    found, word = {}, f"{MARK}={mark}".encode()
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/environ", "rb") as file:
                if word not in file.read().split(b"\0"):
                    continue
            with open(f"/proc/{pid}/comm") as file:
                found[int(pid)] = file.read().strip()
        except OSError:
            pass
    return found


def resident_mib(pid):
    with open(f"/proc/{pid}/status") as file:
        return next((int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS")), 0.0)


def descriptors(pid):
    return len(os.listdir(f"/proc/{pid}/fd"))


def link_memory(session):
    """The System V segments and semaphores of this session's link (linkKeyOf in common/ipc/link_place.h)."""
    key, found = str(int(session) ^ 0x424D0000), []
    for kind in ("shm", "sem"):
        with open(f"/proc/sysvipc/{kind}") as file:
            found += [f"{kind} {line.split()[1]}" for line in file if line.split()[0] == key]
    return found


class Laboratory:
    def __init__(self, options, seconds=30):
        self.options, self.children = options, {}
        self.home = tempfile.mkdtemp(prefix="bonemill_soak_")
        self.session = str(100000 + os.getpid())
        self.mark = os.path.basename(self.home)
        for name in ("tmp", "recordings"):
            os.mkdir(os.path.join(self.home, name))
        self.environment = dict(os.environ, TMPDIR=self / "tmp", XDG_CONFIG_HOME=self / "config",
                                XDG_STATE_HOME=self / "state", **{MARK: self.mark})
        self.scene = write_scene(self.home, seconds)

    def __truediv__(self, name):
        return os.path.join(self.home, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for pid in marked(self.mark):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        for child in self.children.values():
            child.wait()
        subprocess.run(["rm", "-rf", self.home], check=True)

    def start(self, title, program, *words, **more_environment):
        with open(self / f"{title}.log", "ab") as log:
            self.children[title] = subprocess.Popen(
                [os.path.join(self.options.bin, program), *words], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                env=dict(self.environment, **more_environment), cwd=self.home)
        return self.children[title]

    def place(self):
        return ["--session", self.session, "--domain", str(self.options.domain)]

    def start_server(self, *words, **more):
        return self.start("server", "haptic_server", "--scene", self.scene, *self.place(),
                          "--recording", self / "recordings", "--report", self / "report.json", *words, **more)

    def start_device(self, *words, **more):
        child = self.start("device", "device_daemon", "--device", "simulated", *self.place(), "--stop-dir",
                           self / "tmp", "--wait-seconds", "60", *words, **more)
        self.await_words("device", "haptic_server answers")
        return child

    def start_gateway(self, *words, port=0, **more):
        """Returns its port."""
        self.start("gateway", "render_client", "--serve", f"127.0.0.1:{port}", *self.place(), *words, **more)
        said = self.await_words("gateway", "https://127.0.0.1:")
        return int(re.search(r"https://127\.0\.0\.1:(\d+)\n", said)[1])

    def invite(self, port, people, role="operator"):
        words = ["--name", f"Guest {people}", "--role", role, "--gateway", f"https://127.0.0.1:{port}"]
        links = []
        while people > 0:
            words[1] = f"Guest {people}"
            link = subprocess.run([os.path.join(ROOT, "deploy", "security", "invite"), *words, "--expires", "0",
                                   "--people", str(min(people, 50))], env=self.environment, check=True,
                                  stdout=subprocess.PIPE, text=True).stdout.strip()
            links += [link.rsplit("#", 1)[1]] * min(people, 50)
            people -= 50
        return links

    def order(self, *words):
        return subprocess.run([os.path.join(self.options.bin, "render_client"), *self.place(), "--timeout-s", "20",
                               "--command", " ".join(words)], env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)

    def log(self, title):
        with open(self / f"{title}.log", errors="replace") as file:
            return file.read()

    def await_words(self, title, words, limit_s=60):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            said = self.log(title)
            if words in said:
                return said
            if self.children[title].poll() is not None:
                break
            time.sleep(0.05)
        raise Broken(f"{title} does not say '{words}': {self.log(title)[-800:]}")

    def end(self, title, how=signal.SIGTERM, limit_s=30):
        """Returns the exit code."""
        child = self.children.pop(title)
        child.send_signal(how)
        try:
            return child.wait(limit_s)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            raise Broken(f"{title} does not end within {limit_s} s: {self.log(title)[-400:]}") from None

    def await_quiet(self, limit_s=15):
        """Waits until no process is left, and returns those that are."""
        end = time.monotonic() + limit_s
        while (left := marked(self.mark)) and time.monotonic() < end:
            time.sleep(0.1)
        return left
