// Results as JSON, one file per attempt. The functions are pure and allocate; any thread may call them.
#pragma once

#include <optional>
#include <string>

#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill {

inline constexpr size_t kMaxResult = size_t(16) << 20;  // bytes

std::string resultJson(const AttemptResult& result);

// The text may be a stranger's. Throws UserError, which names the file, for what is no result of this kind:
// JSON of another shape, numbers that are not finite where they must be, more figures or rows than an attempt
// can have.
AttemptResult parseResult(const std::string& text, const std::string& file);

}  // namespace bonemill
