#include "common/config/scene_settings.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

scene::Scene with(std::initializer_list<const char*> assignments) {
    scene::Scene scene;
    for (const char* assignment : assignments) setField(scene, assignment);
    return scene;
}

std::string refusalOf(const char* assignment) {
    scene::Scene scene;
    scene.add_tool()->set_name("first");
    try {
        setField(scene, assignment);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(SceneSettings, SetAFieldWhereverItIs) {
    EXPECT_EQ(with({"coupling.max_speed_mm_per_s=80"}).coupling().max_speed_mm_per_s(), 80);
    EXPECT_EQ(with({"title=Bore, \"quick\""}).title(), "Bore, \"quick\"");
    EXPECT_EQ(with({"title=\"Bore\""}).title(), "Bore");
    EXPECT_EQ(with({"accuracy.preset=EXACT"}).accuracy().preset(), scene::Accuracy::EXACT);
    EXPECT_TRUE(with({"assessment.exam=true"}).assessment().exam());
    EXPECT_TRUE(with({"effects.cutting_force={}"}).effects().has_cutting_force());
    EXPECT_FALSE(with({"title=x"}).has_effects());
    EXPECT_EQ(with({"title=x", "title=y"}).title(), "y");
}

TEST(SceneSettings, AMessageIsTakenAwayWithAllThatItSays) {
    const scene::Scene scene = with({"effects.thermal.heat_share=0.3", "effects.cutting_force={}",
                                     "effects.thermal=", "coupling.max_speed_mm_per_s=80", "coupling="});
    EXPECT_FALSE(scene.effects().has_thermal());
    EXPECT_TRUE(scene.effects().has_cutting_force());
    EXPECT_FALSE(scene.has_coupling());
}

TEST(SceneSettings, ElementsOfListsHaveNumbers) {
    const scene::Scene scene = with({"tool[0].burr_radius_mm=2", "tool[1].name=small", "tool[0].name=large"});
    ASSERT_EQ(scene.tool_size(), 2);
    EXPECT_EQ(scene.tool(0).name(), "large");
    EXPECT_EQ(scene.tool(0).burr_radius_mm(), 2);
    EXPECT_EQ(scene.tool(1).name(), "small");
}

TEST(SceneSettings, WhatIsWrongIsNamed) {
    EXPECT_NE(refusalOf("coupling.max_sped_mm_per_s=80").find("did you mean `max_speed_mm_per_s`"),
              std::string::npos);
    for (const auto& [assignment, part] : {std::pair{"coupling.max_speed_mm_per_s", "PATH=VALUE"},
                                           {"=3", "PATH=VALUE"},
                                           {"a..b=3", "PATH=VALUE"},
                                           {"coupling.max_speed_mm_per_s=fast", "takes no fast"},
                                           {"coupling.max_speed_mm_per_s=", "takes no empty"},
                                           {"coupling=3", "set its fields"},
                                           {"coupling=", "has no `coupling` to take away"},
                                           {"effects.thermal=", "has no `thermal` to take away"},
                                           {"title.x=3", "has no fields"},
                                           {"tool.name=x", "is a list"},
                                           {"title[0]=x", "is no list"},
                                           {"tool[2].name=x", "there are 1 of `tool`"},
                                           {"tool[0]=x", "field by field"},
                                           {"accuracy.preset=BEST", "takes no BEST"}}) {
        const std::string refusal = refusalOf(assignment);
        EXPECT_TRUE(refusal.starts_with(std::string("--set ") + assignment)) << refusal;
        EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
    }
}

}  // namespace
}  // namespace bonemill
