// The handbook is made of this checkout and this build: every link and anchor leads somewhere, nothing is
// fetched.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

TEST(Handbook, IsWholeAndSaysWhatSourcesAndProgramsSay) {
    if (std::system("command -v mkdocs >/dev/null") != 0) GTEST_SKIP() << "mkdocs is not installed";
    const test::TemporaryFolder folder;
    const std::filesystem::path pages = folder / "handbook";
    const test::Finished made = test::run({test::sourceDir() + "/deploy/packaging/handbook/make-handbook",
                                           "--programs", test::binDir(), pages.string()});
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
    const auto expectIn = [&](const char* page, const std::string& text) {
        EXPECT_NE(test::readFile(pages / page).find(text), std::string::npos) << page << ": " << text;
    };
    expectIn("index.html", "tutorials/teacher.html");
    expectIn("reference/programs.html", "--trajectory");           // of haptic_server simulate --help
    expectIn("reference/scene.html", "An octree leaf is a cube");  // a comment of proto/scene.proto
    expectIn("search/index.js", "howto/troubleshooting.html#the-scan-is-refused");
    for (const auto& file : std::filesystem::recursive_directory_iterator(pages))
        if (file.path().extension() == ".html") {
            EXPECT_EQ(test::readFile(file.path()).find(test::sourceDir()), std::string::npos) << file.path();
        }
}

}  // namespace
}  // namespace bonemill
