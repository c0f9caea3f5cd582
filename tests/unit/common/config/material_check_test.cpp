#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"

namespace bonemill {
namespace {

std::string refusal(const std::string& text) {
    try {
        checkScene(parseSceneText("volume { path: 'v' label_path: 'l' }\n" + text, "s"), "s");
    } catch (const UserError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(MaterialCheck, materialsHaveNamesOfTheirOwn) {
    EXPECT_EQ(refusal("material { name: 'a' label: 1 }\nmaterial { name: 'b' from_value: 3 }"), "accepted");
    EXPECT_EQ(refusal("material { name: 'a' label: 1 }\nmaterial { label: 2 }"),
              "s:3: field `material[1].name` is missing: say what the material is called");
    EXPECT_EQ(refusal("material { name: 'a' label: 1 }\nmaterial { name: 'a' label: 2 }"),
              "s:3: field `material[1].name` = \"a\" is also what material[0] is called: give each material "
              "a name of "
              "its own");
}

TEST(MaterialCheck, materialsSayWhereTheyAre) {
    EXPECT_EQ(refusal("\nmaterial { name: 'a' }"),
              "s:3: field `material[0]` does not say where it is: give it from_value, below_value, label or "
              "segment");
    EXPECT_EQ(
        refusal("material { name: 'a'\nfrom_value: 5 below_value: 5 }"),
        "s:3: field `material[0].from_value` = 5 is not below below_value = 5: no voxel is of this material");
    EXPECT_EQ(refusal("material { name: 'a' below_value: -5 }"), "accepted");
    EXPECT_EQ(refusal("material { name: 'a' segment: 'b c' }"), "accepted");
    EXPECT_EQ(refusal("volume { label_path: '' } material { name: 'a'\nlabel: 1 }").find("accepted"),
              std::string::npos);
}

TEST(MaterialCheck, labelsNeedTheirVolume) {
    const ParsedScene parsed =
        parseSceneText("volume { path: 'v' }\nmaterial { name: 'a'\n label: 1 label: 2 }", "s");
    try {
        checkScene(parsed, "s");
        FAIL();
    } catch (const UserError& error) {
        EXPECT_STREQ(
            error.what(),
            "s:3: field `material[0].label[0]` needs volume.label_path: name the file with the labels");
    }
}

TEST(MaterialCheck, segmentsNeedTheirVolume) {
    EXPECT_EQ(refusal("volume { label_path: '' } material { name: 'a'\nsegment: 'b' }").find("accepted"),
              std::string::npos);
}

TEST(MaterialCheck, protectionNeedsSomethingToProtect) {
    const std::string bone = "material { name: 'bone' label: 1 }\n";
    EXPECT_EQ(refusal(bone + "effects { protected_structures { } }"),
              "s:3: field `effects.protected_structures` needs something to protect: set is_protected in at "
              "least one "
              "material");
    EXPECT_EQ(
        refusal(bone + "effects {\nvirtual_fixture { } }"),
        "s:4: field `effects.virtual_fixture` needs something to protect: set is_protected in at least one "
        "material");
    EXPECT_EQ(refusal(bone + "material { name: 'nerve' label: 2 is_protected: true }\n"
                             "effects { protected_structures { } virtual_fixture { } }"),
              "accepted");
}

}  // namespace
}  // namespace bonemill
