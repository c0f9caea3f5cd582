#include "render_client/panel/panel/panel_memory.h"

#include <algorithm>
#include <set>
#include <utility>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr uint32_t kMaxSide = 512;  // pixels

ScenePicture decoded(const std::string& png) {
    ScenePicture picture{.png = png, .pixels = {}};
    if (auto pixels = pixelsOfPng(png, kMaxSide)) picture.pixels = std::move(*pixels);
    return picture;
}

}  // namespace

void ScenePictures::follow(const SessionView& session) {
    std::set<std::string> known;
    const auto take = [&](const std::string& name, const std::string& png) {
        if (!known.insert(name).second) return;  // two of one name would take turns
        ScenePicture& picture = pictures_[name];
        if (picture.png == png) return;
        picture = decoded(png);
        if (picture.pixels.width > 0) picture.number = ++last_number_;
    };
    if (session.lesson)
        for (const topics::SceneChoice& scene : session.lesson->scenes()) take(scene.id(), scene.picture());
    if (session.past)
        for (const PastAttempt& attempt : *session.past) take(attempt.stem, attempt.picture);
    std::erase_if(pictures_, [&](const auto& entry) { return !known.contains(entry.first); });
}

void LessonDraft::follow(const SessionView& session) {
    if (!session.lesson) return;
    const topics::Lesson& lesson = *session.lesson;
    const uint32_t last = lesson.attempts().empty() ? 0 : lesson.attempts().rbegin()->number();
    const bool has_looked = std::exchange(has_looked_, true);
    const bool is_new_scene = std::exchange(scene_id_, lesson.scene_id()) != lesson.scene_id();
    const bool was_running = std::exchange(was_running_, lesson.is_running());
    const uint32_t last_before = std::exchange(last_attempt_, last);
    if ((is_new_scene || !was_running) && (is_new_scene || lesson.is_running()))
        task_since_s_ = session.time_s;
    countTime(session, has_looked);
    scrolls_to_top = scrolls_to_top || (has_looked && is_new_scene);
    if (lesson.is_running() && !was_running) summary_ = 0;
    if (has_looked && last > last_before) summary_ = lesson.is_running() ? 0 : last;
}

void LessonDraft::countTime(const SessionView& session, bool has_looked) {
    const topics::Lesson& lesson = *session.lesson;
    const double passed = session.time_s - std::exchange(counted_s_, session.time_s);
    if (!lesson.is_running()) return attempt_s_.reset();
    const bool begins =
        std::exchange(start_stamp_ns_, lesson.start_stamp_ns()) != lesson.start_stamp_ns() || !attempt_s_;
    const bool is_paused = session.status && session.status->is_milling_paused();
    if (begins) {
        const double since_s = double(session.realtime_ns - lesson.start_stamp_ns()) * 1e-9;
        attempt_s_ = has_looked ? 0 : std::max(since_s, 0.0);
        leaves_keyboard = std::exchange(has_entered, false);
    } else if (!is_paused) {
        *attempt_s_ += passed;
    }
}

float LessonDraft::taskOpacity(double time_s) const {
    if (!task_since_s_) return 0;
    return float(std::clamp((kTaskTime - (time_s - *task_since_s_)) / kFadeTime, 0.0, 1.0));
}

const topics::Attempt* LessonDraft::summary(const SessionView& session) const {
    if (!session.lesson || summary_ == 0) return nullptr;
    for (const topics::Attempt& attempt : session.lesson->attempts())
        if (attempt.number() == summary_) return &attempt;
    return nullptr;
}

const topics::SceneChoice* sceneOf(const topics::Lesson& lesson, const std::string& id) {
    const auto scene = std::ranges::find(lesson.scenes(), id, [](const auto& choice) { return choice.id(); });
    return scene == lesson.scenes().end() ? nullptr : &*scene;
}

std::string panelTitle(const SessionView& session) {
    const bool teaches = session.lesson && session.lesson->scenes_size() > 0;
    return withKey(teaches ? tr("Lesson") : tr("Controls"), Action::kPanel);
}

}  // namespace bonemill
