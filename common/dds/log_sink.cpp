#include "common/dds/log_sink.h"

#include <dds/ddsrt/log.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>
#include <string_view>

#include "common/base/units.h"
#include "common/log/log_limit.h"
#include "common/rt/clock.h"

namespace bonemill::dds {
namespace {

void sayWithinLimit(void*, const dds_log_data_t* data) {
    static std::mutex mutex;
    static LogLimit limit(10, 60 * kNsPerSecond);
    const std::lock_guard lock(mutex);
    const int64_t left_out = limit.ask(monotonicNowNs());
    if (left_out < 0) return;
    std::string_view text(data->message, data->size);
    text = text.substr(0, std::min(text.find_last_not_of("\r\n") + 1, text.size()));
    if (left_out > 0) spdlog::warn("Cyclone DDS: {} messages were left out", left_out);
    spdlog::warn("Cyclone DDS: {}", text);
}

}  // namespace

void limitCycloneLog() {
    dds_set_log_sink(sayWithinLimit, nullptr);
}

}  // namespace bonemill::dds
