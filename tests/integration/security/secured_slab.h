// A session of the real haptic_server, with one scene, for people whose folders make-session has made.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/secured_session.h"

namespace bonemill::test {

using Words = std::vector<std::string>;

class SecuredSlab {
  public:
    // `more` goes to make-session.
    explicit SecuredSlab(const Words& more = {}) : people_(joined(more), testSession()) {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        writeFile(folder_ / "scene.textproto",
                  "name: \"told_to_nobody\" volume { path: \"slab.nrrd\" window_low: 0 window_high: 65535 "
                  "iso_value: 32768 }");
    }
    Words with(Words words, const std::string& person = "") const {
        words.insert(words.end(), {"--session", std::to_string(testSession()), "--domain", domain_});
        if (!person.empty()) words.insert(words.end(), {"--secure", person});
        return words;
    }
    std::string folderOf(const std::string& name) const { return people_.folderOf(name); }
    // Starts it, with --secure or without.
    std::unique_ptr<Process> server(bool is_secured) const {
        auto server = std::make_unique<Process>(with(
            {"haptic_server", "--scene", folder_ / "scene.textproto"}, is_secured ? folderOf("server") : ""));
        EXPECT_TRUE(waitFor([&] {
            return server->errSoFar().find("waits for a device") != std::string::npos;
        })) << server->errSoFar();
        return server;
    }
    std::unique_ptr<Process> probe(const std::string& secure) const {
        return std::make_unique<Process>(with({helperDir() + "/probe_viewer"}, secure));
    }
    static bool isComplete(const Process& probe) {
        return probe.outSoFar().find("\"complete\":true") != std::string::npos;
    }
    Finished command(const std::string& person, const Words& more) const {
        Words words = with({"render_client"}, folderOf(person));
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    std::unique_ptr<Process> intruder(const std::string& secure, const Words& more = {}) const {
        Words words = with({helperDir() + "/intruder"}, secure);
        words.insert(words.end(), more.begin(), more.end());
        return std::make_unique<Process>(words);
    }
    static nlohmann::json end(Process& intruder) {
        const Finished finished = intruder.wait();
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return nlohmann::json::parse(finished.out, nullptr, false);
    }

  private:
    static Words joined(const Words& more) {
        Words words{"--server", "--person",      "Anna:instructor", "--person",   "Olga:operator",
                    "--person", "Otto:observer", "--person",        "Ed:examiner"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    TemporaryFolder folder_;
    SecuredSession people_;
    std::string domain_ = std::to_string(testDomain());
};

}  // namespace bonemill::test
