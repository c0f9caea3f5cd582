// Whatever the parsers let through is drawn without harm.
#include <gtest/gtest.h>

#include "render_client/link/subscribe/payloads.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/synthetic_scene.h"
#include "tests/support/mutated_bytes.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr int kRounds = 150;

std::span<const uint8_t> bytesOf(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

class HostileScene : public testing::TestWithParam<Quality> {
  protected:
    HostileScene() : context_(kWidth, kHeight), scene_(context_.gl()) {
        scene_.settings().quality = GetParam();
    }

    void show(const std::string& info, const std::string& tool, const std::string& status,
              const std::string& viewer) {
        if (const auto parsed = parseSceneInfo(bytesOf(info))) scene_.setSceneInfo(*parsed);
        if (const auto parsed = parseToolState(bytesOf(tool))) scene_.setToolState(*parsed);
        if (const auto parsed = parseStatus(bytesOf(status))) scene_.setStatus(*parsed);
        if (const auto parsed = parseViewer(bytesOf(viewer), 7)) scene_.setWatchers({*parsed});
    }
    std::string mutated(const std::string& valid) { return test::mutated(valid, random_); }
    // Each message is damaged in one of three rounds: the rest must not hide it.
    std::string sometimes(const std::string& valid) { return random_() % 3 ? valid : mutated(valid); }

    OsmesaContext context_;
    RenderScene scene_;
    std::mt19937 random_{11};
};

TEST_P(HostileScene, IsDrawnWhateverTheMessagesSay) {
    topics::SceneInfo info = syntheticSceneInfo();
    info.mutable_camera()->set_distance_m(0.1);
    for (int n = 0; n < 2; ++n) info.add_materials()->mutable_color()->set_red(0.5 * n);
    topics::ToolState tool = test::makeToolState({}, {}, 1);
    tool.set_epoch(1);
    tool.mutable_effects()->set_events(31);
    tool.mutable_effects()->set_spin_speed(3000);
    tool.mutable_effects()->set_temperature_c(40);
    tool.mutable_effects()->set_protected_distance_m(1e-3);
    tool.mutable_effects()->set_protected_id(2);
    tool.mutable_effects()->set_event_id(77);
    test::listAllEffects(info);
    tool.set_tick(5);
    tool.mutable_effects()->set_removed_mm3(2);
    topics::Status status = test::makeStatus();
    status.set_epoch(1);
    topics::Viewer viewer;
    viewer.set_sender(7);
    viewer.set_name("teacher");
    viewer.set_role(topics::Viewer::INSTRUCTOR);
    viewer.mutable_pointer_m()->Resize(3, 0.01);
    std::string messages[] = {info.SerializeAsString(), tool.SerializeAsString(), status.SerializeAsString(),
                              viewer.SerializeAsString()};
    for (int round = 0; round < kRounds; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        show(sometimes(messages[0]), sometimes(messages[1]), sometimes(messages[2]), sometimes(messages[3]));
        for (uint32_t leaf = 0; leaf < 3; ++leaf) {
            NodeMesh mesh = syntheticNode(leaf, 2);
            for (size_t n = 0; n < mesh.vertices.size(); ++n) mesh.materials.push_back(uint8_t(n * 50));
            const std::string node = encodeNodeMesh(mesh, {.epoch = 1}).bytes;
            if (auto parsed = parseNode(bytesOf(sometimes(node)), leaf, 2))
                scene_.setNode(std::move(parsed->mesh));
        }
        scene_.settings().is_transparent = round % 5 == 1;
        scene_.settings().cuts[0].is_on = round % 3 == 1;
        scene_.settings().camera = round % 4 == 1 ? CameraMode::kEndoscope : CameraMode::kOrbit;
        if (round % 10 == 0) scene_.resetView();
        tool.set_tick(tool.tick() + 1);
        messages[1] = tool.SerializeAsString();
        scene_.advance(0.02);
        ASSERT_NO_THROW(scene_.draw(kWidth, kHeight, 0.7f));
    }
}

// The numbers are as large as the parsers let through.
TEST_P(HostileScene, IsDrawnFarAwayAndHuge) {
    topics::SceneInfo info = syntheticSceneInfo();
    for (int axis = 0; axis < 3; ++axis) {
        info.set_p_wv_m(axis, 1e6);
        info.set_bone_min_m(axis, -1e6);
        info.set_bone_max_m(axis, axis == 1 ? -1e6 : 1e6);
    }
    info.set_burr_radius_m(1e6);
    test::listAllEffects(info);
    ASSERT_TRUE(parseSceneInfo(bytesOf(info.SerializeAsString())));
    scene_.setSceneInfo(info);
    NodeMesh node = syntheticNode(1, 2);
    node.origin.setConstant(-1e6f);
    node.step.setConstant(1);
    const auto parsed = parseNode(bytesOf(encodeNodeMesh(node, {.epoch = 1}).bytes), 1, 2);
    ASSERT_TRUE(parsed);
    scene_.setNode(parsed->mesh);
    topics::ToolState tool = test::makeToolState({}, {}, 1);
    for (int axis = 0; axis < 3; ++axis) tool.set_force_n(axis, 1e6);
    tool.mutable_effects()->set_spin_speed(1e300);
    tool.mutable_effects()->set_removed_mm3(1e300);
    scene_.setToolState(tool);
    scene_.advance(1e9);
    for (const bool is_cut : {false, true}) {
        scene_.settings().cuts[0].is_on = is_cut;
        ASSERT_NO_THROW(scene_.draw(kWidth, kHeight, 0.7f));
        ASSERT_NO_THROW(scene_.draw(kWidth, kHeight, 0.7f));
    }
}

INSTANTIATE_TEST_SUITE_P(Qualities, HostileScene, testing::Values(Quality::kFull, Quality::kQuick),
                         [](const auto& info) { return info.param == Quality::kFull ? "Full" : "Quick"; });

}  // namespace
}  // namespace bonemill
