// Asks what deploy/install-deps says of wrong use. It installs nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

test::Finished installDeps(const std::vector<std::string>& options) {
    std::vector<std::string> arguments{test::sourceDir() + "/deploy/install-deps"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return test::run(arguments);
}

TEST(InstallDeps, AnUnknownOptionIsRefused) {
    const std::vector<std::vector<std::string>> wrong{
        {"--check", "--chek"}, {"--check", "more"}, {"--bench", "--check", "--all"}, {"--chek", "--check"}};
    for (const auto& options : wrong) {
        const test::Finished finished = installDeps(options);
        EXPECT_EQ(finished.exit_code, 2) << finished.out;
        EXPECT_EQ(finished.out, "");
        EXPECT_EQ(finished.err.rfind("install-deps: unknown option ", 0), 0u) << finished.err;
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
    }
}

TEST(InstallDeps, OptionsComeInAnyOrder) {
    const test::Finished finished = installDeps({"--check", "--bench"});
    EXPECT_TRUE(finished.exit_code == 0 || finished.exit_code == 1) << finished.err;
    EXPECT_EQ(finished.out, installDeps({"--bench", "--check"}).out);
    EXPECT_EQ(finished.err, "");
}

// A copy with a list of its own wants a package that Debian does not have.
TEST(InstallDeps, APackageWhoseProgramIsThereIsNotInstalledOverIt) {
    const test::TemporaryFolder folder;
    const std::string script = folder / "install-deps", tools = folder / "tools";
    std::filesystem::copy_file(test::sourceDir() + "/deploy/install-deps", script);
    test::writeFile(folder / "packages.txt", "bonemill-no-such-package  # for this test\n");
    std::filesystem::create_directory(tools);
    const std::string path = "PATH=" + tools + ":" + std::getenv("PATH");
    const auto check = [&] { return test::run({"/usr/bin/env", path, "/bin/bash", script, "--check"}); };
    EXPECT_EQ(check().out, "missing: bonemill-no-such-package\n");
    EXPECT_EQ(check().exit_code, 1);
    test::writeFile(tools + "/bonemill-no-such-package", "#!/bin/sh\n");
    std::filesystem::permissions(tools + "/bonemill-no-such-package", std::filesystem::perms::owner_all);
    EXPECT_EQ(check().exit_code, 0) << check().out << check().err;
}

TEST(InstallDeps, HelpSaysHowToUseIt) {
    const test::Finished finished = installDeps({"--help"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_NE(finished.out.find("--check"), std::string::npos) << finished.out;
}

}  // namespace
}  // namespace bonemill
