#include "haptic_server/recording/statistics/trace_writer.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

std::string headerOf(const RecordedEffects& recorded) {
    std::string header = kTraceHeader;
    if (recorded.burr) header += kBurrColumns;
    if (recorded.heat) header += kHeatColumns;
    if (recorded.protection) header += kProtectionColumns;
    if (recorded.any()) header += kEventColumn;
    return header + '\n';
}

template <class Number>
void append(std::string& line, Number value) {
    char text[32];  // the longest shortest double has 24 characters
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    line.append(text, end).push_back(',');
}

void appendAll(std::string& line, std::span<const double> values) {
    for (const double value : values) append(line, value);
}

std::FILE* openForWriting(const std::string& path) {
    requireNoPipe(path);
    return std::fopen(path.c_str(), "w");
}

}  // namespace

TraceWriter::TraceWriter(const std::string& path, const RecordedEffects& recorded)
    : recorded_(recorded), file_(openForWriting(path)) {
    if (!file_) {
        throw UserError("trace " + path + " cannot be written (" + std::strerror(errno) +
                        "): does its folder exist, and may you write there?");
    }
    is_good_ = std::fputs(headerOf(recorded).c_str(), file_.get()) >= 0;
}

void TraceWriter::appendEffects(const EffectRecord& effects) {
    if (recorded_.burr) {
        append(line_, double(effects.spin_speed) / kRpm);
        append(line_, effects.burr_force);
        append(line_, effects.axis_torque);
        append(line_, effects.cutting_power);
        append(line_, effects.removal_power);
        append(line_, effects.removed_energy);
    }
    if (recorded_.heat) {
        append(line_, effects.temperature);
        append(line_, double(effects.necrotic_volume) * kPerCubicMillimetre);
    }
    if (recorded_.protection) {
        append(line_, effects.protected_id);
        append(line_, double(effects.protected_distance) * kPerMillimetre);
        append(line_, effects.protected_force);
        append(line_, double(effects.damaged_volume) * kPerCubicMillimetre);
    }
    if (recorded_.any()) append(line_, effects.events);
}

bool TraceWriter::write(const TickRecord& record) {
    if (!is_good_ || !file_) return false;
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
    append(line_, record.removed * kPerCubicMillimetre);
    append(line_, record.faults);
    append(line_, microsecondsOfNs(double(record.compute_ns)));
    appendEffects(record.effects);
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
