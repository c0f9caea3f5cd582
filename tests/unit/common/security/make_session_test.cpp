// deploy/security/make-session: what it makes, and what it refuses.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/secured_session.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

TEST(MakeSession, KeysAreForTheirOwnerOnlyAndStayWhereTheyBelong) {
    const test::SecuredSession session({"--server", "--person", "Anna:instructor"});
    for (const auto& entry : fs::recursive_directory_iterator(session.folderOf("")))
        EXPECT_EQ(int(entry.status().permissions()) & 077, 0) << entry.path();
    EXPECT_TRUE(fs::exists(session.folderOf("ca/identity_ca.key")));
    for (const char* name : {"server", "device", "Anna"}) {
        EXPECT_TRUE(fs::exists(session.folderOf(name) + "/identity.key")) << name;
        EXPECT_FALSE(fs::exists(session.folderOf(name) + "/identity_ca.key")) << name;
        EXPECT_FALSE(fs::exists(session.folderOf(name) + "/permissions_ca.key")) << name;
    }
}

TEST(MakeSession, WrongUseMakesNothing) {
    const test::TemporaryFolder folder;
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{},
                                               {"--person", "Anna"},
                                               {"--person", "Anna:boss"},
                                               {"--person", "Anna:server"},
                                               {"--person", "../Anna:operator"},
                                               {"--person", "A<b>:operator"},
                                               {"--person", "Anna,OU=instructor:observer"},
                                               {"--person", "Anna:operator\nX"},
                                               {"--person", std::string(41, 'a') + ":operator"},
                                               {"--person", ":operator"},
                                               {"--person", "ca:operator"},
                                               {"--person", "Anna:operator", "--person", "anna:observer"},
                                               {"--person", "Anna:operator", "--days", "0"},
                                               {"--person", "Anna:operator", "--days", "4000"},
                                               {"--person", "Anna:operator", "--from", "yesterday"},
                                               {"--person", "Anna:operator", "--from", "2026-02-31"},
                                               {"--person", "Anna:operator", "--what"}}) {
        const test::Finished made = test::makeSession(folder / "session", words);
        EXPECT_EQ(made.exit_code, 2) << ::testing::PrintToString(words) << made.err;
        EXPECT_EQ(made.err.rfind("make-session: ", 0), 0u) << made.err;
        EXPECT_FALSE(fs::exists(folder / "session")) << ::testing::PrintToString(words);
    }
}

TEST(MakeSession, APersonIsMadeOnceAndInItsSession) {
    const test::SecuredSession session({"--person", "Anna:instructor"});
    const test::Finished again = test::makeSession(session.folderOf(""), {"--person", "Anna:operator"});
    EXPECT_EQ(again.exit_code, 2) << again.err;
    EXPECT_NE(again.err.find("is there already"), std::string::npos) << again.err;
    const test::Finished other =
        test::run({test::sourceDir() + "/deploy/security/make-session", session.folderOf(""), "--session",
                   "8", "--person", "Olga:operator"});
    EXPECT_EQ(other.exit_code, 2) << other.err;
    EXPECT_NE(other.err.find("belongs to session 7"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace bonemill
