// Random and mutated bytes go through every parser of the topics: nothing crashes (nor makes a sanitizer
// speak), and what is accepted holds the promises that the renderer relies on.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "common/dds/remark_bounds.h"
#include "common/device_messages/device_messages.h"
#include "common/mesh_codec/mesh_codec.h"
#include "device_daemon/hands/pointer/hand_wish.h"
#include "haptic_server/server/publish/command_inbox.h"
#include "haptic_server/server/publish/trainee_eye.h"
#include "render_client/link/subscribe/payloads.h"
#include "tests/support/hand_pointer.h"
#include "tests/support/mutated_bytes.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

constexpr int kRounds = 20000;

using Bytes = std::span<const uint8_t>;

// Returns how many of the mutated byte strings were accepted.
int fuzz(const std::string& valid, const std::function<bool(Bytes)>& accepts) {
    std::mt19937 random(20121);
    int accepted = 0;
    for (int round = 0; round < kRounds; ++round) {
        const std::string bytes = test::mutated(valid, random);
        accepted += accepts({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    }
    EXPECT_TRUE(accepts({reinterpret_cast<const uint8_t*>(valid.data()), valid.size()}));
    EXPECT_LT(accepted, kRounds);
    return accepted;
}

TEST(TopicsFuzz, NodeMesh) {
    NodeMesh coloured = syntheticNode(3, 8);
    for (size_t n = 0; n < coloured.vertices.size(); ++n) coloured.materials.push_back(uint8_t(n / 5));
    fuzz(encodeNodeMesh(coloured, {.epoch = 42}).bytes, [](Bytes bytes) {
        const auto node = parseNode(bytes, 3, 8);
        if (!node) return false;
        EXPECT_FALSE(node->mesh.indices.empty());
        EXPECT_EQ(node->mesh.indices.size() % 3, 0u);
        for (const uint32_t index : node->mesh.indices) EXPECT_LT(index, node->mesh.vertices.size());
        EXPECT_TRUE(node->mesh.origin.allFinite() && node->mesh.step.allFinite());
        EXPECT_TRUE(node->mesh.materials.empty() ||
                    node->mesh.materials.size() == node->mesh.vertices.size());
        return true;
    });
}

TEST(TopicsFuzz, StructureMesh) {
    topics::StructureMesh structure;
    structure.set_epoch(42);
    structure.set_surface(encodeNodeMesh(syntheticNode(3, 1), {.epoch = 42}).bytes);
    structure.set_warning_distance_m(2e-3);
    const std::string valid = structure.SerializeAsString();
    fuzz(valid, [](Bytes bytes) {
        const auto parsed = parseStructure(bytes, 3);
        if (!parsed) return false;
        EXPECT_FALSE(parsed->mesh.isEmpty());
        EXPECT_EQ(parsed->mesh.leaf, 3u);
        EXPECT_LE(parsed->mesh.vertices.size(), kMaxStructureVertices);
        for (const uint32_t index : parsed->mesh.indices) EXPECT_LT(index, parsed->mesh.vertices.size());
        EXPECT_TRUE(parsed->mesh.origin.allFinite() && parsed->mesh.step.allFinite());
        EXPECT_TRUE(parsed->warning_distance > 0 && parsed->warning_distance <= 1);
        return true;
    });
    const auto parsed = [&](const topics::StructureMesh& message, uint32_t id) {
        const std::string bytes = message.SerializeAsString();
        return parseStructure({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, id).has_value();
    };
    EXPECT_TRUE(parsed(structure, kMaxVertexMaterials));
    EXPECT_FALSE(parsed(structure, 0)) << "no material";
    EXPECT_FALSE(parsed(structure, kMaxVertexMaterials + 1)) << "more than a scene has";
    topics::StructureMesh other = structure;
    other.set_epoch(43);
    EXPECT_FALSE(parsed(other, 3)) << "the surface of another run";
    other = structure;
    other.set_surface(encodeNodeMesh(syntheticNode(3, 1, 150000), {.epoch = 42}).bytes);
    EXPECT_FALSE(parsed(other, 3)) << "too large to be searched";
    for (const double distance : {0.0, -1.0, 1e300, std::nan("")}) {
        other = structure;
        other.set_warning_distance_m(distance);
        EXPECT_FALSE(parsed(other, 3)) << distance;
    }
}

topics::SceneInfo sceneInfoWithEffects() {
    topics::SceneInfo info = syntheticSceneInfo();
    for (const float number : {0.f, 1e-3f, 0.f, 5e-4f}) info.add_burr_balls_m(number);
    info.mutable_viewer_effects()->mutable_bone_dust()->set_drag_time_ms(40);
    info.mutable_viewer_effects()->mutable_bone_dust()->set_most_grains(100);
    info.mutable_viewer_effects()->mutable_milling_sound()->set_idle_level(0.5);
    for (const char* name : {"enamel", "facial nerve"}) {
        scene::Material& material = *info.add_materials();
        material.set_name(name);
        material.mutable_color()->set_red(0.5);
        material.mutable_color()->set_blue(0.125);
    }
    return info;
}

TEST(TopicsFuzz, SceneInfo) {
    fuzz(sceneInfoWithEffects().SerializeAsString(), [](Bytes bytes) {
        const auto info = parseSceneInfo(bytes);
        if (!info) return false;
        EXPECT_EQ(info->p_wv_m_size(), 3);
        EXPECT_EQ(info->q_wv_size(), 4);
        EXPECT_EQ(info->tool().vertices_m_size(), info->tool().normals_size());
        const scene::BoneDust& dust = info->viewer_effects().bone_dust();
        EXPECT_TRUE(dust.drag_time_ms() >= 1 && dust.drag_time_ms() <= 10000);
        EXPECT_LE(dust.most_grains(), 20000u);
        EXPECT_LE(std::abs(info->viewer_effects().milling_sound().idle_level()), 1);
        for (const uint32_t index : info->tool().indices()) {
            EXPECT_LT(3 * index + 2, static_cast<uint32_t>(info->tool().vertices_m_size()));
        }
        EXPECT_LE(info->materials_size(), 127);
        for (const scene::Material& material : info->materials()) {
            for (const double part :
                 {material.color().red(), material.color().green(), material.color().blue()})
                EXPECT_TRUE(part >= 0 && part <= 1) << part;
            EXPECT_LE(material.name().size(), 64u);
        }
        EXPECT_FALSE(info->viewer_effects().has_energy_removal());
        EXPECT_EQ(info->burr_balls_m_size() % 4, 0);
        for (const float number : info->burr_balls_m()) EXPECT_TRUE(std::isfinite(number));
        return true;
    });
}

TEST(TopicsFuzz, Remark) {
    topics::Remark remark;
    remark.set_epoch(42);
    remark.set_number(3);
    remark.set_author("Anna \xc3\xbc");
    remark.set_role(topics::Viewer::INSTRUCTOR);
    remark.set_session_s(12.5);
    remark.set_color(0xffd23f);
    for (const bool is_note : {false, true}) {
        remark.clear_points_m();
        remark.set_note(is_note ? "mind the nerve" : "");
        for (int n = 0; n < (is_note ? 3 : 30); ++n) remark.add_points_m(0.01f * float(n));
        fuzz(remark.SerializeAsString(), [](Bytes bytes) {
            const auto parsed = parseRemark(bytes, 7);
            if (!parsed) return false;
            EXPECT_GT(parsed->number(), 0u);
            EXPECT_TRUE(parsed->session_s() >= 0 && parsed->session_s() <= 1e9);
            EXPECT_LE(parsed->color(), 0xffffffu);
            EXPECT_LE(parsed->author().size(), 64u);
            EXPECT_LE(lettersOf(parsed->note()), kMaxNoteLetters);
            const int points = parsed->points_m_size() / 3;
            EXPECT_EQ(parsed->points_m_size() % 3, 0);
            EXPECT_TRUE(parsed->note().empty() ? points >= 2 && points <= kMaxRemarkPoints : points <= 1);
            for (const float number : parsed->points_m()) EXPECT_LE(std::abs(number), 1e6f);
            return true;
        });
    }
}

TEST(TopicsFuzz, ToolState) {
    topics::ToolState state;
    state.set_epoch(1);
    for (auto* vector : {state.mutable_p_wt_m(), state.mutable_p_wt_device_m(), state.mutable_force_n(),
                         state.mutable_torque_nm()}) {
        vector->Resize(3, 0.5);
    }
    for (auto* quaternion : {state.mutable_q_wt(), state.mutable_q_wt_device()}) quaternion->Resize(4, 0.5);
    state.mutable_effects()->set_events(5);
    state.mutable_effects()->set_spin_speed(3000);
    state.mutable_effects()->set_temperature_c(40);
    state.mutable_effects()->set_protected_distance_m(1e-3);
    state.mutable_effects()->set_removed_mm3(0.5);
    fuzz(state.SerializeAsString(), [](Bytes bytes) {
        const auto parsed = parseToolState(bytes);
        if (!parsed) return false;
        for (const double coordinate : parsed->p_wt_m()) EXPECT_TRUE(std::isfinite(coordinate));
        EXPECT_EQ(parsed->q_wt_size(), 4);
        EXPECT_TRUE(std::isfinite(parsed->effects().spin_speed()));
        EXPECT_TRUE(std::isfinite(parsed->effects().temperature_c()));
        EXPECT_GE(parsed->effects().removed_mm3(), 0);
        return true;
    });
}

TEST(TopicsFuzz, Ticks) {
    topics::Ticks ticks;
    ticks.set_epoch(1);
    for (int n = 0; n < 3; ++n) {
        topics::Tick& tick = *ticks.add_ticks();
        tick.set_stamp_ns(1'700'000'000'000'000'000);
        for (auto* vector : {tick.mutable_p_wt_m(), tick.mutable_p_wt_device_m(), tick.mutable_force_n(),
                             tick.mutable_torque_nm()})
            vector->Resize(3, 0.5);
        for (auto* quaternion : {tick.mutable_q_wt(), tick.mutable_q_wt_device()}) quaternion->Resize(4, 0.5);
    }
    fuzz(ticks.SerializeAsString(), [](Bytes bytes) {
        const auto parsed = parseTicks(bytes);
        if (!parsed) return false;
        for (const topics::Tick& tick : parsed->ticks()) {
            EXPECT_EQ(tick.p_wt_device_m_size() + tick.q_wt_device_size() + tick.force_n_size(), 10);
            for (const double number : tick.p_wt_m()) EXPECT_TRUE(std::isfinite(number));
        }
        return parsed->ticks_size() <= 256;
    });
}

TEST(TopicsFuzz, Status) {
    topics::Status status;
    status.set_epoch(1);
    status.set_scene("tooth");
    status.set_rate_hz(1000);
    status.set_node_digest(0x0123456789abcdef);
    status.mutable_training()->set_least_distance_mm(0.5);
    status.mutable_training()->add_warnings("touched facial nerve");
    status.mutable_task()->add_zones()->set_removed_mm3(3);
    status.mutable_task()->add_gates()->set_text("held");
    status.mutable_task()->set_score(0.5);
    fuzz(status.SerializeAsString(), [](Bytes bytes) {
        const auto parsed = parseStatus(bytes);
        return parsed && std::isfinite(parsed->rate_hz()) &&
               std::isfinite(parsed->training().least_distance_mm()) &&
               parsed->training().warnings_size() <= 64 && parsed->task().zones_size() <= 32 &&
               parsed->task().gates_size() <= 64 && parsed->task().score() >= 0 &&
               parsed->task().score() <= 1;
    });
}

TEST(TopicsFuzz, Viewer) {
    topics::Viewer viewer;
    viewer.set_sender(7);
    viewer.set_name("Ärztin");
    viewer.set_role(topics::Viewer::INSTRUCTOR);
    viewer.mutable_pointer_m()->Resize(3, 0.5);
    fuzz(viewer.SerializeAsString(), [](Bytes bytes) {
        const auto parsed = parseViewer(bytes, 7);
        if (!parsed) return false;
        EXPECT_LE(parsed->name().size(), 64u);
        EXPECT_TRUE(parsed->pointer_m().empty() || parsed->pointer_m_size() == 3);
        for (const double coordinate : parsed->pointer_m()) EXPECT_TRUE(std::isfinite(coordinate));
        return true;
    });
}

TEST(TopicsFuzz, HandPointer) {
    const Pose X_WT{{0.1, 0.2, 0.3}, expRotation({0.4, 0.5, 0.6})};
    fuzz(test::handPointer(7, 3, X_WT, kButtonRemove).SerializeAsString(), [](Bytes bytes) {
        const auto wish = parseHandWish(bytes, 7);
        if (!wish) return false;
        EXPECT_EQ(wish->sender, 7u);
        EXPECT_TRUE(wish->X_WT.isFinite());
        EXPECT_LE(wish->X_WT.position.norm(), kMaxDeviceReach);
        EXPECT_NEAR(wish->X_WT.rotation.norm(), 1, 1e-9);
        EXPECT_LE(wish->buttons, uint32_t{kButtonRemove | kButtonAdd});
        return true;
    });
}

TEST(TopicsFuzz, ScenePicture) {
    topics::ScenePicture picture;
    picture.set_epoch(5);
    picture.set_scene_id("tooth_cavity");
    picture.set_png("\x89PNG\r\n\x1a\n and so on");
    fuzz(picture.SerializeAsString(), [](Bytes bytes) {
        const auto parsed = parseScenePicture(bytes, 3);
        if (!parsed) return false;
        EXPECT_FALSE(parsed->scene_id().size() > 64 || parsed->epoch() == 0);
        return true;
    });
}

TEST(TopicsFuzz, Command) {
    topics::Command command;
    command.set_sender(7);
    command.set_sequence(3);
    command.set_pause_milling(true);
    fuzz(command.SerializeAsString(), [](Bytes bytes) {
        CommandInbox inbox([](uint64_t) { return true; });
        const auto decision = inbox.receive(7, {1, 2}, bytes);
        EXPECT_TRUE(!decision.command || decision.command->action_case() != topics::Command::ACTION_NOT_SET);
        return decision.command.has_value();
    });
}

TEST(TopicsFuzz, TraineesEye) {
    topics::Viewer viewer;
    viewer.set_sender(7);
    viewer.set_name("Ann");
    viewer.set_role(topics::Viewer::OPERATOR);
    for (const double p : {0.1, 0.2, 0.3}) viewer.mutable_eye()->add_p_wc_m(p);
    for (const double q : {0.5, 0.5, 0.5, 0.5}) viewer.mutable_eye()->add_q_wc(q);
    viewer.mutable_eye()->set_field_of_view_rad(0.5);
    TraineeEye eyes;
    TraineeEye::Clock::time_point now;
    fuzz(viewer.SerializeAsString(), [&](Bytes bytes) {
        const bool is_accepted = eyes.hear(bytes, 7, 1, {}, now);
        if (const auto seen = eyes.takeChanged(now)) {
            EXPECT_TRUE(seen->X_WC.isFinite());
            EXPECT_NEAR(seen->X_WC.rotation.norm(), 1, 1e-12);
            EXPECT_GT(seen->field_of_view, 0);
        }
        return is_accepted;
    });
}

}  // namespace
}  // namespace bonemill
