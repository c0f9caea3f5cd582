#include "haptic_server/server/replay/comparison.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <utility>

#include "common/config/shown_colours.h"
#include "common/geometry/node_mesh.h"
#include "common/text/foreign_text.h"
#include "common/text/hex_text.h"
#include "haptic_server/server/replay/low_priority.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kFollowEvery = 2ms;
constexpr auto kMostAtOnce = 20ms;  // then orders are looked at
constexpr const char* kNothingCompared = "no other attempt is compared: choose one first";
constexpr size_t kMostProblem = 400;  // bytes, with the paths of two files
// Recorded time by which the other tool may lag and still be seen as going along.
constexpr double kNearS = 0.1;

constexpr const char* kShownParts[DifferencePaint::kParts] = {
    "removed here alone", "removed by the other alone", "removed by both"};

}  // namespace

void Comparison::run(const std::stop_token& stop) {
    takeLowPriority(kNiceBeside);
    bool is_arrived = true;
    while (!stop.stop_requested()) {
        std::optional<Wish> wish = awaitWish(stop, is_arrived);
        try {
            if (wish) open(std::move(*wish));
            is_arrived = !companion_ || follow(stop);
        } catch (const std::exception& error) {
            giveUp(printableLine(error.what(), kMostProblem));
            is_arrived = true;
        }
    }
}

// What lags behind the replay does not rest.
std::optional<Comparison::Wish> Comparison::awaitWish(const std::stop_token& stop, bool is_arrived) {
    std::unique_lock lock(mutex_);
    const auto is_wished = [this] { return wish_.has_value(); };
    if (!companion_)
        changed_.wait(lock, stop, is_wished);
    else if (is_arrived)
        changed_.wait_for(lock, stop, kFollowEvery, is_wished);
    return std::exchange(wish_, std::nullopt);
}

void Comparison::open(Wish wish) {
    takeAway();
    if (wish.isNone()) return;
    if (!wish.attempt)
        wish.attempt = openCompared({resultOfName(folders_, wish.result), 0}, folders_, shown_.recording);
    begin(std::move(*wish.attempt));
}

void Comparison::takeAway() {
    companion_.reset();
    const std::lock_guard lock(mutex_);
    paint_.reset();
    bone_.reset();
    X_WT_.reset();
}

void Comparison::giveUp(const std::string& problem) {
    spdlog::warn("the replay goes on without another attempt: {}", problem);
    takeAway();
    const std::lock_guard lock(mutex_);
    if (wish_ || !state_) return;  // another one is to be compared by now
    state_->set_problem(problem);
    state_->set_is_on_its_way(false);
}

void Comparison::begin(ComparedAttempt attempt) {
    companion_ = std::make_unique<Companion>(std::move(attempt), shown_.recording, shown_.simulation,
                                             shown_.scene, shown_.scanned);
    spdlog::info("compared with {}: {:.1f} s", companion_->text(), companion_->lengthS());
    const std::lock_guard lock(mutex_);
    bone_ = companion_->bone();
    if (first_material_ != 0)
        paint_ = std::make_shared<const DifferencePaint>(shown_.scanned, shown_.simulation.bone->volume,
                                                         companion_->bone(), first_material_);
}

bool Comparison::follow(const std::stop_token& stop) {
    const bool is_arrived = companion_->follow(shown_.player.shown(), kMostAtOnce, stop);
    const bool is_near = companion_->awayS() < kNearS;
    const std::lock_guard lock(mutex_);
    X_WT_ = is_near ? companion_->X_WT() : std::nullopt;
    if (wish_ || !state_) return is_arrived;
    state_->set_attempt(companion_->text());
    state_->set_attempt_s(companion_->attemptS());
    state_->set_length_s(companion_->lengthS());
    state_->set_is_on_its_way(!is_near);
    return is_arrived;
}

void Comparison::wish(Wish wish, const std::string& name) {
    {
        const std::lock_guard lock(mutex_);
        state_.reset();
        if (!wish.isNone()) {
            state_.emplace().set_attempt(name);
            state_->set_is_on_its_way(true);
        }
        wish_ = std::move(wish);
    }
    changed_.notify_all();
}

void Comparison::compareWith(ComparedAttempt attempt) {
    const std::string name = attempt.text;
    wish({std::move(attempt), ""}, name);
}

// A viewer may name a result, never a file: whatever it says, nothing else of this PC is opened.
Answer Comparison::compareWithResult(const std::string& name) {
    if (folders_.classes.empty() || folders_.recordings.empty())
        return Answer::refused(
            "this replay does not know where attempts are: begin it with `bonemill replay`, or with "
            "--classes and --recordings");
    if (name.find('/') != std::string::npos || name.find('\0') != std::string::npos)
        return Answer::refused("'" + repeatedText(name) + "' is no name of a result");
    wish({{}, name}, printableLine(name));
    return Answer::done();
}

Answer Comparison::compareWithNone() {
    wish({});
    return Answer::done();
}

Answer Comparison::showDifference(bool is_shown) {
    const std::lock_guard lock(mutex_);
    if (first_material_ == 0)
        return Answer::refused(
            "the scene's materials and zones leave no numbers for the difference's colours");
    if (is_shown && !isCompared()) return Answer::refused(kNothingCompared);
    shows_difference_ = is_shown;
    return Answer::done();
}

Answer Comparison::showBeside(bool is_shown) {
    const std::lock_guard lock(mutex_);
    if (is_shown && !isCompared()) return Answer::refused(kNothingCompared);
    shows_beside_ = is_shown;
    return Answer::done();
}

void Comparison::describe(topics::Replay& replay) const {
    replay.set_scene_hash(hexText(shown_.recording.manifest().scene_hash()));
    const std::lock_guard lock(mutex_);
    if (!state_) return;
    topics::Comparison& comparison = *replay.mutable_comparison();
    comparison = *state_;
    comparison.set_shows_difference(shows_difference_);
    comparison.set_first_material(first_material_);
    comparison.set_shows_beside(shows_beside_);
}

std::optional<Pose> Comparison::otherTool() const {
    const std::lock_guard lock(mutex_);
    return X_WT_;
}

void Comparison::extend(topics::SceneInfo& info) {
    first_leaf_ = info.leaf_count();
    info.set_other_first_leaf(first_leaf_);
    info.set_leaf_count(first_leaf_ + shown_.simulation.bone->lattice.leafCount());
    if (info.materials_size() + DifferencePaint::kParts > kMaxVertexMaterials) return;
    first_material_ = uint8_t(info.materials_size() + 1);
    for (size_t part = 0; part < DifferencePaint::kParts; ++part) {
        scene::Material& shown = *info.add_materials();
        shown.set_name(kShownParts[part]);
        shown.mutable_color()->set_red(kDifferenceColours[part][0]);
        shown.mutable_color()->set_green(kDifferenceColours[part][1]);
        shown.mutable_color()->set_blue(kDifferenceColours[part][2]);
    }
}

std::shared_ptr<const VertexPaint> Comparison::paint() const {
    const std::lock_guard lock(mutex_);
    return shows_difference_ ? paint_ : nullptr;
}

std::shared_ptr<const BoneModel> Comparison::boneBeside() const {
    const std::lock_guard lock(mutex_);
    return shows_beside_ ? bone_ : nullptr;
}

}  // namespace bonemill
