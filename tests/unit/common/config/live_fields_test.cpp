#include "common/config/live_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/config/scene_text.h"

namespace bonemill {
namespace {

LiveField fieldOf(const std::string& path) {
    const auto found = std::ranges::find(liveFields(), path, &LiveField::path);
    EXPECT_NE(found, liveFields().end()) << path;
    return found == liveFields().end() ? liveFields().front() : *found;
}

scene::Tuning tuningWith(const std::string& path, double value) {
    scene::Tuning tuning;
    setValue(tuning, fieldOf(path), value);
    return tuning;
}

TEST(LiveFields, AreTheSchemasOwnWithTheirUnits) {
    EXPECT_EQ(liveFields().size(), 7u);
    EXPECT_EQ(fieldOf("coupling.damping_time_ms").unit(), "ms");
    EXPECT_EQ(fieldOf("coupling.relaxing_share").unit(), "");
    EXPECT_EQ(fieldOf("contact.stiffness_n_per_mm3").range().max(), 1e6);
    for (const LiveField& field : liveFields())
        EXPECT_EQ(field.field->cpp_type(), google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) << field.path();
}

TEST(LiveFields, AScenesOwnValuesAreThereWithTheirDefaults) {
    scene::Scene scene;
    scene.mutable_coupling()->set_max_force_n(8);
    const scene::Tuning own = tunableOf(scene);
    for (const LiveField& field : liveFields()) EXPECT_TRUE(valueOf(own, field)) << field.path();
    EXPECT_EQ(own.coupling().max_force_n(), 8);
    EXPECT_EQ(own.coupling().translation_stiffness_n_per_mm(), 3);
    EXPECT_EQ(tuningProblem(own, own), "");
    EXPECT_FALSE(own.coupling().has_max_speed_mm_per_s());
}

TEST(LiveFields, WhatNoSceneMaySayIsRefusedInOneLine) {
    const scene::Tuning own = tunableOf({});
    EXPECT_EQ(tuningProblem({}, own), "");
    for (const LiveField& field : liveFields()) {
        for (const double value :
             {field.range().min() - 1e-3, field.range().max() + 1, std::numeric_limits<double>::quiet_NaN(),
              std::numeric_limits<double>::infinity()}) {
            scene::Tuning tuning;
            setValue(tuning, field, value);
            const std::string why = tuningProblem(tuning, own);
            EXPECT_NE(why.find("field `" + field.path() + "` = "), std::string::npos) << why;
            EXPECT_EQ(why.find('\n'), std::string::npos);
        }
        scene::Tuning least;
        setValue(least, field, field.range().min());
        EXPECT_EQ(tuningProblem(least, own), "") << field.path();
    }
    EXPECT_EQ(tuningProblem(tuningWith("coupling.damping_time_ms", 200), own),
              "field `coupling.damping_time_ms` = 200 is outside 0 .. 100 (ms)");
}

TEST(LiveFields, WhatTheHandMayFeelIsOnlyLowered) {
    scene::Scene scene;
    scene.mutable_coupling()->set_max_force_n(8);
    const scene::Tuning own = tunableOf(scene);
    EXPECT_EQ(tuningProblem(tuningWith("coupling.max_force_n", 8), own), "");
    EXPECT_EQ(
        tuningProblem(tuningWith("coupling.max_force_n", 8.5), own),
        "field `coupling.max_force_n` = 8.5 is above what the scene file says (8): what the hand may feel "
        "is only lowered while the session runs");
    EXPECT_EQ(boundsOf(fieldOf("coupling.max_force_n"), own).max(), 8);
    EXPECT_EQ(boundsOf(fieldOf("coupling.relaxing_share"), own).max(), 10);
}

TEST(LiveFields, AFieldThatNeedsARestartIsNamed) {
    scene::Tuning tuning;
    tuning.mutable_coupling()->mutable_grip_mm()->set_x(1);
    EXPECT_EQ(
        tuningProblem(tuning, tunableOf({})),
        "field `coupling.grip_mm` cannot be tuned while the session runs: change it in the scene file and "
        "choose the scene anew");
}

TEST(LiveFields, TheTextIsThatOfASceneFile) {
    EXPECT_EQ(tuningText({}), "");
    scene::Tuning tuning = tuningWith("coupling.damping_time_ms", 2.5);
    setValue(tuning, fieldOf("coupling.max_force_n"), 10);
    setValue(tuning, fieldOf("contact.stiffness_n_per_mm3"), 400);
    const std::string text = tuningText(tuning);
    EXPECT_EQ(text,
              "contact { stiffness_n_per_mm3: 400 }\ncoupling { max_force_n: 10 damping_time_ms: 2.5 }");
    const auto read = tuningOfText(text);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->SerializeAsString(), tuning.SerializeAsString());
    const ParsedScene parsed = parseSceneText("volume { path: \"a\" }\n" + text, "s");
    EXPECT_EQ(parsed.scene.coupling().damping_time_ms(), 2.5);
    EXPECT_EQ(parsed.scene.contact().stiffness_n_per_mm3(), 400);
    for (const char* bad : {"coupling {", "loop { rate_hz: 500 }", "coupling { stiffness: 1 }"})
        EXPECT_FALSE(tuningOfText(bad)) << bad;
}

TEST(LiveFields, WhatIsTunedTakesThePlaceOfTheScenesOwn) {
    scene::Scene scene;
    scene.mutable_coupling()->set_max_speed_mm_per_s(300);
    scene.mutable_coupling()->set_relaxing_share(2);
    const scene::Scene tuned = tunedScene(scene, tuningWith("coupling.damping_time_ms", 4));
    EXPECT_EQ(tuned.coupling().damping_time_ms(), 4);
    EXPECT_EQ(tuned.coupling().relaxing_share(), 2);
    EXPECT_EQ(tuned.coupling().max_speed_mm_per_s(), 300);
}

}  // namespace
}  // namespace bonemill
