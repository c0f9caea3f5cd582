#include "render_client/look/visual_effects/bone_surface.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace bonemill {
namespace {

constexpr float kSurfaceFound = 0.6e-3f;  // m: farther off there is no surface
constexpr float kLevel = 0.06f;           // sine of the slope on which a drop rests
constexpr float kOverhang = -0.85f;       // cosine to `up` of a surface that holds no drop

constexpr int kBuckets = 8;           // per axis of a leaf
constexpr float kFocusStep = 0.002f;  // m that the focus moves before leaves are looked for again
constexpr float kNearRadius = BoneSurface::kFocusRadius + kFocusStep;
constexpr int kCells = 11;  // per axis of the grid around the focus
constexpr float kCellSize = 2 * kNearRadius / kCells;
constexpr uint64_t kPlace = 0xffffffffffff;  // of a packed vertex: without its normal

uint64_t placeOf(const PackedVertex& vertex) {
    return std::bit_cast<uint64_t>(vertex) & kPlace;
}

template <class Visit>
void forEachCell(const Eigen::Array3i& low, const Eigen::Array3i& high, Visit&& visit) {
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) visit(Eigen::Array3i(x, y, z));
}

std::vector<uint64_t> sortedPlaces(const std::vector<PackedVertex>& vertices) {
    std::vector<uint64_t> places(vertices.size());
    std::ranges::transform(vertices, places.begin(), placeOf);
    std::ranges::sort(places);
    return places;
}

}  // namespace

Walk walkDown(const BoneSurface& surface, const Eigen::Vector3f& up_V, float distance, SurfacePoint& at) {
    if (at.n_V.dot(up_V) < kOverhang) return Walk::kFallsOff;
    const Eigen::Vector3f along = -up_V + at.n_V.dot(up_V) * at.n_V;
    const float slope = along.norm();
    if (slope < kLevel) return Walk::kRests;
    const Eigen::Vector3f moved = at.p_V + along * distance;  // slower where it is less steep
    const auto found = surface.nearest(moved, kSurfaceFound + distance);
    if (!found) return Walk::kFallsOff;
    at.n_V = (at.n_V + found->n_V).normalized();
    if (!at.n_V.allFinite()) return Walk::kFallsOff;
    at.p_V = moved - found->heightOf(moved) * found->n_V;
    return Walk::kGoesOn;
}

static_assert(std::endian::native == std::endian::little, "placeOf() reads x, y, z as the low bytes");

SurfacePoint BoneSurface::Leaf::point(size_t vertex) const {
    const PackedVertex& v = vertices[vertex];
    return {origin + step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z)),
            decodeNormal(v.octahedral_u, v.octahedral_v), materials.empty() ? uint8_t(0) : materials[vertex]};
}

Eigen::Array3i BoneSurface::Leaf::bucketOf(const Eigen::Vector3f& p) const {
    const Eigen::Array3f size = box.sizes().array().max(1e-9f);
    const Eigen::Array3f place = ((p - box.min()).array() / size * float(kBuckets)).max(0).min(kBuckets - 1);
    return place.cast<int>();
}

void BoneSurface::Leaf::sortIntoBuckets() const {
    const auto number = [](const Eigen::Array3i& b) {
        return size_t((b.z() * kBuckets + b.y()) * kBuckets + b.x());
    };
    starts.assign(kBuckets * kBuckets * kBuckets + 1, 0);
    order.resize(vertices.size());
    std::vector<size_t> buckets(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) ++starts[(buckets[i] = number(bucketOf(point(i).p_V))) + 1];
    for (size_t b = 1; b < starts.size(); ++b) starts[b] += starts[b - 1];
    std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
    for (size_t i = 0; i < vertices.size(); ++i) order[next[buckets[i]]++] = uint32_t(i);
}

void BoneSurface::Leaf::findNearer(const Eigen::Vector3f& p_V, float& reach,
                                   const PackedVertex*& found) const {
    if (box.exteriorDistance(p_V) >= reach) return;
    if (starts.empty()) sortIntoBuckets();
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(reach);
    const Eigen::Array3i low = bucketOf(p_V - margin), high = bucketOf(p_V + margin);
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y) {
            const size_t row = size_t((z * kBuckets + y) * kBuckets);
            for (uint32_t i = starts[row + size_t(low.x())]; i < starts[row + size_t(high.x()) + 1]; ++i) {
                const PackedVertex& v = vertices[order[i]];
                const float distance =
                    (origin + step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z)) - p_V).norm();
                if (distance >= reach) continue;
                reach = distance;
                found = &v;
            }
        }
}

void BoneSurface::set(const NodeMesh& mesh) {
    if (mesh.isEmpty()) return remove(mesh.leaf);
    Leaf leaf{mesh.origin, mesh.step, mesh.vertices, {}, {}, {}, {}};
    if (mesh.materials.size() == mesh.vertices.size()) leaf.materials = mesh.materials;
    for (uint8_t& material : leaf.materials) material &= uint8_t(~kMilledBit);
    for (size_t i = 0; i < leaf.vertices.size(); ++i) leaf.box.extend(leaf.point(i).p_V);
    const auto known = leaves_.find(mesh.leaf);
    if (tracks_fresh_) noteFresh(known == leaves_.end() ? nullptr : &known->second, leaf);
    leaves_.insert_or_assign(mesh.leaf, std::move(leaf));
    is_stale_ = true;
}

void BoneSurface::noteFresh(const Leaf* before, const Leaf& after) {
    std::vector<uint64_t> old_places;
    if (before && before->origin == after.origin && before->step == after.step)
        old_places = sortedPlaces(before->vertices);
    for (size_t i = 0; i < after.vertices.size() && fresh_.size() < kMaxFresh; ++i)
        if (!std::ranges::binary_search(old_places, placeOf(after.vertices[i])))
            fresh_.push_back(after.point(i));
}

void BoneSurface::remove(uint32_t leaf) {
    leaves_.erase(leaf);
    is_stale_ = true;
}

void BoneSurface::clear() {
    leaves_.clear();
    fresh_.clear();
    is_stale_ = true;
}

void BoneSurface::focusOn(const Eigen::Vector3f& p_V) {
    focus_ = p_V;
    if (is_stale_ || (p_V - sought_around_).norm() > kFocusStep) findLeaves();
}

void BoneSurface::findLeaves() {
    sought_around_ = focus_;
    is_stale_ = false;
    near_.resize(size_t(kCells) * kCells * kCells);
    for (auto& leaves : near_) leaves.clear();
    for (const auto& entry : leaves_) {
        const Leaf& leaf = entry.second;
        if (leaf.box.exteriorDistance(focus_) < kNearRadius)
            forEachCell(cellOf(leaf.box.min()), cellOf(leaf.box.max()),
                        [&](const Cell& cell) { near_[numberOf(cell)].push_back(&leaf); });
    }
}

Eigen::Array3i BoneSurface::cellOf(const Eigen::Vector3f& p_V) const {
    const Eigen::Array3f place = ((p_V - sought_around_).array() + kNearRadius) / kCellSize;
    return place.max(0).min(kCells - 1).cast<int>();
}

size_t BoneSurface::numberOf(const Cell& cell) {
    return size_t((cell.z() * kCells + cell.y()) * kCells + cell.x());
}

std::optional<SurfacePoint> BoneSurface::nearest(const Eigen::Vector3f& p_V, float reach) const {
    if (is_stale_ || !isInFocus(p_V)) return std::nullopt;
    const PackedVertex* found = nullptr;
    const Leaf* found_in = nullptr;
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(reach);
    forEachCell(cellOf(p_V - margin), cellOf(p_V + margin), [&](const Cell& cell) {
        for (const Leaf* leaf : near_[numberOf(cell)]) {
            const PackedVertex* before = found;
            leaf->findNearer(p_V, reach, found);
            if (found != before) found_in = leaf;
        }
    });
    if (!found) return std::nullopt;
    return found_in->point(size_t(found - found_in->vertices.data()));
}

}  // namespace bonemill
