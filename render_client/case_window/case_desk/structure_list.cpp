#include "render_client/case_window/case_desk/structure_list.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "common/base/user_error.h"
#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/scans/labels/labels.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

std::set<uint32_t> numbersIn(const RawVolume& map) {
    std::set<uint32_t> numbers;
    map.values.visit([&](auto samples) {
        uint32_t last = 0;
        for (const auto sample : samples) {
            const double value = double(sample);
            if (value == double(last) || value == 0) continue;
            if (!(value > 0 && value <= double(kMaxLabel)) || value != std::floor(value))
                throw UserError(tr("this is no label map: it holds the value {1}", {std::to_string(value)}));
            last = uint32_t(value);
            if (numbers.insert(last).second && numbers.size() > kMaxStructureRows)
                throw UserError(tr("this is no label map: it holds more than {1} different values",
                                   {std::to_string(kMaxStructureRows)}));
        }
    });
    return numbers;
}

bool isOf(const CaseLabel& label, const StructureRow& row) {
    return label.labels.empty() ? !row.number && label.name == row.name
                                : row.number && label.labels[0] == *row.number;
}

StructureUse useOf(CaseLabel::Role role) {
    switch (role) {
        case CaseLabel::Role::kProtected:
            return StructureUse::kProtected;
        case CaseLabel::Role::kTarget:
            return StructureUse::kTarget;
        case CaseLabel::Role::kPlain:
            break;
    }
    return StructureUse::kShown;
}

const char* roleText(StructureUse use) {
    return use == StructureUse::kProtected ? ":protected" : use == StructureUse::kTarget ? ":target" : "";
}

}  // namespace

std::vector<StructureRow> structuresOf(const RawVolume& map) {
    std::vector<StructureRow> rows;
    for (const Segment& segment : map.segments.list)
        rows.push_back({std::nullopt, segment.name, segment.labels, StructureUse::kIgnored});
    if (!rows.empty()) return rows;
    for (const uint32_t number : numbersIn(map))
        rows.push_back({number, "structure " + std::to_string(number), {number}, StructureUse::kIgnored});
    return rows;
}

void takeWords(const std::vector<std::string>& words, std::vector<StructureRow>& rows) {
    for (const CaseLabel& label : labelsOf(words))
        for (StructureRow& row : rows)
            if (isOf(label, row)) {
                row.name = label.name;
                row.use = useOf(label.role);
            }
}

std::vector<std::string> labelWordsOf(const std::vector<StructureRow>& rows) {
    std::vector<std::string> words;
    for (const StructureRow& row : rows) {
        if (row.use == StructureUse::kIgnored || row.name.empty()) continue;
        words.push_back((row.number ? std::to_string(*row.number) + "=" : "") + row.name + roleText(row.use));
    }
    return words;
}

std::array<uint8_t, 3> structureTint(size_t row) {
    constexpr std::array<std::array<uint8_t, 3>, 6> kTints = {
        {{90, 150, 255}, {255, 210, 60}, {210, 140, 250}, {255, 110, 90}, {100, 220, 150}, {80, 220, 230}}};
    return kTints[row % kTints.size()];
}

}  // namespace bonemill
