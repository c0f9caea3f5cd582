// Each bad input gives one clear message on one line, exit code 2, and nothing else.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::run;
using test::TemporaryFolder;
using test::writeFile;

class BadInput : public testing::Test {
  protected:
    BadInput() {
        writeFile(folder_ / "t.csv",
                  "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n0,0,0,0,1,0,0,0,0\n0.001,0,0,0,1,0,0,0,0\n");
        const auto made = run({"make_phantom", "body", "--kind", "sphere", "--out", folder_ / "ball.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
    }
    std::string sceneOf(const std::string& text) {
        writeFile(folder_ / "scene.textproto", text);
        return folder_ / "scene.textproto";
    }
    std::string ball() { return sceneOf("volume { path: \"ball.nrrd\" }"); }

    void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
        const auto finished = run(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_EQ(finished.out, "");
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
        EXPECT_EQ(finished.err.rfind("error: ", 0), 0u) << finished.err;
        for (const std::string& word : words)
            EXPECT_NE(finished.err.find(word), std::string::npos) << word << " in: " << finished.err;
    }
    void expectSceneRefused(const std::string& text, const std::vector<std::string>& words) {
        expectRefused(
            {"haptic_server", "simulate", "--scene", sceneOf(text), "--trajectory", folder_ / "t.csv"},
            words);
    }

    TemporaryFolder folder_;
};

TEST_F(BadInput, TheGoodCaseIsAccepted) {
    const auto finished =
        run({"haptic_server", "simulate", "--scene", ball(), "--trajectory", folder_ / "t.csv"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
}

TEST_F(BadInput, MissingSceneFile) {
    expectRefused({"haptic_server", "--scene", folder_ / "none.textproto"}, {"none.textproto"});
    expectRefused({"haptic_server", "simulate", "--scene", folder_ / "none.textproto", "--trajectory",
                   folder_ / "t.csv"},
                  {"none.textproto"});
    expectRefused({"device_daemon", "--scene", folder_ / "none.textproto"}, {"none.textproto"});
}

TEST_F(BadInput, MissingVolumeFile) {
    expectSceneRefused("volume { path: \"gone.nrrd\" }", {"gone.nrrd"});
}

// Opening a pipe waits for its writer, and a device may never end.
TEST_F(BadInput, PipesAndDevicesInsteadOfFiles) {
    ASSERT_EQ(mkfifo((folder_ / "pipe.nrrd").c_str(), 0600), 0);
    const std::string pipe = folder_ / "pipe.nrrd";
    for (const std::string& path : {pipe, std::string("/dev/zero")}) {
        const std::vector<std::string> words{path, "named pipe"};
        expectSceneRefused("volume { path: \"" + path + "\" }", words);
        expectSceneRefused("volume { path: \"ball.nrrd\" label_path: \"" + path +
                               "\" }\nmaterial { name: \"bone\" label: 1 }",
                           words);
        expectRefused({"haptic_server", "simulate", "--scene", ball(), "--trajectory", path}, words);
        expectRefused({"haptic_server", "--scene", ball(), "--session", "941", "--accuracy", path}, words);
        expectRefused({"haptic_server", "--scene", path}, {path, "not a file"});
    }
    writeFile(folder_ / "detached.nhdr",
              "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 4 4\nspacings: 1 1 1\nencoding: raw\n"
              "endian: little\ndata file: pipe.nrrd\n");
    expectSceneRefused("volume { path: \"detached.nhdr\" }", {"pipe.nrrd", "named pipe"});
    std::filesystem::rename(folder_ / "pipe.nrrd", folder_ / "pipe.stl");
    expectSceneRefused("volume { path: \"ball.nrrd\" }\ntool { mesh_path: \"pipe.stl\" }",
                       {"pipe.stl", "not a file"});
}

TEST_F(BadInput, EmptyFolder) {
    std::filesystem::create_directory(folder_ / "empty");
    expectSceneRefused("volume { path: \"empty\" }", {"empty"});
}

TEST_F(BadInput, TextInsteadOfDicom) {
    std::filesystem::create_directory(folder_ / "texts");
    writeFile(folder_ / "texts/slice.dcm", "this is a letter, not a picture\n");
    expectSceneRefused("volume { path: \"texts\" }", {"texts"});
}

TEST_F(BadInput, TruncatedSlice) {
    ASSERT_EQ(run({"make_phantom", "tooth", "--out", folder_ / "tooth"}).exit_code, 0);
    const std::string slice = folder_ / "tooth/slice_0080.dcm";
    std::filesystem::resize_file(slice, std::filesystem::file_size(slice) * 6 / 10);
    expectSceneRefused("volume { path: \"tooth\" }", {"slice_0080.dcm"});
}

TEST_F(BadInput, MisspeltField) {
    expectSceneRefused("volume { path: \"ball.nrrd\" }\nefects { spindle {} }",
                       {"scene.textproto:2", "efects", "effects"});
}

TEST_F(BadInput, NegativeRadius) {
    expectSceneRefused("volume { path: \"ball.nrrd\" }\ntool {\n  burr_radius_mm: -1\n}",
                       {"scene.textproto:3", "burr_radius_mm", "-1"});
}

TEST_F(BadInput, OctreeLeavesBeyondAllBounds) {
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--dims", "300", "8", "8", "--out",
                   folder_ / "bar.nrrd"})
                  .exit_code,
              0);
    expectSceneRefused(
        "volume { path: \"bar.nrrd\" window_low: 0 window_high: 65535 iso_value: 32768 octree_depth: 1 }",
        {"octree_depth", "leaf_voxels"});
}

TEST_F(BadInput, UnreadableStl) {
    writeFile(folder_ / "tool.stl", "solid nothing\nfacet gibberish\n");
    expectSceneRefused("volume { path: \"ball.nrrd\" }\ntool { mesh_path: \"tool.stl\" }", {"tool.stl"});
    expectSceneRefused("volume { path: \"ball.nrrd\" }\ntool { mesh_path: \"gone.stl\" }", {"gone.stl"});
}

TEST_F(BadInput, BadTrajectories) {
    const auto refuse = [&](const std::string& csv, const std::vector<std::string>& words) {
        writeFile(folder_ / "bad.csv", csv);
        expectRefused({"haptic_server", "simulate", "--scene", ball(), "--trajectory", folder_ / "bad.csv"},
                      words);
    };
    const std::string header = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    refuse("", {"bad.csv"});
    refuse(header, {"bad.csv"});
    refuse("t_s,px_m\n0,0\n", {"bad.csv"});
    refuse(header + "0,0,0,nan,1,0,0,0,0\n", {"bad.csv:2"});
    refuse(header + "0,0,0,0,3,0,0,0,0\n", {"bad.csv:2"});
    refuse(header + "0,0,0,0,1,0,0,0,0\n0,0,0,0,1,0,0,0,0\n", {"bad.csv:3"});
    refuse(header + "0,0,0,0,1,0,0,0,0\n0.5,0,0,0,1,0,0,0,0\n", {"bad.csv:3", "rate_hz"});
}

TEST_F(BadInput, UnwritableOutputs) {
    const std::vector<std::string> base{"haptic_server", "simulate",     "--scene",
                                        ball(),          "--trajectory", folder_ / "t.csv"};
    const auto refuse = [&](const char* option, const char* file, const char* word) {
        auto arguments = base;
        arguments.insert(arguments.end(), {option, folder_ / file});
        expectRefused(arguments, {file, word});
    };
    refuse("--trace", "no/such/folder/file", "folder");
    refuse("--save-volume", "no/such/folder/file.nrrd", "folder");
    refuse("--save-mesh", "no/such/folder/file.ply", "folder");
    refuse("--save-difference", "no/such/folder/file.nrrd", "folder");
    refuse("--save-mesh", "file.obj", ".stl or .ply");
    refuse("--save-difference", "file.nii", ".nrrd");
}

TEST_F(BadInput, WritingOverWhatIsReadOrWritten) {
    const std::string scene = ball(), path = folder_ / "t.csv", volume = folder_ / "ball.nrrd";
    const std::string before = test::readFile(volume);
    std::filesystem::create_symlink("t.csv", folder_ / "link.csv");
    std::filesystem::create_hard_link(volume, folder_ / "hard.nrrd");
    const auto refuse = [&](std::vector<std::string> more, const std::vector<std::string>& words) {
        more.insert(more.begin(), {"haptic_server", "simulate", "--scene", scene, "--trajectory", path});
        expectRefused(more, words);
    };
    refuse({"--trace", path}, {"--trace", "--trajectory", "another file"});
    refuse({"--trace", folder_ / "link.csv"}, {"link.csv", "--trajectory"});
    refuse({"--trace", scene}, {"--trace", "the scene"});
    refuse({"--save-volume", volume}, {"--save-volume", "volume.path"});
    refuse({"--save-difference", folder_ / "hard.nrrd"}, {"hard.nrrd", "volume.path"});
    refuse({"--save-volume", folder_ / "a.nrrd", "--save-difference", folder_ / "./a.nrrd"},
           {"--save-difference", "--save-volume"});
    expectRefused({"haptic_server", "--scene", scene, "--session", "941", "--report", scene},
                  {"--report", "the scene"});
    expectRefused({"make_phantom", "block", "--out", folder_ / "a.nrrd", "--labels", folder_ / "a.nrrd"},
                  {"--labels", "--out"});
    EXPECT_EQ(test::readFile(volume), before);
    EXPECT_NE(test::readFile(path), "");
    EXPECT_NE(test::readFile(scene), "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.nrrd"));
    const auto finished = run({"haptic_server", "simulate", "--scene", scene, "--trajectory", path, "--trace",
                               "/dev/null", "--save-volume", folder_ / "a.nrrd", "--save-mesh",
                               folder_ / "a.ply", "--save-difference", folder_ / "b.nrrd"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
}

TEST_F(BadInput, LeavesTheTraceOfBefore) {
    writeFile(folder_ / "old.csv", "old");
    const std::string gone = sceneOf("volume { path: \"gone.nrrd\" }");
    expectRefused({"haptic_server", "simulate", "--scene", gone, "--trajectory", folder_ / "t.csv", "--trace",
                   folder_ / "old.csv"},
                  {"gone.nrrd"});
    EXPECT_EQ(test::readFile(folder_ / "old.csv"), "old");
    expectRefused({"haptic_server", "--scene", ball(), "--session", "941", "--trace", folder_ / "old.csv",
                   "--export-dir", folder_ / "none"},
                  {"no such folder"});
    EXPECT_EQ(test::readFile(folder_ / "old.csv"), "old");
}

TEST_F(BadInput, LayersThatAreNone) {
    for (const char* layer : {"-1:5", "nan:5", "1:x", "5000000"})
        expectRefused({"make_phantom", "block", "--out", folder_ / "x.nrrd", "--layers", layer},
                      {"--layers", layer});
}

TEST_F(BadInput, WrongArguments) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"haptic_server", "--wrong"},
          {"haptic_server"},
          {"haptic_server", "simulate"},
          {"make_phantom", "body", "--kind", "cube", "--out", folder_ / "x.nrrd"},
          {"device_daemon", "--scene"},
          {"render_client", "--offscreen"}}) {
        const auto finished = run(arguments);
        EXPECT_EQ(finished.exit_code, 2) << arguments[0] << ": " << finished.err;
        EXPECT_NE(finished.err, "");
    }
}

}  // namespace
}  // namespace bonemill
