#include "haptic_server/cases/casework/case_request.h"

#include <algorithm>
#include <charconv>

#include "common/base/user_error.h"
#include "haptic_server/scans/labels/material_ids.h"
#include "haptic_server/scans/labels/segment_text.h"

namespace bonemill {
namespace {

// Without "=" the name is a segment's.
CaseLabel numberAndName(const std::string& word) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos) return {.labels = {}, .name = word};
    uint32_t number = 0;
    const char* const end = word.data() + equals;
    const auto read = std::from_chars(word.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end || number > kMaxLabel)
        throw UserError("--label " + word +
                        ": write NUMBER=NAME, or the NAME of a segment, and :protected or :target behind it");
    return {.labels = {number}, .name = word.substr(equals + 1)};
}

CaseLabel labelOf(const std::string& word) {
    CaseLabel label = numberAndName(word);
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

bool isSameStructure(const CaseLabel& a, const CaseLabel& b) {
    return a.name == b.name || (!a.labels.empty() && a.labels == b.labels);
}

}  // namespace

std::vector<CaseLabel> labelsOf(const std::vector<std::string>& words) {
    std::vector<CaseLabel> labels;
    for (const std::string& word : words) {
        labels.push_back(labelOf(word));
        for (size_t n = 0; n + 1 < labels.size(); ++n)
            if (isSameStructure(labels[n], labels.back()))
                throw UserError("--label " + word + ": that number or name was given before");
    }
    return labels;
}

void findSegments(const Segments& segments, const std::string& file, std::vector<CaseLabel>& labels) {
    for (CaseLabel& label : labels) {
        if (!label.labels.empty()) {
            if (!segments.are_layered) continue;
            throw UserError(file + ": its labels lie in several layers; give --label the names of segments");
        }
        label.labels = labelsOfSegment(segments, label.name, file);
        if (label.labels.empty()) throw UserError(file + ": its segment " + label.name + " has no voxel");
        label.color = std::ranges::find(segments.list, label.name, &Segment::name)->color;
    }
}

}  // namespace bonemill
