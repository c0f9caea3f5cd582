#include "haptic_server/record/trace_writer.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <span>

#include "common/config/user_error.h"

namespace bonemill {
namespace {

template <class Number>
void append(std::string& line, Number value) {
    char text[32];  // the longest shortest double has 24 characters
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    line.append(text, end).push_back(',');
}

void appendAll(std::string& line, std::span<const double> values) {
    for (const double value : values) append(line, value);
}

}  // namespace

TraceWriter::TraceWriter(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
    if (!file_) {
        throw UserError("trace " + path + " cannot be written (" + std::strerror(errno) +
                        "): does its folder exist, and may you write there?");
    }
    is_good_ = std::fputs(kTraceHeader, file_.get()) >= 0 && std::fputc('\n', file_.get()) != EOF;
}

bool TraceWriter::write(const TickRecord& record) {
    if (!is_good_ || !file_) return false;
    constexpr double kMm3PerM3 = 1e9;
    constexpr double kNsPerUs = 1e3;
    line_.clear();
    append(line_, record.t_s);
    appendAll(line_, record.p_WT);
    appendAll(line_, record.q_WT);
    appendAll(line_, record.p_WT_device);
    appendAll(line_, record.q_WT_device);
    appendAll(line_, record.f_hand_W);
    appendAll(line_, record.t_hand_W);
    append(line_, record.contacts);
    append(line_, record.max_penetration);
    append(line_, record.removed_voxels);
    append(line_, record.removed * kMm3PerM3);
    append(line_, record.faults);
    append(line_, double(record.compute_ns) / kNsPerUs);
    line_.back() = '\n';
    is_good_ = std::fwrite(line_.data(), 1, line_.size(), file_.get()) == line_.size();
    return is_good_;
}

bool TraceWriter::close() {
    if (!file_) return is_good_;
    is_good_ = std::fclose(file_.release()) == 0 && is_good_;
    return is_good_;
}

}  // namespace bonemill
