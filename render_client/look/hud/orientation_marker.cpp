#include "render_client/look/hud/orientation_marker.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace bonemill {
namespace {

constexpr float kArm = 2.9f;          // from the middle to a letter's, in units of the text's height
constexpr float kReach = 3.6f;        // and to the marker's rim
constexpr float kAboveCorner = 5.2f;  // from the marker's lower end to the picture's: room for the scale bar
constexpr float kFromEdge = 1.2f;
constexpr float kMinPicture = 30;  // text heights, in both directions
constexpr float kThickArm = 0.2f, kThinArm = 0.11f;
constexpr float kFaintest = 0.35f;    // opacity of what points away from the eye
constexpr float kNearestPair = 1.0f;  // a letter this near to one before it is not written

// Lines and letters have a dark rim, so that they are seen before bright bone too.
constexpr HudColour kRimColour{0.03f, 0.045f, 0.06f, 0.8f};
constexpr float kRim = 1;  // pixel
constexpr HudColour kAxisColours[] = {
    {1.0f, 0.55f, 0.50f, 1}, {0.55f, 0.90f, 0.55f, 1}, {0.58f, 0.76f, 1.0f, 1}};

// W is LPS: x to the patient's left, y to the back (posterior), z to the head (superior).
constexpr std::string_view kPatientsPositive = "LPS", kPatientsNegative = "RAI", kVolumes = "xyz";

HudColour colourOf(const OrientationEnd& end) {
    HudColour colour = kAxisColours[end.axis];
    colour[3] = kFaintest + (1 - kFaintest) * (end.nearness + 1) / 2;
    return colour;
}

void addLetter(HudCanvas& canvas, char letter, float x, float y, const HudColour& colour) {
    const std::string_view text(&letter, 1);
    const float left = x - canvas.width(text, FontStyle::kBold) / 2, base = y + 0.36f * canvas.em();
    canvas.text(left + kRim, base + kRim, text, FontStyle::kBold, kRimColour);
    canvas.text(left - kRim, base - kRim, text, FontStyle::kBold, kRimColour);
    canvas.text(left, base, text, FontStyle::kBold, colour);
}

}  // namespace

std::vector<OrientationEnd> orientationEnds(const OrientationAxes& axes) {
    std::vector<OrientationEnd> ends;
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3f along = axes.R_CA.col(axis);
        const auto n = size_t(axis);
        ends.push_back(
            {axes.are_patients ? kPatientsPositive[n] : kVolumes[n], axis, true, along.head<2>(), along.z()});
        if (axes.are_patients)
            ends.push_back({kPatientsNegative[n], axis, false, -along.head<2>(), -along.z()});
    }
    std::ranges::stable_sort(ends, {}, &OrientationEnd::nearness);
    return ends;
}

void layOutOrientation(HudCanvas& canvas, const OrientationAxes& axes, const PictureSize& picture) {
    const float em = canvas.em();
    const auto width = float(picture.width), height = float(picture.height);
    if (std::min(width, height) < kMinPicture * em) return;
    const Eigen::Vector2f middle(width - (kFromEdge + kReach) * em, height - (kAboveCorner + kReach) * em);
    const std::vector<OrientationEnd> ends = orientationEnds(axes);
    const auto placeOf = [&](const OrientationEnd& end) -> Eigen::Vector2f {
        return middle + kArm * em * Eigen::Vector2f(end.towards.x(), -end.towards.y());
    };
    for (size_t n = 0; n < ends.size(); ++n) {
        const OrientationEnd& end = ends[n];
        const Eigen::Vector2f place = placeOf(end);
        const float letter_part = std::max(1 - 0.75f / (kArm * std::max(end.towards.norm(), 0.01f)), 0.0f);
        const Eigen::Vector2f tip = middle + letter_part * (place - middle);
        const float thickness = (end.is_positive ? kThickArm : kThinArm) * em;
        canvas.line(middle, tip, thickness + 2 * kRim, kRimColour);
        canvas.line(middle, tip, thickness, colourOf(end));
        const bool is_covered =
            std::any_of(ends.begin() + ptrdiff_t(n) + 1, ends.end(),
                        [&](const auto& near) { return (placeOf(near) - place).norm() < kNearestPair * em; });
        if (!is_covered) addLetter(canvas, end.letter, place.x(), place.y(), colourOf(end));
    }
}

}  // namespace bonemill
