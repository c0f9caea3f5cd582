"""Plans how a hand opens bone in strokes, layer by layer: for deploy/plan-hand and deploy/make-training-bone.

Lengths are in mm. Places are (out, across, along): out to the hand, along the strokes. A plan (deploy/hand_plans.py) says
which axes of W these are; it is of a left side, and a right one is its mirror image in x."""
import array
import dataclasses
import gzip
import math
import re
import typing

class PlanError(Exception):
    pass


Span = tuple[float, float]
FULL = 65535  # the densest value of a scan as the server saves it


@dataclasses.dataclass(frozen=True)
class Field:
    # Of the burr's centre, where it is outermost and where it is deepest: across, and along the strokes.
    across: tuple[Span, Span]
    along: tuple[Span, Span]
    # How deep the burr is below the scan's surface in the first layer and in the last one.
    first_mm: float
    deepest_mm: float
    # How much of the strokes' low end is left out, by the share of the way across: 0 nothing, 1 all.
    shortened: typing.Callable[[float], float] = lambda share: 0.0


@dataclasses.dataclass(frozen=True)
class Plan:
    burr_mm: float
    # What is left between burr and structure, by label.
    clearance_mm: dict[int, float]
    # One is opened after the other.
    fields: tuple[Field, ...]
    # A layer is this thick where all of it is bone, and where all is air.
    solid_mm: float
    hollow_mm: float
    step_mm: float
    # No quicker, and none that takes more of the densest bone in a second.
    stroke_mm_per_s: float
    most_mm3_per_s: float
    # Names of what is done, each down to a depth.
    phases: tuple[tuple[float, str], ...]
    # Where the hand rests, and where it is clear of the bone; out.
    rest_mm: float
    free_mm: float
    # Which axes of W out, across and along are, and how the hand holds the tool: w, x, y, z.
    axes: tuple[int, int, int]
    turn: tuple[str, str, str, str]

    def phase(self, depth):
        return next(name for down_to, name in self.phases if depth < down_to)


class Volume:
    """A gzipped NRRD file as our programs write them: voxels along the axes of W."""

    TYPES = {"uint8": "B", "int16": "h", "uint16": "H", "float": "f"}

    def __init__(self, path):
        head, _, body = path.read_bytes().partition(b"\n\n")
        self.header = head.decode()
        field = lambda name: re.search(rf"^{name}: *(.*)$", self.header, re.M).group(1)
        self.dims = [int(n) for n in field("sizes").split()]
        self.origin = [float(v) for v in field("space origin").strip("()").split(",")]
        rows = re.findall(r"\(([^)]*)\)", field("space directions"))
        self.spacing = [float(row.split(",")[axis]) for axis, row in enumerate(rows)]
        self.type = field("type")
        self.values = array.array(self.TYPES[self.type], gzip.decompress(body))

    def index(self, p):
        return [min(max(round((v - o) / s), 0), n - 1) for v, o, s, n in zip(p, self.origin, self.spacing, self.dims)]

    def place(self, i, j, k):
        return i + self.dims[0] * (j + self.dims[1] * k)


class Frame:
    """Between W and a plan's places."""

    def __init__(self, plan, side):
        self.axes, self.side = plan.axes, side

    def to_w(self, p):
        q = [0.0] * 3
        for axis, value in zip(self.axes, p):
            q[axis] = value
        return (self.side * q[0], q[1], q[2])

    def of_w(self, p):
        q = (self.side * p[0], p[1], p[2])
        return tuple(q[axis] for axis in self.axes)


class Bone:
    def __init__(self, scan, iso, frame):
        self.scan, self.iso, self.frame = scan, iso, frame

    def value(self, p):
        return self.scan.values[self.scan.place(*self.scan.index(self.frame.to_w(p)))]

    def has(self, p):
        return self.value(p) >= self.iso

    def density(self, p):
        """From 0, where there is no bone, to 1."""
        value = self.value(p)
        return value / FULL if value >= self.iso else 0.0

    def surface(self, across, along):
        """How far out the outermost bone lies."""
        axis, scan = self.frame.axes[0], self.scan
        index = scan.index(self.frame.to_w((0, across, along)))
        outwards = self.frame.side if axis == 0 else 1
        for n in range(scan.dims[axis] - 1, -1, -1) if outwards > 0 else range(scan.dims[axis]):
            index[axis] = n
            if scan.values[scan.place(*index)] >= self.iso:
                return outwards * (scan.origin[axis] + scan.spacing[axis] * n)
        return 0.0


class Burr:
    """Remembers what a burr has taken; lengths are in cells of half a millimetre."""

    CELL = 0.5

    def __init__(self, plan, bone):
        self.bone, self.gone = bone, set()
        reach = int(plan.burr_mm / self.CELL)
        span = range(-reach, reach + 1)
        self.ball = [(a, b, c) for a in span for b in span for c in span
                     if math.hypot(a, b, c) * self.CELL <= plan.burr_mm]

    def take(self, start, end):
        """How much bone it takes on a straight way, mm3 of the densest."""
        steps, taken = max(1, math.ceil(math.dist(start, end) / self.CELL)), 0.0
        for n in range(steps + 1):
            i, j, k = (round(v / self.CELL) for v in between((start, end), n / steps))
            for cell in {(i + a, j + b, k + c) for a, b, c in self.ball} - self.gone:
                self.gone.add(cell)
                taken += self.bone.density([v * self.CELL for v in cell])
        return taken * self.CELL ** 3


class Structures:
    """Tells whether a burr keeps clear of what must be spared."""

    EDGE = 2.0

    def __init__(self, labels, plan, frame):
        self.cubes, self.reach = {}, plan.burr_mm + max(plan.clearance_mm.values())
        stride = [max(1, round(0.6 / spacing)) for spacing in labels.spacing]
        for k in range(0, labels.dims[2], stride[2]):
            for j in range(0, labels.dims[1], stride[1]):
                row = labels.values[labels.place(0, j, k):labels.place(labels.dims[0] - 1, j, k) + 1:stride[0]]
                if not any(row):
                    continue
                for n, label in enumerate(row):
                    if label in plan.clearance_mm:
                        index = (n * stride[0], j, k)
                        p = [o + s * v for o, s, v in zip(labels.origin, labels.spacing, index)]
                        self._add(frame.of_w(p), plan.burr_mm + plan.clearance_mm[label])

    def _add(self, p, reach):
        self.cubes.setdefault(self._cube(p), []).append((p, reach))

    def _cube(self, p):
        return tuple(math.floor(v / self.EDGE) for v in p)

    def are_clear_of(self, p):
        a, b, c = self._cube(p)
        reach = math.ceil(self.reach / self.EDGE)
        span = range(-reach, reach + 1)
        return all(math.dist(p, q) >= far for u in span for v in span for w in span
                   for q, far in self.cubes.get((a + u, b + v, c + w), ()))


def between(pair, share):
    return tuple(a + (b - a) * share for a, b in zip(*pair))


def stroke(place, clear, span, across):
    """(low, high) end of the longest way along that keeps clear; None where there is none."""
    best, run = [], []
    for n in range(int((span[1] - span[0]) / 0.4) + 1):
        p = place(across, span[0] + 0.4 * n)
        run = [*run, p] if clear(p) else []
        best = max(best, run, key=len)
    return (best[0], best[-1]) if len(best) > 4 else None


def layer_mm(plan, bone, places):
    """How thick the next layer is: the less, the more bone lies below the burr."""
    below = [bone.has((out - plan.burr_mm, across, along)) for out, across, along in places]
    return between(((plan.hollow_mm,), (plan.solid_mm,)), sum(below) / len(below))[0]


def strokes(plan, field, bone, structures):
    """(depth, places) of each layer: to and fro in a zigzag across the field, back along its high side, and down its
    first or last stroke."""
    depth, is_forwards = field.first_mm, True
    while depth <= field.deepest_mm:
        share = depth / field.deepest_mm
        (front, back), (low, high) = between(field.across, share), between(field.along, share)
        place = lambda across, along: (bone.surface(across, along) + plan.burr_mm - depth, across, along)
        count = max(2, round((back - front) / plan.step_mm) + 1)
        ways = []
        for n in range(count) if is_forwards else reversed(range(count)):
            ends = stroke(place, structures.are_clear_of, (low + field.shortened(n / (count - 1)) * (high - low), high),
                          front + (back - front) * n / (count - 1))
            if ends:
                ways.append(ends)
        if not ways:
            return
        yield depth, [ends[n % 2] for n, ends in enumerate(ways)] + [ways[-1][1], *reversed(ways[0])]
        is_forwards = not is_forwards
        depth += layer_mm(plan, bone, [between(way, n / 6) for way in ways for n in range(7)])


def lifted(start, end, clear):
    """Places over which the burr keeps clear between two that are: none where the straight way does."""
    count = max(1, math.ceil(math.dist(start, end) / 0.4))
    up = 0.0
    while up < 10 and not all(clear((out + up, across, along)) for out, across, along in
                              (between((start, end), n / count) for n in range(1, count))):
        up += 0.5
    return [(start[0] + up, *start[1:]), (end[0] + up, *end[1:])] if up else []


class Waypoints:
    """The lines of simulated_operator, one by one."""

    def __init__(self, plan, side):
        self.frame, self.lines, self.time, self.here, self.phase = Frame(plan, side), [], 0.0, None, ""
        w, x, y, z = plan.turn
        if side < 0:
            y, z = (mirrored(value) for value in (y, z))
        self.turn = f"q_WT {{ w: {w} x: {x} y: {y} z: {z} }}"

    def go(self, seconds, p, phase, remove=True):
        self.time, self.here = self.time + seconds, p
        x, y, z = self.frame.to_w(p)
        words = f"  waypoint {{ time_s: {self.time:.2f} p_WT_mm {{ x: {x:.1f} y: {y:.1f} z: {z:.1f} }} {self.turn}"
        words += (" remove: true" if remove else "") + (f' phase: "{phase}"' if phase != self.phase else "")
        self.lines.append(words + " }\n")
        self.phase = phase


def mirrored(number):
    return number if float(number) == 0 else number.removeprefix("-") if number.startswith("-") else f"-{number}"


def waypoints(plan, scan_file, iso, labels_file, side=1):
    """The waypoints of a hand that comes, strokes, and leaves, as text; side is 1, or -1 for a right one."""
    frame = Frame(plan, side)
    bone = Bone(Volume(scan_file), iso, frame)
    way = Waypoints(plan, side)
    structures, burr = Structures(Volume(labels_file), plan, frame), Burr(plan, bone)
    for depth, places in (layer for field in plan.fields for layer in strokes(plan, field, bone, structures)):
        phase = plan.phase(depth)
        if way.here is None:
            way.go(0, (plan.rest_mm, *places[0][1:]), "approach", remove=False)
            way.go(1.5, (places[0][0] + 1, *places[0][1:]), phase)
        for end in places:
            for p in [*lifted(way.here, end, structures.are_clear_of), end]:
                taken = burr.take(way.here, p) if plan.most_mm3_per_s < math.inf else 0.0
                way.go(max(math.dist(way.here, p) / plan.stroke_mm_per_s, taken / plan.most_mm3_per_s, 0.05), p, phase)
    if way.here is None:
        raise PlanError("no stroke fits between the structures of this bone; try another seed")
    beside = way.here[1:]
    way.go(1, (plan.free_mm, *beside), "withdraw", remove=False)
    way.go(1.5, (plan.rest_mm, *beside), "rest", remove=False)
    way.go(1.5, way.here, "rest", remove=False)
    return "".join(way.lines)
