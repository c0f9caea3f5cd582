#include "haptic_server/scans/nrrd/nrrd_segments.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <unordered_map>

#include "common/base/user_error.h"
#include "haptic_server/scans/labels/labels.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"

namespace bonemill {
namespace {

std::optional<uint32_t> wholeNumber(const std::string& text) {
    uint32_t number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
    return number;
}

// A colour that is none is no reason to refuse a label map.
std::optional<Eigen::Vector3d> colorOf(const std::string& text) {
    std::istringstream words(text);
    Eigen::Vector3d color;
    for (double& part : color)
        if (!(words >> part) || !(part >= 0 && part <= 1)) return std::nullopt;
    return color;
}

uint32_t requireNumber(const std::string& key, const std::string& text, uint32_t most,
                       const std::filesystem::path& path) {
    const std::optional<uint32_t> number = wholeNumber(text);
    if (!number || *number > most)
        throw UserError(path.string() + ": its " + key + " is no whole number from 0 to " +
                        std::to_string(most) + "; the header is damaged");
    return *number;
}

// Files of old versions of 3D Slicer have a layer of zeros and ones for each segment, and say neither.
void completePlaces(NrrdSegments& segments, uint32_t layers, const std::string& file) {
    for (auto& [number, segment] : segments) {
        if (!segment.layer) segment.layer = layers > 1 ? number : 0;
        if (!segment.value) segment.value = layers > 1 ? 1 : number + 1;
        if (!isSegmentName(segment.name))
            throw UserError(file + ": segment " + std::to_string(number) + " has no name of 1 to " +
                            std::to_string(kLongestSegmentName) +
                            " bytes without control characters; rename it in 3D Slicer");
        if (*segment.layer >= layers)
            throw UserError(file + ": segment " + segment.name + " is said to be in layer " +
                            std::to_string(*segment.layer) + ", but the file has " + std::to_string(layers) +
                            "; the header is damaged");
    }
}

class LayerJoiner {
  public:
    LayerJoiner(const NrrdSegments& segments, uint32_t layers, const std::string& file)
        : members_(layers), codes_(file) {
        size_t n = 0;
        for (const auto& [number, segment] : segments) members_[*segment.layer][*segment.value].set(n++);
    }

    template <class T>
    uint16_t codeOf(std::span<const T> labels) {
        SegmentMembers members;
        for (size_t layer = 0; layer < labels.size(); ++layer) members |= membersOf(layer, labels[layer]);
        return codes_.codeOf(members);
    }
    void listCodes(Segments& segments) const { codes_.listIn(segments); }

  private:
    template <class T>
    SegmentMembers membersOf(size_t layer, T label) const {
        if (!(label > 0 && double(label) <= kMaxLabel)) return {};
        const auto found = members_[layer].find(uint32_t(label));
        return found == members_[layer].end() ? SegmentMembers() : found->second;
    }

    std::vector<std::unordered_map<uint32_t, SegmentMembers>> members_;  // of each layer, by label
    SegmentCodes codes_;
};

RawValues joinedValues(const RawValues& values, uint32_t layers, LayerJoiner& joiner) {
    RawValues joined;
    joined.reserve(values.size() / layers);
    values.visit([&]<class T>(std::span<const T> samples) {
        constexpr size_t kBlock = size_t(1) << 20;
        std::vector<uint16_t> block;
        uint16_t code = 0;
        for (size_t at = 0; at + layers <= samples.size(); at += layers) {
            const auto voxel = samples.subspan(at, layers);
            if (at == 0 || !std::ranges::equal(voxel, samples.subspan(at - layers, layers)))
                code = joiner.codeOf(voxel);
            block.push_back(code);
            if (block.size() < kBlock && at + 2 * layers <= samples.size()) continue;
            joined.append(std::span<const uint16_t>(block));
            block.clear();
        }
    });
    return joined;
}

}  // namespace

void takeSegmentLine(const std::string& key, const std::string& value, const std::filesystem::path& path,
                     NrrdSegments& segments) {
    constexpr std::string_view kStart = "Segment";
    const size_t end = key.find('_');
    if (!key.starts_with(kStart) || end == std::string::npos) return;
    const auto number = wholeNumber(key.substr(kStart.size(), end - kStart.size()));
    if (!number) return;
    if (*number >= kMaxSegments)
        throw UserError(path.string() + ": has more than " + std::to_string(kMaxSegments) +
                        " segments; export fewer of them");
    NrrdSegment& segment = segments[*number];
    const std::string field = key.substr(end + 1);
    if (field == "Name") segment.name = trimmed(value);
    if (field == "Color") segment.color = colorOf(value);
    if (field == "LabelValue") segment.value = requireNumber(key, trimmed(value), kMaxLabel, path);
    if (field == "Layer") segment.layer = requireNumber(key, trimmed(value), kMaxSegments - 1, path);
}

Segments joinLayers(const NrrdSegments& segments, uint32_t layers, RawValues& values,
                    const std::string& file) {
    NrrdSegments whole = segments;
    completePlaces(whole, layers, file);
    Segments out;
    out.are_layered = layers > 1;
    for (const auto& [number, segment] : whole) out.list.push_back({segment.name, segment.color, {}});
    if (layers > 1) {
        LayerJoiner joiner(whole, layers, file);
        values = joinedValues(values, layers, joiner);
        joiner.listCodes(out);
        return out;
    }
    size_t n = 0;
    for (const auto& [number, segment] : whole) out.list[n++].labels = {*segment.value};
    return out;
}

}  // namespace bonemill
