#include "haptic_server/scans/confined/guarded_import.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "common/text/printed_text.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/labels/labels.h"

namespace bonemill {
namespace {

// No enumeration, as no bool: the child may have been made to write anything.
constexpr uint8_t kVolume = kErrorWords + 1, kLines = kVolume + 1;

// This follows the volume's words, which are its description; then come the segments and the values.
struct Head {
    uint8_t is_hounsfield;
    uint8_t lacks_patient_axes;
    int32_t dims[3];
    double spacing[3];
    double position[3];
    double rotation[4];  // Eigen's order
    uint8_t has_surface_value;
    double surface_value;
    uint64_t segments_bytes;
    uint64_t values;
    uint64_t type;  // RawValues::type()
};
static_assert(std::is_trivially_copyable_v<Head>);

bool isWithin(std::span<const double> numbers, double low, double high) {
    return std::ranges::all_of(numbers, [&](double n) { return n >= low && n <= high; });
}

// A volume's place, as far as any file of ours may say it (physical_frame.h).
bool isPlace(const Head& head) {
    constexpr double kMinStep = 1e-10, kLongestStep = 10, kFarthest = 1e5, kUnit = 1e-9;
    double square = 0;
    for (const double q : head.rotation) square += q * q;
    return isWithin(head.spacing, kMinStep, kLongestStep) && isWithin(head.position, -kFarthest, kFarthest) &&
           std::abs(square - 1) <= kUnit;
}

// The child may have been damaged by what it read, and what it says is checked before memory is asked for.
// Throws std::length_error.
void checkHead(const Head& head) {
    if (head.segments_bytes > kMaxWordsBytes) throw std::length_error("text");
    uint64_t voxels = 1;
    for (const int32_t n : head.dims) {
        if (n < 1 || (voxels *= uint64_t(n)) > kMaxVoxels) throw std::length_error("dims");
    }
    if (head.values != voxels || head.type >= std::variant_size_v<RawValues::Samples>)
        throw std::length_error("values");
    if (!isPlace(head) || !std::isfinite(head.surface_value)) throw std::length_error("place");
}

constexpr size_t kChunk = size_t(1) << 20;  // values

// Each chunk leaves this process once it is in the pipe, or both would hold the whole scan.
bool sendValues(int file, RawValues& values) {
    for (size_t begin = 0; begin < values.size(); begin += kChunk) {
        const size_t end = std::min(begin + kChunk, values.size());
        const bool is_sent = values.visit([&](auto samples) {
            const auto chunk = samples.subspan(begin, end - begin);
            return writeAll(file, chunk.data(), chunk.size_bytes());
        });
        if (!is_sent) return false;
        values.forget(begin, end);
    }
    return true;
}

template <class T>
bool receiveValues(Incoming& from, size_t count, RawValues& values) {
    std::vector<T> chunk;
    values.reserve(count);
    while (values.size() < count) {
        chunk.resize(std::min(kChunk, count - values.size()));
        if (!from.read(chunk.data(), chunk.size() * sizeof(T))) return false;
        values.append(std::span<const T>(chunk));
    }
    return true;
}

bool receiveValues(Incoming& from, const Head& head, RawValues& values) {
    constexpr bool (*kReceive[])(Incoming&, size_t, RawValues&) = {
        // order of RawValues::Samples
        receiveValues<uint8_t>, receiveValues<int16_t>, receiveValues<uint16_t>, receiveValues<float>};
    static_assert(std::size(kReceive) == std::variant_size_v<RawValues::Samples>);
    return kReceive[head.type](from, head.values, values);
}

void sendVolume(int file, RawVolume raw) {
    Head head{};
    head.is_hounsfield = raw.is_hounsfield;
    head.lacks_patient_axes = raw.lacks_patient_axes;
    std::copy_n(raw.geometry.dims.data(), 3, head.dims);
    std::copy_n(raw.geometry.spacing.data(), 3, head.spacing);
    std::copy_n(raw.geometry.X_WV.position.data(), 3, head.position);
    std::copy_n(raw.geometry.X_WV.rotation.coeffs().data(), 4, head.rotation);
    head.has_surface_value = raw.surface_value.has_value();
    head.surface_value = raw.surface_value.value_or(0);
    const std::string segments = textOfSegments(raw.segments);
    head.segments_bytes = segments.size();
    head.values = raw.values.size();
    head.type = raw.values.type();
    sendWords(file, kVolume, raw.description) && writeAll(file, &head, sizeof head) &&
        writeAll(file, segments.data(), segments.size()) && sendValues(file, raw.values);
}

void sendLines(int file, const Lines& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    sendWords(file, kLines, text);
}

Lines linesOf(const std::string& text) {
    Lines lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(printable(line));
    return lines;
}

// They are false when the child died, or it was too late, before everything was handed over. They throw
// std::length_error when what comes does not fit together.
bool receiveVolume(Incoming& from, RawVolume& raw) {
    Words words;
    Head head;
    if (!receiveWords(from, words)) return false;
    if (words.kind != kVolume) throw std::length_error("kind");
    if (!from.read(&head, sizeof head)) return false;
    checkHead(head);
    raw.description = oneLine(words.text);
    std::string segments(head.segments_bytes, '\0');
    if (!from.read(segments.data(), segments.size())) return false;
    raw.segments = segmentsFromText(segments);
    raw.is_hounsfield = head.is_hounsfield;
    raw.lacks_patient_axes = head.lacks_patient_axes;
    if (head.has_surface_value) raw.surface_value = head.surface_value;
    raw.geometry.dims = Eigen::Map<const Eigen::Vector3i>(head.dims);
    raw.geometry.spacing = Eigen::Map<const Eigen::Vector3d>(head.spacing);
    raw.geometry.X_WV.position = Eigen::Map<const Eigen::Vector3d>(head.position);
    raw.geometry.X_WV.rotation = Eigen::Quaterniond(head.rotation);
    return receiveValues(from, head, raw.values);
}

bool receiveLines(Incoming& from, Lines& lines) {
    Words words;
    if (!receiveWords(from, words)) return false;
    if (words.kind != kLines) throw std::length_error("kind");
    lines = linesOf(words.text);
    return true;
}

}  // namespace

void readAsChild(int file, const std::filesystem::path& path, const std::function<RawVolume()>& read) {
    sendAsChild(file, path, [&] { sendVolume(file, read()); });
}

void readLinesAsChild(int file, const std::filesystem::path& path, const std::function<Lines()>& read) {
    sendAsChild(file, path, [&] { sendLines(file, read()); });
}

RawVolume importFrom(const std::filesystem::path& path, const StartReader& start,
                     std::chrono::milliseconds most) {
    RawVolume volume;
    receiveFrom(path, start, most, [&](Incoming& from) { return receiveVolume(from, volume); });
    return volume;
}

Lines linesFrom(const std::filesystem::path& path, const StartReader& start, std::chrono::milliseconds most) {
    Lines lines;
    receiveFrom(path, start, most, [&](Incoming& from) { return receiveLines(from, lines); });
    return lines;
}

RawVolume importGuarded(const std::filesystem::path& path, const std::function<RawVolume()>& read,
                        std::chrono::milliseconds most) {
    return importFrom(path, forkOf([&](int pipe) { readAsChild(pipe, path, read); }), most);
}

Lines linesGuarded(const std::filesystem::path& path, const std::function<Lines()>& read,
                   std::chrono::milliseconds most) {
    return linesFrom(path, forkOf([&](int pipe) { readLinesAsChild(pipe, path, read); }), most);
}

}  // namespace bonemill
