// A burr mills across node borders under a tight budget, and the viewer's frames cut the batches that arrive:
// what it shows is a closed surface all the time.
#include <gtest/gtest.h>

#include "common/rt/clock.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/milling/timed_milling.h"
#include "haptic_server/server/publish/publisher.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/contact_scene.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

constexpr double kSpacing = 0.25e-3;
constexpr int kVoxels = 48;

class Cracks : public testing::Test {
  protected:
    void millAt(const Eigen::Vector3d& center) {
        const MillingResult milled =
            milling_.apply(bone_.volume, bone_.lattice, bone_.shell, center, -1, 1e-3);
        if (milled.removed_voxels > 0) cuts_.tryPush(cutOf(milled.changed, monotonicNowNs()));
    }
    void mesh() {
        while (
            rounds_.round([this](NodeGroup&& group) { outbox_.put(std::move(group), monotonicNowNs()); })) {
        }
    }
    void publish(const Eigen::Vector3d& burr, int64_t bytes) {
        for (NodeGroup& group : outbox_.takeNearest(burr.cast<float>(), bytes, monotonicNowNs()))
            ASSERT_TRUE(publisher_.publishNodes(group.meshes, group.oldest_cut_ns).is_whole);
        ASSERT_TRUE(publisher_.publishStatus({}));
    }
    bool isClosed() const {
        std::vector<NodeMesh> meshes;
        for (const auto& [leaf, mesh] : client_.nodes) meshes.push_back(mesh);
        return checkMesh(meshes, grid_).isClosed();
    }

    BoneModel bone_{test::bodyVolume(test::cubeGeometry(kVoxels, kSpacing),
                                     test::halfSpace({0, 0, 6e-3}, Eigen::Vector3d::UnitZ())),
                    Eigen::Vector3i::Constant(8), ShellConfig{}};
    MeshGrid grid_{bone_.volume, bone_.lattice, MeshGrid::kStreamedStepsPerCell};
    TimedMilling milling_{
        {.removal_rate = 1e9, .shape = MillingShape::kSubVoxel}, bone_.volume, bone_.lattice, 1e-3};
    SpscRing<Cut> cuts_{64};
    MeshRounds rounds_{bone_.volume, bone_.lattice, cuts_};
    MeshOutbox outbox_;
    Publisher publisher_{{.domain = testDomain(), .session = testSession(), .epoch = 0}};
    ClientProbe client_;
    int open_pictures_ = 0;
};

TEST_F(Cracks, NoneIsSeenForMoreThanAFrame) {
    while (!rounds_.hasMeshedAll()) mesh();
    publish(Eigen::Vector3d::Zero(), INT64_MAX);
    ASSERT_TRUE(client_.pollUntil([&] { return client_.subscriber.isComplete(); }));
    ASSERT_TRUE(isClosed());
    int open_in_a_row = 0;
    for (int frame = 0; frame < 150; ++frame) {
        const double along = 2e-3 + 7e-3 * frame / 150;
        const Eigen::Vector3d burr(along, 6e-3 + 3e-3 * std::sin(along * 3e3), 5.6e-3);
        millAt(burr);
        mesh();
        publish(burr, frame % 3 == 0 ? 2000 : 0);  // what changed waits, and only little may go at a time
        for (const size_t nodes : {size_t(3), SceneSubscriber::kAllNodes}) {
            client_.poll(nodes);
            // It is open at most once in a row, when this process was not run for so long that the viewer
            // no longer waited.
            open_in_a_row = isClosed() ? 0 : open_in_a_row + 1;
            ASSERT_LE(open_in_a_row, 1) << "frame " << frame;
            open_pictures_ += open_in_a_row;
        }
    }
    EXPECT_LE(open_pictures_, 3);
    publish(Eigen::Vector3d::Zero(), INT64_MAX);
    ASSERT_TRUE(client_.pollUntil([&] {
        return client_.subscriber.isComplete() && client_.subscriber.digest() == publisher_.digest();
    }));
    EXPECT_TRUE(isClosed());
}

}  // namespace
}  // namespace bonemill
