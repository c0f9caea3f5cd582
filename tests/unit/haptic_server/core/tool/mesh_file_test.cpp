#include "haptic_server/scans/solid_mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "common/base/user_error.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/core/tool/mesh_test_support.h"

namespace bonemill {
namespace {

using test::TriangleSoup;

const TriangleSoup kBox = test::boxSoup({-1, -1.25f, -1.5f}, {1, 12.1f, 1.7f});

class MeshFile : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        test::writeBytes(folder_ / name, bytes);
        return folder_ / name;
    }

    // The tool is refused with one message that names the file.
    void expectRefused(const std::filesystem::path& path, const std::string& words) {
        ToolConfig config;
        config.mesh_path = path;
        try {
            buildTool(config);
            ADD_FAILURE() << path << " was accepted, expected: " << words;
        } catch (const UserError& e) {
            EXPECT_EQ(std::string(e.what()).find(path.string()), 0u) << e.what();
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
        }
    }

    test::TemporaryFolder folder_;
};

TEST_F(MeshFile, EveryFormatGivesTheSameCorners) {
    const auto expected = test::cornersOf(kBox);
    EXPECT_EQ(readMeshFile(write("box.stl", test::binaryStl(kBox))), expected);
    EXPECT_EQ(readMeshFile(write("BOX.STL", test::binaryStl(kBox))), expected);
    EXPECT_EQ(readMeshFile(write("text.stl", test::textStl(kBox))), expected);
    EXPECT_EQ(readMeshFile(write("box.obj", test::obj(kBox))), expected);
}

TEST_F(MeshFile, BinaryMayStartWithSolid) {
    std::string bytes = test::binaryStl(kBox);
    std::memcpy(bytes.data(), "solid", 5);
    EXPECT_EQ(readMeshFile(write("solid.stl", bytes)), test::cornersOf(kBox));
}

TEST_F(MeshFile, CutsUpQuads) {
    const std::string text =
        "# cube\no tool\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
        "l 1 2\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    const TriangleMesh mesh = closedMesh(readMeshFile(write("cube.obj", text)), "cube.obj");
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST_F(MeshFile, MissingOrNoFile) {
    expectRefused(folder_ / "nowhere.stl", "there is no such mesh file");
    std::filesystem::create_directories(folder_ / "folder.stl");
    expectRefused(folder_ / "folder.stl", "not a file");
    expectRefused(write("tool.step", "ISO-10303-21;"), "is an .stl or .obj file");
    expectRefused(write("tool", "solid"), "is an .stl or .obj file");
}

TEST_F(MeshFile, Empty) {
    expectRefused(write("empty.stl", ""), "the file is empty");
    expectRefused(write("empty.obj", ""), "the file is empty");
    expectRefused(write("none.stl", test::binaryStl({})), "holds no triangles");
    expectRefused(write("header.stl", std::string(40, '\0')), "not an STL file");
    expectRefused(write("comment.obj", "# nothing here, really nothing at all\n"), "");
    expectRefused(write("solid.stl", "solid tool\nendsolid tool\n"), "");
}

TEST_F(MeshFile, TextGarbage) {
    std::string garbage;
    while (garbage.size() < 5000) garbage += "Dear sir, please find enclosed the drill. <xml/> ";
    expectRefused(write("letter.stl", garbage), "damaged or not an STL file");
    expectRefused(write("letter.obj", garbage), "");
    expectRefused(write("solid.stl", "solid " + garbage), "");
}

TEST_F(MeshFile, Truncated) {
    const std::string binary = test::binaryStl(kBox), text = test::textStl(kBox), obj = test::obj(kBox);
    expectRefused(write("binary.stl", binary.substr(0, binary.size() - 30)),
                  "announces 12 triangles, which take 684 bytes, but it has 654");
    expectRefused(write("text.stl", text.substr(0, text.size() / 2)), "");
    expectRefused(write("box.obj", obj.substr(0, obj.size() - 20)), "");
}

TEST_F(MeshFile, HugeCount) {
    std::string bytes = test::binaryStl(kBox);
    const uint32_t count = 0xFFFFFFFF;
    std::memcpy(bytes.data() + 80, &count, sizeof count);
    expectRefused(write("huge.stl", bytes), "announces 4294967295 triangles");
    expectRefused(write("huge.obj", test::obj(kBox) + "f 1 2 4000000000\n"), "");
    expectRefused(write("negative.obj", test::obj(kBox) + "f -1 -2 -4000\n"), "");
}

TEST_F(MeshFile, FacesOfVeryManyCorners) {
    const auto disk = [](int corners) {
        std::string points, face = "f";
        for (int n = 0; n < corners; ++n) {
            const double angle = 2 * M_PI * n / corners;
            points += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
            face += " " + std::to_string(n + 1);
        }
        return points + face + "\n";
    };
    EXPECT_EQ(readMeshFile(write("disk.obj", disk(1000))).size(), 3u * 998);
    expectRefused(write("disk.obj", disk(20000)), "has a face of 20000 corners, more than 1000");
}

TEST_F(MeshFile, Open) {
    TriangleSoup soup = kBox;
    soup.pop_back();
    for (const auto& [name, bytes] : {std::pair("open.stl", test::binaryStl(soup)),
                                      {"text.stl", test::textStl(soup)},
                                      {"open.obj", test::obj(soup)}})
        expectRefused(write(name, bytes), "not closed: 3 edges have one triangle only");
}

TEST_F(MeshFile, NotANumber) {
    TriangleSoup soup = kBox;
    soup[2][1].z() = std::nanf("");
    expectRefused(write("binary.stl", test::binaryStl(soup)), "1 of 36 triangle corners are not finite");
    expectRefused(write("text.stl", test::textStl(soup)), "not finite");
    expectRefused(write("box.obj", test::obj(soup)), "not finite");
}

TEST_F(MeshFile, PartsThroughEachOther) {
    TriangleSoup soup = test::boxSoup({-1, -1, -1}, {1, 8, 1});
    const TriangleSoup other = test::boxSoup({-0.5f, 6, -0.5f}, {0.5f, 12, 0.5f});
    soup.insert(soup.end(), other.begin(), other.end());
    expectRefused(write("overlap.stl", test::binaryStl(soup)), "merge them into one solid");
}

TEST_F(MeshFile, OnePartInsideOut) {
    TriangleSoup soup = test::boxSoup({-1, -1, -1}, {1, 8, 1});
    const TriangleSoup other = test::insideOut(test::boxSoup({-1, 9, -1}, {1, 11, 1}));
    soup.insert(soup.end(), other.begin(), other.end());
    expectRefused(write("turned.stl", test::binaryStl(soup)), "inside out");
}

}  // namespace
}  // namespace bonemill
