// Damaged mesh files end in a tool or in a UserError, never in anything else.
//
// BONEMILL_FUZZ_RUNS is the number of files per format (default 400). BONEMILL_FUZZ_SEED is the first seed
// (default 1); each file has its own, printed when it fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <random>

#include "common/base/user_error.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/support/stl_writer.h"
#include "tests/support/temporary_folder.h"

// Under AddressSanitizer this is needed: assimp 5.2 forgets what it had read of some damaged files. The
// program ends there anyway.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libassimp";
}

namespace bonemill {
namespace {

unsigned fromEnvironment(const char* name, unsigned otherwise) {
    const char* text = std::getenv(name);
    return text ? unsigned(std::strtoul(text, nullptr, 10)) : otherwise;
}

class Corruption {
  public:
    explicit Corruption(unsigned seed) : random_(seed) {}

    std::string of(std::string bytes) {
        for (size_t n = 1 + below(4); n > 0; --n) corruptOnce(bytes);
        return bytes;
    }

  private:
    size_t below(size_t limit) { return std::uniform_int_distribution<size_t>(0, limit - 1)(random_); }

    void corruptOnce(std::string& bytes) {
        static const std::vector<std::string> kTokens = {"nan",
                                                         "-inf",
                                                         "1e999",
                                                         "-0",
                                                         "99999999999999999999",
                                                         "\n",
                                                         " ",
                                                         "\r",
                                                         "\\",
                                                         "facet",
                                                         "endloop",
                                                         "solid",
                                                         "f 1 2 3\n",
                                                         "f 1/1/1 2//2 -1\n",
                                                         "v 1\n",
                                                         "vn",
                                                         "f",
                                                         "l 1 2 3\n",
                                                         "usemtl x\n",
                                                         "mtllib x.mtl\n",
                                                         "g\n",
                                                         std::string(1, '\0'),
                                                         std::string(4, '\xff'),
                                                         "endsolid",
                                                         "outer loop",
                                                         "vertex"};
        if (bytes.empty()) bytes = "x";
        const size_t at = below(bytes.size());
        const size_t length = std::min(bytes.size() - at, 1 + below(200));
        switch (below(7)) {
            case 0:
                bytes[at] = char(below(256));
                break;
            case 1:
                bytes[at] = char(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3:
                bytes.erase(at, length);
                break;
            case 4:
                bytes.insert(below(bytes.size()), bytes.substr(at, length));
                break;
            case 5:
                bytes.insert(at, kTokens[below(kTokens.size())]);
                break;
            default:
                for (size_t i = at; i < at + std::min<size_t>(length, 16); ++i) bytes[i] = char(below(256));
        }
    }

    std::mt19937 random_;
};

class MeshFileFuzz : public testing::Test {
  protected:
    void corruptMany(const std::string& extension, const std::string& sound_bytes) {
        const std::string path = folder_ / ("mesh" + extension);
        ToolConfig config;
        config.sdf_nodes = {6, 12, 6};
        config.sdf_spacing = 0.6e-3;
        config.mesh_path = path;
        const unsigned first = fromEnvironment("BONEMILL_FUZZ_SEED", 1);
        const unsigned runs = fromEnvironment("BONEMILL_FUZZ_RUNS", 400);
        std::cout << "seeds " << first << " to " << first + runs - 1 << std::endl;
        unsigned refused = 0;
        for (unsigned seed = first; seed < first + runs; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            test::writeBytes(path, Corruption(seed).of(sound_bytes));
            refused += isRefused(config);
            std::filesystem::remove(path);  // some file systems flush a file that is overwritten
        }
        std::cout << refused << " of " << runs << " refused" << std::endl;
        EXPECT_GT(refused, 0u);
    }

    static bool isRefused(const ToolConfig& config) {
        try {
            const TriangleSurface surface = toolSurface(config);
            EXPECT_FALSE(surface.indices.empty());
            const BuiltTool tool = buildTool(config);
            EXPECT_FALSE(tool.model.grid().box().isEmpty());
            return false;
        } catch (const UserError& e) {
            EXPECT_NE(std::string(e.what()), "");
            return true;
        } catch (const std::exception& e) {
            ADD_FAILURE() << "not a UserError: " << e.what();
            return true;
        }
    }

    test::TemporaryFolder folder_;
    const test::TriangleSoup ball_ = test::ballSoup(6, {0, 0, 0}, [](const auto&) { return 1.3; });
};

TEST_F(MeshFileFuzz, BinaryStl) {
    corruptMany("binary.stl", test::binaryStl(ball_));
}
TEST_F(MeshFileFuzz, TextStl) {
    corruptMany("text.stl", test::textStl(ball_));
}
TEST_F(MeshFileFuzz, Obj) {
    corruptMany("mesh.obj", test::obj(ball_));
}

// The checks between the file and the library hide most damage to a binary STL from it: keep its
// length right.
TEST_F(MeshFileFuzz, BinaryStlOfTheRightLength) {
    const std::string sound = test::binaryStl(ball_);
    const std::string path = folder_ / "length.stl";
    ToolConfig config;
    config.sdf_nodes = {6, 12, 6};
    config.sdf_spacing = 0.6e-3;
    config.mesh_path = path;
    const unsigned first = fromEnvironment("BONEMILL_FUZZ_SEED", 1);
    const unsigned runs = fromEnvironment("BONEMILL_FUZZ_RUNS", 400);
    std::cout << "seeds " << first << " to " << first + runs - 1 << std::endl;
    unsigned refused = 0;
    for (unsigned seed = first; seed < first + runs; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::string bytes = sound;
        std::mt19937 random(seed);
        for (int n = 0; n < 8; ++n) bytes[84 + random() % (bytes.size() - 84)] = char(random());
        test::writeBytes(path, bytes);
        refused += isRefused(config);
        std::filesystem::remove(path);
    }
    EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace bonemill
