"""Plans how a hand opens the mastoid of a temporal bone phantom: for deploy/make-temporal-bone.

Lengths are in mm. Places are those of a left bone (x to the side, y to the back, z up); a right one is its mirror image."""
import array
import gzip
import math
import re

BURR_MM = 3.0
# What is left between burr and structure: 1 sigmoid sinus, 2 facial nerve, 3 dura, 4 semicircular canals, 5 ossicles.
CLEARANCE_MM = {1: 1.6, 2: 2.5, 3: 1.4, 4: 2.0, 5: 2.0}
STROKE_MM_PER_S, STEP_MM = 20.0, 1.5
# The field of the burr's centre at the surface, and where the antrum is open: (low, high). Behind and in front it ends
# higher than in its middle: towards the tip the field is as narrow as the mastoid process.
FIELD_Y, FIELD_Z = ((3.4, 15.5), (3.4, 8.5)), ((-14.0, 3.0), (-6.0, 2.5))
DEEPEST_MM = 14.0
CORTEX_MM, ANTRUM_MM = 3.0, 8.5
# A layer is this thick where all of it is bone, and where all is air.
SOLID_MM, HOLLOW_MM = 0.42, 0.95
ISO_HU = 150


class Volume:
    """A NRRD file of make_phantom: cubes, gzip, voxels along the axes of W."""

    def __init__(self, path):
        head, _, body = path.read_bytes().partition(b"\n\n")
        text = head.decode()
        field = lambda name: re.search(rf"^{name}: *(.*)$", text, re.M).group(1)
        self.dims = [int(n) for n in field("sizes").split()]
        self.origin = [float(v) for v in field("space origin").strip("()").split(",")]
        self.spacing = float(re.match(r"\(([^,]*)", field("space directions")).group(1))
        self.values = array.array("B" if field("type") == "uint8" else "h", gzip.decompress(body))

    def index(self, p):
        return [min(max(round((v - o) / self.spacing), 0), n - 1) for v, o, n in zip(p, self.origin, self.dims)]

    def place(self, i, j, k):
        return i + self.dims[0] * (j + self.dims[1] * k)


class Structures:
    """Tells whether a burr keeps clear of what must be spared."""

    EDGE = 2.0

    def __init__(self, labels, side):
        self.cubes = {}
        stride = max(1, round(0.6 / labels.spacing))
        for k in range(0, labels.dims[2], stride):
            for j in range(0, labels.dims[1], stride):
                row = labels.values[labels.place(0, j, k):labels.place(labels.dims[0] - 1, j, k) + 1:stride]
                if not any(row):
                    continue
                for n, label in enumerate(row):
                    if label in CLEARANCE_MM:
                        index = (n * stride, j, k)
                        x, y, z = (o + labels.spacing * v for o, v in zip(labels.origin, index))
                        self._add((side * x, y, z), BURR_MM + CLEARANCE_MM[label])

    def _add(self, p, reach):
        self.cubes.setdefault(self._cube(p), []).append((p, reach))

    def _cube(self, p):
        return tuple(math.floor(v / self.EDGE) for v in p)

    def are_clear_of(self, p):
        a, b, c = self._cube(p)
        reach = math.ceil((BURR_MM + max(CLEARANCE_MM.values())) / self.EDGE)
        span = range(-reach, reach + 1)
        return all(math.dist(p, q) >= far for u in span for v in span for w in span
                   for q, far in self.cubes.get((a + u, b + v, c + w), ()))


def surface(scan, side, y, z):
    """x of the outermost bone of a left ear."""
    i_from, j, k = scan.index((0, y, z))
    order = range(scan.dims[0] - 1, -1, -1) if side > 0 else range(scan.dims[0])
    for i in order:
        if scan.values[scan.place(i, j, k)] >= ISO_HU:
            return side * (scan.origin[0] + scan.spacing * i)
    return 0.0


def between(pair, share):
    return tuple(a + (b - a) * share for a, b in zip(*pair))


def stroke(place, clear, z_range, y):
    """(lower, upper) end of the longest way up at y that keeps clear; None where there is none."""
    best, run = [], []
    for n in range(int((z_range[1] - z_range[0]) / 0.4) + 1):
        p = place(y, z_range[0] + 0.4 * n)
        run = [*run, p] if clear(p) else []
        best = max(best, run, key=len)
    return (best[0], best[-1]) if len(best) > 4 else None


def layer_mm(scan, side, places):
    """How thick the next layer is: the less, the more bone lies below the burr."""
    below = [scan.values[scan.place(*scan.index((side * (x - BURR_MM), y, z)))] for x, y, z in places]
    return between(((HOLLOW_MM,), (SOLID_MM,)), sum(hu >= ISO_HU for hu in below) / len(below))[0]


def strokes(scan, labels, side):
    """(depth, places) of each layer down to the antrum: up and down in a zigzag along the sinus, back below the
    tegmen, and down the canal wall or the sinus."""
    structures = Structures(labels, side)
    depth, is_forwards = 0.3, True
    while depth <= DEEPEST_MM:
        share = depth / DEEPEST_MM
        (front, back), (low, high) = between(FIELD_Y, share), between(FIELD_Z, share)
        place = lambda y, z: (surface(scan, side, y, z) + BURR_MM - depth, y, z)
        count = max(2, round((back - front) / STEP_MM) + 1)
        ways = []
        for n in range(count) if is_forwards else reversed(range(count)):
            aside = abs(2 * n / (count - 1) - 0.7) / 1.3
            ends = stroke(place, structures.are_clear_of, (low + 0.65 * (high - low) * aside ** 2, high),
                          front + (back - front) * n / (count - 1))
            if ends:
                ways.append(ends)
        if not ways:
            return
        yield depth, [ends[n % 2] for n, ends in enumerate(ways)] + [ways[-1][1], *reversed(ways[0])]
        is_forwards = not is_forwards
        depth += layer_mm(scan, side, [between(way, n / 6) for way in ways for n in range(7)])


def waypoints(scan_file, labels_file, side):
    """The waypoints of simulated_operator, a line each: it comes from the side, strokes, and leaves; side is 1 or -1 (right)."""
    scan, labels = Volume(scan_file), Volume(labels_file)
    lines, time, here, phase = [], 0.0, None, ""

    def go(seconds, p, now, remove=True):
        nonlocal time, here, phase
        time, here = time + seconds, p
        words = f"  waypoint {{ time_s: {time:.2f} p_WT_mm {{ x: {side * p[0]:.1f} y: {p[1]:.1f} z: {p[2]:.1f} }}"
        words += f" q_WT {{ w: 0.70710678 x: 0 y: 0 z: {-side * 0.70710678} }}" + (" remove: true" if remove else "")
        lines.append(words + (f' phase: "{now}"' if now != phase else "") + " }\n")
        phase = now

    for depth, places in strokes(scan, labels, side):
        if here is None:
            go(0, (18, *places[0][1:]), "approach", remove=False)
            go(1.5, (places[0][0] + 1, *places[0][1:]), "cortex")
        for p in places:
            go(max(math.dist(here, p) / STROKE_MM_PER_S, 0.05), p,
               "cortex" if depth < CORTEX_MM else "air cells" if depth < ANTRUM_MM else "antrum")
    go(1, (4, *here[1:]), "withdraw", remove=False)
    go(1.5, (18, *here[1:]), "rest", remove=False)
    go(1.5, here, "rest", remove=False)
    return "".join(lines)
