// A secured session: people do what their role may, and nobody else does anything.
#include <signal.h>

#include <ctime>
#include <filesystem>
#include <regex>

#include "tests/integration/security/secured_slab.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::SecuredSlab;

constexpr char kPlugins[] = "/usr/lib/x86_64-linux-gnu/libddsc0debian";

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(SecuredSession, PeopleCommandInTheirRolesAndUnderTheirNames) {
    const SecuredSlab slab;
    const auto server = slab.server(true);
    EXPECT_EQ(slab.command("Anna", {"--command", "pause"}).exit_code, 0);
    const Finished examiner = slab.command("Ed", {"--command", "reset"});
    EXPECT_TRUE(has(examiner.out, "refused: an examiner leaves bone, tool and device")) << examiner.out;
    EXPECT_EQ(slab.command("Ed", {"--command", "checkpoint"}).exit_code, 0);
    const Finished observer = slab.command("Otto", {"--command", "resume"});
    EXPECT_EQ(observer.exit_code, 1);
    EXPECT_TRUE(has(observer.out, "only looks")) << observer.out;
    const Finished pretender = slab.command("Olga", {"--command", "pause", "--role", "instructor"});
    EXPECT_EQ(pretender.exit_code, 2);
    EXPECT_TRUE(has(pretender.err, "is Olga's, operator")) << pretender.err;

    const auto olga = slab.intruder(slab.folderOf("Olga"), {"--plugins", kPlugins, "--seconds", "1"});
    const auto forged = SecuredSlab::end(*olga);
    EXPECT_GE(forged["matched"], 1) << "her orders arrive";
    EXPECT_GE(forged["read"], 1);
    ASSERT_TRUE(server->isRunning()) << server->errSoFar();
    server->signal(SIGTERM);
    const std::string log = server->wait().err;
    EXPECT_TRUE(has(log, "order of Anna (instructor, proven): pause_milling: done")) << log;
    EXPECT_TRUE(has(log, "order of Ed (examiner, proven): save_checkpoint: done")) << log;
    EXPECT_TRUE(has(log, "order of Olga (operator, proven): shut_down: refused: only an instructor")) << log;
    EXPECT_FALSE(has(log, "(instructor, proven): shut_down")) << log;
    EXPECT_FALSE(has(log, "order of Otto")) << log;
}

TEST(SecuredSession, StrangersAndThoseWhoOnlyLookReadAndWriteNothingThatIsNotTheirs) {
    const SecuredSlab slab;
    const test::SecuredSession elsewhere({"--person", "Anna:instructor"}, testSession());
    const std::string foreign = elsewhere.folderOf("Anna");
    const test::TemporaryFolder lax;
    for (const char* kind : {"auth", "crypto"}) {
        const std::string name = std::string("libdds_security_") + kind + ".so";
        std::filesystem::create_symlink(std::filesystem::path(kPlugins) / name, lax / name);
    }
    std::filesystem::create_symlink(test::helperDir() + "/lax_access_control.so",
                                    lax / "libdds_security_ac.so");
    setenv("BONEMILL_REAL_ACCESS_CONTROL", (std::string(kPlugins) + "/libdds_security_ac.so").c_str(), 1);

    const auto server = slab.server(true);
    const auto viewer = slab.probe(slab.folderOf("Otto")), outside = slab.probe(""),
               other = slab.probe(foreign);
    const auto stranger = slab.intruder(""), foreigner = slab.intruder(foreign, {"--plugins", kPlugins});
    const auto observer = slab.intruder(slab.folderOf("Otto"), {"--plugins", lax.path()});
    EXPECT_TRUE(test::waitFor([&] { return SecuredSlab::isComplete(*viewer); })) << viewer->errSoFar();
    for (Process* intruder : {stranger.get(), foreigner.get()}) {
        const auto seen = SecuredSlab::end(*intruder);
        EXPECT_EQ(seen["commands"], true) << seen;
        EXPECT_EQ(seen["matched"], 0) << seen;
        EXPECT_EQ(seen["read"], 0) << seen;
    }
    const auto seen = SecuredSlab::end(*observer);
    EXPECT_EQ(seen["commands"], true) << "its own checks are out of the way";
    EXPECT_EQ(seen["statuses"], true);
    EXPECT_GE(seen["read"], 1) << "it may look";
    for (const auto* blind : {outside.get(), other.get()}) {
        EXPECT_TRUE(has(blind->outSoFar(), "\"nodes\":0")) << blind->errSoFar();
        EXPECT_FALSE(std::regex_search(blind->outSoFar(), std::regex("\"nodes\":[1-9]")));
    }
    EXPECT_TRUE(server->isRunning()) << "nobody has ended the session";
    EXPECT_FALSE(has(server->errSoFar(), "order of ")) << server->errSoFar();
    const std::string shown = viewer->outSoFar();
    EXPECT_TRUE(has(shown.substr(shown.rfind("{")), "\"complete\":true"))
        << "a forged status changes nothing";
}

std::string daysAgo(int days) {
    const std::time_t then = std::time(nullptr) - days * 86400;
    char text[16] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&then));
    return text;
}

// Programs of ours do not start with an identity that has expired; a thief's does, and turns its clock back.
TEST(SecuredSession, WhoseIdentityHasExpiredStaysOutsideWhateverTheOwnClockSays) {
    const SecuredSlab slab({"--from", daysAgo(100), "--days", "3650"});
    const std::string session = std::filesystem::path(slab.folderOf("server")).parent_path();
    const Finished made = test::makeSession(
        session, {"--person", "Old:instructor", "--from", daysAgo(100), "--days", "30"}, testSession());
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto server = slab.server(true);
    const Finished late = slab.command("Old", {"--command", "pause"});
    EXPECT_EQ(late.exit_code, 2);
    EXPECT_TRUE(has(late.err, "the certificate of Old expired on " + daysAgo(70))) << late.err;
    const auto slow = [&](const std::string& person, const std::string& sender) {
        return slab.intruder(slab.folderOf(person),
                             {"--plugins", kPlugins, "--days-back", "90", "--sender", sender});
    };
    const auto olgas = slow("Olga", "67"), thief = slow("Old", "66");
    const auto olga = SecuredSlab::end(*olgas), old = SecuredSlab::end(*thief);
    EXPECT_EQ(old["commands"], true) << "in its own eyes it may: " << old;
    EXPECT_EQ(old["matched"], 0) << old;
    EXPECT_EQ(old["read"], 0) << old;
    EXPECT_GE(olga["matched"], 1) << "a slow clock alone keeps nobody outside: " << olga;
    EXPECT_TRUE(server->isRunning());
    EXPECT_FALSE(has(server->errSoFar(), "order of Old")) << server->errSoFar();
}

}  // namespace
}  // namespace bonemill
