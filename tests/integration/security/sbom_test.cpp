// deploy/security/make-sbom names every package behind a program's libraries, with version and licence.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

test::Finished makeSbom(const std::string& programs, const std::string& out) {
    return test::run({test::sourceDir() + "/deploy/security/make-sbom", "--bin", programs, "--out", out});
}

const std::string kPagePackages = test::binDir() + "/../render_client/web/page/made/contained.json";

bool isTool(const nlohmann::json& sbom, const std::string& id) {
    return std::ranges::any_of(sbom["relationships"], [&](const nlohmann::json& relation) {
        return relation["spdxElementId"] == id && relation["relationshipType"] == "DEV_TOOL_OF";
    });
}

TEST(Sbom, NamesEveryPackageWithVersionAndLicence) {
    const test::TemporaryFolder folder;
    const test::Finished made = makeSbom(test::binDir(), folder / "sbom");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto sbom = nlohmann::json::parse(test::readFile(folder / "sbom/bonemill.spdx.json"));
    EXPECT_EQ(sbom["spdxVersion"], "SPDX-2.3");
    std::map<std::string, nlohmann::json> packages;
    for (const auto& package : sbom["packages"])
        if (!isTool(sbom, package["SPDXID"])) packages[package["name"]] = package;
    EXPECT_EQ(sbom["packages"].size(), sbom["relationships"].size());
    for (const char* name : {"bonemill", "libddsc0debian", "libprotobuf32", "libssl3", "libseccomp2", "libc6",
                             "libglfw3", "libeigen3-dev", "libimgui-dev"})
        EXPECT_TRUE(packages.contains(name)) << name;
    const std::string notice = test::readFile(folder / "sbom/NOTICE.txt");
    for (const auto& [name, package] : packages) {
        EXPECT_FALSE(package["versionInfo"].get<std::string>().empty()) << name;
        if (name == "bonemill") continue;
        EXPECT_NE(
            package["licenseDeclared"].get<std::string>() + package["licenseComments"].get<std::string>(),
            "NOASSERTIONDebian's copyright file says: ")
            << name;
        EXPECT_NE(notice.find("\n" + name + " " + package["versionInfo"].get<std::string>() + ": "),
                  std::string::npos)
            << name;
    }
    const test::Finished version =
        test::run({"/usr/bin/dpkg-query", "-W", "-f", "${Version}", "libddsc0debian"});
    EXPECT_EQ(packages["libddsc0debian"]["versionInfo"], version.out);
    EXPECT_NE(packages["bonemill"]["comment"].get<std::string>().find("haptic_server "), std::string::npos);
}

// What the page is made with is in no program and in no notice; what it holds is.
TEST(Sbom, TellsWhatThePageHoldsFromWhatItWasMadeWith) {
    if (!std::filesystem::exists(kPagePackages)) GTEST_SKIP() << "the page was not built";
    const test::TemporaryFolder folder;
    ASSERT_EQ(makeSbom(test::binDir(), folder / "sbom").exit_code, 0);
    const auto sbom = nlohmann::json::parse(test::readFile(folder / "sbom/bonemill.spdx.json"));
    const std::string notice = test::readFile(folder / "sbom/NOTICE.txt");
    std::map<std::string, bool> are_tools;
    for (const auto& package : sbom["packages"])
        if (package["SPDXID"].get<std::string>().starts_with("SPDXRef-npm-")) {
            EXPECT_NE(package["licenseDeclared"], "NOASSERTION") << package["name"];
            are_tools[package["name"]] = isTool(sbom, package["SPDXID"]);
        }
    EXPECT_EQ(are_tools["@bufbuild/protobuf"] || are_tools["meshoptimizer"], false);
    EXPECT_EQ(are_tools["esbuild"] && are_tools["typescript"] && are_tools["playwright-core"], true);
    for (const auto& [name, is_tool] : are_tools)
        EXPECT_EQ(notice.find("\n" + name + " ") == std::string::npos, is_tool) << name;
    EXPECT_NE(notice.find("Arseny Kapoulkine"), std::string::npos) << "the licence's text";
}

TEST(Sbom, NeedsPrograms) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(makeSbom(folder.path(), folder / "sbom").exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "sbom"));
}

}  // namespace
}  // namespace bonemill
