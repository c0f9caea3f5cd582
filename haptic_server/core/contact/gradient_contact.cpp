#include "haptic_server/core/contact/gradient_contact.h"

#include <numeric>

#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

// Of a patch's diagonal: no place is farther from the patch's own point, its centroid. The pieces of a cell
// may be nearly that far apart.
constexpr double kReachOfPatch = 0.6;

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

ContactFrame contactFrame(const Pose& X_VT, const Vector3d& origin, double depth_cap) noexcept {
    ContactFrame frame;
    const Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    for (int i = 0; i < 9; ++i) frame.R_VT[i] = R_VT(i / 3, i % 3);
    for (int axis = 0; axis < 3; ++axis) frame.p_OT[axis] = X_VT.position[axis] - origin[axis];
    frame.depth_cap = depth_cap;
    return frame;
}

GradientContactResult resultOf(const ContactSums& sums, uint32_t contacts) noexcept {
    GradientContactResult result;
    result.term.energy = sums.energy;
    result.term.wrench = {Vector3d(sums.force), Vector3d(sums.torque)};
    const double* sum = sums.stiffness;
    for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column)
            result.term.stiffness(row, column) = result.term.stiffness(column, row) = *sum++;
    result.contacts = contacts;
    result.max_depth = sums.max_depth;
    return result;
}

constexpr size_t kSampleTests = 4;  // a sample in double precision takes no longer than N distances in single

double smoothstep(double t) noexcept {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Calls visit(candidate, distance, gradient in T) for all of them.
template <class Visit>
void forEachSample(const Candidates& candidates, const ToolField& tool, const Pose& X_VT,
                   const Vector3d& origin, Visit&& visit) noexcept {
    constexpr size_t kBatch = PointBatch<double>::kCapacity;
    const IntoTool<double> into_tool(X_VT, origin);
    PointBatch<double> batch;
    SampleBatch<double> at;
    const Candidates& c = candidates;
    for (size_t first = 0; first < c.count; first += kBatch) {
        into_tool.fill(batch, &c.x[first], &c.y[first], &c.z[first], int(std::min(kBatch, c.count - first)));
        tool.sample(batch, at);
        for (int i = 0; i < batch.count; ++i)
            visit(first + size_t(i), at.distance[i], Vector3d(at.gx[i], at.gy[i], at.gz[i]));
    }
}

// Few of the candidates touch: those are collected first, then summed.
template <class Scalar>
class TouchingPoints {
  public:
    TouchingPoints(const Candidates& candidates, const ToolField& tool, const Pose& X_VT,
                   const Vector3d& origin) noexcept
        : c_(candidates),
          tool_(tool),
          roughly_into_tool_(X_VT, origin),
          into_tool_(X_VT, origin),
          frame_(contactFrame(X_VT, origin, GradientContact::kDepthCap * tool.thinnestRadius())) {}

    // Single precision finds those that may touch.
    void find(size_t first, int count) noexcept {
        constexpr bool kIsExact = sizeof(Scalar) == sizeof(float);
        const float beside = kIsExact ? 0 : float(2 * tool_.distanceError());
        roughly_into_tool_.fill(rough_batch_, &c_.x[first], &c_.y[first], &c_.z[first], count);
        tool_.distances(rough_batch_, rough_distance_);
        uint32_t* const found = touching_ + touching_count_;
        int found_count = 0;
        for (int i = 0; i < count; ++i) {
            found[found_count] = uint32_t(first) + uint32_t(i);
            found_count += rough_distance_[i] < beside;
        }
        touching_count_ += kIsExact ? found_count : keepTouching(found, found_count);
        if (touching_count_ >= kBatch) sum(kBatch);
    }
    GradientContactResult result() noexcept {
        sum(touching_count_);
        return resultOf(sums_, contacts_);
    }

  private:
    static constexpr int kBatch = PointBatch<Scalar>::kCapacity;
    static_assert(kBatch == kContactBatch);

    // Returns how many of these touch, which it moves to the front.
    int keepTouching(uint32_t* found, int count) noexcept {
        if (count == 0) return 0;
        fill(found, count);
        tool_.distances(batch_, distance_);
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            found[kept] = found[i];
            kept += distance_[i] < 0;
        }
        return kept;
    }
    void fill(const uint32_t* points, int count) noexcept {
        for (int i = 0; i < count; ++i) {
            const size_t n = points[i];
            x_[i] = c_.x[n], y_[i] = c_.y[n], z_[i] = c_.z[n], weight_[i] = c_.weight[n];
        }
        into_tool_.fill(batch_, x_, y_, z_, count);
    }
    // Sums the first `count` of the points found.
    void sum(int count) noexcept {
        fill(touching_, count);
        tool_.sample(batch_, at_);
        kernels().points<Scalar>().add_contacts(frame_, x_, y_, z_, weight_, at_.distance, at_.gx, at_.gy,
                                                at_.gz, count, sums_);
        contacts_ += uint32_t(count);
        std::copy(touching_ + count, touching_ + touching_count_, touching_);
        touching_count_ -= count;
    }

    const Candidates& c_;
    const ToolField& tool_;
    IntoTool<float> roughly_into_tool_;
    PointBatch<float> rough_batch_;
    alignas(64) float rough_distance_[kBatch];
    IntoTool<Scalar> into_tool_;
    ContactFrame frame_;
    PointBatch<Scalar> batch_;
    SampleBatch<Scalar> at_;
    alignas(64) Scalar distance_[kBatch];
    alignas(64) float x_[kBatch], y_[kBatch], z_[kBatch], weight_[kBatch];
    uint32_t touching_[2 * kBatch];
    int touching_count_ = 0;
    ContactSums sums_;
    uint32_t contacts_ = 0;
};

}  // namespace

GradientContact::GradientContact(const GradientContactConfig& config, size_t most_candidates)
    : config_(config),
      near_shell_(2 * most_candidates),
      near_(most_candidates),
      near_distance_(most_candidates),
      candidates_(most_candidates),
      split_(most_candidates),
      new_level_(most_candidates),
      next_place_(most_candidates),
      source_(most_candidates),
      piece_area_(most_candidates),
      lowest_(most_candidates),
      inverse_rate_(most_candidates) {}

bool GradientContact::gather(const ShellView& bone, const ToolField& tool, const Pose& X_VT, double margin,
                             size_t most_tests) noexcept {
    margin_ = margin;
    origin_ = X_VT.position;
    const bool has_room = collect(bone, tool, X_VT, most_tests);
    refine(bone, tool, X_VT, most_tests);
    sumStiffness();
    if (weights_) most_stiffness_ *= weights_->scale(candidates_, origin_, tool, X_VT);
    guardFarSide(bone.volume, tool, X_VT);
    capStiffness(tool, X_VT);
    return has_room;
}

void GradientContact::sumStiffness() noexcept {
    constexpr size_t kLanes = 8;  // one sum would wait for itself
    double sums[kLanes] = {};
    const float *nearest = candidates_.nearest.data(), *weight = candidates_.weight.data();
    for (size_t i = 0; i < candidates_.count; ++i)
        sums[i % kLanes] += shareInContact(double(nearest[i])) * double(weight[i]);
    most_stiffness_ = std::accumulate(sums, sums + kLanes, 0.0);
}

bool GradientContact::collect(const ShellView& bone, const ToolField& tool, const Pose& X_VT,
                              size_t most_tests) noexcept {
    const Vector3d& spacing = bone.volume.spacing();
    const double patch_diagonal = bone.shell.scalingFactor(bone.level) * spacing.norm();
    patch_reach_ = bone.sample_spacing > 0 ? kReachOfPatch * patch_diagonal : 0;
    near_.count = 0;
    deepest_ = 0;
    bool has_room = true;
    const Pose X_TV = X_VT.inverse();
    const double reach = margin_ + std::max(patch_reach_, spacing.norm());
    Eigen::AlignedBox3d box = boxInV(tool.box(), X_VT);
    box.min().array() -= reach;
    box.max().array() += reach;
    near_shell_.begin({bone.shell, bone.level, tool, X_VT, margin_, margin_ + patch_reach_});
    BlockBatch blocks;
    const size_t tests_before = point_tests_;
    const auto test = [&] {
        point_tests_ += near_shell_.takePointTests();
        has_room = has_room && point_tests_ - tests_before <= most_tests && collectFrom(blocks, tool, X_VT);
        blocks.count = 0;
    };
    bone.lattice.forEachSurfaceLeaf(box, spacing, bone.volume.iso(), [&](LeafId leaf) {
        if (bone.shell.pointCount(bone.level, leaf) == 0 || !has_room) return;
        const Sphere around = sphereAround(bone.lattice.cellsOf(leaf), spacing);
        if (tool.distanceBound(X_TV * around.center) > around.radius + reach) return;
        near_shell_.forEachBlock(leaf, [&](const ShellBlock& block, uint32_t count) {
            blocks.add(block, count, leaf);
            if (blocks.count == BlockBatch::kCapacity) test();
        });
    });
    test();
    near_shell_.end();
    return has_room;
}

// Collects points of the blocks that the tool may touch after a motion of at most the margin, or near it
// with their patches.
bool GradientContact::collectFrom(const BlockBatch& blocks, const ToolField& tool,
                                  const Pose& X_VT) noexcept {
    const IntoTool<float> into_tool(X_VT, Vector3d::Zero());
    PointBatch<float> batch;
    alignas(64) float to_block[PointBatch<float>::kCapacity];
    alignas(64) float center[3][BlockBatch::kCapacity];
    for (int n = 0; n < blocks.count; ++n)
        for (int axis = 0; axis < 3; ++axis) center[axis][n] = blocks.block[n]->center[axis];
    into_tool.fill(batch, center[0], center[1], center[2], blocks.count);
    tool.distances(batch, to_block);
    const NearTest test = nearTest(tool, X_VT);
    const float reach = test.margin + test.patch_reach;
    const float error = float(2 * tool.distanceError());  // of the centre's distance and the points'
    SampleBatch<float> at;
    bool has_room = true;
    for (int n = 0; n < blocks.count && has_room; ++n) {
        const ShellBlock& block = *blocks.block[n];
        if (to_block[n] > block.radius + reach + error) continue;
        into_tool.fill(batch, block.x, block.y, block.z, blocks.points[n]);
        tool.sample(batch, at);
        point_tests_ += size_t(batch.count);
        has_room = addCandidates(block, blocks.leaf[n], batch.count, at, test);
    }
    return has_room;
}

NearTest GradientContact::nearTest(const ToolField& tool, const Pose& X_VT) const noexcept {
    NearTest test;
    const Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    for (int i = 0; i < 9; ++i) test.R_VT[i] = float(R_VT(i / 3, i % 3));
    test.patch_reach = float(patch_reach_);
    // The bone may bend towards the tool as much as the thinnest tool does.
    test.bend = float(0.5 * patch_reach_ * patch_reach_ / tool.thinnestRadius());
    test.margin = float(margin_);
    return test;
}

// Adds the near ones of the block's first `count` points. False means that there is no room for all.
bool GradientContact::addCandidates(const ShellBlock& block, LeafId leaf, int count,
                                    const SampleBatch<float>& at, const NearTest& test) noexcept {
    alignas(64) float nearest[kContactBatch];
    int selected[kContactBatch];
    const int found = kernels().select_near(test, at.distance, at.gx, at.gy, at.gz, block.nx, block.ny,
                                            block.nz, count, nearest, selected);
    const size_t before = near_.count;
    const bool has_room =
        near_.add(block, selected, found, leaf, origin_, float(config_.stiffness_per_area), nearest);
    for (size_t n = before; n < near_.count; ++n) {
        near_distance_[n] = at.distance[selected[n - before]];
        deepest_ = std::max(deepest_, -double(near_distance_[n]));
    }
    return has_room;
}

// Far-side guard and stiffness cap scale the candidates' energy for the length of one solve.
void GradientContact::guardFarSide(const VoxelVolume& volume, const ToolField& tool,
                                   const Pose& X_VT) noexcept {
    const double from = kGuardFrom * tool.thinnestRadius(), full = kGuardFull * tool.thinnestRadius();
    const double guard = volume.isBoneAt(X_VT.position) ? 1 : smoothstep((deepest_ - from) / (full - from));
    if (guard == 0) return;
    point_tests_ += kSampleTests * candidates_.count;
    const Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    forEachSample(candidates_, tool, X_VT, origin_, [&](size_t i, double, const Vector3d& gradient) {
        const Vector3d n = candidates_.normal(i).cast<double>();
        if (n.isZero(0)) return;
        candidates_.weight[i] *= float(1 - guard * (1 - smoothstep(-n.dot(R_VT * gradient) / kGuardWidth)));
    });
}

void GradientContact::capStiffness(const ToolField& tool, const Pose& X_VT) noexcept {
    if (most_stiffness_ <= config_.stiffness_cap) return;
    point_tests_ += kSampleTests * candidates_.count;
    Matrix3d stiffness = Matrix3d::Zero();  // T axes
    forEachSample(candidates_, tool, X_VT, origin_, [&](size_t i, double distance, const Vector3d& g) {
        const double weight = shareInContact(distance) * double(candidates_.weight[i]);
        if (weight > 0) stiffness += weight * g * g.transpose();
    });
    if (stiffness.trace() <= config_.stiffness_cap) return;
    point_tests_ += kSampleTests * candidates_.count;
    forEachSample(candidates_, tool, X_VT, origin_, [&](size_t i, double, const Vector3d& g) {
        const double in_direction = g.dot(stiffness * g);
        if (in_direction > config_.stiffness_cap)
            candidates_.weight[i] *= float(config_.stiffness_cap / in_direction);
    });
}

template <class Scalar>
GradientContactResult GradientContact::evaluate(const ToolField& tool, const Pose& X_VT) const noexcept {
    constexpr size_t kBatch = PointBatch<float>::kCapacity;
    TouchingPoints<Scalar> touching(candidates_, tool, X_VT, origin_);
    for (size_t first = 0; first < candidates_.count; first += kBatch)
        touching.find(first, int(std::min(kBatch, candidates_.count - first)));
    return touching.result();
}

template GradientContactResult GradientContact::evaluate<float>(const ToolField&, const Pose&) const noexcept;
template GradientContactResult GradientContact::evaluate<double>(const ToolField&,
                                                                 const Pose&) const noexcept;

// Lists the contacts of a pose one by one, for those who ask what the solve ended with.
size_t GradientContact::list(const ToolField& tool, const Pose& X_VT,
                             std::span<SurfaceContact> out) const noexcept {
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const double depth_cap = kDepthCap * tool.thinnestRadius();
    const IntoTool<float> into_tool(X_VT, origin_);
    const Vector3d to_origin = origin_ - X_VT.position;
    const Matrix3d R_VT = X_VT.rotation.toRotationMatrix();
    PointBatch<float> batch;
    SampleBatch<float> at;
    size_t count = 0;
    for (size_t first = 0; first < candidates_.count; first += kBatch) {
        const int points = int(std::min(size_t(kBatch), candidates_.count - first));
        into_tool.fill(batch, &candidates_.x[first], &candidates_.y[first], &candidates_.z[first], points);
        tool.sample(batch, at);
        for (int i = 0; i < points; ++i) {
            if (!(at.distance[i] < 0)) continue;
            if (count == out.size()) return count;
            const size_t n = first + size_t(i);
            const Eigen::Vector3d gradient_T(at.gx[i], at.gy[i], at.gz[i]);
            const double depth = -double(at.distance[i]), slope = gradient_T.norm();
            const double force = double(candidates_.weight[n]) * std::min(depth, depth_cap) * slope;
            if (!(force > 0)) continue;
            out[count++] = {(candidates_.position(n).cast<double>() + to_origin).cast<float>(),
                            (R_VT * gradient_T / -slope).cast<float>(), float(depth), float(force),
                            uint32_t(n)};
        }
    }
    return count;
}

}  // namespace bonemill
