#include "device_daemon/control/device_loop/black_box.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>

#include "common/base/assert.h"
#include "common/base/user_error.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// A folder that a user has chosen may hold files of the user's own: only names of stopFile() count.
bool isStopFile(const fs::directory_entry& entry) {
    constexpr char kDate[] = "[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]",
                   kTime[] = "[0-9][0-9]-[0-9][0-9]-[0-9][0-9]";
    static const std::string kPattern = std::string("stop_[0-9]*_") + kDate + '_' + kTime + "_[0-9]*_*.csv";
    std::error_code error;
    return entry.symlink_status(error).type() == fs::file_type::regular &&
           fnmatch(kPattern.c_str(), entry.path().filename().c_str(), 0) == 0;
}

// One that has just gone counts as the oldest.
fs::file_time_type lastWriteTime(const fs::directory_entry& entry) {
    std::error_code error;
    return entry.last_write_time(error);
}

void makeRoomIn(const fs::path& dir) {
    std::error_code error;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error))
        if (isStopFile(*entry)) files.emplace_back(lastWriteTime(*entry), entry->path());
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + kMaxStopFiles <= files.size(); ++i) fs::remove(files[i].second, error);
}

template <size_t N>
void writeAll(std::ostream& out, const double (&values)[N]) {
    for (const double value : values) out << ',' << value;
}

void writeRow(std::ostream& out, const BlackBoxRecord& r, int64_t start_ns) {
    out << double(r.time_ns - start_ns) * 1e-9 << ',' << r.is_heard << ',' << r.sample.sequence << ','
        << nameOf(SafetyState(r.sample.state)) << ',' << nameOf(StopCause(r.sample.stop_cause)) << ','
        << r.sample.flags << ',' << r.sample.buttons;
    writeAll(out, r.sample.p_DT);
    writeAll(out, r.sample.q_DT);
    writeAll(out, r.sample.v_DT);
    writeAll(out, r.sample.w_DT);
    out << ',' << r.command.sequence << ',' << double(r.command.stamp_ns - start_ns) * 1e-9;
    writeAll(out, r.command.f_hand_D);
    writeAll(out, r.command.t_hand_D);
    writeAll(out, r.f_given_D);
    writeAll(out, r.t_given_D);
    out << '\n';
}

constexpr char kColumns[] =
    "time_s,is_heard,sample,state,cause,flags,buttons,px_DT_m,py_DT_m,pz_DT_m,qw_DT,qx_DT,qy_DT,qz_DT,vx_DT_"
    "m_per_s,"
    "vy_DT_m_per_s,vz_DT_m_per_s,wx_DT_rad_per_s,wy_DT_rad_per_s,wz_DT_rad_per_s,command,command_time_s,"
    "fx_commanded_D_n,fy_commanded_D_n,fz_commanded_D_n,tx_commanded_D_nm,ty_commanded_D_nm,tz_commanded_D_"
    "nm,"
    "fx_given_D_n,fy_given_D_n,fz_given_D_n,tx_given_D_nm,ty_given_D_nm,tz_given_D_nm\n";

}  // namespace

BlackBox::BlackBox(StopCause before)
    : records_((kBeforeNs + kAfterNs) / kShortestPeriodNs + 10), last_cause_(before) {}

void BlackBox::record(const BlackBoxRecord& record, StopCause cause) noexcept {
    if (isFull()) return;
    const bool is_stop = cause != StopCause::kNone && cause != last_cause_ && !is_stopping_;
    last_cause_ = cause;
    keep(record, is_stop);
    if (is_stop) {
        is_stopping_ = true;
        stop_ns_ = record.time_ns;
        stop_cause_ = cause;
    }
    if (is_stopping_ && record.time_ns - stop_ns_ >= kAfterNs) finish();
}

void BlackBox::keep(const BlackBoxRecord& record, bool is_stop) noexcept {
    if (record.time_ns < due_ns_ - kShortestPeriodNs / 2 && !is_stop) return;
    due_ns_ = std::max(due_ns_ + kShortestPeriodNs, record.time_ns);
    records_[next_] = record;
    next_ = (next_ + 1) % records_.size();
    count_ = std::min(count_ + 1, records_.size());
}

void BlackBox::finish() noexcept {
    if (!is_stopping_) return;
    is_stopping_ = false;
    is_full_.store(true, std::memory_order_release);
}

void BlackBox::write(const std::filesystem::path& file) {
    BONEMILL_ASSERT(isFull());
    std::ofstream out(file);
    out.precision(9);
    out << kColumns;
    const size_t oldest = count_ < records_.size() ? 0 : next_;
    const BlackBoxRecord* first = nullptr;
    for (size_t i = 0; i < count_; ++i) {
        const BlackBoxRecord& record = records_[(oldest + i) % records_.size()];
        if (record.time_ns < stop_ns_ - kBeforeNs) continue;
        if (!first) first = &record;
        writeRow(out, record, first->time_ns);
    }
    is_full_.store(false, std::memory_order_release);
    if (!out.flush()) throw UserError(file.string() + ": cannot be written");
}

fs::path defaultStopDir() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
        return fs::path(state) / "bonemill";
    const char* home = std::getenv("HOME");
    return fs::path(home && *home ? home : ".") / ".local/state/bonemill";
}

fs::path stopFile(const fs::path& dir, uint32_t session, StopCause cause) {
    std::error_code error;
    fs::create_directories(dir, error);
    makeRoomIn(dir);
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    std::tm local{};
    localtime_r(&now.tv_sec, &local);
    char time[32];
    std::strftime(time, sizeof(time), "%Y-%m-%d_%H-%M-%S", &local);
    std::string name = "stop_" + std::to_string(session) + '_' + time + '_' +
                       std::to_string(now.tv_nsec / 1'000'000) + '_' + nameOf(cause) + ".csv";
    std::replace(name.begin(), name.end(), ' ', '_');
    return dir / name;
}

}  // namespace bonemill
