#include "haptic_server/app/mesh_outbox.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

NodeMesh meshOf(uint32_t leaf, uint32_t revision) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = revision;
    return mesh;
}

TEST(MeshOutbox, HoldsTheNewestMeshOfEachLeafUntilItIsTaken) {
    MeshOutbox outbox;
    outbox.put(meshOf(7, 2));
    outbox.put(meshOf(3, 4));
    outbox.put(meshOf(7, 6));
    const std::vector<NodeMesh> taken = outbox.takeAll();
    ASSERT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0].leaf, 3u);
    EXPECT_EQ(taken[0].revision, 4u);
    EXPECT_EQ(taken[1].leaf, 7u);
    EXPECT_EQ(taken[1].revision, 6u);
    EXPECT_TRUE(outbox.takeAll().empty());
}

// The publisher puts back what DDS refused; the mesher may have been faster.
TEST(MeshOutbox, AMeshPutBackDoesNotReplaceANewerOne) {
    MeshOutbox outbox;
    outbox.put(meshOf(7, 2));
    std::vector<NodeMesh> refused = outbox.takeAll();
    outbox.put(meshOf(7, 4));
    outbox.put(std::move(refused[0]));
    EXPECT_EQ(outbox.takeAll()[0].revision, 4u);
}

}  // namespace
}  // namespace bonemill
