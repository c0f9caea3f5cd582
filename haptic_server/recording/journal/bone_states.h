// The bone's states, one after the other, as what changed in between (proto/journal.proto, Bone), and back to
// every density. It is for one normal thread at a time.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "haptic_server/core/bone/bone_snapshot.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "proto/journal.pb.h"

namespace bonemill {

// The scanned bone that states differ from, and its leaves; both must outlive who has it.
struct DensitiesAsScanned {
    const VoxelVolume& volume;
    const LeafLattice& lattice;
};

// Those of the leaf in this bone, in the order of LeafCopy::densities.
std::vector<Density> densitiesOf(const VoxelVolume& volume, const LeafLattice& lattice, LeafId leaf);

class BoneStateWriter {
  public:
    explicit BoneStateWriter(const DensitiesAsScanned& scanned) : scanned_(scanned) {}

    // Returns the messages that lead there from the state before, of which all but the last go on; none if
    // nothing differs, unless it is a KEY, a checkpoint, or the first after a checkpoint. Of a checkpoint the
    // caller fills in what it is.
    std::vector<journal::Bone> add(const BoneSnapshot& state, journal::Bone::Kind kind);

  private:
    DensitiesAsScanned scanned_;
    using Leaves = std::map<LeafId, std::shared_ptr<const LeafCopy>>;
    Leaves last_;
    bool is_current_ = true;  // last_ is the bone, and not only a checkpoint of it
};

class BoneStateReader {
  public:
    explicit BoneStateReader(const DensitiesAsScanned& scanned) : scanned_(scanned) {}

    // False if the message cannot be one of this bone's, or its KEY is missing: what was whole before stays,
    // and another KEY is needed.
    bool add(const journal::Bone& bone);
    // The newest state that is whole; null before there is any.
    const std::shared_ptr<const BoneSnapshot>& state() const noexcept { return state_; }
    // Whether the message before completed it.
    bool isComplete() const noexcept { return is_complete_; }
    // A state from elsewhere is gone on from, as by a seek: the messages after it are to be added next.
    void startFrom(std::shared_ptr<const BoneSnapshot> state);

  private:
    bool take(const journal::Bone& bone);

    DensitiesAsScanned scanned_;
    std::map<LeafId, std::shared_ptr<const LeafCopy>> leaves_;
    std::shared_ptr<const BoneSnapshot> state_;
    bool has_key_ = false, is_complete_ = false;
};

}  // namespace bonemill
