#include "haptic_server/server/session/result_files.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

class ResultFilesTest : public testing::Test {
  protected:
    ServerOptions options() const {
        ServerOptions options;
        options.trace = folder_ / "trace.csv";
        options.save.difference = folder_ / "case.nrrd";
        return options;
    }
    const test::TemporaryFolder folder_;
};

TEST_F(ResultFilesTest, LaterScenesCountOn) {
    ResultFiles results(options(), {});
    EXPECT_EQ(results.next("b").trace, folder_ / "trace_2.csv");
    EXPECT_EQ(results.next("c").trace, folder_ / "trace_2.csv") << "the other one was refused";
    results.take(results.next("c"));
    EXPECT_EQ(results.next("d").trace, folder_ / "trace_3.csv");
    EXPECT_EQ(results.next("d").scene, "d");
    ServerOptions device = options();
    device.trace = "/dev/null";
    EXPECT_EQ(ResultFiles(device, {}).next("b").trace, "/dev/null");
}

TEST_F(ResultFilesTest, WhatAnySceneReadsIsSpared) {
    const NamedFile scan{"the scene's volume.path", folder_ / "case_2.nrrd"};
    ResultFiles results(options(), {scan});
    EXPECT_EQ(results.next("b").save.difference, folder_ / "case_3.nrrd");
    EXPECT_EQ(results.next("b").trace, folder_ / "trace_3.csv") << "all of a scene have one number";
    EXPECT_THROW(ResultFiles(options(), {{"the scene's volume.path", folder_ / "case.nrrd"}}), UserError);
}

// A scan may be a folder: none of its slices is a result's place, whatever name leads there.
TEST_F(ResultFilesTest, AFolderThatASceneReadsIsSpared) {
    namespace fs = std::filesystem;
    const fs::path series = folder_ / "series", slice = series / "sub" / "0001.dcm";
    fs::create_directories(slice.parent_path());
    test::writeFile(slice.string(), "a slice");
    fs::create_directory_symlink(series, folder_ / "link");
    fs::create_hard_link(slice, folder_ / "hard.csv");
    fs::create_symlink(slice, folder_ / "soft.csv");
    const std::vector<NamedFile> read{{"the scene's volume.path", series}};
    for (const fs::path& path :
         {slice, series / "new.csv", fs::path(folder_ / "link/sub/0001.dcm"), fs::path(folder_ / "hard.csv"),
          fs::path(folder_ / "soft.csv"), series / "sub" / ".." / "new.csv"}) {
        ServerOptions into = options();
        into.trace = path.string();
        EXPECT_THROW(ResultFiles(into, read), UserError) << path;
        into = options();
        into.class_table = path.string();
        EXPECT_THROW(ResultFiles(into, read), UserError) << path;
    }
    ServerOptions beside = options();
    beside.trace = folder_ / "series_of_mine.csv";
    beside.report = "/dev/null";
    EXPECT_NO_THROW(ResultFiles(beside, read));
    EXPECT_EQ(test::readFile(slice.string()), "a slice");
}

TEST_F(ResultFilesTest, WhatIsThereIsSpared) {
    test::writeFile(folder_ / "trace_2.csv", "of yesterday");
    std::filesystem::create_symlink(folder_ / "elsewhere", folder_ / "trace_3.csv");
    EXPECT_EQ(ResultFiles(options(), {}).next("b").trace, folder_ / "trace_4.csv");
    // The first scene's own files come at its end.
    ServerOptions crossed = options();
    crossed.save.mesh = folder_ / "mesh_2.stl", crossed.trace = folder_ / "mesh.stl";
    EXPECT_EQ(ResultFiles(crossed, {}).next("b").trace, folder_ / "mesh_3.stl");
}

}  // namespace
}  // namespace bonemill
