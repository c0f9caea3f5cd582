#include "render_client/web/gateway/host_names.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace bonemill::gateway {
namespace {

TEST(HostNames, OfACertificateThatWasGivenAreItsOwn) {
    const test::TemporaryFolder folder;
    const GatewayCertificate made = selfMadeCertificate(folder.path());
    const HostNames names(certificateOf(made.certificate, made.key), {"Relay.Example.org"});
    char here[256] = "";
    gethostname(here, sizeof here - 1);
    for (const std::string& own :
         {std::string("localhost"), std::string("LocalHost:8443"), std::string(here) + ":8443",
          std::string("192.0.2.7"), std::string("192.0.2.7:8443"), std::string("[2001:db8::1]:8443"),
          std::string("[::1]"), std::string("relay.example.org:443"), std::string("relay.example.org.:443")})
        EXPECT_TRUE(names.isOwn(own)) << own;
    for (const char* other : {"evil.example", "localhost.evil.example:8443", "relay.example.org.evil.example",
                              "192.0.2.7.evil.example", "[::1", "", "[", ":8443", "a b"})
        EXPECT_FALSE(names.isOwn(other)) << other;
}

TEST(HostNames, OfACertificateOfItsOwnMakingNobodyKnows) {
    const test::TemporaryFolder folder;
    const HostNames names(selfMadeCertificate(folder.path()), {});
    EXPECT_TRUE(names.isOwn("whatever.the.network.calls.it:8443"));
}

TEST(HostNames, AnOriginIsTheSameWithAndWithoutTheDefaultPort) {
    for (const auto& [origin, host] : {std::pair("https://there", "there"),
                                       {"https://there:443", "there"},
                                       {"https://there", "there:443"},
                                       {"HTTPS://There", "tHere"},
                                       {"https://[::1]", "[::1]:443"},
                                       {"https://there:8443", "there:8443"}})
        EXPECT_TRUE(isSameOrigin(origin, host)) << origin << " " << host;
    for (const auto& [origin, host] : {std::pair("https://there", "there:8443"),
                                       {"http://there", "there"},
                                       {"https://there:4430", "there"},
                                       {"https://", "there"},
                                       {"null", "there"},
                                       {"https://there.evil", "there"},
                                       {"", "there"}})
        EXPECT_FALSE(isSameOrigin(origin, host)) << origin << " " << host;
}

}  // namespace
}  // namespace bonemill::gateway
