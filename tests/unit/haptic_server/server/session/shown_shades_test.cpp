#include "haptic_server/server/session/shown_shades.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

namespace bonemill {
namespace {

constexpr const char* kTwoRanges = R"(
    material { name: "cells" from_value: 300 below_value: 800 color { red: 0.5 green: 1 blue: 0 } }
    material { name: "nerve" label: 3 color { red: 1 } is_protected: true }
    material { name: "cortex" from_value: 800 color { red: 1 green: 0.5 blue: 0 } })";

scene::Scene shownScene(const std::string& text) {
    scene::Scene scene;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene)) << text;
    return scene;
}

DensityMapping huMapping() {
    return {-200, 1800, 300, {}, 16384};
}

TEST(ShownShades, LieBetweenTheColoursOfRanges) {
    const ShownShades shades = shadesOf(shownScene(kTwoRanges), huMapping());
    const int count = shades.scale.count;
    ASSERT_GE(count, 8);
    ASSERT_EQ(shades.list.size(), size_t(count));
    EXPECT_EQ(shades.scale.first, 4) << "behind the materials";
    EXPECT_EQ(shades.scale.low, huMapping().density(550)) << "the middle of the first range";
    EXPECT_EQ(shades.scale.high, huMapping().density(1050)) << "an open range is as wide as the others";
    EXPECT_TRUE(shades.scale.stands_for[1] && shades.scale.stands_for[3]);
    EXPECT_FALSE(shades.scale.stands_for[2]) << "a label stays what it is";
    EXPECT_NEAR(shades.list.front().color().red(), 0.5, 1e-12);
    EXPECT_NEAR(shades.list.back().color().red(), 1, 1e-12);
    for (int n = 1; n < count; ++n)
        EXPECT_NEAR(shades.list[size_t(n)].color().red() - shades.list[size_t(n) - 1].color().red(),
                    0.5 / (count - 1), 1e-9);
}

TEST(ShownShades, HaveTheNameOfTheirMaterialAndBleedAsItDoes) {
    const ShownShades shades = shadesOf(shownScene(kTwoRanges), huMapping());
    EXPECT_EQ(shades.list.front().name(), "cells");
    EXPECT_EQ(shades.list.back().name(), "cortex");
    for (size_t n = 0; n < shades.list.size(); ++n) {
        const double raw = 550 + 500.0 * double(n) / double(shades.list.size() - 1);
        EXPECT_EQ(shades.list[n].name(), raw < 800 ? "cells" : "cortex") << raw;
        EXPECT_FALSE(shades.list[n].is_protected());
    }
}

TEST(ShownShades, NeedTwoRangesOfValuesWithColours) {
    EXPECT_EQ(shadesOf(shownScene(""), huMapping()).scale.count, 0);
    EXPECT_EQ(shadesOf(shownScene("material { name: 'a' from_value: 300 color { red: 1 } }"), huMapping())
                  .scale.count,
              0);
    EXPECT_EQ(shadesOf(shownScene("material { name: 'a' label: 1 color { red: 1 } }"
                                  "material { name: 'b' label: 2 color { red: 1 } }"),
                       huMapping())
                  .scale.count,
              0);
    EXPECT_EQ(shadesOf(shownScene("material { name: 'a' from_value: 300 below_value: 500 }"
                                  "material { name: 'b' from_value: 500 }"),
                       huMapping())
                  .scale.count,
              0);
    EXPECT_EQ(shadesOf(shownScene("material { name: 'a' from_value: 5000 below_value: 6000 color { red: 1 } }"
                                  "material { name: 'b' from_value: 6000 color { red: 1 } }"),
                       huMapping())
                  .scale.count,
              0)
        << "beyond the window";
}

TEST(ShownShades, LieBehindTheZonesOfATask) {
    const std::string zone =
        "assessment { zone { name: 'out' role: TARGET material: 'cells' } feedback: LIVE }";
    topics::SceneInfo info;
    const scene::Scene scene = shownScene(kTwoRanges + zone);
    const ShownShades shades = shadesOf(scene, huMapping());
    for (int n = 0; n < scene.material_size() + scene.assessment().zone_size(); ++n) info.add_materials();
    describeShades(shades, info);
    EXPECT_EQ(info.materials(shades.scale.first - 1).name(), "cells");
    EXPECT_EQ(shades.scale.first, 5);
}

}  // namespace
}  // namespace bonemill
