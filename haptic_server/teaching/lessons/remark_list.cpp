#include "haptic_server/teaching/lessons/remark_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/text/foreign_text.h"

namespace bonemill {
namespace {

Eigen::Vector3d pointOf(const topics::Remark& remark, int n) {
    return {remark.points_m(3 * n), remark.points_m(3 * n + 1), remark.points_m(3 * n + 2)};
}

std::string noteProblem(const topics::Remark& remark) {
    const size_t letters = lettersOf(remark.note());
    if (remark.note().find_first_not_of(' ') == std::string::npos) return "the note is empty";
    if (letters > kMaxNoteLetters)
        return "the note has " + std::to_string(letters) + " letters; " + std::to_string(kMaxNoteLetters) +
               " at most";
    if (hasUnprintable(remark.note())) return "the note has characters that cannot be printed";
    if (remark.points_m_size() > 3) return "a note belongs to one place at most";
    return "";
}

std::string strokeProblem(const topics::Remark& remark) {
    const int points = remark.points_m_size() / 3;
    if (points < 2) return "there is neither a note nor a stroke of two points";
    if (points > kMaxRemarkPoints)
        return "the stroke has " + std::to_string(points) + " points; " + std::to_string(kMaxRemarkPoints) +
               " at most";
    return "";
}

}  // namespace

// What is not finite is not near either.
bool RemarkList::isNear(const Eigen::Vector3d& p_W) const {
    const Eigen::Array3d p_V = volume_.X_WV.inverse() * p_W;
    const Eigen::Array3d size = volume_.dims.cast<double>().array() * volume_.spacing.array();
    return (p_V >= -kFarthest).all() && (p_V <= size + kFarthest).all();
}

std::string RemarkList::problemOf(const topics::Remark& remark) const {
    if (remark.points_m_size() % 3 != 0) return "a point has three coordinates";
    if (std::string problem = remark.note().empty() ? strokeProblem(remark) : noteProblem(remark);
        !problem.empty())
        return problem;
    for (int n = 0; n < remark.points_m_size() / 3; ++n)
        if (!isNear(pointOf(remark, n))) return "point " + std::to_string(n + 1) + " is not at the bone";
    return "";
}

// Returns that of the oldest one where there is no other.
uint32_t RemarkList::freePlace() const {
    if (kept_.size() >= kMaxRemarks)
        return std::ranges::min_element(kept_, {}, [](const auto& kept) { return kept.second.number(); })
            ->first;
    uint32_t place = 0;
    while (kept_.contains(place)) ++place;
    return place;
}

Answer RemarkList::add(const topics::Command& command, double session_s) {
    const topics::Remark& asked = command.add_remark();
    if (const std::string problem = problemOf(asked); !problem.empty()) return Answer::refused(problem);
    topics::Remark remark;
    remark.set_number(++last_number_);
    remark.set_author(cutToBytes(command.name(), kLongestAuthor));
    remark.set_role(command.role());
    remark.set_session_s(session_s);
    remark.set_note(asked.note());
    *remark.mutable_points_m() = asked.points_m();
    remark.set_color(asked.color() & 0xffffff);
    const uint32_t place = freePlace();
    kept_[place] = std::move(remark);
    changed_.insert(place);
    return Answer::done();
}

Answer RemarkList::erase(uint32_t number) {
    const auto erased = std::erase_if(kept_, [&](const auto& kept) {
        const bool is_meant = number == 0 || kept.second.number() == number;
        if (is_meant) changed_.insert(kept.first);
        return is_meant;
    });
    if (erased == 0 && number != 0)
        return Answer::refused("there is no note or stroke " + std::to_string(number) +
                               "; it may be erased already");
    return Answer::done();
}

std::vector<RemarkList::Change> RemarkList::takeChanges() {
    std::vector<Change> changes;
    for (const uint32_t place : std::exchange(changed_, {})) {
        const auto kept = kept_.find(place);
        changes.push_back({place, kept == kept_.end() ? std::nullopt : std::optional(kept->second)});
    }
    return changes;
}

}  // namespace bonemill
