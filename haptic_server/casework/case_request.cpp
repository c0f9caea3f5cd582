#include "haptic_server/casework/case_request.h"

#include <algorithm>
#include <charconv>

#include "common/user_error.h"

namespace bonemill {
namespace {

CaseLabel labelOf(const std::string& word) {
    CaseLabel label;
    const size_t equals = word.find('=');
    const char* const end = word.data() + std::min(equals, word.size());
    const auto read = std::from_chars(word.data(), end, label.label);
    if (equals == std::string::npos || read.ec != std::errc() || read.ptr != end || label.label > 65535)
        throw UserError("--label " + word +
                        ": write NUMBER=NAME, NUMBER=NAME:protected or NUMBER=NAME:target");
    label.name = word.substr(equals + 1);
    const auto endsIn = [&](const std::string& role) {
        if (!label.name.ends_with(role)) return false;
        label.name.resize(label.name.size() - role.size());
        return true;
    };
    if (endsIn(":protected"))
        label.role = CaseLabel::Role::kProtected;
    else if (endsIn(":target"))
        label.role = CaseLabel::Role::kTarget;
    if (label.name.empty()) throw UserError("--label " + word + ": the structure has no name");
    return label;
}

}  // namespace

std::vector<CaseLabel> labelsOf(const std::vector<std::string>& words) {
    std::vector<CaseLabel> labels;
    for (const std::string& word : words) {
        labels.push_back(labelOf(word));
        for (size_t n = 0; n + 1 < labels.size(); ++n)
            if (labels[n].label == labels.back().label || labels[n].name == labels.back().name)
                throw UserError("--label " + word + ": that number or name was given before");
    }
    return labels;
}

}  // namespace bonemill
