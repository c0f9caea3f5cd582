#include "render_client/subscribe/payloads.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/mesh/mesh_codec.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

std::span<const uint8_t> bytesOf(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

topics::ToolState validToolState() {
    topics::ToolState state;
    state.set_epoch(1);
    for (auto* vector : {state.mutable_p_wt_m(), state.mutable_p_wt_device_m(), state.mutable_force_n(),
                         state.mutable_torque_nm()}) {
        vector->Resize(3, 0.5);
    }
    for (auto* quaternion : {state.mutable_q_wt(), state.mutable_q_wt_device()}) quaternion->Resize(4, 0.5);
    return state;
}

template <class Message>
bool isAccepted(std::optional<Message> (*parse)(std::span<const uint8_t>), const Message& message) {
    return parse(bytesOf(message.SerializeAsString())).has_value();
}

TEST(Payloads, NodeComesThrough) {
    const auto node = parseNode(bytesOf(encodeNodeMesh(syntheticNode(3, 8), {.epoch = 42}).bytes), 3, 8);
    ASSERT_TRUE(node);
    EXPECT_EQ(node->tag.epoch, 42u);
    EXPECT_EQ(node->mesh.leaf, 3u);
    EXPECT_EQ(node->mesh.revision, 8u);
    EXPECT_EQ(node->mesh.indices.size(), syntheticNode(3, 8).indices.size());
}

TEST(Payloads, NodeThatContradictsItsEnvelopeIsRefused) {
    const std::string bytes = encodeNodeMesh(syntheticNode(3, 8), {.epoch = 42}).bytes;
    EXPECT_FALSE(parseNode(bytesOf(bytes), 3, 10));
    EXPECT_FALSE(parseNode(bytesOf(encodeNodeMesh(syntheticNode(3, 8), {}).bytes), 3, 8)) << "no epoch";
    EXPECT_FALSE(parseNode(bytesOf(encodeNodeMesh(emptyNode(3, 8), {.epoch = 42}).bytes), 3, 8))
        << "empty nodes are disposed";
    EXPECT_FALSE(parseNode({}, 3, 8));
}

TEST(Payloads, SceneInfoIsChecked) {
    const topics::SceneInfo valid = syntheticSceneInfo();
    EXPECT_TRUE(isAccepted(&parseSceneInfo, valid));

    topics::SceneInfo index_beyond_vertices = valid;
    index_beyond_vertices.mutable_tool()->set_indices(2, 3);
    EXPECT_FALSE(isAccepted(&parseSceneInfo, index_beyond_vertices));

    topics::SceneInfo half_triangle = valid;
    half_triangle.mutable_tool()->add_indices(0);
    EXPECT_FALSE(isAccepted(&parseSceneInfo, half_triangle));

    topics::SceneInfo missing_normal = valid;
    missing_normal.mutable_tool()->mutable_normals()->RemoveLast();
    EXPECT_FALSE(isAccepted(&parseSceneInfo, missing_normal));

    topics::SceneInfo short_vector = valid;
    short_vector.mutable_p_wv_m()->RemoveLast();
    EXPECT_FALSE(isAccepted(&parseSceneInfo, short_vector));

    topics::SceneInfo target_without_numbers = valid;
    target_without_numbers.mutable_camera()->set_has_target(true);
    EXPECT_FALSE(isAccepted(&parseSceneInfo, target_without_numbers));

    topics::SceneInfo no_epoch = valid;
    no_epoch.clear_epoch();
    EXPECT_FALSE(isAccepted(&parseSceneInfo, no_epoch));
}

TEST(Payloads, ToolStateIsChecked) {
    const topics::ToolState valid = validToolState();
    EXPECT_TRUE(isAccepted(&parseToolState, valid));

    topics::ToolState not_finite = valid;
    not_finite.set_p_wt_m(1, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(isAccepted(&parseToolState, not_finite));

    topics::ToolState not_unit = valid;
    not_unit.set_q_wt(0, 7);
    EXPECT_FALSE(isAccepted(&parseToolState, not_unit));

    topics::ToolState too_short = valid;
    too_short.mutable_q_wt_device()->RemoveLast();
    EXPECT_FALSE(isAccepted(&parseToolState, too_short));
}

TEST(Payloads, StatusIsChecked) {
    topics::Status status;
    status.set_epoch(1);
    EXPECT_TRUE(isAccepted(&parseStatus, status));
    status.set_rate_hz(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(isAccepted(&parseStatus, status));
}

}  // namespace
}  // namespace bonemill
