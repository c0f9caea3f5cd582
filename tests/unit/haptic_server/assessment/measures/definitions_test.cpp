#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "haptic_server/assessment/measures/figure.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

TEST(Definitions, EachHasItsOwnNameAndWords) {
    std::set<std::string> ids, labels;
    for (const Definition& definition : techniqueDefinitions()) {
        EXPECT_TRUE(ids.insert(definition.id).second) << definition.id;
        EXPECT_TRUE(labels.insert(definition.label).second) << definition.label;
        EXPECT_GE(definition.version, 1);
    }
}

// The page has a row "| `id` | version |" for each.
TEST(Definitions, EachStandsInThePageWithItsVersion) {
    std::ifstream file(test::sourceDir() + "/docs/reference/assessment.md");
    std::ostringstream page;
    page << file.rdbuf();
    for (const Definition& definition : techniqueDefinitions()) {
        const std::string row =
            "| `" + std::string(definition.id) + "` | " + std::to_string(definition.version) + " | ";
        EXPECT_NE(page.str().find(row), std::string::npos) << row;
    }
}

TEST(Definitions, AFigureNamesWhatItIsOf) {
    Figures figures;
    put(figures, "damage.volume", 0.8, "nerve");
    put(figures, "force.mean", std::nan(""));
    ASSERT_EQ(figures.size(), 1) << "what has no value is left out";
    EXPECT_EQ(figures[0].id, "damage.volume:nerve");
    EXPECT_EQ(figures[0].label, "Cut of this structure: nerve");
    EXPECT_EQ(figures[0].unit, "mm3");
}

}  // namespace
}  // namespace bonemill
