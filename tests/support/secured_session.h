// A session's folders, made as people make them: by deploy/security/make-session.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::test {

inline Finished makeSession(const std::string& folder, const std::vector<std::string>& more,
                            uint32_t session = 7) {
    std::vector<std::string> words{sourceDir() + "/deploy/security/make-session", folder, "--session",
                                   std::to_string(session)};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
}

// It is gone with this object. The folder of a person has the person's name, the server's is called server.
class SecuredSession {
  public:
    explicit SecuredSession(const std::vector<std::string>& more, uint32_t session = 7) {
        const Finished made = makeSession(folder_ / "session", more, session);
        if (made.exit_code != 0) throw std::runtime_error(made.err);
    }
    std::string folderOf(const std::string& name) const { return folder_ / ("session/" + name); }

  private:
    TemporaryFolder folder_;
};

}  // namespace bonemill::test
