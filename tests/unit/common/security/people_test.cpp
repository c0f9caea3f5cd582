#include "common/security/people.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "common/security/security_folder.h"
#include "tests/support/secured_session.h"

namespace bonemill {
namespace {

GuidPrefix prefixOf(const test::SecuredSession& session, const std::string& name) {
    return SecurityFolder(session.folderOf(name)).self().prefix;
}

TEST(People, AreKnownByTheirCertificatesAlsoThoseWhoComeLater) {
    const test::SecuredSession session({"--server", "--person", "Anna:instructor"});
    People people(session.folderOf("server"));
    const auto anna = people.find(prefixOf(session, "Anna"));
    ASSERT_TRUE(anna);
    EXPECT_EQ(anna->name, "Anna");
    EXPECT_EQ(anna->role, "instructor");
    EXPECT_FALSE(people.find({0x80, 1, 2, 3, 4, 5}));

    ASSERT_EQ(test::makeSession(session.folderOf(""), {"--person", "Late:observer"}).exit_code, 0);
    const auto late = people.find(prefixOf(session, "Late"));
    ASSERT_TRUE(late);
    EXPECT_EQ(late->role, "observer");
    EXPECT_TRUE(people.find(prefixOf(session, "Anna")));
}

TEST(People, OfAnotherAuthorityDoNotCount) {
    const test::SecuredSession session({"--server"}), other({"--person", "Mallory:instructor"});
    const std::string list = session.folderOf("server") + "/people.pem";
    test::writeFile(list, test::readFile(list) + test::readFile(other.folderOf("Mallory") + "/identity.pem"));
    EXPECT_FALSE(People(session.folderOf("server")).find(prefixOf(other, "Mallory")));
}

TEST(People, AreInTheServersFolderOnly) {
    const test::SecuredSession session({"--person", "Anna:instructor"});
    EXPECT_THROW(People(session.folderOf("Anna")), UserError);
}

}  // namespace
}  // namespace bonemill
