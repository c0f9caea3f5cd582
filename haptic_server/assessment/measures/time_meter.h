// Measures how the time of an attempt was spent, and how far the burr went. SI. One normal thread.
#pragma once

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"
#include "haptic_server/assessment/measures/definitions.h"
#include "haptic_server/assessment/measures/motion.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

class TimeMeter {
  public:
    void add(const TickStep& step) noexcept {
        session_ += step.dt;
        if (step.record.buttons & kButtonRemove) pedal_ += step.dt;
        if (step.isInContact()) contact_ += step.dt;
    }
    void addLost(double time) noexcept { lost_ += time; }
    // Returns the way since the sample before.
    double add(const MotionSample& sample) noexcept {
        const double way = sample.follows ? (sample.p_W - last_.p_W).norm() : 0;
        path_ += way;
        if (sample.contact >= 0.5) contact_path_ += way;
        last_ = sample;
        return way;
    }
    double session() const noexcept { return session_; }
    // `cutting` in s, `removed` in m³.
    void append(Figures& figures, double cutting, double removed) const {
        put(figures, "time.session", session_);
        put(figures, "time.pedal", pedal_);
        put(figures, "time.contact", contact_);
        put(figures, "time.cutting", cutting);
        put(figures, "time.idle", session_ - contact_);
        if (lost_ > 0) put(figures, "time.lost", lost_);
        put(figures, "path.length", path_ * kPerMillimetre);
        put(figures, "path.contact", contact_path_ * kPerMillimetre);
        if (removed > 0)
            put(figures, "path.per_volume", path_ * kPerMillimetre / (removed * kPerCubicMillimetre));
    }

  private:
    double session_ = 0, pedal_ = 0, contact_ = 0, lost_ = 0;  // s
    double path_ = 0, contact_path_ = 0;                       // m
    MotionSample last_;
};

}  // namespace bonemill
