#include "render_client/panel/panel/plot_history.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

double lengthOf(const google::protobuf::RepeatedField<double>& v) {
    return v.size() == 3 ? std::hypot(v[0], v[1], v[2]) : 0;
}

}  // namespace

void PlotHistory::Curve::add(double value) {
    values[next] = std::isfinite(value) ? float(value) : 0;
    next = (next + 1) % kLength;
}

float PlotHistory::Curve::largest() const {
    return std::ranges::max(values);
}

void PlotHistory::update(const SessionView& session) {
    if (!session.tool) return;
    if (session.tool->epoch() != epoch_) {
        *this = {};
        epoch_ = session.tool->epoch();
        shown_s_ = session.time_s - kStep;
    }
    constexpr double kRounding = 1e-6;
    const int due = int(std::clamp((session.time_s - shown_s_) / kStep + kRounding, 0.0, double(kLength)));
    constexpr double kMillimetres = 1000;
    for (int n = 0; n < due; ++n) {
        force_.add(lengthOf(session.tool->force_n()));
        torque_.add(kMillimetres * lengthOf(session.tool->torque_nm()));
        tick_.add(session.status ? session.status->tick_p99_us() : 0);
    }
    shown_s_ = due < int(kLength) ? shown_s_ + due * kStep : session.time_s;
}

}  // namespace bonemill
