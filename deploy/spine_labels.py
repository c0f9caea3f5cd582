"""Places what lies around a vertebra in a CT of a spine, by rule: for deploy/make-real-case.

    spine_labels.py SCAN.nrrd LABELS.nrrd X Y Z LOW HIGH

X Y Z: a place in the spinal canal where the arch closes it, mm in W; LOW, HIGH: down to and up to which z. Labels: 1 spinal
canal, 2 roots, 3 aorta. No clinician has seen them: the canal is what bone leaves open about its middle, followed slice by
slice, the aorta the roundest even soft tissue in front of the bodies, a root a short tube through each foramen."""
import array
import gzip
import math
import pathlib
import sys

import hand_planner

BONE_HU, SOFT_HU = 200, (-20, 110)
CANAL, ROOT, AORTA = 1, 2, 3
ROOT_MM, ROOT_LENGTH_MM = 1.6, 14.0
AORTA_MM = (9.0, 10.0, 11.0, 12.0)


class Slices:
    def __init__(self, path):
        self.volume = hand_planner.Volume(path)
        self.labels = bytearray(len(self.volume.values))
        self.step = self.volume.spacing[0]

    def hu(self, x, y, k):
        i, j, _ = self.volume.index((x, y, 0))
        return self.volume.values[self.volume.place(i, j, k)]

    def z(self, k):
        return self.volume.origin[2] + self.volume.spacing[2] * k

    def level(self, z):
        return self.volume.index((0, 0, z))[2]

    def disc(self, x, y, radius):
        """Places of the pixels within the radius."""
        (i, j, _), reach = self.volume.index((x, y, 0)), math.ceil(radius / self.step)
        for b in range(j - reach, j + reach + 1):
            for a in range(i - reach, i + reach + 1):
                p = (self.volume.origin[0] + self.step * a, self.volume.origin[1] + self.step * b)
                if math.dist(p, (x, y)) <= radius:
                    yield p

    def mark(self, x, y, k, label):
        i, j, _ = self.volume.index((x, y, 0))
        place = self.volume.place(i, j, k)
        self.labels[place] = self.labels[place] or label

    def write(self, path):
        head = self.volume.header.replace(f"type: {self.volume.type}", "type: uint8")
        path.write_bytes(head.encode() + b"\n\n" + gzip.compress(bytes(self.labels), mtime=0))


def around(step, reach):
    count = int(reach / step)
    return [(a * step, b * step) for b in range(-count, count + 1) for a in range(-count, count + 1)]


def room(slices, x, y, k):
    """How far it is to bone, at most 15 mm."""
    radius = slices.step
    while radius < 15 and all(slices.hu(x + radius * math.cos(n * math.pi / 12), y + radius * math.sin(n * math.pi / 12), k) < BONE_HU
                              for n in range(24)):
        radius += slices.step / 2
    return radius


def follow(find, slices, start, from_k, low_k, high_k):
    """What find(k, what it was in the slice beside) gives from the start downwards and upwards, by slice."""
    found = {from_k: start}
    for k in range(from_k - 1, low_k - 1, -1):
        found[k] = find(k, found[k + 1])
    for k in range(from_k + 1, high_k + 1):
        found[k] = find(k, found[k - 1])
    return found


def canal_at(slices, k, before):
    """(x, y, radius) of the largest circle without bone whose middle lies near that of the slice beside."""
    x, y, _ = before
    best = max(((room(slices, x + a, y + b, k), -math.hypot(a, b), x + a, y + b) for a, b in around(0.5, 1.0)))
    return (best[2], best[3], min(best[0], 10.0))


def mark_canal(slices, k, circle):
    """What can be reached from the middle without crossing bone, a little wider than the circle."""
    x, y, radius = circle
    pixel = lambda p: tuple(slices.volume.index((*p, 0))[:2])
    open_places = {pixel(p): p for p in slices.disc(x, y, 1.15 * radius) if slices.hu(*p, k) < BONE_HU}
    reached = [pixel((x, y))]
    while reached:
        i, j = reached.pop()
        p = open_places.pop((i, j), None)
        if p:
            slices.mark(*p, k, CANAL)
            reached += [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)]


def roundness(slices, x, y, radius, k):
    """How even the soft tissue of a disc is, and how much darker than it, by fat and lung, the ring around it."""
    inside = [slices.hu(*p, k) for p in slices.disc(x, y, radius - 1)]
    soft = sum(SOFT_HU[0] <= hu <= SOFT_HU[1] for hu in inside) / len(inside)
    ring = [slices.hu(x + far * math.cos(n * math.pi / 16), y + far * math.sin(n * math.pi / 16), k)
            for far in (radius + 1.2, radius + 2.2) for n in range(32)]
    darker = sum(min(max(45 - hu, 0), 100) if hu < BONE_HU else 100 for hu in ring) / len(ring)
    return soft + darker / 100


def aorta_at(slices, k, places, radii):
    return max((roundness(slices, x, y, radius, k), x, y, radius) for x, y in places for radius in radii)[1:]


def first_aorta(slices, canal, k):
    """It lies before the body, from its middle to the left."""
    x, y, _ = canal
    return aorta_at(slices, k, [(x + a, y - b) for a in range(-6, 17) for b in range(40, 66)], AORTA_MM)


def side_is_open(slices, canal, k, side):
    x, y, radius = canal
    return all(slices.hu(x + side * d, y - 1 + a, k) < BONE_HU for d in range(int(radius), 18) for a in (-1, 0, 1))


def mark_roots(slices, canals, side):
    """In each run of slices in which the canal is open to a side: a tube outwards, a third below its top."""
    levels = [k for k in sorted(canals) if side_is_open(slices, canals[k], k, side)]
    runs = []
    for k in levels:
        if runs and runs[-1][-1] == k - 1:
            runs[-1].append(k)
        else:
            runs.append([k])
    for run in runs:
        if (run[-1] - run[0]) * slices.volume.spacing[2] < 4:
            continue
        middle = run[0] + round(0.66 * (len(run) - 1))
        x, y, radius = canals[middle]
        for n in range(int(ROOT_LENGTH_MM) + 1):
            centre = (x + side * (radius - 1 + n), y - 1 - 0.3 * n, slices.z(middle) - 0.4 * n)
            mark_ball(slices, centre, ROOT_MM)


def mark_ball(slices, centre, radius):
    for k in range(slices.level(centre[2] - radius), slices.level(centre[2] + radius) + 1):
        up = abs(slices.z(k) - centre[2])
        if up < radius:
            for p in slices.disc(centre[0], centre[1], math.sqrt(radius ** 2 - up ** 2)):
                if slices.hu(*p, k) < BONE_HU:
                    slices.mark(*p, k, ROOT)


def main():
    scan, out, *numbers = sys.argv[1:]
    x, y, z, low, high = map(float, numbers)
    slices = Slices(pathlib.Path(scan))
    at, low_k, high_k = slices.level(z), slices.level(low), slices.level(high)
    canals = follow(lambda k, before: canal_at(slices, k, before), slices, canal_at(slices, at, (x, y, 0)), at, low_k, high_k)
    for k, circle in canals.items():
        mark_canal(slices, k, circle)
    near = lambda k, before: aorta_at(slices, k, [(before[0] + a, before[1] + b) for a, b in around(1.0, 1.0)], [before[2]])
    for k, (x, y, radius) in follow(near, slices, first_aorta(slices, canals[at], at), at, low_k, high_k).items():
        for p in slices.disc(x, y, radius):
            if slices.hu(*p, k) < BONE_HU:
                slices.mark(*p, k, AORTA)
    for side in (1, -1):
        mark_roots(slices, canals, side)
    slices.write(pathlib.Path(out))


if __name__ == "__main__":
    main()
