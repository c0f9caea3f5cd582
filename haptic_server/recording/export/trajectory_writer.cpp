#include "haptic_server/recording/export/trajectory_writer.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <iomanip>
#include <memory>
#include <vector>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/text/csv_text.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"

namespace bonemill {
namespace {

constexpr double kRowPeriod = 0.01;  // s; viewers are told where the tool is some hundred times per second

template <class Number>
void append(std::string& line, Number value) {
    line += numberText(value) + ',';
}

std::string lineOf(const JournalTick& tick) {
    std::string line;
    append(line, secondsOfNs(tick.start_ns));
    for (const double p : tick.input.p_WT) append(line, p);
    for (const double q : tick.input.q_WT) append(line, q);
    append(line, tick.buttons);
    for (const uint64_t number : numbersOf(tick.input, tick.device)) append(line, number);
    append(line, tick.input.stale_factor);
    line += tick.input.has_other_device ? textOfDevice(tick.input.other_device) : "";
    return line + '\n';
}

// The first tick that `simulate` cannot do: it took up an order to put the bone back, or was tuned. Else the
// number of ticks.
uint64_t firstBeyondScene(const Recording& recording) {
    RecordedTicks ticks(recording);
    const uint64_t at_first = ticks.at(0).input.decisions.bone_order;
    if (recording.content().put_backs.contains(at_first)) return 0;
    for (uint64_t tick = 0; tick < recording.ticks(); ++tick)
        if (const TickDecisions& decisions = ticks.at(tick).input.decisions;
            decisions.bone_order != at_first || decisions.tuning != 0)
            return tick;
    return recording.ticks();
}

}  // namespace

ToolPathExport::ToolPathExport(const std::string& path, const Recording& recording, int attempt)
    : file_(path), out_(file_.part()) {
    const std::vector<RecordedAttempt> attempts = recordedAttempts(recording.content());
    if (attempt > int(attempts.size()))
        throw UserError(path + ": the session has " + std::to_string(attempts.size()) + " attempts, not " +
                        std::to_string(attempt));
    if (!attempts.empty()) {
        const RecordedAttempt& chosen = attempt == 0 ? attempts.back() : attempts[size_t(attempt) - 1];
        first_bone_order_ = chosen.bone_order;
        end_ = chosen.end;
    }
    out_ << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
}

void ToolPathExport::add(const TickRecord& record, bool is_paused) {
    if (record.bone_order < first_bone_order_ || record.tick > end_) return;
    if (has_begun_ && !is_paused) attempt_s_ += record.t_s - last_s_;
    has_begun_ = true;
    last_s_ = record.t_s;
    if (attempt_s_ < next_row_s_) return;
    next_row_s_ += kRowPeriod;
    out_ << std::setprecision(9) << attempt_s_;
    for (const double p : record.p_WT) out_ << ',' << p;
    for (const double q : record.q_WT) out_ << ',' << q;
    out_ << ',' << record.buttons << '\n';
}

void ToolPathExport::finish() {
    out_.close();
    if (!out_) throw UserError(file_.path().string() + ": cannot be written to its end (disk full?)");
    file_.finish();
}

void writeTrajectory(const std::string& path, const Recording& recording) {
    const uint64_t count = firstBeyondScene(recording);
    if (count == 0 || recording.manifest().has_resumed_from())
        throw UserError(
            path +
            ": the session does not begin on the scanned bone and as its scene says, as `simulate` does; "
            "`session verify` runs its ticks again");
    if (count < recording.ticks())
        spdlog::warn("{}: only the {:.3f} s before the bone was put back, or the contact law tuned", path,
                     recording.secondsOf(count));
    WholeFile file(path);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.part().c_str(), "w"),
                                                              &std::fclose);
    if (!out) throw UserError(path + ": cannot be written");
    bool is_written =
        std::fputs(("t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons," + recordedHeader() + "\n").c_str(),
                   out.get()) >= 0;
    RecordedTicks ticks(recording);
    for (uint64_t tick = 0; tick < count && is_written; ++tick)
        is_written = std::fputs(lineOf(ticks.at(tick)).c_str(), out.get()) >= 0;
    if (!is_written || std::fflush(out.get()) != 0)
        throw UserError(path + ": cannot be written to its end (disk full?)");
    file.finish();
}

}  // namespace bonemill
