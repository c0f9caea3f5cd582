#include <gtest/gtest.h>

#include <fstream>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

class DetachedData : public testing::Test {
  protected:
    std::vector<std::string> namesIn(const std::string& name, const std::string& header) const {
        std::ofstream(folder_ / name, std::ios::binary) << header;
        std::vector<std::string> names;
        for (const auto& path : detachedDataOf(folder_ / name)) {
            const bool is_here = path.parent_path() == folder_.path();
            names.push_back(is_here ? path.filename().string() : path.string());
        }
        return names;
    }
    using Names = std::vector<std::string>;
    test::TemporaryFolder folder_;
};

TEST_F(DetachedData, OfNrrd) {
    const std::string begin = "NRRD0004\n# data file: comment.raw\ntype: short\n";
    EXPECT_EQ(namesIn("a.nhdr", begin + "data file: a.raw\n"), Names{"a.raw"});
    EXPECT_EQ(namesIn("b.NRRD", begin + "Data File: ./b c.raw\r\n\n"), Names{"b c.raw"});
    EXPECT_EQ(namesIn("c.nhdr", begin + "datafile: /elsewhere/c.raw\n"), Names{"/elsewhere/c.raw"});
    EXPECT_EQ(namesIn("d.nhdr", begin + "data file: LIST\n1.raw\n2.raw\n"), (Names{"1.raw", "2.raw"}));
    EXPECT_EQ(namesIn("e.nhdr", begin + "data file: s%02d.raw 9 11 1\n"),
              (Names{"s09.raw", "s10.raw", "s11.raw"}));
    EXPECT_EQ(namesIn("f.nhdr", begin + "data file: s%d.raw 3 1 -2\n"), (Names{"s3.raw", "s1.raw"}));
    EXPECT_EQ(namesIn("g.nrrd", begin + "\ndata file: voxels.raw\n"), Names{}) << "voxels are no header";
}

TEST_F(DetachedData, OfMetaImage) {
    EXPECT_EQ(namesIn("a.mhd", "NDims = 3\nElementDataFile = a.zraw\n"), Names{"a.zraw"});
    EXPECT_EQ(namesIn("b.mha", "NDims = 3\nElementDataFile = LOCAL\nElementDataFile = b.raw\n"), Names{});
    EXPECT_EQ(namesIn("c.mhd", "NDims = 3\nElementDataFile = LIST\n1.raw\n"), Names{"1.raw"});
}

TEST_F(DetachedData, WhatMakesNoSenseNamesNothing) {
    for (const char* pattern :
         {"%s%n 1 2 1", "%d", "%99999d 1 2 1", "%d 1 2 0", "%", "%d 1 99999999999999 1"})
        EXPECT_EQ(namesIn("a.nhdr", std::string("NRRD0004\ndata file: ") + pattern + "\n").size(), 0u)
            << pattern;
    EXPECT_EQ(namesIn("a.nii", "NRRD0004\ndata file: a.raw\n"), Names{});
    EXPECT_EQ(namesIn("empty.mhd", ""), Names{});
    EXPECT_TRUE(detachedDataOf(folder_ / "missing.nhdr").empty());
    EXPECT_THROW(namesIn("many.nhdr", "NRRD0004\ndata file: %d 1 999999999 1\n"), UserError);
}

TEST_F(DetachedData, BelongsToTheFilesOfItsScene) {
    std::ofstream(folder_ / "v.nhdr") << "NRRD0004\ndata file: v.raw\n";
    std::ofstream(folder_ / "s.textproto") << "name: 's' volume { path: 'v.nhdr' iso_value: 600 }";
    const auto files = filesOf(loadScene(folder_ / "s.textproto"));
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[2].name, "the scene's volume.path, its data");
    EXPECT_EQ(files[2].path.string(), folder_ / "v.raw");
}

}  // namespace
}  // namespace bonemill
