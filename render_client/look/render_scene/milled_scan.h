// Gives the vertices of nodes that were milled what the scan measured there, as its densities come.
//
// It belongs to the thread of the context. The frame is V; the units are m.
#pragma once

#include <cstdint>
#include <vector>

#include "render_client/link/density_store/density_store.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/slices/slice_image.h"

namespace bonemill {

class MilledScan {
  public:
    // Samples the nodes that changed, or whose bricks did. The sampler reads that store, which has a grid.
    void update(const DensitySampler& sampler, const DensityStore& store, NodeStore& nodes);
    void clear() { bricks_.clear(); }

    // Returns the bricks around all milled nodes.
    const std::vector<uint32_t>& bricks() const { return bricks_; }

  private:
    std::vector<uint32_t> bricks_;
};

}  // namespace bonemill
