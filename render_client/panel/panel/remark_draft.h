// What the panel keeps of a note between two pictures, while it is being typed. It belongs to the render
// thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace bonemill {

struct RemarkDraft {
    std::array<char, 301> note{};          // as typed so far, zero-terminated UTF-8
    std::optional<Eigen::Vector3d> place;  // W; nothing: the note belongs to no place
    bool wants_keyboard = false;           // it is to be typed from now on
    bool leaves_keyboard = false;          // it was sent: keys are the viewer's again
};

}  // namespace bonemill
