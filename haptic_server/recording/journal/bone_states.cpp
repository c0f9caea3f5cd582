#include "haptic_server/recording/journal/bone_states.h"

#include <utility>

#include "haptic_server/core/bone/bone_snapshot.h"

namespace bonemill {
namespace {

constexpr size_t kMaxDensityBytes = size_t(4) << 20;  // of a message, but for a leaf that is larger by itself

uint16_t zigzagged(uint16_t difference) noexcept {
    return uint16_t(uint16_t(difference << 1) ^ uint16_t(int16_t(difference) >> 15));
}
uint16_t unzigzagged(uint16_t code) noexcept {
    return uint16_t(uint16_t(code >> 1) ^ uint16_t(-(code & 1)));
}

// The leaves of one state, in as many messages as it takes.
class Messages {
  public:
    explicit Messages(journal::Bone::Kind kind) { begin(kind); }

    void add(LeafId leaf, const std::vector<Density>& now, const std::vector<Density>& base) {
        if (!codes_.empty() && (codes_.size() + now.size()) * sizeof(Density) > kMaxDensityBytes) {
            finish();
            all_.back().set_goes_on(true);
            begin(all_.back().kind() == journal::Bone::KEY ? journal::Bone::CURRENT : all_.back().kind());
        }
        all_.back().add_leaf_steps(leaf - last_leaf_);
        last_leaf_ = leaf;
        for (size_t n = 0; n < now.size(); ++n) codes_.push_back(zigzagged(uint16_t(now[n] - base[n])));
    }
    void addScanned(LeafId leaf) {
        all_.back().add_as_scanned_steps(leaf - last_scanned_);
        last_scanned_ = leaf;
    }
    std::vector<journal::Bone> take() {
        finish();
        return std::move(all_);
    }

  private:
    void begin(journal::Bone::Kind kind) {
        all_.emplace_back().set_kind(kind);
        last_leaf_ = last_scanned_ = 0;
        codes_.clear();
    }
    void finish() {
        std::string& bytes = *all_.back().mutable_densities();
        bytes.reserve(codes_.size() * sizeof(Density));
        for (const uint16_t code : codes_) bytes += char(code);
        for (const uint16_t code : codes_) bytes += char(code >> 8);
    }

    std::vector<journal::Bone> all_;
    std::vector<uint16_t> codes_;
    LeafId last_leaf_ = 0, last_scanned_ = 0;
};

bool isNothing(const std::vector<journal::Bone>& messages) {
    const journal::Bone& last = messages.back();
    return messages.size() == 1 && last.leaf_steps().empty() && last.as_scanned_steps().empty();
}

}  // namespace

std::vector<Density> densitiesOf(const VoxelVolume& volume, const LeafLattice& lattice, LeafId leaf) {
    const IndexBox cells = lattice.cellsOf(leaf), voxels = voxelsOf(cells);
    const int count = voxels.max.x() - voxels.min.x() + 1;
    std::vector<Density> densities(size_t(voxels.count()) + VoxelVolume::kReadSlack);
    forEachRow(voxels, [&](const Eigen::Vector3i& first) {
        volume.readRow(first, count, densities.data() + placeOf(cells, first));
    });
    densities.resize(size_t(voxels.count()));
    return densities;
}

std::vector<journal::Bone> BoneStateWriter::add(const BoneSnapshot& state, journal::Bone::Kind kind) {
    if (kind == journal::Bone::KEY) last_.clear();
    Messages messages(kind);
    Leaves now;
    for (const auto& copy : state.leaves) {
        const auto before = last_.find(copy->leaf);
        now.emplace_hint(now.end(), copy->leaf, copy);
        if (before == last_.end()) {
            messages.add(copy->leaf, copy->densities,
                         densitiesOf(scanned_.volume, scanned_.lattice, copy->leaf));
        } else if (before->second != copy && before->second->densities != copy->densities) {
            messages.add(copy->leaf, copy->densities, before->second->densities);
        }
    }
    for (const auto& [leaf, copy] : last_)
        if (!now.contains(leaf)) messages.addScanned(leaf);
    last_ = std::move(now);
    std::vector<journal::Bone> all = messages.take();
    // After a checkpoint nobody knows yet that the bone is like it.
    const bool was_current = std::exchange(is_current_, kind != journal::Bone::OTHER);
    if (kind == journal::Bone::CURRENT && isNothing(all) && was_current) return {};
    for (journal::Bone& message : all) {
        message.set_tick(state.ticks);
        message.set_missing_voxels(state.missing_voxels);
    }
    return all;
}

bool BoneStateReader::add(const journal::Bone& bone) {
    is_complete_ = false;
    if (bone.kind() == journal::Bone::KEY) {
        leaves_.clear();
        has_key_ = true;
    }
    if (!has_key_ || !take(bone)) return has_key_ = false;
    if (bone.goes_on()) return true;
    auto whole = std::make_shared<BoneSnapshot>();
    whole->missing_voxels = bone.missing_voxels();
    whole->ticks = bone.tick();
    for (const auto& [leaf, copy] : leaves_) whole->leaves.push_back(copy);
    state_ = std::move(whole);
    return is_complete_ = true;
}

bool BoneStateReader::take(const journal::Bone& bone) {
    const uint32_t count = scanned_.lattice.leafCount();
    const std::string& bytes = bone.densities();
    const size_t codes = bytes.size() / sizeof(Density);
    size_t at = 0;
    uint64_t leaf = 0;
    for (int n = 0; n < bone.leaf_steps_size(); ++n) {
        leaf += bone.leaf_steps(n);
        if (leaf >= count || (n > 0 && bone.leaf_steps(n) == 0)) return false;
        const auto voxels = size_t(voxelsOf(scanned_.lattice.cellsOf(LeafId(leaf))).count());
        if (voxels > codes - at) return false;
        const auto before = leaves_.find(LeafId(leaf));
        auto copy = std::make_shared<LeafCopy>(LeafCopy{LeafId(leaf), 0, {}});
        copy->densities = before == leaves_.end()
                              ? densitiesOf(scanned_.volume, scanned_.lattice, LeafId(leaf))
                              : before->second->densities;
        for (Density& density : copy->densities) {
            const auto code = uint16_t(uint8_t(bytes[at]) | uint8_t(bytes[codes + at]) << 8);
            density = Density(density + unzigzagged(code));
            ++at;
        }
        leaves_[LeafId(leaf)] = std::move(copy);
    }
    uint64_t scanned = 0;
    for (int n = 0; n < bone.as_scanned_steps_size(); ++n) {
        if (n > 0 && bone.as_scanned_steps(n) == 0) return false;
        scanned += bone.as_scanned_steps(n);
        if (scanned >= count) return false;
        leaves_.erase(LeafId(scanned));
    }
    return at == codes && bytes.size() == codes * sizeof(Density);
}

void BoneStateReader::startFrom(std::shared_ptr<const BoneSnapshot> state) {
    leaves_.clear();
    for (const auto& copy : state->leaves) leaves_[copy->leaf] = copy;
    state_ = std::move(state);
    has_key_ = true;
    is_complete_ = false;
}

}  // namespace bonemill
