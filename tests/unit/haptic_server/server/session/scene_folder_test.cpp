#include "haptic_server/teaching/lessons/scene_folder.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

class SceneFolder : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        test::writeFile(folder_ / name, text);
    }
    std::vector<ListedScene> listedScenes() const { return listScenes({folder_.path()}); }
    const test::TemporaryFolder folder_;
};

const std::string kPng = "\x89PNG\r\n\x1a\n rest";

TEST_F(SceneFolder, SaysWhatATraineeWantsToKnow) {
    write("v.nrrd", "");
    write("b.textproto",
          "volume { path: 'v.nrrd' } title: 'Cavity' task: 'Open it.' expected_minutes: 5 "
          "tool { name: 'fine' }");
    write("b.png", kPng);
    write("a.textproto", "volume { path: 'v.nrrd' } name: 'named'");
    write("a.png", "no picture");
    write("notes.txt", "no scene");
    const auto scenes = listedScenes();
    ASSERT_EQ(scenes.size(), 2u);
    EXPECT_EQ(scenes[0].choice.id(), "a");
    EXPECT_EQ(scenes[0].choice.title(), "named");
    EXPECT_EQ(scenes[0].choice.picture(), "");
    const topics::SceneChoice& cavity = scenes[1].choice;
    EXPECT_EQ(cavity.title(), "Cavity");
    EXPECT_EQ(cavity.task(), "Open it.");
    EXPECT_EQ(cavity.expected_s(), 300);
    EXPECT_EQ(cavity.tools(0), "fine");
    EXPECT_EQ(cavity.picture(), kPng);
    EXPECT_EQ(cavity.problem(), "");
    EXPECT_EQ(idOfScene(scenes, folder_ / "b.textproto"), "b");
    EXPECT_EQ(idOfScene(scenes, folder_ / "c.textproto"), "");
}

TEST_F(SceneFolder, WhatAMakerMakesIsNoProblem) {
    write("late.textproto", "volume { path: 'late.nrrd' }");
    write("lost.textproto", "volume { path: 'lost.nrrd' }");
    const auto scenes = listScenes({folder_.path()}, {"maker", {"late"}});
    ASSERT_EQ(scenes.size(), 2u);
    EXPECT_TRUE(scenes[0].choice.is_made_first());
    EXPECT_EQ(scenes[0].choice.problem(), "");
    EXPECT_FALSE(scenes[1].choice.is_made_first());
    EXPECT_NE(scenes[1].choice.problem(), "");
    EXPECT_NE(sceneTable(scenes).find("made when it is chosen"), std::string::npos);
    EXPECT_TRUE(lacksFiles(scenes[0]));
    EXPECT_THROW(makeMissing(scenes[0], {"/bin/true", {}}), UserError) << "it is still not there";
    write("late.nrrd", "");
    EXPECT_FALSE(lacksFiles(scenes[0]));
    EXPECT_NO_THROW(makeMissing(scenes[0], {"/bin/true", {}}));
}

TEST_F(SceneFolder, ABrokenSceneIsListedWithItsProblem) {
    write("bad.textproto", "volume { pth: 'x' }");
    write("lost.textproto", "volume { path: 'lost.nrrd' }");
    test::writeFile(folder_ / "big.png", kPng + std::string(kMaxPictureBytes, 'x'));
    write("big.textproto", "volume { path: 'big.png' }");
    const auto scenes = listedScenes();
    ASSERT_EQ(scenes.size(), 3u);
    EXPECT_NE(scenes[0].choice.problem().find("pth"), std::string::npos);
    EXPECT_EQ(scenes[1].choice.problem(), "");
    EXPECT_EQ(scenes[1].choice.picture(), "") << "it is too large";
    EXPECT_NE(scenes[2].choice.problem().find("lost.nrrd: no such file"), std::string::npos);
    for (const auto& scene : scenes)
        EXPECT_EQ(scene.choice.problem().find(folder_ / ""), std::string::npos) << "folders of this PC";
    EXPECT_NE(sceneTable(scenes).find("cannot be chosen"), std::string::npos);
}

TEST_F(SceneFolder, OfTwoFilesOfOneNameTheFirstCounts) {
    write("v.nrrd", "");
    write("a.textproto", "volume { path: 'v.nrrd' } title: 'shipped'");
    write("bad name.textproto", "volume { path: 'v.nrrd' }");
    const test::TemporaryFolder own;
    test::writeFile(own / "a.textproto", "volume { path: 'v.nrrd' } title: 'own'");
    test::writeFile(own / "0.textproto", "volume { path: '/' }");
    const auto scenes = listScenes({folder_.path(), own.path()});
    ASSERT_EQ(scenes.size(), 2u);
    EXPECT_EQ(scenes[0].choice.title(), "shipped");
    EXPECT_EQ(scenes[1].choice.id(), "0");
    EXPECT_THROW(listScenes({own / "none"}), UserError);
}

TEST_F(SceneFolder, ThereIsABoundToThem) {
    for (size_t n = 0; n < kMaxListedScenes + 2; ++n)
        write("s" + std::to_string(n) + ".textproto", "volume { path: '/' }");
    EXPECT_EQ(listedScenes().size(), kMaxListedScenes);
}

}  // namespace
}  // namespace bonemill
