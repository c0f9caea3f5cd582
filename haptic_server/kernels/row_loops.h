// Rows of voxels: milling and ranges. Part of kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// Anything to mill: a row of air has nothing to remove, a solid one no room to add.
template <int kDirection>
bool isFinished(const uint16_t* row, int count) {
    constexpr uint16_t kFinished = kDirection < 0 ? 0 : 65535;
    WideWords any{}, part;
    for (int i = 0; i < count; i += kWideWords) {
        loadWords(row + i, part);
        any |= part ^ kFinished;
    }
    uint64_t parts[sizeof any / sizeof(uint64_t)], left = 0;
    __builtin_memcpy(parts, &any, sizeof any);
    for (const uint64_t p : parts) left |= p;
    return left == 0;
}

// kDirection: -1 removes, +1 adds. Without branches; lanes beyond the burr's reach or the row keep their
// density.
template <int kDirection>
MilledRow millRow(const BurrRow& burr, const uint16_t* __restrict row, int count, uint16_t* __restrict out) {
    if (isFinished<kDirection>(row, count)) return {0, 0, 0};
    constexpr float kMost = 65535, kCore = kDirection < 0 ? 0 : kMost;
    const BurrRow b = burr;
    Ints lane, changed{}, removed{}, added{};  // counts below zero: a true comparison is -1
    for (int l = 0; l < kWidth; ++l) lane[l] = l;
    for (int i = 0; i < count; i += kWidth) {
        Words words;
        loadWords(row + i, words);
        const Ints old = __builtin_convertvector(words, Ints);
        const Floats x = b.first_x + __builtin_convertvector(lane + i, Floats) * b.step_x;
        const Floats squared = x * x + b.off_row_squared;
        Floats distance;
        rootOf(squared, distance);
        const Floats ramp = float(b.iso) - float(kDirection) * b.slope * (distance - b.radius);
        const Floats low = ramp < 0 ? Floats{} : ramp;
        const Floats clamped = (low > kMost ? Floats{} + kMost : low) + 0.5f;
        const Ints limit =
            __builtin_convertvector(squared < b.core_squared ? Floats{} + kCore : clamped, Ints);
        const Ints step = old + kDirection * b.amount;
        const Ints moved = kDirection < 0 ? (limit > step ? limit : step) : (limit < step ? limit : step);
        const Ints towards = kDirection < 0 ? (moved < old ? moved : old) : (moved > old ? moved : old);
        const Ints now = (squared < b.reach_squared) & (lane + i < count) ? towards : old;
        const Words fresh = __builtin_convertvector(now, Words);
        __builtin_memcpy(out + i, &fresh, sizeof fresh);
        changed += now != old;
        removed += (old >= b.iso) & (now < b.iso);
        added += (old < b.iso) & (now >= b.iso);
    }
    MilledRow sum{0, 0, 0};
    for (int l = 0; l < kWidth; ++l) {
        sum.changed -= changed[l];
        sum.removed -= removed[l];
        sum.added -= added[l];
    }
    return sum;
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
