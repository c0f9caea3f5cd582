#include "common/cli/version.h"

#include "version_numbers.h"

namespace bonemill {

std::string versionText() {
    const std::string commit = BONEMILL_COMMIT;
    return std::string(BONEMILL_VERSION " (") + (commit.empty() ? commit : commit + "; ") +
           BONEMILL_BUILD ")";
}

}  // namespace bonemill
