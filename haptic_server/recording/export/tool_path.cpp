#include "haptic_server/recording/export/tool_path.h"

#include <iomanip>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/recording/rerun/recorded_attempts.h"

namespace bonemill {
namespace {

constexpr double kRowPeriod = 0.01;  // s; viewers are told where the tool is some hundred times per second

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

}  // namespace bonemill
