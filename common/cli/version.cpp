#include "common/cli/version.h"

#include "version_numbers.h"

namespace bonemill {

std::string versionText() {
    const std::string commit = BONEMILL_COMMIT;
    return BONEMILL_VERSION + (commit.empty() ? commit : " (" + commit + ")");
}

}  // namespace bonemill
