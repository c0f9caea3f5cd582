#include "common/security/security_folder.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "tests/support/secured_session.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr std::time_t kDay = 24 * 3600;

class SecurityFolderTest : public testing::Test {
  protected:
    // Says why the folder is refused; empty if it is not.
    static std::string refusalOf(const fs::path& folder, std::time_t now = std::time(nullptr)) {
        try {
            SecurityFolder checked(folder, now);
            return "";
        } catch (const UserError& error) {
            return error.what();
        }
    }
    static void expectRefused(const fs::path& folder, const std::string& why,
                              std::time_t now = std::time(nullptr)) {
        const std::string refusal = refusalOf(folder, now);
        EXPECT_NE(refusal.find(why), std::string::npos) << refusal;
        EXPECT_EQ(refusal.rfind("--secure ", 0), 0u) << refusal;
    }
    // Takes this file of Olga's from somewhere else.
    void exchange(const std::string& file, const std::string& from) const {
        fs::copy_file(from, olga_ / file, fs::copy_options::overwrite_existing);
    }

    test::SecuredSession session_{{"--server", "--person", "Anna:instructor", "--person", "Olga:operator"}};
    fs::path olga_ = session_.folderOf("Olga");
};

TEST_F(SecurityFolderTest, SaysWhoseItIs) {
    const SecurityFolder folder(olga_);
    EXPECT_EQ(folder.self().name, "Olga");
    EXPECT_EQ(folder.self().role, "operator");
    EXPECT_EQ(folder.self().session, 7u);
    EXPECT_GE(folder.self().prefix[0], 0x80);
    EXPECT_NE(folder.self().prefix, SecurityFolder(session_.folderOf("Anna")).self().prefix);
    EXPECT_EQ(folder.properties("/plugins").size(), 6u + 3 * 3);
    EXPECT_EQ(SecurityFolder(session_.folderOf("server")).self().role, "server");
}

TEST_F(SecurityFolderTest, IsRefusedBeforeAndAfterItsTime) {
    const std::time_t now = std::time(nullptr);
    EXPECT_EQ(refusalOf(olga_, now + 29 * kDay), "");
    expectRefused(olga_, "Olga expired on ", now + 31 * kDay);
    expectRefused(olga_, "Olga is not valid before ", now - kDay);
}

TEST_F(SecurityFolderTest, IsRefusedWhenSomethingIsMissingOrNoneOfIt) {
    expectRefused(olga_ / "nothing", "there is no such folder");
    for (const char* file : {"identity_ca.pem", "identity.pem", "identity.key", "permissions_ca.pem",
                             "governance.p7s", "permissions.p7s"}) {
        fs::rename(olga_ / file, olga_ / "kept");
        expectRefused(olga_, std::string(file) + " is missing");
        test::writeFile(olga_ / file, "nothing of the kind\n");
        EXPECT_NE(refusalOf(olga_), "") << file;
        fs::rename(olga_ / "kept", olga_ / file);
    }
    EXPECT_EQ(refusalOf(olga_), "");
}

TEST_F(SecurityFolderTest, IsRefusedWithWhatIsSomebodyElses) {
    const test::SecuredSession other({"--person", "Olga:operator"});
    exchange("identity.key", session_.folderOf("Anna") + "/identity.key");
    expectRefused(olga_, "identity.key does not belong to identity.pem");
    exchange("identity.key", session_.folderOf("Anna") + "/identity.key");
    exchange("identity.pem", session_.folderOf("Anna") + "/identity.pem");
    expectRefused(olga_,
                  "permissions.p7s is for CN=Olga,OU=operator,O=bonemill-session-7, but identity.pem for "
                  "CN=Anna,OU=instructor,O=bonemill-session-7");
    exchange("permissions.p7s", session_.folderOf("Anna") + "/permissions.p7s");
    EXPECT_EQ(refusalOf(olga_), "") << "now it is Anna's";
    exchange("permissions.p7s", other.folderOf("Olga") + "/permissions.p7s");
    expectRefused(olga_, "permissions.p7s was not signed by this folder's permissions_ca.pem");
    exchange("identity_ca.pem", other.folderOf("Olga") + "/identity_ca.pem");
    expectRefused(olga_, "identity.pem was not issued by this folder's identity_ca.pem");
}

TEST_F(SecurityFolderTest, IsRefusedWhereOthersCanReadOrWriteIt) {
    const auto may = [](const fs::path& path, int mode) { fs::permissions(path, fs::perms(mode)); };
    for (const int mode : {0640, 0604, 0620, 0602}) {
        may(olga_ / "identity.key", mode);
        expectRefused(olga_, "identity.key can be read or written by others; type: chmod 600 ");
    }
    may(olga_ / "identity.key", 0400);
    for (const int mode : {0750, 0705, 0720, 0702}) {
        may(olga_, mode);
        expectRefused(olga_, "Olga can be read or written by others; type: chmod 700 ");
    }
    may(olga_, 0700);
    EXPECT_EQ(refusalOf(olga_), "");
}

TEST_F(SecurityFolderTest, ATamperedRuleIsNotTheSignedOne) {
    std::string text = test::readFile(olga_ / "governance.p7s");
    const size_t at = text.find("ENCRYPT");
    ASSERT_NE(at, std::string::npos);
    test::writeFile(olga_ / "governance.p7s", text.replace(at, 7, "NONE"));
    expectRefused(olga_, "governance.p7s was not signed");
}

TEST(PluginFolder, IsRefusedWhereThePluginsAreMissing) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(pluginFolder(folder.path()), UserError);
    for (const char* kind : {"auth", "ac", "crypto"})
        test::writeFile(folder / (std::string("libdds_security_") + kind + ".so"), "");
    EXPECT_EQ(pluginFolder(folder.path()), folder.path());
}

}  // namespace
}  // namespace bonemill
