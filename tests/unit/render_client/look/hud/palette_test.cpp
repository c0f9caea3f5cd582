#include "render_client/look/hud/palette.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMinDistance = 30;  // CIE 1976; about 2.3 can just be seen, side by side

Vector3d linearOf(const Srgb& colour) {
    return Vector3d(colour.data()).unaryExpr([](double value) {
        return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    });
}

// L*a*b* of a linear colour, for the white D65 (CIE 15:2004; the matrix of IEC 61966-2-1).
Vector3d labOf(const Vector3d& linear) {
    Matrix3d xyz_of;
    xyz_of << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920,
        0.9503041;
    const Vector3d white(0.95047, 1, 1.08883);
    const Vector3d f = (xyz_of * linear).cwiseQuotient(white).unaryExpr([](double t) {
        return t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : t * 29 * 29 / 108 + 4.0 / 29;
    });
    return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

struct Eyes {
    const char* name;
    Matrix3d seen_of;  // linear
};

// Machado et al. 2009, severity 1.
std::vector<Eyes> allEyes() {
    Matrix3d protan, deutan, tritan;
    protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
    deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
    tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
    return {{"usual", Matrix3d::Identity()},
            {"protanopia", protan},
            {"deuteranopia", deutan},
            {"tritanopia", tritan}};
}

double distanceFor(const Eyes& eyes, const Srgb& a, const Srgb& b) {
    const auto seen = [&](const Srgb& colour) {
        return labOf((eyes.seen_of * linearOf(colour)).cwiseMax(0).cwiseMin(1));
    };
    return (seen(a) - seen(b)).norm();
}

struct Row {
    std::string name;
    std::vector<Srgb> colours;
};

// What stands beside each other in one picture.
std::vector<Row> rowsOf(const Palette& palette) {
    const auto row = [](const char* name, const auto& colours) {
        return Row{name, {colours.begin(), colours.end()}};
    };
    std::vector<Row> rows{row("tones", palette.tones), row("structures", palette.named),
                          row("distance", palette.distance), row("zones", palette.zones),
                          row("differences", palette.differences)};
    rows[1].colours.insert(rows[1].colours.end(), palette.structures.begin(), palette.structures.end());
    return rows;
}

double leastDistance(const Palette& palette, std::string& where) {
    double least = 1e9;
    for (const Eyes& eyes : allEyes())
        for (const Row& row : rowsOf(palette))
            for (size_t i = 0; i < row.colours.size(); ++i)
                for (size_t k = i + 1; k < row.colours.size(); ++k) {
                    const double distance = distanceFor(eyes, row.colours[i], row.colours[k]);
                    if (distance >= least) continue;
                    least = distance;
                    where =
                        row.name + " " + std::to_string(i) + " and " + std::to_string(k) + ", " + eyes.name;
                }
    return least;
}

class Palettes : public testing::Test {
  protected:
    void TearDown() override { usePalette(false); }
};

TEST_F(Palettes, TheDistanceIsThatOfTheCie) {
    EXPECT_NEAR(distanceFor(allEyes()[0], {1, 1, 1}, {0, 0, 0}), 100, 0.1);
    // Red and green of sRGB, by L*a*b* (53.24, 80.09, 67.20) and (87.73, -86.18, 83.18).
    EXPECT_NEAR(distanceFor(allEyes()[0], {1, 0, 0}, {0, 1, 0}), 170.6, 0.2);
}

TEST_F(Palettes, ColourBlindPeopleCanTellApartWhatStandsBesideEachOther) {
    std::string where;
    EXPECT_GE(leastDistance(colourBlindPalette(), where), kMinDistance) << where;
    EXPECT_LT(leastDistance(usualPalette(), where), 15) << "else there would be no need of another";
}

TEST_F(Palettes, OnlyColoursThatNoSceneHasChosenAreExchanged) {
    scene::Color target, own;
    const Srgb& usual = usualPalette().zones[0];
    target.set_red(usual[0]), target.set_green(usual[1]), target.set_blue(usual[2]);
    own.set_red(0.31), own.set_green(0.72), own.set_blue(0.35);
    EXPECT_EQ(shownColour(target).red(), usual[0]);
    usePalette(true);
    EXPECT_EQ(shownColour(target).blue(), colourBlindPalette().zones[0][2]);
    EXPECT_EQ(shownColour(own).red(), 0.31);
}

TEST_F(Palettes, FiguresFollow) {
    const HudColour before = colourOf(HudTone::kAlarm);
    usePalette(true);
    EXPECT_NE(colourOf(HudTone::kAlarm), before);
    EXPECT_EQ(colourOf(HudTone::kPlain)[3], 1);
}

}  // namespace
}  // namespace bonemill
