#include "haptic_server/recording/rerun/recorded_eyes.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

bool areFinite(const auto& numbers) {
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

}  // namespace

std::vector<RecordedEye> recordedEyes(const Recording& recording) {
    std::vector<RecordedEye> eyes;
    readJournal(recording.path(), [&](JournalTopic topic, const mcap::Message& message) {
        journal::Camera camera;
        if (topic != JournalTopic::kCamera ||
            !camera.ParseFromArray(message.data.data(), int(message.data.size())))
            return;
        const topics::Eye& eye = camera.eye();
        if (eye.p_wc_m_size() == 3 && eye.q_wc_size() == 4 && areFinite(eye.p_wc_m()) &&
            areFinite(eye.q_wc()) && camera.tick() < recording.ticks())
            eyes.push_back({camera.tick(), Eigen::Vector3d(eye.p_wc_m().data()),
                            Eigen::Quaterniond(eye.q_wc(0), eye.q_wc(1), eye.q_wc(2), eye.q_wc(3)),
                            eye.field_of_view_rad()});
    });
    std::ranges::stable_sort(eyes, {}, &RecordedEye::tick);
    return eyes;
}

}  // namespace bonemill
