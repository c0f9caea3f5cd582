#include "render_client/link/subscribe/payloads.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/dds/remark_bounds.h"
#include "common/mesh_codec/mesh_codec.h"
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
    const auto accepts = [](auto change) {
        topics::ToolState state = validToolState();
        change(state);
        return isAccepted(&parseToolState, state);
    };
    EXPECT_TRUE(accepts([](auto&) {}));
    EXPECT_FALSE(accepts([](auto& s) { s.set_p_wt_m(1, std::numeric_limits<double>::quiet_NaN()); }));
    EXPECT_FALSE(accepts([](auto& s) { s.set_q_wt(0, 7); })) << "not of length 1";
    EXPECT_FALSE(accepts([](auto& s) { s.mutable_q_wt_device()->RemoveLast(); }));
    EXPECT_FALSE(accepts([](auto& s) { s.mutable_p_wt_expert_m()->Resize(3, 0.5); })) << "half a pose";
    EXPECT_TRUE(accepts([](auto& s) {
        s.mutable_p_wt_expert_m()->Resize(3, 0.5);
        s.mutable_q_wt_expert()->Resize(4, 0.5);
    }));
}

TEST(Payloads, OfAScenesPartsOnlyWhatAViewerUsesComesThrough) {
    topics::SceneInfo info = syntheticSceneInfo();
    info.mutable_viewer_effects()->mutable_bone_dust();
    info.mutable_viewer_effects()->mutable_energy_removal();
    scene::Material& material = *info.add_materials();
    material.set_name(std::string(200, 'n') + "\n");
    material.mutable_color()->set_green(0.25);
    material.set_is_protected(true);
    for (uint32_t label = 0; label < 1000; ++label) material.add_label(label);
    const auto parsed = parseSceneInfo(bytesOf(info.SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_TRUE(parsed->viewer_effects().has_bone_dust());
    EXPECT_FALSE(parsed->viewer_effects().has_energy_removal());
    ASSERT_EQ(parsed->materials_size(), 1);
    EXPECT_EQ(parsed->materials(0).name(), std::string(64, 'n'));
    EXPECT_EQ(parsed->materials(0).color().green(), 0.25);
    EXPECT_TRUE(parsed->materials(0).is_protected());
    EXPECT_EQ(parsed->materials(0).label_size(), 0);
}

TEST(Payloads, MaterialsAndEffectsOutOfBoundsAreRefused) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto accepts = [](auto change) {
        topics::SceneInfo info = syntheticSceneInfo();
        change(info);
        return isAccepted(&parseSceneInfo, info);
    };
    const auto withRed = [](double red) {
        return [red](topics::SceneInfo& info) { info.add_materials()->mutable_color()->set_red(red); };
    };
    EXPECT_TRUE(accepts(withRed(1)));
    EXPECT_FALSE(accepts(withRed(kNan)));
    EXPECT_FALSE(accepts(withRed(1.5)));
    EXPECT_FALSE(accepts(withRed(-std::numeric_limits<double>::infinity())));
    const auto withMaterials = [](int count) {
        return [count](topics::SceneInfo& info) {
            for (int n = 0; n < count; ++n) info.add_materials();
        };
    };
    EXPECT_TRUE(accepts(withMaterials(kMaxVertexMaterials)));
    EXPECT_FALSE(accepts(withMaterials(kMaxVertexMaterials + 1)));
    EXPECT_FALSE(accepts([](topics::SceneInfo& info) {
        info.mutable_viewer_effects()->mutable_spindle()->set_inertia_kg_mm2(kNan);
    }));
}

TEST(Payloads, EffectStateAndTrainingAreChecked) {
    topics::ToolState state = validToolState();
    state.mutable_effects()->set_temperature_c(48);
    state.mutable_effects()->set_events(~0u);
    state.mutable_effects()->set_protected_id(~0u);
    EXPECT_TRUE(isAccepted(&parseToolState, state));
    state.mutable_effects()->set_removed_mm3(-1);
    EXPECT_FALSE(isAccepted(&parseToolState, state));
    state = validToolState();
    state.mutable_effects()->set_protected_distance_m(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(isAccepted(&parseToolState, state));

    topics::Status status;
    status.set_epoch(1);
    status.mutable_training()->set_least_distance_mm(-3);
    status.mutable_training()->add_warnings("touched\nnerve");
    const auto parsed = parseStatus(bytesOf(status.SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->training().warnings(0), "touchednerve");
    for (int n = 0; n < 64; ++n) status.mutable_training()->add_warnings("w");
    EXPECT_FALSE(isAccepted(&parseStatus, status));
    status.mutable_training()->clear_warnings();
    status.mutable_training()->set_damaged_mm3(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(isAccepted(&parseStatus, status));
}

TEST(Payloads, HowTheTaskStandsIsChecked) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    topics::Status good;
    good.set_epoch(1);
    good.mutable_task()->add_zones()->set_name("box\n");
    good.mutable_task()->mutable_zones(0)->set_removed_mm3(2);
    good.mutable_task()->add_gates()->set_text("no\thole");
    good.mutable_task()->set_time_left_s(-1);
    good.mutable_task()->set_score(1);
    const auto parsed = parseStatus(bytesOf(good.SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->task().zones(0).name(), "box");
    EXPECT_EQ(parsed->task().gates(0).text(), "nohole");
    const auto accepts = [&](const auto& spoil) {
        topics::Status status = good;
        spoil(*status.mutable_task());
        return isAccepted(&parseStatus, status);
    };
    EXPECT_FALSE(accepts([](topics::TaskState& task) { task.mutable_zones(0)->set_bone_mm3(kNan); }));
    EXPECT_FALSE(accepts([](topics::TaskState& task) { task.mutable_zones(0)->set_removed_mm3(1e300); }));
    EXPECT_FALSE(accepts([](topics::TaskState& task) { task.set_time_left_s(kNan); }));
    EXPECT_FALSE(accepts([](topics::TaskState& task) { task.set_score(1.01); }));
    EXPECT_FALSE(accepts([](topics::TaskState& task) {
        for (int n = 0; n < 32; ++n) task.add_zones();
    }));
    EXPECT_FALSE(accepts([](topics::TaskState& task) {
        for (int n = 0; n < 64; ++n) task.add_gates();
    }));
}

TEST(Payloads, ADevicesNameIsCleanedAndItsFiguresAreChecked) {
    topics::Status status;
    status.set_epoch(1);
    topics::Device& device = *status.mutable_device();
    device.set_name("Touch\n" + std::string(100, 'x'));
    device.set_state(77);  // of a later version
    device.set_max_force_n(3.3);
    const auto parsed = parseStatus(bytesOf(status.SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->device().name(), "Touch" + std::string(59, 'x'));
    EXPECT_EQ(parsed->device().state(), 77u);
    for (const double bad : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        device.set_max_force_n(bad);
        EXPECT_FALSE(isAccepted(&parseStatus, status)) << bad;
        device.set_max_force_n(3.3);
        device.set_max_torque_nmm(bad);
        EXPECT_FALSE(isAccepted(&parseStatus, status)) << bad;
        device.set_max_torque_nmm(0);
    }
    status.clear_device();
    EXPECT_FALSE(parseStatus(bytesOf(status.SerializeAsString()))->has_device());
}

TEST(Payloads, AReplaysFiguresAreCheckedAndItsWordsCleaned) {
    topics::Status status;
    status.set_epoch(1);
    topics::Replay& replay = *status.mutable_replay();
    replay.set_length_s(60);
    replay.set_speed(2);
    replay.set_event("cut\x01 " + std::string(5000, 'x'));
    const auto parsed = parseStatus(bytesOf(status.SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_LE(parsed->replay().event().size(), 512u);
    EXPECT_EQ(parsed->replay().event().substr(0, 4), "cut ");
    for (const double bad : {-1.0, 1e12, std::nan("")}) {
        topics::Status other = status;
        other.mutable_replay()->set_length_s(bad);
        EXPECT_FALSE(isAccepted(&parseStatus, other)) << bad;
        other = status;
        other.mutable_replay()->set_speed(bad);
        EXPECT_FALSE(isAccepted(&parseStatus, other)) << bad;
    }
}

TEST(Payloads, StatusIsChecked) {
    topics::Status status;
    status.set_epoch(1);
    EXPECT_TRUE(isAccepted(&parseStatus, status));
    status.mutable_device()->set_name("mouse\n" + std::string(200, 'n'));
    status.mutable_device()->set_max_force_n(8);
    EXPECT_EQ(parseStatus(bytesOf(status.SerializeAsString()))->device().name(),
              "mouse" + std::string(59, 'n'));
    status.mutable_device()->set_max_force_n(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(isAccepted(&parseStatus, status));
    status.clear_device();
    status.set_rate_hz(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(isAccepted(&parseStatus, status));
}

topics::Lesson validLesson() {
    topics::Lesson lesson;
    lesson.set_epoch(1);
    topics::SceneChoice& scene = *lesson.add_scenes();
    scene.set_id("tooth_cavity");
    scene.add_tools("round bur");
    scene.set_expected_s(300);
    scene.set_picture(std::string(64 << 10, 'p'));
    topics::Attempt& attempt = *lesson.add_attempts();
    attempt.set_trainee("Ann\n" + std::string(200, 'n'));
    attempt.set_time_s(12);
    attempt.mutable_training()->set_damaged_mm3(1);
    attempt.add_structures_touched("nerve\x1b[2J");
    attempt.mutable_verdict()->add_failed_gates("dura\x1b[2J");
    return lesson;
}

TEST(Payloads, LessonComesThroughWithTextsThatCanBeShown) {
    const auto parsed = parseLesson(bytesOf(validLesson().SerializeAsString()));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->scenes(0).id(), "tooth_cavity");
    EXPECT_EQ(parsed->attempts(0).trainee(), "Ann" + std::string(61, 'n'));
    EXPECT_EQ(parsed->attempts(0).structures_touched(0), "nerve[2J");
    EXPECT_EQ(parsed->attempts(0).verdict().failed_gates(0), "dura[2J");
}

TEST(Payloads, LessonIsChecked) {
    const auto is_accepted = [](const std::function<void(topics::Lesson&)>& change) {
        topics::Lesson lesson = validLesson();
        change(lesson);
        return isAccepted(&parseLesson, lesson);
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(is_accepted([](topics::Lesson&) {}));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.set_epoch(0); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.mutable_scenes(0)->clear_id(); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.mutable_scenes(0)->set_expected_s(kNan); }));
    EXPECT_FALSE(
        is_accepted([](topics::Lesson& l) { l.mutable_scenes(0)->mutable_picture()->push_back(0); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.mutable_attempts(0)->set_time_s(-1); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.mutable_attempts(0)->set_removed_mm3(kNan); }));
    EXPECT_FALSE(is_accepted(
        [](topics::Lesson& l) { l.mutable_attempts(0)->mutable_verdict()->set_score_percent(kNan); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) {
        for (int n = 0; n < 65; ++n) l.mutable_attempts(0)->mutable_verdict()->add_failed_gates("x");
    }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) { l.mutable_attempts(0)->set_max_force_n(1e9); }));
    EXPECT_FALSE(is_accepted(
        [](topics::Lesson& l) { l.mutable_attempts(0)->mutable_training()->set_max_temperature_c(kNan); }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) {
        for (int n = 0; n < 64; ++n) *l.add_scenes() = topics::SceneChoice(l.scenes(0));
    }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) {
        for (int n = 0; n < 256; ++n) l.add_attempts();
    }));
    EXPECT_FALSE(is_accepted([](topics::Lesson& l) {
        for (int n = 0; n < 64; ++n) l.mutable_attempts(0)->add_structures_touched("x");
    }));
}

TEST(Payloads, PicturesOfScenesAreChecked) {
    topics::ScenePicture picture;
    picture.set_epoch(5);
    picture.set_scene_id("tooth_cavity");
    picture.set_png(std::string(64u << 10, 'x'));
    const auto parsed = [&](uint32_t scene) {
        return parseScenePicture(bytesOf(picture.SerializeAsString()), scene);
    };
    ASSERT_TRUE(parsed(63));
    EXPECT_EQ(parsed(63)->scene_id(), "tooth_cavity");
    EXPECT_FALSE(parsed(64)) << "there are no more scenes";
    picture.mutable_png()->push_back('x');
    EXPECT_FALSE(parsed(0));
    picture.clear_png();
    EXPECT_TRUE(parsed(0));
    picture.clear_epoch();
    EXPECT_FALSE(parsed(0));
}

topics::Remark validRemark(const std::string& note, int points) {
    topics::Remark remark;
    remark.set_epoch(1);
    remark.set_number(3);
    remark.set_author("Ann\n" + std::string(200, 'n'));
    remark.set_session_s(61);
    remark.set_note(note);
    for (int n = 0; n < 3 * points; ++n) remark.add_points_m(0.01f * float(n % 7));
    return remark;
}

TEST(Payloads, RemarksComeThroughWithTextsThatCanBeShown) {
    const auto parsed =
        parseRemark(bytesOf(validRemark("mind\x1b[2J the nerve", 1).SerializeAsString()), 255);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->author(), "Ann" + std::string(61, 'n'));
    EXPECT_EQ(parsed->note(), "mind[2J the nerve");
    EXPECT_EQ(parsed->points_m_size(), 3);
}

TEST(Payloads, RemarksAreChecked) {
    const auto is_accepted = [](const topics::Remark& remark, uint32_t place = 0) {
        return parseRemark(bytesOf(remark.SerializeAsString()), place).has_value();
    };
    EXPECT_TRUE(is_accepted(validRemark("x", 0)));
    EXPECT_TRUE(is_accepted(validRemark("", kMaxRemarkPoints)));
    EXPECT_TRUE(is_accepted(validRemark(std::string(300, 'x'), 1)));
    EXPECT_FALSE(is_accepted(validRemark("x", 0), kMaxRemarks)) << "a place that no server has";
    EXPECT_FALSE(is_accepted(validRemark("", 1)));
    EXPECT_FALSE(is_accepted(validRemark("\n", 1))) << "nothing of it can be shown";
    EXPECT_FALSE(is_accepted(validRemark("x", 2)));
    EXPECT_FALSE(is_accepted(validRemark("", kMaxRemarkPoints + 1)));
    EXPECT_FALSE(is_accepted(validRemark(std::string(301, 'x'), 1)));
    const std::function<void(topics::Remark&)> damages[] = {
        [](topics::Remark& r) { r.set_epoch(0); },
        [](topics::Remark& r) { r.set_number(0); },
        [](topics::Remark& r) { r.set_session_s(-1); },
        [](topics::Remark& r) { r.set_session_s(std::numeric_limits<double>::quiet_NaN()); },
        [](topics::Remark& r) { r.set_role(topics::Viewer::Role(9)); },
        [](topics::Remark& r) { r.add_points_m(0); },
        [](topics::Remark& r) { r.set_points_m(4, std::numeric_limits<float>::infinity()); },
        [](topics::Remark& r) { r.set_points_m(4, 1e9f); }};
    for (const auto& damage : damages) {
        topics::Remark remark = validRemark("", 2);
        damage(remark);
        EXPECT_FALSE(is_accepted(remark)) << remark.ShortDebugString();
    }
}

TEST(Payloads, WhoOnlyLooksHoldsNothing) {
    topics::Viewer viewer;
    viewer.set_sender(7);
    viewer.set_is_holding(true);
    const auto parsed = [&] { return parseViewer(bytesOf(viewer.SerializeAsString()), 7); };
    EXPECT_FALSE(parsed()->is_holding());
    viewer.set_role(topics::Viewer::OPERATOR);
    EXPECT_TRUE(parsed()->is_holding());
}

}  // namespace
}  // namespace bonemill
