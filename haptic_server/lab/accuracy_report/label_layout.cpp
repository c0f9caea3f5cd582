#include "haptic_server/lab/accuracy_report/label_layout.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector2d;

constexpr double kCharacterWidth = 8, kTextHeight = 15;  // pixels, of the plot's label font, rounded up
constexpr double kPointRadius = 6;
constexpr double kGaps[] = {3, 14, 28, 45, 65, 90};  // between point and text
constexpr double kLongestGapWithoutLine = 3;
constexpr int kDirections = 16;

struct Rectangle {
    Vector2d center, half;
    bool overlaps(const Rectangle& other) const {
        return ((center - other.center).cwiseAbs().array() < (half + other.half).array()).all();
    }
};

// The text's middle lies there when it is `gap` outside of the point in this direction.
Vector2d placeAt(const PlotLabel& label, int direction, double gap) {
    const double angle = M_PI / 4 + 2 * M_PI * direction / kDirections;  // first: right above
    const Vector2d unit(std::cos(angle), std::sin(angle));
    return label.point + unit.cwiseProduct(labelHalfSize(label.text)) + (kPointRadius + gap) * unit;
}

}  // namespace

Eigen::Vector2d labelHalfSize(const std::string& text) {
    return {kCharacterWidth * double(text.size()) / 2, kTextHeight / 2};
}

void layOutLabels(std::vector<PlotLabel>& labels) {
    std::vector<Rectangle> taken;
    for (const PlotLabel& label : labels) taken.push_back({label.point, Vector2d::Constant(kPointRadius)});
    for (PlotLabel& label : labels) {
        const Vector2d half = labelHalfSize(label.text);
        const auto isFree = [&](const Vector2d& center) {
            return std::none_of(taken.begin(), taken.end(), [&](const Rectangle& r) {
                return r.overlaps({center, half});
            });
        };
        bool is_placed = false;
        label.center = placeAt(label, 0, kGaps[0]);
        for (const double gap : kGaps)
            for (int direction = 0; direction < kDirections && !is_placed; ++direction) {
                const Vector2d center = placeAt(label, direction, gap);
                if (!isFree(center)) continue;
                is_placed = true;
                label.center = center;
                label.needs_line = gap > kLongestGapWithoutLine;
            }
        taken.push_back({label.center, half});
    }
}

}  // namespace bonemill
