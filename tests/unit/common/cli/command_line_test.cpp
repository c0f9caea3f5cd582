#include "common/cli/command_line.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

struct Mill {
    CLI::App app{"Mills"};
    std::string way;
    int port = 0, speed = 3;
    bool is_fast = false;

    Mill() {
        CLI::App* verb = app.add_subcommand("go", "Goes");
        CLI::Option* fast = verb->add_flag("--fast", is_fast, "Quickly");
        verb->add_option("--way", way, "Where to")->check(CLI::IsMember({"left", "right"}))->excludes(fast);
        CLI::Option* on =
            verb->add_option("--port", port, "Where it listens")->check(CLI::Range(1, 9))->needs(fast);
        verb->add_option("--speed", speed, "m/s")->type_name("NUMBER")->check(CLI::Number)->excludes(on);
        verb->get_option("--speed")->capture_default_str();
    }
    bool parse(std::vector<const char*> words) {
        words.insert(words.begin(), "mill");
        return parseCommandLine(app, int(words.size()), words.data(), "mill");
    }
    std::string help(std::vector<const char*> words) {
        testing::internal::CaptureStdout();
        EXPECT_FALSE(parse(std::move(words)));
        return testing::internal::GetCapturedStdout();
    }
};

TEST(CommandLine, HelpSaysWhatAnOptionTakesOnce) {
    const std::string help = Mill().help({"go", "--help"});
    for (const char* line :
         {"--way {left,right} ", "--port INT in [1 - 9] with --fast\n", "--speed NUMBER=3 "})
        EXPECT_NE(help.find(line), std::string::npos) << line << "\n" << help;
    EXPECT_EQ(help.find("Excludes"), std::string::npos) << help;
}

TEST(CommandLine, WhatDoesNotGoTogetherIsRefusedInOneLine) {
    try {
        Mill().parse({"go", "--fast", "--way", "left"});
        FAIL() << "it was taken";
    } catch (const UserError& error) {
        const std::string line = error.what();
        for (const char* word : {"--fast", "--way", "mill --help"})
            EXPECT_NE(line.find(word), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
}

}  // namespace
}  // namespace bonemill
