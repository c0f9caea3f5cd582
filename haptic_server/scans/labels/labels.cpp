#include "haptic_server/scans/labels/labels.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

bool isInRange(const MaterialRule& rule, double value) {
    return rule.has_range && std::isfinite(value) && (!rule.from || value >= *rule.from) &&
           (!rule.below || value < *rule.below);
}

// Of a few structures there are dozens.
constexpr size_t kMaxCombinations = 4096, kMaxMemberships = 100'000;

constexpr const char* kLayered = "layered";
constexpr const char* kSingle = "single";

std::optional<Eigen::Vector3d> colorFromText(const std::string& text) {
    if (text == "-") return std::nullopt;
    std::istringstream words(text);
    Eigen::Vector3d color;
    for (double& part : color)
        if (!(words >> part) || !(part >= 0 && part <= 1)) throw std::length_error("colour");
    return color;
}

std::vector<uint32_t> labelsFromText(const std::string& text) {
    std::istringstream words(text);
    std::vector<uint32_t> labels;
    for (uint32_t label; words >> label;) {
        if (label > kMaxLabel || (!labels.empty() && label <= labels.back()))
            throw std::length_error("labels");
        labels.push_back(label);
    }
    if (!words.eof()) throw std::length_error("labels");
    return labels;
}

std::string namesOf(const Segments& segments) {
    constexpr size_t kMaxNames = 40;
    std::string names;
    for (size_t n = 0; n < std::min(segments.list.size(), kMaxNames); ++n)
        names += (n == 0 ? "" : ", ") + segments.list[n].name;
    return segments.list.size() > kMaxNames ? names + ", ..." : names;
}

}  // namespace

std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    std::vector<MaterialId> of_labels) {
    std::vector<MaterialId> ids = std::move(of_labels);
    ids.resize(raw.values.size(), kNoMaterial);
    if (std::ranges::none_of(rules, &MaterialRule::has_range)) return ids;
    raw.values.visit([&](auto samples) {
        for (size_t n = 0; n < samples.size(); ++n)
            for (size_t rule = rules.size(); rule > ids[n]; --rule)  // the later one wins
                if (isInRange(rules[rule - 1], double(samples[n]))) ids[n] = MaterialId(rule);
    });
    return ids;
}

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

bool isSegmentName(const std::string& name) {
    return !name.empty() && name.size() <= kLongestSegmentName &&
           std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

std::string textOfSegments(const Segments& segments) {
    if (segments.list.empty()) return {};
    std::ostringstream text;
    text << (segments.are_layered ? kLayered : kSingle) << '\n';
    for (const Segment& segment : segments.list) {
        text << segment.name << '\n';
        if (segment.color)
            text << segment.color->transpose();
        else
            text << '-';
        text << '\n';
        for (const uint32_t label : segment.labels) text << label << ' ';
        text << '\n';
    }
    return text.str();
}

Segments segmentsFromText(const std::string& text) {
    Segments segments;
    std::istringstream lines(text);
    std::string line, color, labels;
    if (!std::getline(lines, line)) return segments;
    if (line != kLayered && line != kSingle) throw std::length_error("layers");
    segments.are_layered = line == kLayered;
    while (std::getline(lines, line)) {
        if (!isSegmentName(line) || segments.list.size() == kMaxSegments || !std::getline(lines, color) ||
            !std::getline(lines, labels))
            throw std::length_error("segments");
        segments.list.push_back({line, colorFromText(color), labelsFromText(labels)});
    }
    return segments;
}

std::vector<uint32_t> labelsOfSegment(const Segments& segments, const std::string& name,
                                      const std::string& file) {
    if (segments.list.empty())
        throw UserError(file + ": names no segments; give label numbers, or a .seg.nrrd or DICOM SEG");
    std::vector<uint32_t> labels;
    bool is_there = false;
    for (const Segment& segment : segments.list) {
        if (segment.name != name) continue;
        is_there = true;
        labels.insert(labels.end(), segment.labels.begin(), segment.labels.end());
    }
    if (!is_there)
        throw UserError(file + ": has no segment \"" + name + "\"; there are: " + namesOf(segments));
    return labels;
}

}  // namespace bonemill
