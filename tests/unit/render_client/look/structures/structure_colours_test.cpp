#include <gtest/gtest.h>

#include "render_client/look/structures/structure_set.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;

topics::SceneInfo named(const std::vector<std::string>& names) {
    topics::SceneInfo info;
    for (const std::string& name : names) info.add_materials()->set_name(name);
    return info;
}

// What deuteranopes see of a colour (Viénot, Brettel and Mollon 1999), linear.
Vector3f withoutGreen(const Vector3f& srgb) {
    Eigen::Matrix3f seen;
    seen << 0.29275f, 0.70725f, 0, 0.29275f, 0.70725f, 0, -0.02234f, 0.02234f, 1;
    return srgbColour(seen * linearColour(srgb));
}

TEST(StructureColours, TheScenesColourComesFirst) {
    topics::SceneInfo info = named({"facial nerve"});
    info.mutable_materials(0)->mutable_color()->set_red(0.25);
    info.mutable_materials(0)->mutable_color()->set_green(0.5);
    info.mutable_materials(0)->mutable_color()->set_blue(0.75);
    EXPECT_TRUE(structureColour(info, 1).isApprox(Vector3f(0.25f, 0.5f, 0.75f)));
}

TEST(StructureColours, NamesHaveTheColoursOfAnatomyBooksWhichAreToldApart) {
    const topics::SceneInfo info =
        named({"Facial Nerve", "sigmoid sinus", "internal carotid artery", "dura", "other"});
    const Vector3f nerve = structureColour(info, 1), vein = structureColour(info, 2),
                   artery = structureColour(info, 3), dura = structureColour(info, 4);
    EXPECT_GT(std::min(nerve.x(), nerve.y()), 3 * nerve.z());
    EXPECT_GT(vein.z(), 1.5f * std::max(vein.x(), vein.y()));
    EXPECT_GT(artery.x(), 3 * std::max(artery.y(), artery.z()));
    EXPECT_GT(std::min(dura.x(), dura.z()), 1.2f * dura.y());
    for (uint32_t a = 1; a <= 4; ++a)
        for (uint32_t b = 1; b < a; ++b)
            EXPECT_GT(
                (withoutGreen(structureColour(info, a)) - withoutGreen(structureColour(info, b))).norm(),
                0.2f)
                << a << " " << b;
    EXPECT_TRUE(structureColour(info, 200).allFinite()) << "of no material";
}

TEST(StructureColours, ADistanceGoesFromRedThroughYellowToGreen) {
    const Vector3f red = distanceColour(0, 2e-3), yellow = distanceColour(1e-3, 2e-3),
                   green = distanceColour(2e-3, 2e-3);
    EXPECT_GT(red.x(), 3 * red.y());
    EXPECT_GT(std::min(yellow.x(), yellow.y()), 3 * yellow.z());
    EXPECT_GT(green.y(), 2 * green.x());
    EXPECT_EQ(distanceColour(-1, 2e-3), red);
    EXPECT_EQ(distanceColour(1, 2e-3), green);
}

}  // namespace
}  // namespace bonemill
