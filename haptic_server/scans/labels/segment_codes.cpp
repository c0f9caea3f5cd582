#include "haptic_server/scans/labels/segment_codes.h"

#include <algorithm>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

// Of a few structures there are dozens.
constexpr size_t kMaxCombinations = 4096, kMaxMemberships = 100'000;

}  // namespace

SegmentCodes::SegmentCodes(std::string file) : file_(std::move(file)) {
    codes_[{}] = 0;
}

uint16_t SegmentCodes::codeOf(const SegmentMembers& members) {
    const auto [found, is_new] = codes_.try_emplace(members, uint16_t(codes_.size()));
    if (is_new && found->second > kMaxCombinations) refuse();
    return found->second;
}

bool SegmentCodes::anyOverlap() const {
    return std::ranges::any_of(codes_, [](const auto& code) { return code.first.count() > 1; });
}

void SegmentCodes::listIn(Segments& segments) const {
    for (const auto& [members, code] : codes_)
        for (size_t n = 0; n < segments.list.size(); ++n)
            if (members[n]) segments.list[n].labels.push_back(uint32_t(code));
    size_t memberships = 0;
    for (const Segment& segment : segments.list) memberships += segment.labels.size();
    if (memberships > kMaxMemberships) refuse();
    for (Segment& segment : segments.list) std::ranges::sort(segment.labels);
}

void SegmentCodes::refuse() const {
    throw UserError(file_ + ": its segments overlap in too many ways; export fewer of them");
}

}  // namespace bonemill
