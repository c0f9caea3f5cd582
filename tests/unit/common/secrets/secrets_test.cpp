#include "common/secrets/secrets.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "common/files/whole_file.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

TEST(Secrets, HashIsThatOfTheStandard) {
    EXPECT_EQ(sha256Hex("abc"),  // FIPS 180-4, the example of NIST
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Secrets, TokensDifferAndAreCompared) {
    const std::string one = randomToken(), other = randomToken();
    EXPECT_EQ(one.size(), 32u);
    EXPECT_EQ(one.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_FALSE(isSameSecret(one, other));
    EXPECT_TRUE(isSameSecret(one, std::string(one)));
    EXPECT_FALSE(isSameSecret(one, one + "0"));
}

mode_t modeOf(const std::string& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 ? status.st_mode & 0777 : 0;
}

TEST(PrivateFile, IsForItsUserAloneAlsoWhereAnotherOneStood) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "in/a/new/folder";
    writePrivateFile(path, "first");
    EXPECT_EQ(modeOf(path), 0600u);
    EXPECT_EQ(test::readFile(path), "first");
    chmod(path.c_str(), 0644);
    writePrivateFile(path, "second");
    EXPECT_EQ(modeOf(path), 0600u);
    EXPECT_EQ(test::readFile(path), "second");
}

TEST(PrivateFile, ThatCannotBeWrittenSaysSo) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "file", "");
    EXPECT_THROW(writePrivateFile(folder / "file/below", "secret"), UserError);
}

}  // namespace
}  // namespace bonemill
