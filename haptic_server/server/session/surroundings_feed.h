// Meshes the bone around the milled part on a thread of its own, beside the session, and puts it into the
// outbox.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"
#include "haptic_server/surface/mesh/scan_shade.h"

namespace bonemill {

class SurroundingsFeed {
  public:
    // Begins at once; there is nothing to do without surroundings (null). Nodes are numbered from first_leaf
    // on, in these shades. The outbox must outlive this object, whose end ends the work.
    SurroundingsFeed(const std::shared_ptr<const Surroundings>& surroundings, uint32_t first_leaf,
                     const ShadeScale& shades, MeshOutbox& outbox);

    // Any thread: all that there is has been put.
    bool isDone() const noexcept { return is_done_; }

  private:
    std::atomic<bool> is_done_ = false;
    std::jthread thread_;
};

}  // namespace bonemill
