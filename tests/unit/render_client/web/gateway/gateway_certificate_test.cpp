#include "render_client/web/gateway/gateway_certificate.h"

#include <gtest/gtest.h>

#include <ctime>
#include <functional>

#include "common/base/user_error.h"
#include "tests/support/process.h"

namespace bonemill::gateway {
namespace {

constexpr std::time_t kYear_s = 365 * 86400;

std::string whyNot(const std::function<void()>& start) {
    try {
        start();
    } catch (const UserError& error) {
        return error.what();
    }
    return "nothing is wrong";
}

bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(GatewayCertificate, IsMadeOnceAndOneOfTheUsersIsTaken) {
    const test::TemporaryFolder folder;
    const std::time_t now = std::time(nullptr);
    const GatewayCertificate made = selfMadeCertificate(folder.path(), now);
    EXPECT_TRUE(made.is_self_made);
    EXPECT_EQ(made.fingerprint.size(), 64u);
    EXPECT_EQ(selfMadeCertificate(folder.path(), now).fingerprint, made.fingerprint);
    const GatewayCertificate given = certificateOf(made.certificate, made.key, now);
    EXPECT_FALSE(given.is_self_made);
    EXPECT_EQ(given.fingerprint, made.fingerprint);
}

TEST(GatewayCertificate, ThatGuestsWouldRefuseStopsTheStart) {
    const test::TemporaryFolder folder;
    const std::time_t now = std::time(nullptr);
    const GatewayCertificate made = selfMadeCertificate(folder.path(), now);
    const auto refusal = [&](std::time_t when) {
        return whyNot([&] { certificateOf(made.certificate, made.key, when); });
    };
    EXPECT_TRUE(says(refusal(now + 11 * kYear_s), made.certificate.string() + " expired on "))
        << refusal(now + 11 * kYear_s);
    EXPECT_TRUE(says(refusal(now - kYear_s), "is not valid before")) << refusal(now - kYear_s);
    const std::string old = whyNot([&] { selfMadeCertificate(folder.path(), now + 11 * kYear_s); });
    EXPECT_TRUE(says(old, "delete it")) << old;
}

TEST(GatewayCertificate, AnotherOnesKeyAndWhatIsNoneAreNamed) {
    const test::TemporaryFolder folder;
    const std::time_t now = std::time(nullptr);
    const GatewayCertificate made = selfMadeCertificate(folder.path() / "one", now);
    const GatewayCertificate other = selfMadeCertificate(folder.path() / "other", now);
    const auto refusal = [&](const std::filesystem::path& certificate, const std::filesystem::path& key) {
        return whyNot([&] { certificateOf(certificate, key, now); });
    };
    const std::string mixed = refusal(made.certificate, other.key);
    EXPECT_TRUE(says(mixed, other.key.string() + ": is not the key of")) << mixed;
    test::writeFile(folder / "text", "no PEM");
    EXPECT_TRUE(says(refusal(folder / "text", made.key), "holds no certificate"));
    EXPECT_TRUE(says(refusal(made.certificate, folder / "text"), "holds no private key"));
    EXPECT_TRUE(says(refusal(folder / "none", made.key), "cannot be read"));
    EXPECT_TRUE(says(refusal(made.certificate, folder / "none"), "cannot be read"));
    std::filesystem::permissions(made.key, std::filesystem::perms(0644));
    EXPECT_TRUE(says(refusal(made.certificate, made.key), "can be read or written by others"));
}

}  // namespace
}  // namespace bonemill::gateway
