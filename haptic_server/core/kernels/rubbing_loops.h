// This loop says how bone holds on to a burr that turns in it. It is part of kernel_loops.h, and needs
// point_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

struct Vector {
    double x, y, z;
};
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double inner(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
// What of a is left at right angles to the unit vector n.
inline Vector beside(const Vector& a, const Vector& n) {
    const double along = inner(a, n);
    return {a.x - along * n.x, a.y - along * n.y, a.z - along * n.z};
}
// sums[..] += Σ a[row] b[column], the upper triangle row by row.
template <int kRows>
void addProducts(const double (*a)[kContactBatch], const double (*b)[kContactBatch], int padded,
                 double* sums) {
    for (int row = 0; row < kRows; ++row)
        for (int column = row; column < kRows; ++column) *sums++ += dot(a[row], b[column], padded);
}

void addRubbing(const RubbingMotion& motion, const RubbingPoints& points, RubbingSums& sums) {
    const RubbingMotion m = motion;
    const RubbingPoints p = points;
    const Vector axis{m.axis[0], m.axis[1], m.axis[2]}, v{m.velocity[0], m.velocity[1], m.velocity[2]},
        omega{m.angular_velocity[0], m.angular_velocity[1], m.angular_velocity[2]};
    // w is the twist of a motion along the normal: n, r × n.
    alignas(64) double d[kContactBatch], r[3][kContactBatch], w[6][kContactBatch], pull[6][kContactBatch],
        d_r[3][kContactBatch], d_w[6][kContactBatch];
    for (int i = 0; i < p.count; ++i) {
        const Vector at{double(p.rx[i]), double(p.ry[i]), double(p.rz[i])},
            n{double(p.nx[i]), double(p.ny[i]), double(p.nz[i])};
        const Vector turn = beside(cross(axis, at), n), turning = cross(omega, at);
        const Vector moved = beside({v.x + turning.x, v.y + turning.y, v.z + turning.z}, n);
        const Vector slip{m.spin * turn.x + moved.x, m.spin * turn.y + moved.y, m.spin * turn.z + moved.z};
        const double force = double(p.force[i]), spread = p.spread[i];
        const double mean_square = inner(slip, slip) + m.spin * m.spin * spread;
        const double per_speed = m.friction * force / root(mean_square + m.slow_squared);
        const double per_turn = per_speed * m.spin + m.held_per_moment * force / p.rho[i];
        const Vector f{-per_turn * turn.x, -per_turn * turn.y, -per_turn * turn.z}, t = cross(at, f),
                                                                                    across = cross(at, n);
        const double by_itself = per_turn * spread;
        d[i] = per_speed;
        r[0][i] = at.x, r[1][i] = at.y, r[2][i] = at.z;
        w[0][i] = n.x, w[1][i] = n.y, w[2][i] = n.z;
        w[3][i] = across.x, w[4][i] = across.y, w[5][i] = across.z;
        pull[0][i] = f.x, pull[1][i] = f.y, pull[2][i] = f.z;
        pull[3][i] = t.x - by_itself * axis.x, pull[4][i] = t.y - by_itself * axis.y,
        pull[5][i] = t.z - by_itself * axis.z;
    }
    const int padded = (p.count + kSumLanes - 1) / kSumLanes * kSumLanes;
    for (int i = p.count; i < padded; ++i) {
        d[i] = 0;
        for (auto& values : r) values[i] = 0;
        for (auto& values : w) values[i] = 0;
        for (auto& values : pull) values[i] = 0;
    }
    for (int i = 0; i < padded; ++i) {
        for (int row = 0; row < 3; ++row) d_r[row][i] = d[i] * r[row][i];
        for (int row = 0; row < 6; ++row) d_w[row][i] = d[i] * w[row][i];
    }
    for (int axis_of = 0; axis_of < 3; ++axis_of) {
        sums.force[axis_of] += sumOf(pull[axis_of], padded);
        sums.torque[axis_of] += sumOf(pull[3 + axis_of], padded);
        sums.of_r[axis_of] += sumOf(d_r[axis_of], padded);
    }
    sums.per_speed += sumOf(d, padded);
    addProducts<3>(d_r, r, padded, sums.of_rr);
    addProducts<6>(d_w, w, padded, sums.of_ww);
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
