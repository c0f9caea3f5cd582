#include "haptic_server/server/session/surroundings_feed.h"

#include <spdlog/spdlog.h>

#include <exception>

#include "common/rt/clock.h"
#include "haptic_server/surface/mesh/surroundings_mesher.h"

namespace bonemill {
namespace {

void feed(const Surroundings& surroundings, uint32_t first_leaf, const ShadeScale& shades, MeshOutbox& outbox,
          const std::stop_token& stop) {
    size_t nodes = 0, triangles = 0;
    meshSurroundings(surroundings, first_leaf, shades, [&](NodeMesh&& mesh) {
        ++nodes;
        triangles += mesh.indices.size() / 3;
        NodeGroup group;
        group.meshes.push_back(std::move(mesh));
        outbox.put(std::move(group), monotonicNowNs());
        return !stop.stop_requested();
    });
    spdlog::info("the bone around the region is shown by {} nodes with {} triangles", nodes, triangles);
}

}  // namespace

SurroundingsFeed::SurroundingsFeed(const std::shared_ptr<const Surroundings>& surroundings,
                                   uint32_t first_leaf, const ShadeScale& shades, MeshOutbox& outbox) {
    if (!surroundings) {
        is_done_ = true;
        return;
    }
    thread_ = std::jthread([this, surroundings, first_leaf, shades, &outbox](const std::stop_token& stop) {
        try {
            feed(*surroundings, first_leaf, shades, outbox, stop);
        } catch (const std::exception& error) {  // it is for people: the session goes on
            spdlog::error("the bone around the region cannot be shown: {}", error.what());
        }
        is_done_ = true;
    });
}

}  // namespace bonemill
