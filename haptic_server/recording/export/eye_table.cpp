#include "haptic_server/recording/export/eye_table.h"

#include <vector>

#include "haptic_server/recording/rerun/recorded_eyes.h"

namespace bonemill {
namespace {

struct Eyes {
    std::vector<double> t_s, p_m, q_wxyz, field_of_view_rad;

    void add(double at_s, const RecordedEye& eye) {
        t_s.push_back(at_s);
        p_m.insert(p_m.end(), eye.p_WC.begin(), eye.p_WC.end());
        for (const double part : {eye.q_WC.w(), eye.q_WC.x(), eye.q_WC.y(), eye.q_WC.z()})
            q_wxyz.push_back(part);
        field_of_view_rad.push_back(eye.field_of_view);
    }
};

}  // namespace

void writeEyes(const Recording& recording, H5File& file) {
    Eyes eyes;
    for (const RecordedEye& seen : recordedEyes(recording)) eyes.add(recording.secondsOf(seen.tick), seen);
    if (eyes.t_s.empty()) return;
    const auto write = [&](const char* place, size_t width, const H5About& about,
                           const std::vector<double>& values) {
        file.addColumn(place, width, H5File::Number::kDouble, about).append(values);
    };
    write("/eye/t_s", 1, {"s", "since the session's first tick"}, eyes.t_s);
    write("/eye/p_m", 3, {"m", "where the trainee's eye was, world frame W"}, eyes.p_m);
    write("/eye/q_wxyz", 4, {"1", "the camera's axes (x right, y up, z towards the eye) to W, w, x, y, z"},
          eyes.q_wxyz);
    write("/eye/field_of_view_rad", 1, {"rad", "vertical angle of view"}, eyes.field_of_view_rad);
}

}  // namespace bonemill
