#include "render_client/apps/render_client/past_list.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "common/base/is_ready.h"
#include "common/files/whole_file.h"
#include "common/process/run_captured.h"

namespace bonemill {

void PastList::follow(const std::string& launcher, bool is_open, const SessionView& session) {
    if (launcher.empty()) return;
    take();
    if (made_.valid()) return;
    const topics::Lesson* const lesson = session.lesson;
    const bool has_attempts = lesson && !lesson->attempts().empty();
    const std::string newest = has_attempts ? lesson->attempts().rbegin()->verdict().results() : "";
    const std::string scene_hash = isReplay(session) ? session.status->replay().scene_hash() : "";
    const std::string now = std::to_string(is_open) + newest + ' ' + std::to_string(kept_) + ' ' + scene_hash;
    if (std::exchange(seen_, now) == now || !is_open) return;
    made_ = std::async(std::launch::async, [launcher, scene_hash] { return listsOf(launcher, scene_hash); });
}

PastList::Lists PastList::listsOf(const std::string& launcher, const std::string& scene_hash) {
    Lists lists;
    lists.all = pastAttemptsOf(runCaptured({launcher, "sessions", "--tab-separated"}).out);
    if (!scene_hash.empty())
        lists.same_scene =
            pastAttemptsOf(runCaptured({launcher, "sessions", "--tab-separated", "--scene", scene_hash}).out);
    return lists;
}

void PastList::take() {
    try {
        if (isReady(made_)) lists_ = made_.get();
        if (!isReady(keeping_)) return;
        keeping_.get();
        ++kept_;
    } catch (const std::exception& error) {
        spdlog::warn("{}", error.what());
    }
}

void PastList::keep(const std::string& stem, Picture picture) {
    keeping_ = std::async(std::launch::async, [stem, picture = std::move(picture)] {
        writePrivateFile(stem + ".png", pngOf(picture));
    });
}

}  // namespace bonemill
