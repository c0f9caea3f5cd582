// Looks at a lesson's pixels: the list of scenes with their pictures, and the summary of an attempt; and at
// the sessions to choose from.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/panel/panel/panel.h"
#include "tests/gl/golden.h"
#include "tests/support/class_lesson.h"
#include "tests/support/controlled_panel.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr int kScreenWidth = 1280, kScreenHeight = 800;

std::string scenePng() {
    Picture picture(160, 120);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            uint8_t* const pixel = picture.row(y) + 3 * x;
            pixel[0] = uint8_t(x + 60);
            pixel[1] = uint8_t(2 * y);
            pixel[2] = 40;
        }
    const test::TemporaryFolder folder;
    writePng(picture, folder.path() / "scene.png");
    return test::readFile(folder / "scene.png");
}

class LessonPicture : public testing::Test, protected test::ControlledPanel {
  protected:
    LessonPicture() {
        for (int n : {0, 1}) lesson_.mutable_scenes(n)->set_picture(scenePng());
        session_.lesson = &lesson_;
        session_.time_s = 100;
    }
    // Draws it over a mid-grey picture.
    Picture draw() {
        for (int n = 0; n < 3; ++n) layOut(kScreenWidth, kScreenHeight);
        const GlApi& gl = context_.gl();
        gl.ClearColor(0.5f, 0.5f, 0.5f, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        painter_.paint(panel_, kScreenWidth, kScreenHeight);
        return context_.read();
    }
    void endAttempt() {
        draw();
        session_.time_s += 100;
        *lesson_.add_attempts() = lesson_.attempts(1);
        lesson_.mutable_attempts(2)->set_number(3);
    }

    topics::Lesson lesson_ = test::makeLesson();
    OsmesaContext context_{kScreenWidth, kScreenHeight};
    PanelPainter painter_{context_.gl()};
};

double coveredShare(const Picture& picture) {
    size_t count = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) count += picture.at(x, y) != picture.at(640, 500);
    return double(count) / (kScreenWidth * kScreenHeight);
}

TEST_F(LessonPicture, TheListOfScenes) {
    lesson_.mutable_scenes(1)->set_is_made_first(true);
    switchPanel();
    EXPECT_EQ(test::goldenProblem(draw(), "lesson_scenes"), "");
}

TEST_F(LessonPicture, SessionsToChooseFrom) {
    session_.lesson = nullptr;
    session_.offered = {{4, "session 4: tooth_corridor since 14:05:09 on lab-pc-2"},
                        {9, "session 9: skull since 14:07:30 on lab-pc-3"}};
    EXPECT_EQ(test::goldenProblem(draw(), "session_choice"), "");
}

TEST_F(LessonPicture, TheSummaryOfAnAttempt) {
    session_.class_folder = "/class";
    session_.has_launcher = true;
    endAttempt();
    lesson_.mutable_attempts(2)->mutable_verdict()->set_results("third");
    EXPECT_EQ(test::goldenProblem(draw(), "lesson_summary"), "");
}

TEST_F(LessonPicture, AQuestionInTheMiddle) {
    status_.set_removed_mm3(4.97);
    lesson_.set_is_running(true);
    lesson_.set_trainee("Anna");
    controls_.act(Action::kNextScene, session_, wishes_);
    switchPanel();
    EXPECT_EQ(test::goldenProblem(draw(), "question"), "");
}

// Figures and messages take a tenth, as the quiet screen has them; a sixth is the most.
TEST_F(LessonPicture, WhatStandsOverThePictureIsSmall) {
    EXPECT_LT(coveredShare(draw()), 0.05) << "task and handle";
    endAttempt();
    const double summary = coveredShare(draw());
    EXPECT_GT(summary, 0.01);
    EXPECT_LT(summary, 1.0 / 6 - 0.06) << "with figures of 6 % it stays below a sixth";
    lesson_.set_changing_to("pedicle");
    EXPECT_LT(coveredShare(draw()), 1.0 / 6 - 0.06);
}

}  // namespace
}  // namespace bonemill
