// These loops run over rows of voxels, for milling and ranges. They are part of kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// Is there anything to mill? A row of air has nothing to remove, a solid one no room to add.
template <int kDirection>
bool isFinished(const uint16_t* row) {
    constexpr uint16_t kFinished = kDirection < 0 ? 0 : 65535;
    WideWords any{}, part;
    for (int i = 0; i < kBrickCells; i += kWideWords) {
        loadWords(row + i, part);
        any |= part ^ kFinished;
    }
    uint64_t parts[sizeof any / sizeof(uint64_t)], left = 0;
    __builtin_memcpy(parts, &any, sizeof any);
    for (const uint64_t p : parts) left |= p;
    return left == 0;
}

// A true comparison is -1, so this counts voxels below zero.
struct MilledLanes {
    Ints changed{}, removed{}, added{};
};

// This is a row's part in the squares of distances, m², and its part along the way, m.
struct RowPlace {
    float off_squared, along;
};

// Takes from squared distances from the way's beginning to those from its nearest point.
void fromWay(const BurrPlane& b, const RowPlace& place, const Floats& x, Floats& squared) {
    const Floats along = x * b.way_x + place.along;
    const Floats low = along < 0 ? Floats{} : along;
    const Floats nearest = low > b.way ? Floats{} + b.way : low;
    const Floats left = squared + nearest * (nearest - 2 * along);
    squared = left < 0 ? Floats{} : left;
}

// kDirection -1 removes, +1 adds. There are no branches; lanes beyond the burr's reach or the row keep their
// density.
template <int kDirection, bool kIsSwept>
void millRow(const BurrPlane& b, const RowPlace& place, const uint16_t* row, int count, uint16_t* out,
             MilledLanes& milled) {
    constexpr float kMax = 65535, kCore = kDirection < 0 ? 0 : kMax;
    Ints lane;
    countLanes(lane);
    for (int i = 0; i < kBrickCells; i += kWidth) {
        Words words;
        loadWords(row + i, words);
        const Ints old = __builtin_convertvector(words, Ints);
        const Floats x = b.first_x + __builtin_convertvector(lane + i, Floats) * b.step_x;
        Floats squared = x * x + place.off_squared;
        if constexpr (kIsSwept) fromWay(b, place, x, squared);
        Floats distance;
        rootOf(squared, distance);
        const Floats ramp = float(b.iso) - float(kDirection) * b.slope * (distance - b.radius);
        const Floats low = ramp < 0 ? Floats{} : ramp;
        const Floats clamped = (low > kMax ? Floats{} + kMax : low) + 0.5f;
        const Ints limit =
            __builtin_convertvector(squared < b.core_squared ? Floats{} + kCore : clamped, Ints);
        const Ints step = old + kDirection * b.amount;
        const Ints moved = kDirection < 0 ? (limit > step ? limit : step) : (limit < step ? limit : step);
        const Ints towards = kDirection < 0 ? (moved < old ? moved : old) : (moved > old ? moved : old);
        const Ints now = (squared < b.reach_squared) & (lane + i < count) ? towards : old;
        const Words fresh = __builtin_convertvector(now, Words);
        __builtin_memcpy(out + i, &fresh, sizeof fresh);
        milled.changed += now != old;
        milled.removed += (old >= b.iso) & (now < b.iso);
        milled.added += (old < b.iso) & (now >= b.iso);
    }
}

template <int kDirection, bool kIsSwept>
MilledPlane millRows(const BurrPlane& burr, const uint16_t* first, int count, int rows, uint16_t* out) {
    const BurrPlane b = burr;
    MilledLanes sum;
    uint32_t is_changed = 0;
    for (int r = 0; r < rows; ++r, first += kBrickStrideY, out += kBrickCells) {
        const float y = b.first_y + float(r) * b.step_y;
        const RowPlace place{y * y + b.off_plane_squared, y * b.way_y + b.off_plane_along};
        if (!kIsSwept && place.off_squared >= b.reach_squared) continue;
        if (isFinished<kDirection>(first)) continue;
        MilledLanes milled;
        millRow<kDirection, kIsSwept>(b, place, first, count, out, milled);
        is_changed |= uint32_t(isAny(milled.changed)) << r;
        sum.removed += milled.removed;
        sum.added += milled.added;
    }
    MilledPlane plane{0, 0, is_changed};
    for (int l = 0; l < kWidth; ++l) {
        plane.removed -= sum.removed[l];
        plane.added -= sum.added[l];
    }
    return plane;
}

template <int kDirection>
MilledPlane millPlane(const BurrPlane& burr, const uint16_t* first, int count, int rows, uint16_t* out) {
    return burr.way > 0 ? millRows<kDirection, true>(burr, first, count, rows, out)
                        : millRows<kDirection, false>(burr, first, count, rows, out);
}

struct LaidLanes {
    Ints changed{}, added{}, owed{};
};

void layRow(const BurrPlane& b, const RowPlace& place, const uint16_t* shall, const uint16_t* row, int count,
            uint16_t* out, LaidLanes& laid) {
    Ints lane;
    countLanes(lane);
    for (int i = 0; i < kBrickCells; i += kWidth) {
        Words words, wanted;
        loadWords(row + i, words);
        loadWords(shall + i, wanted);
        const Ints old = __builtin_convertvector(words, Ints);
        const Ints end = lane + i < count ? __builtin_convertvector(wanted, Ints) : Ints{};
        const Floats x = b.first_x + __builtin_convertvector(lane + i, Floats) * b.step_x;
        Floats squared = x * x + place.off_squared;
        fromWay(b, place, x, squared);
        const Ints allowed = squared < b.core_squared ? Ints{} : end;
        const Ints step = old + b.amount;
        const Ints risen = allowed < step ? allowed : step;
        const Ints now = risen > old ? risen : old;
        const Words fresh = __builtin_convertvector(now, Words);
        __builtin_memcpy(out + i, &fresh, sizeof fresh);
        laid.changed += now != old;
        laid.added += (old < b.iso) & (now >= b.iso);
        laid.owed += end > now;
    }
}

LaidPlane layPlane(const BurrPlane& burr, const uint16_t* shall, const uint16_t* first, int count, int rows,
                   uint16_t* out) {
    const BurrPlane b = burr;
    LaidLanes sum;
    uint32_t is_changed = 0;
    for (int r = 0; r < rows; ++r, first += kBrickStrideY, shall += kBrickStrideY, out += kBrickCells) {
        if (isFinished<-1>(shall)) continue;
        const float y = b.first_y + float(r) * b.step_y;
        const RowPlace place{y * y + b.off_plane_squared, y * b.way_y + b.off_plane_along};
        LaidLanes laid;
        layRow(b, place, shall, first, count, out, laid);
        is_changed |= uint32_t(isAny(laid.changed)) << r;
        sum.added += laid.added;
        sum.owed += laid.owed;
    }
    LaidPlane plane{0, is_changed, isAny(sum.owed)};
    for (int l = 0; l < kWidth; ++l) plane.added -= sum.added[l];
    return plane;
}

void cellSides(const VoxelBox& box, int columns, int rows, uint16_t iso, size_t row_size, uint8_t* out) {
    using Bytes = uint8_t __attribute__((vector_size(kWideWords)));
    for (int r = 0; r < rows; ++r, out += row_size) {
        const uint16_t* row = box.first + box.stride_y * size_t(r);
        for (int i = 0; i < columns; i += kWideWords) {
            WideWords a, b, c, d;
            loadWords(row + i, a);
            loadWords(row + i + box.stride_y, b);
            loadWords(row + i + box.stride_z, c);
            loadWords(row + i + box.stride_y + box.stride_z, d);
            const WideWords low = (WideWords(a >= iso) & 1) | (WideWords(b >= iso) & 4);
            const WideWords high = (WideWords(c >= iso) & 16) | (WideWords(d >= iso) & 64);
            const Bytes bytes = __builtin_convertvector(low | high, Bytes);
            __builtin_memcpy(out + i, &bytes, sizeof bytes);
        }
        __builtin_memset(out + columns, out[columns - 1], kCellsAtOnce);
    }
}

void rangeOfRows(const uint16_t* row, int count, size_t stride, int rows, uint16_t& low, uint16_t& high) {
    uint16_t l = low, h = high;
    if (count < kWideWords) {
        for (int r = 0; r < rows; ++r, row += stride)
            for (int i = 0; i < count; ++i) l = least(l, row[i]), h = largest(h, row[i]);
    } else {
        WideWords lows = WideWords{} + l, highs = WideWords{} + h, part;
        for (int r = 0; r < rows; ++r, row += stride)
            for (int i = 0; i < count; i += kWideWords) {
                loadWords(row + least(i, count - kWideWords), part);  // the last one may overlap
                lows = part < lows ? part : lows;
                highs = highs < part ? part : highs;
            }
        for (int n = 0; n < kWideWords; ++n) l = least(l, lows[n]), h = largest(h, highs[n]);
    }
    low = l, high = h;
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
