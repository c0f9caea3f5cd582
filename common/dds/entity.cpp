#include "common/dds/entity.h"

#include <dds/dds.h>

#include "common/base/user_error.h"

namespace bonemill::dds {

Entity::~Entity() {
    if (handle_ > 0) dds_delete(handle_);
}

Entity requireEntity(int32_t result, const std::string& what) {
    if (result < 0) {
        throw UserError("cannot create " + what + " (" + dds_strretcode(result) +
                        "): check the network interfaces and the profile (docs/lab/network.md)");
    }
    return Entity(result);
}

}  // namespace bonemill::dds
