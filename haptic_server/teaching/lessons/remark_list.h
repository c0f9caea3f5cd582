// Keeps what the people of a session wrote, and drew on the bone: notes and strokes, each at a place of its
// own until it is erased or room is needed. It belongs to the publisher thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/commands/answer.h"
#include "common/dds/remark_bounds.h"
#include "haptic_server/core/volume/raw_volume.h"
#include "proto/topics.pb.h"

namespace bonemill {

class RemarkList {
  public:
    static constexpr double kFarthest = 0.05;     // m, of a point from the scanned volume
    static constexpr size_t kLongestAuthor = 64;  // bytes

    // Points must lie in or near this volume.
    explicit RemarkList(const VolumeGeometry& volume) : volume_(volume) {}

    // Takes Command.add_remark: number, author, role and clock are filled in from the sender. The oldest one
    // makes room where kMaxRemarks are kept.
    Answer add(const topics::Command& command, double session_s);
    // Takes Command.erase_remark: a number, or 0 for all.
    Answer erase(uint32_t number);

    // It is what is shown at a place now; nothing: what was there is gone.
    struct Change {
        uint32_t place = 0;
        std::optional<topics::Remark> remark;
    };
    // Returns each place that has changed since the last call, once.
    std::vector<Change> takeChanges();
    size_t count() const noexcept { return kept_.size(); }

  private:
    std::string problemOf(const topics::Remark& remark) const;
    bool isNear(const Eigen::Vector3d& p_W) const;
    uint32_t freePlace() const;

    VolumeGeometry volume_;
    std::map<uint32_t, topics::Remark> kept_;  // by place
    std::set<uint32_t> changed_;               // places
    uint32_t last_number_ = 0;
};

}  // namespace bonemill
