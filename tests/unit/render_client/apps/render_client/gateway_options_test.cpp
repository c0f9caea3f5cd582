// Options of a gateway, and of a viewer that comes through one.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "common/base/user_error.h"
#include "render_client/viewer_options/viewer_options.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

ClientOptions parsed(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "render_client");
    return *parseOptions(int(arguments.size()), arguments.data());
}

TEST(GatewayOptions, ServesThisPcAloneUnlessAnAddressIsGiven) {
    EXPECT_FALSE(parsed({}).serve);
    const ClientOptions alone = parsed({"--serve", "8443", "--session", "7", "--domain", "3"});
    ASSERT_TRUE(alone.serve);
    EXPECT_EQ(alone.serve->address, "127.0.0.1");
    EXPECT_EQ(alone.serve->port, 8443);
    EXPECT_EQ(alone.serve->session, 7u);
    EXPECT_EQ(alone.serve->domain, 3u);
    EXPECT_EQ(alone.serve->page.filename(), "page");
    EXPECT_EQ(parsed({"--serve", "0.0.0.0:80"}).serve->address, "0.0.0.0");
    const ClientOptions v6 = parsed({"--serve", "[::1]:0", "--page", "p"});
    EXPECT_EQ(v6.serve->address, "::1");
    EXPECT_EQ(v6.serve->port, 0);
    EXPECT_EQ(v6.serve->page, "p");
    for (const char* place : {"", "port", "70000", ":80", "1.2.3.4:", "8443x"})
        EXPECT_THROW(parsed({"--serve", place}), UserError) << place;
    EXPECT_THROW(parsed({"--page", "p"}), UserError) << "of no gateway";
    EXPECT_THROW(parsed({"--serve", "1", "--key", "k"}), UserError) << "a key without its certificate";
    EXPECT_THROW(parsed({"--serve", "1", "--known-as", "k"}), UserError) << "a name without a certificate";
    EXPECT_EQ(parsed({"--serve", "1", "--certificate", "c", "--key", "k", "--known-as", "sim.example.org"})
                  .serve->names,
              std::vector<std::string>{"sim.example.org"});
    EXPECT_THROW(parsed({"--serve", "1", "--command", "reset"}), UserError);
}

TEST(RelayOptions, RelayAndGatewayShareASecretOutOfAPrivateFile) {
    const test::TemporaryFolder folder;
    const std::string secret = folder / "secret", letters(32, 'a');
    test::writeFile(secret, letters + "\n");
    chmod(secret.c_str(), 0600);
    EXPECT_FALSE(parsed({}).relay);
    const ClientOptions alone = parsed({"--relay", "9443", "--relay-secret", secret.c_str()});
    ASSERT_TRUE(alone.relay);
    EXPECT_EQ(alone.relay->address, "127.0.0.1");
    EXPECT_EQ(alone.relay->port, 9443);
    EXPECT_EQ(alone.relay->secret, letters);
    EXPECT_EQ(parsed({"--relay", "0.0.0.0:0", "--relay-secret", secret.c_str()}).relay->address, "0.0.0.0");
    const ClientOptions gateway = parsed({"--serve", "8443", "--via", "relay.example.org:9443",
                                          "--relay-secret", secret.c_str(), "--guests-at-once", "200"});
    ASSERT_TRUE(gateway.serve && gateway.serve->via);
    EXPECT_FALSE(gateway.relay);
    EXPECT_EQ(gateway.serve->via->host, "relay.example.org");
    EXPECT_EQ(gateway.serve->via->port, 9443);
    EXPECT_EQ(gateway.serve->via->secret, letters);
    EXPECT_EQ(gateway.serve->most_guests, 200u);
    EXPECT_FALSE(parsed({"--serve", "8443"}).serve->via);
    for (const char* place : {"9443", ":9443", "relay:", "relay:0", "relay:x"})
        EXPECT_THROW(parsed({"--serve", "1", "--via", place, "--relay-secret", secret.c_str()}), UserError)
            << place;
    EXPECT_THROW(parsed({"--via", "relay:1", "--relay-secret", secret.c_str()}), UserError) << "no gateway";
    EXPECT_THROW(parsed({"--relay-secret", secret.c_str()}), UserError) << "for nothing";
    EXPECT_THROW(parsed({"--relay", "1", "--serve", "2", "--relay-secret", secret.c_str()}), UserError);
    EXPECT_THROW(parsed({"--relay", "1", "--session", "2", "--relay-secret", secret.c_str()}), UserError);
    chmod(secret.c_str(), 0644);
    EXPECT_THROW(parsed({"--relay", "1", "--relay-secret", secret.c_str()}), UserError) << "all can read it";
}

TEST(RelayOptions, WithoutASecretTheMessageSaysHowToMakeOne) {
    const test::TemporaryFolder folder;
    setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    try {
        parsed({"--relay", "9443"});
        ADD_FAILURE() << "no secret, and no error";
    } catch (const UserError& error) {
        const std::string words = error.what();
        EXPECT_NE(words.find(folder / "bonemill/relay-secret"), std::string::npos) << words;
        EXPECT_NE(words.find("openssl rand -hex 32"), std::string::npos) << words;
    }
}

TEST(GatewayOptions, TheTokenComesFromLinkFileOrVariable) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "token", "https://lab:8443/#fromfile\n");
    const std::string file = folder / "token";
    unsetenv("BONEMILL_TOKEN");
    EXPECT_THROW(parsed({"--connect", "wss://lab:8443"}), UserError) << "no token";
    const ClientOptions by_file =
        parsed({"--connect", "wss://lab:8443/", "--token-file", file.c_str(), "--fingerprint", "ab:cd"});
    ASSERT_TRUE(by_file.connect);
    EXPECT_EQ(by_file.connect->target.host, "lab");
    EXPECT_EQ(by_file.connect->target.port, 8443);
    EXPECT_EQ(by_file.connect->target.fingerprint, "ab:cd");
    EXPECT_EQ(by_file.connect->token, "fromfile");
    EXPECT_FALSE(by_file.chooses_session);
    EXPECT_EQ(parsed({"--connect", "https://[::1]/#fromlink"}).connect->token, "fromlink");
    EXPECT_EQ(parsed({"--connect", "https://[::1]/#fromlink"}).connect->target.host, "::1");
    setenv("BONEMILL_TOKEN", "fromvariable", 1);
    const ClientOptions by_variable = parsed({"--connect", "wss://lab"});
    EXPECT_EQ(by_variable.connect->token, "fromvariable");
    EXPECT_EQ(by_variable.connect->target.port, 443);
    for (const char* link :
         {"lab:8443", "http://lab", "wss://", "wss://lab:x", "wss://lab/path", "wss://a@b"})
        EXPECT_THROW(parsed({"--connect", link}), UserError) << link;
    EXPECT_THROW(parsed({"--connect", "wss://lab", "--session", "2"}), UserError) << "the gateway has one";
    EXPECT_THROW(parsed({"--connect", "wss://lab", "--role", "operator"}), UserError) << "its list says";
    EXPECT_THROW(parsed({"--connect", "wss://lab", "--token-file", "/nowhere"}), UserError);
    unsetenv("BONEMILL_TOKEN");
}

}  // namespace
}  // namespace bonemill
