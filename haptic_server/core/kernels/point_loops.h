// These loops are for points, the tool's distances and the contact's sums. They are part of kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

template <class Scalar>
void intoFrame(const FrameChange<Scalar>& f, const float* __restrict x, const float* __restrict y,
               const float* __restrict z, int count, Scalar* __restrict out_x, Scalar* __restrict out_y,
               Scalar* __restrict out_z) {
    const FrameChange<Scalar> frame = f;
    for (int i = 0; i < count; ++i) {
        const Scalar dx = Scalar(x[i]) - frame.origin[0], dy = Scalar(y[i]) - frame.origin[1],
                     dz = Scalar(z[i]) - frame.origin[2];
        out_x[i] = frame.R[0] * dx + frame.R[1] * dy + frame.R[2] * dz;
        out_y[i] = frame.R[3] * dx + frame.R[4] * dy + frame.R[5] * dz;
        out_z[i] = frame.R[6] * dx + frame.R[7] * dy + frame.R[8] * dz;
    }
}

// Leads from the nearest place of the solid's axis to the point; returns the length of that way.
template <class Scalar>
inline Scalar fromAxis(const RoundSolid<Scalar>& s, Scalar px, Scalar py, Scalar pz, Scalar& dx, Scalar& dy,
                       Scalar& dz) {
    const Scalar x = px - s.from[0], y = py - s.from[1], z = pz - s.from[2];
    const Scalar along = least(largest(x * s.axis[0] + y * s.axis[1] + z * s.axis[2], Scalar(0)), s.length);
    dx = x - along * s.axis[0], dy = y - along * s.axis[1], dz = z - along * s.axis[2];
    return root(dx * dx + dy * dy + dz * dz);
}

template <class Scalar>
void nearerRound(const RoundSolid<Scalar>& solid, const Scalar* __restrict px, const Scalar* __restrict py,
                 const Scalar* __restrict pz, int count, Scalar* __restrict out) {
    const RoundSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        Scalar dx, dy, dz;
        out[i] = least(out[i], fromAxis(s, px[i], py[i], pz[i], dx, dy, dz) - s.radius);
    }
}

template <class Scalar>
void sampleNearerRound(const RoundSolid<Scalar>& solid, const Scalar* __restrict px,
                       const Scalar* __restrict py, const Scalar* __restrict pz, int count,
                       Scalar* __restrict distance, Scalar* __restrict gx, Scalar* __restrict gy,
                       Scalar* __restrict gz) {
    constexpr Scalar kOnAxis = Scalar(1e-15);  // m
    const RoundSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        Scalar dx, dy, dz;
        const Scalar to_axis = fromAxis(s, px[i], py[i], pz[i], dx, dy, dz);
        const Scalar scale = 1 / largest(to_axis, kOnAxis);
        const Scalar here = to_axis - s.radius;
        const Scalar there = distance[i], tx = gx[i], ty = gy[i], tz = gz[i];
        const bool is_nearer = here < there;
        distance[i] = is_nearer ? here : there;
        gx[i] = is_nearer ? dx * scale : tx;
        gy[i] = is_nearer ? dy * scale : ty;
        gz[i] = is_nearer ? dz * scale : tz;
    }
}

// This is a point as the cone's axis sees it.
template <class Scalar>
struct FromConeAxis {
    Scalar along, off;
    Scalar dx, dy, dz;  // off the axis, of length `off`
};

template <class Scalar>
inline FromConeAxis<Scalar> fromAxis(const ConeSolid<Scalar>& s, Scalar px, Scalar py, Scalar pz) {
    const Scalar x = px - s.from[0], y = py - s.from[1], z = pz - s.from[2];
    const Scalar along = x * s.axis[0] + y * s.axis[1] + z * s.axis[2];
    const Scalar dx = x - along * s.axis[0], dy = y - along * s.axis[1], dz = z - along * s.axis[2];
    // Near the axis it would show what rounding left along it.
    const Scalar rest = dx * s.axis[0] + dy * s.axis[1] + dz * s.axis[2];
    const Scalar ox = dx - rest * s.axis[0], oy = dy - rest * s.axis[1], oz = dz - rest * s.axis[2];
    return {along, root(ox * ox + oy * oy + oz * oz), ox, oy, oz};
}

template <class Scalar>
constexpr Scalar kNoDirection = Scalar(1e-12);  // m: below it a direction is taken by convention

// Returns the distance of the profile, and its gradient along and off the axis. Without its edges' radius the
// profile is convex: it is the largest of the distances to its lines, but for points that are nearest to a
// rim.
template <class Scalar>
struct ConeProfile {
    Scalar distance, along, off;
};

template <class Scalar>
inline ConeProfile<Scalar> fromProfile(const ConeSolid<Scalar>& s, Scalar along, Scalar off) {
    const Scalar beyond = along - s.length, over0 = off - s.radius[0], over1 = off - s.radius[1];
    const bool is_rim0 = (over0 > 0) & (along * s.side[0] + over0 * s.side[1] < 0);
    const bool is_rim1 = (over1 > 0) & (beyond * s.side[0] + over1 * s.side[1] > 0);
    const Scalar rx = is_rim0 ? along : beyond, ry = is_rim0 ? over0 : over1;
    const Scalar to_rim = root(rx * rx + ry * ry);
    const bool is_rim = (is_rim0 | is_rim1) & (to_rim > kNoDirection<Scalar>);
    const Scalar end = largest(-along, beyond), side = over0 * s.side[0] - along * s.side[1];
    const bool is_end = end > side;
    const Scalar outwards = beyond > -along ? Scalar(1) : Scalar(-1);
    const Scalar scale = 1 / largest(to_rim, kNoDirection<Scalar>);
    const Scalar face_along = is_end ? outwards : -s.side[1], face_off = is_end ? Scalar(0) : s.side[0];
    return {(is_rim ? to_rim : largest(end, side)) - s.edge_radius, is_rim ? rx * scale : face_along,
            is_rim ? ry * scale : face_off};
}

template <class Scalar>
void nearerCone(const ConeSolid<Scalar>& solid, const Scalar* __restrict px, const Scalar* __restrict py,
                const Scalar* __restrict pz, int count, Scalar* __restrict out) {
    const ConeSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        const FromConeAxis<Scalar> at = fromAxis(s, px[i], py[i], pz[i]);
        out[i] = least(out[i], fromProfile(s, at.along, at.off).distance);
    }
}

template <class Scalar>
void sampleNearerCone(const ConeSolid<Scalar>& solid, const Scalar* __restrict px,
                      const Scalar* __restrict py, const Scalar* __restrict pz, int count,
                      Scalar* __restrict distance, Scalar* __restrict gx, Scalar* __restrict gy,
                      Scalar* __restrict gz) {
    const ConeSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        const FromConeAxis<Scalar> at = fromAxis(s, px[i], py[i], pz[i]);
        const ConeProfile<Scalar> here = fromProfile(s, at.along, at.off);
        const bool is_on_axis = at.off < kNoDirection<Scalar>;
        const Scalar scale = 1 / largest(at.off, kNoDirection<Scalar>);
        const Scalar nx = is_on_axis ? s.normal[0] : at.dx * scale;
        const Scalar ny = is_on_axis ? s.normal[1] : at.dy * scale;
        const Scalar nz = is_on_axis ? s.normal[2] : at.dz * scale;
        const Scalar there = distance[i], tx = gx[i], ty = gy[i], tz = gz[i];
        const bool is_nearer = here.distance < there;
        distance[i] = is_nearer ? here.distance : there;
        gx[i] = is_nearer ? here.along * s.axis[0] + here.off * nx : tx;
        gy[i] = is_nearer ? here.along * s.axis[1] + here.off * ny : ty;
        gz[i] = is_nearer ? here.along * s.axis[2] + here.off * nz : tz;
    }
}

constexpr int kSumLanes = 8;  // of every sum, whatever the width of the registers
using Doubles = double __attribute__((vector_size(4 * kWidth)));
constexpr int kDoubles = kWidth / 2, kParts = kSumLanes / kDoubles;

inline void load(const double* p, Doubles& v) {
    __builtin_memcpy(&v, p, sizeof v);
}
double total(const Doubles (&parts)[kParts]) {
    double v[kSumLanes];
    __builtin_memcpy(v, parts, sizeof v);
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}
double dot(const double* a, const double* b, int padded) {
    Doubles sum[kParts] = {}, x, y;
    for (int i = 0; i < padded; i += kSumLanes)
        for (int part = 0; part < kParts; ++part) {
            load(a + i + part * kDoubles, x), load(b + i + part * kDoubles, y);
            sum[part] += x * y;
        }
    return total(sum);
}
double sumOf(const double* a, int padded) {
    Doubles sum[kParts] = {}, x;
    for (int i = 0; i < padded; i += kSumLanes)
        for (int part = 0; part < kParts; ++part) {
            load(a + i + part * kDoubles, x);
            sum[part] += x;
        }
    return total(sum);
}

template <class Scalar>
void addContacts(const ContactFrame& frame, const float* __restrict x, const float* __restrict y,
                 const float* __restrict z, const float* __restrict weight, const Scalar* __restrict distance,
                 const Scalar* __restrict gx, const Scalar* __restrict gy, const Scalar* __restrict gz,
                 int count, ContactSums& sums) {
    const ContactFrame f = frame;
    // J is the negative derivative of the depth by the tool's pose: g, r x g.
    alignas(64) double J[6][kContactBatch], pull[kContactBatch], k[kContactBatch], energy[kContactBatch],
        depths[kContactBatch];
    for (int i = 0; i < count; ++i) {
        const double rx = double(x[i]) - f.p_OT[0], ry = double(y[i]) - f.p_OT[1],
                     rz = double(z[i]) - f.p_OT[2];
        const double tx = double(gx[i]), ty = double(gy[i]), tz = double(gz[i]);
        const double vx = f.R_VT[0] * tx + f.R_VT[1] * ty + f.R_VT[2] * tz;
        const double vy = f.R_VT[3] * tx + f.R_VT[4] * ty + f.R_VT[5] * tz;
        const double vz = f.R_VT[6] * tx + f.R_VT[7] * ty + f.R_VT[8] * tz;
        const double depth = -double(distance[i]), w = double(weight[i]);
        const double capped = least(depth, f.depth_cap);
        J[0][i] = vx, J[1][i] = vy, J[2][i] = vz;
        J[3][i] = ry * vz - rz * vy, J[4][i] = rz * vx - rx * vz, J[5][i] = rx * vy - ry * vx;
        pull[i] = w * capped;
        // Beyond the cap the secant keeps the matrix's direction.
        k[i] = depth > f.depth_cap ? pull[i] / depth : w;
        energy[i] = pull[i] * (depth - capped / 2);
        depths[i] = w > 0 ? depth : 0;
    }
    const int padded = (count + kSumLanes - 1) / kSumLanes * kSumLanes;
    for (int i = count; i < padded; ++i) {
        for (int axis = 0; axis < 6; ++axis) J[axis][i] = 0;
        pull[i] = k[i] = energy[i] = depths[i] = 0;
    }
    sums.energy += sumOf(energy, padded);
    for (int i = 0; i < count; ++i) sums.max_depth = largest(sums.max_depth, depths[i]);
    for (int axis = 0; axis < 3; ++axis) {
        sums.force[axis] -= dot(pull, J[axis], padded);
        sums.torque[axis] -= dot(pull, J[3 + axis], padded);
    }
    alignas(64) double kJ[kContactBatch];
    double* sum = sums.stiffness;
    for (int row = 0; row < 6; ++row) {
        for (int i = 0; i < padded; ++i) kJ[i] = k[i] * J[row][i];
        for (int column = row; column < 6; ++column) *sum++ += dot(kJ, J[column], padded);
    }
}

int selectNear(const NearTest& test, const float* distance, const float* gx, const float* gy, const float* gz,
               const float* nx, const float* ny, const float* nz, int count, float* nearest, int* selected) {
    const NearTest t = test;
    const float* R = t.R_VT;
    alignas(64) int is_near[kContactBatch];
    for (int i = 0; i < count; i += kWidth) {
        Floats d, tx, ty, tz, mx, my, mz, slope;
        load(distance + i, d), load(gx + i, tx), load(gy + i, ty), load(gz + i, tz);
        load(nx + i, mx), load(ny + i, my), load(nz + i, mz);
        const Floats vx = R[0] * tx + R[1] * ty + R[2] * tz;
        const Floats vy = R[3] * tx + R[4] * ty + R[5] * tz;
        const Floats vz = R[6] * tx + R[7] * ty + R[8] * tz;
        const Floats cx = vy * mz - vz * my, cy = vz * mx - vx * mz, cz = vx * my - vy * mx;
        rootOf(cx * cx + cy * cy + cz * cz, slope);
        const Floats nearer = t.patch_reach * slope + t.bend;
        const Floats place = d - (nearer < t.patch_reach ? nearer : t.patch_reach + Floats{});
        store(place, nearest + i);
        store(place < t.margin, is_near + i);
    }
    int found = 0;
    for (int i = 0; i < count; ++i) {
        selected[found] = i;
        found -= is_near[i];  // a true comparison is -1
    }
    return found;
}

float leastScaled(const float* __restrict value, const float* __restrict lowest,
                  const float* __restrict scale, int count, float most) {
    constexpr int kLanes = 16;
    float lane[kLanes];
    for (int l = 0; l < kLanes; ++l) lane[l] = most;
    int i = 0;
    for (; i + kLanes <= count; i += kLanes)
        for (int l = 0; l < kLanes; ++l)
            lane[l] = least(lane[l], (value[i + l] - lowest[i + l]) * scale[i + l]);
    float result = most;
    for (int l = 0; l < kLanes; ++l) result = least(result, lane[l]);
    for (; i < count; ++i) result = least(result, (value[i] - lowest[i]) * scale[i]);
    return result;
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
