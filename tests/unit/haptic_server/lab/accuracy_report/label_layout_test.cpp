#include <gtest/gtest.h>

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {
namespace {

bool overlap(const PlotLabel& a, const PlotLabel& b) {
    const Eigen::Vector2d room = labelHalfSize(a.text) + labelHalfSize(b.text);
    return ((a.center - b.center).cwiseAbs().array() < room.array()).all();
}

TEST(LabelLayout, CrowdedPointsGetLabelsThatDoNotHideEachOther) {
    std::vector<PlotLabel> labels;
    for (int n = 0; n < 12; ++n)
        labels.push_back({.point = Eigen::Vector2d(300 + 4 * n, 200 - 3 * (n % 4)),
                          .text = n == 5 ? "balanced" : std::to_string(n)});
    layOutLabels(labels);
    bool any_line = false;
    for (size_t i = 0; i < labels.size(); ++i) {
        any_line |= labels[i].needs_line;
        for (size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(labels[i], labels[j])) << i << ' ' << j;
        for (const PlotLabel& other : labels) {
            const Eigen::Vector2d away =
                (other.point - labels[i].center).cwiseAbs() - labelHalfSize(labels[i].text);
            EXPECT_GT(away.maxCoeff(), 0) << "a point lies under label " << i;
        }
    }
    EXPECT_TRUE(any_line);
}

TEST(LabelLayout, ALonelyPointHasItsLabelBesideIt) {
    std::vector<PlotLabel> labels{{.point = {100, 100}, .text = "exact"}};
    layOutLabels(labels);
    EXPECT_LT((labels[0].center - labels[0].point).norm(), 40);
    EXPECT_FALSE(labels[0].needs_line);
}

}  // namespace
}  // namespace bonemill
