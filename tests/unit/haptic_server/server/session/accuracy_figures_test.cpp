#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "haptic_server/teaching/lessons/scene_folder.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

class AccuracyFiguresFile : public testing::Test {
  protected:
    AccuracyFigures read(const std::string& content) const {
        test::writeFile(file(), content);
        return readAccuracyFigures(file());
    }
    // Returns why the content is refused; the message must name the file.
    std::string refusal(const std::string& content) const {
        test::writeFile(file(), content);
        return refusalOf(file());
    }
    static std::string refusalOf(const std::string& file) {
        try {
            readAccuracyFigures(file);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).rfind(file + ": ", 0), 0u) << error.what();
            return error.what();
        }
        return "accepted";
    }
    std::string file() const { return folder_ / "s.accuracy.json"; }

    test::TemporaryFolder folder_;
};

TEST_F(AccuracyFiguresFile, GivesTheErrorsOfEverySetting) {
    const AccuracyFigures figures = read(R"({"scene": "slab", "settings": {
        "balanced": {"force_error_percent": 0.8, "direction_error_deg": 0.4, "tick_p99_us": 120},
        "gradient s=2 q=2 grid x1 float iterations=1 ccd": {"force_error_percent": 3, "direction_error_deg": 1.5}}})");
    ASSERT_EQ(figures.size(), 2u);
    EXPECT_EQ(figures.at("balanced").force_error_percent, 0.8);
    EXPECT_EQ(figures.at("balanced").direction_error_deg, 0.4);
    EXPECT_EQ(figures.at("gradient s=2 q=2 grid x1 float iterations=1 ccd").force_error_percent, 3.0);
}

TEST_F(AccuracyFiguresFile, WithoutSettingsHasNoFigures) {
    EXPECT_TRUE(read(R"({"settings": {}})").empty());
}

TEST_F(AccuracyFiguresFile, RefusesAMissingOrWrongFieldByName) {
    EXPECT_NE(refusal("{}").find("settings"), std::string::npos);
    EXPECT_NE(refusal(R"({"settings": {"fast": {"force_error_percent": 1}}})").find("direction_error_deg"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"settings": {"fast": {"direction_error_deg": 1}}})").find("force_error_percent"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"settings": {"fast": {"force_error_percent": "1", "direction_error_deg": 1}}})"),
              "accepted");
    EXPECT_NE(refusal(R"({"settings": {"fast": 1}})"), "accepted");
    EXPECT_NE(refusal("[]"), "accepted");
}

TEST_F(AccuracyFiguresFile, RefusesWhatIsNotJson) {
    EXPECT_NE(refusal("volume { path: 'v' }").find("accuracy-report"), std::string::npos);
    EXPECT_NE(refusal(""), "accepted");
    EXPECT_NE(refusal(R"({"settings": {)"), "accepted");
}

TEST_F(AccuracyFiguresFile, RefusesAFileThatIsNotThere) {
    EXPECT_NE(refusalOf(folder_ / "none.json").find("cannot be read"), std::string::npos);
}

TEST(AccuracyFigures, LieBesideTheScene) {
    EXPECT_EQ(accuracyFiguresOf("scenes/skull.textproto"), "scenes/skull.accuracy.json");
    EXPECT_EQ(accuracyFiguresOf("skull"), "skull.accuracy.json");
}

}  // namespace
}  // namespace bonemill
