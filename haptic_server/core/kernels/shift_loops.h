// These loops say by how much densities fall where the surface moves into the bone. They are part of
// kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

constexpr int kUnclampedRounds = 3;  // of corners that come to rest at zero

// All corners of a cell must fall by this, so that the density at `t` falls by `excess`. Those that come to
// rest at zero leave the rest to the others.
inline void equalDrop(const Floats (&corners)[8], float iso, const Points& t, const Floats& excess,
                      Floats& drop) {
    constexpr float kMax = 65535;
    const Floats low_x = 1 - t.x, low_y = 1 - t.y, low_z = 1 - t.z;
    drop = excess;
    for (int round = 0; round < kUnclampedRounds; ++round) {
        Floats done{}, share{};
        for (int c = 0; c < 8; ++c) {
            const Floats weight = (c & 1 ? t.x : low_x) * (c & 2 ? t.y : low_y) * (c & 4 ? t.z : low_z);
            const Floats density = corners[c] + iso;
            const Ints rests = density < drop;
            done += rests ? weight * density : Floats{};
            share += rests ? Floats{} : weight;
        }
        drop = share > 0 ? (excess - done) / share : drop;
    }
    drop = drop < 0 ? Floats{} : drop;
    drop = drop > kMax ? Floats{} + kMax : drop;
}

void sinkSurface(const DensityView& density, const SinkingPoints& points) {
    const DensityView d = density;
    const float ix = d.inverse_spacing[0], iy = d.inverse_spacing[1], iz = d.inverse_spacing[2];
    for (int first = 0; first < points.count; first += kWidth) {
        Ints is_one;
        for (int l = 0; l < kWidth; ++l) is_one[l] = first + l < points.count ? -1 : 0;
        Points at, t, slope;
        load(points.x + first, at.x), load(points.y + first, at.y), load(points.z + first, at.z);
        at.x = is_one ? at.x * ix : Floats{}, at.y = is_one ? at.y * iy : Floats{},
        at.z = is_one ? at.z * iz : Floats{};
        Ints i, j, k;
        Floats corners[8], here, excess, recession, least, drop;
        const auto readAt = [&](const Points& p) {
            cellUnder(p.x, d.dims[0], i, t.x);
            cellUnder(p.y, d.dims[1], j, t.y);
            cellUnder(p.z, d.dims[2], k, t.z);
            readCells(d, i, j, k, corners);
        };
        readAt(at);
        sampleCells(corners, t, here, slope);
        const Floats gx = slope.x * ix, gy = slope.y * iy, gz = slope.z * iz;
        Floats length;
        rootOf(gx * gx + (gy * gy + gz * gz), length);
        load(points.recession + first, recession);
        load(points.least_excess + first, least);
        const Ints moves = is_one & (length > 0);
        const Floats scale = recession / length;
        at.x += moves ? scale * (gx * ix) : Floats{};
        at.y += moves ? scale * (gy * iy) : Floats{};
        at.z += moves ? scale * (gz * iz) : Floats{};
        readAt(at);
        sampleCells(corners, t, excess, slope);
        // The point itself is on the surface but for its projection's tolerance.
        excess -= here;
        excess = excess < least ? least : excess;
        equalDrop(corners, float(d.iso), t, excess, drop);
        store(at.x, points.x + first), store(at.y, points.y + first), store(at.z, points.z + first);
        store(drop, points.drop + first);
    }
}

void hatBoxes(const HatBoxes& boxes, int count) {
    const HatBoxes b = boxes;
    for (int axis = 0; axis < 3; ++axis)
        for (int first = 0; first < count; first += kWidth) {
            Ints lane, low, high;
            countLanes(lane);
            Floats at;
            load(b.at[axis] + first, at);
            at = first + lane < count ? at : Floats{};
            floorOf(at - b.width, low);
            floorOf(-(at + b.width), high);
            low += 1, high = -1 - high;
            low = low < b.low[axis] ? Ints{} + b.low[axis] : low;
            high = high > b.high[axis] ? Ints{} + b.high[axis] : high;
            store(low, b.first[axis] + first);
            store(high - low + 1, b.count[axis] + first);
        }
}

// Calls take(offset of the row, kWidth weights by area) for the hat's rows, with zero beyond their ends.
template <class Take>
inline void forEachHatPart(const VoxelHat& hat, float area, Take&& take) {
    const VoxelHat h = hat;
    Ints lane;
    countLanes(lane);
    const auto weight = [&](int voxel, float place) {
        const float off = float(voxel) - place;
        return h.width - (off < 0 ? -off : off);
    };
    for (int k = 0; k < h.count[2]; ++k)
        for (int j = 0; j < h.count[1]; ++j) {
            const float off_row = weight(h.first[2] + k, h.at[2]) * weight(h.first[1] + j, h.at[1]);
            const size_t row = h.stride_y * size_t(j) + h.stride_z * size_t(k);
            for (int i = 0; i < h.count[0]; i += kWidth) {
                const Floats off = __builtin_convertvector(lane + (h.first[0] + i), Floats) - h.at[0];
                const Floats weights = off_row * (h.width - (off < 0 ? -off : off)) * area;
                take(row + size_t(i), lane + i < h.count[0] ? weights : Floats{});
            }
        }
}

void addHat(const VoxelHat& hat, float area, float drop, float* drops, float* weights) {
    forEachHatPart(hat, area, [&](size_t at, const Floats& share) {
        Floats d, w;
        load(drops + at, d), load(weights + at, w);
        store(d + share * drop, drops + at);
        store(w + share, weights + at);
    });
}

void addHatWhereAny(const VoxelHat& hat, float area, float* weights) {
    forEachHatPart(hat, area, [&](size_t at, const Floats& share) {
        Floats w;
        load(weights + at, w);
        store(w > 0 ? w + share : w, weights + at);
    });
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
