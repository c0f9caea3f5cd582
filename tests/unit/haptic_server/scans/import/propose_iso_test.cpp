// The histograms are made here, in the shapes that real scans have.
#include "haptic_server/scans/find_bone/propose_iso.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/sampled_body.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

struct Material {
    double mean, sigma, share;
};

RawVolume mixtureOf(const std::vector<Material>& materials, double offset = 0,
                    const std::vector<float>& odd = {}) {
    std::mt19937 random(11);
    RawVolume raw;
    raw.geometry.dims = {100, 100, 40};
    std::vector<float> values;
    for (const Material& m : materials) {
        std::normal_distribution<double> value(m.mean + offset, m.sigma);
        const auto count = size_t(m.share * 400000);
        for (size_t n = 0; n < count; ++n) values.push_back(float(std::round(value(random))));
    }
    values.resize(400000, values.front());
    std::copy(odd.begin(), odd.end(), values.begin());
    raw.values.append(std::move(values));
    return raw;
}

const std::vector<Material> kHead = {
    {-1000, 15, 0.5}, {-90, 25, 0.05}, {40, 20, 0.3}, {500, 200, 0.1}, {1200, 200, 0.05}};

TEST(ProposeIso, hounsfieldHeadGivesABoneThreshold) {
    RawVolume head = mixtureOf(kHead);
    head.is_hounsfield = true;
    const double iso = proposeIso(head).value;
    EXPECT_GE(iso, 200);
    EXPECT_LE(iso, 300);
    head.is_hounsfield = false;  // a NRRD does not say so, but air at -1000 does
    EXPECT_EQ(proposeIso(head).value, iso);
}

TEST(ProposeIso, scaleShiftedBy1024IsRecognised) {
    const double iso =
        proposeIso(mixtureOf({{-1000, 15, 0.5}, {40, 20, 0.35}, {700, 300, 0.15}}, 1024)).value;
    EXPECT_GE(iso, 1224);
    EXPECT_LE(iso, 1324);
}

TEST(ProposeIso, weakBoneLowersTheThreshold) {
    const double strong = proposeIso(mixtureOf({{-1000, 15, 0.4}, {30, 15, 0.4}, {900, 100, 0.2}})).value;
    const double weak = proposeIso(mixtureOf({{-1000, 15, 0.4}, {30, 15, 0.4}, {350, 40, 0.2}})).value;
    EXPECT_EQ(strong, 300);
    EXPECT_LT(weak, 250);
    EXPECT_GE(weak, 200);
}

// The shape is that of an industrial CT of a tooth: air, dentine, enamel, and a pulp cavity darker than the
// air outside.
TEST(ProposeIso, industrialScanGivesTheMiddleOfAirAndDentine) {
    const double iso =
        proposeIso(mixtureOf({{390, 15, 0.7}, {150, 40, 0.02}, {825, 20, 0.2}, {1190, 25, 0.08}})).value;
    EXPECT_NEAR(iso, (390 + 825) / 2.0, 15);
}

TEST(ProposeIso, eightBitScanWorksLikeSixteen) {
    const double iso =
        proposeIso(mixtureOf({{77, 3, 0.7}, {30, 8, 0.02}, {162, 4, 0.2}, {232, 5, 0.08}})).value;
    EXPECT_NEAR(iso, 119.5, 3);
}

// 8 bit, -1000 .. 2000 HU: half-way from air to tissue would be the skin.
TEST(ProposeIso, eightBitHeadGivesBoneAndSaysThatItIsAGuess) {
    const IsoProposal head =
        proposeIso(mixtureOf({{2, 1, 0.5}, {78, 2, 0.04}, {88, 2, 0.38}, {130, 14, 0.05}, {185, 17, 0.03}}));
    EXPECT_GT(head.value, 88 + 10);
    EXPECT_LT(head.value, 130);
    EXPECT_EQ(head.doubt, IsoDoubt::kLarge);
    ASSERT_TRUE(head.runner_up);
    EXPECT_NEAR(*head.runner_up, 43, 5);
    EXPECT_NE(textOf(head).find("a guess"), std::string::npos);
    EXPECT_NE(textOf(head).find("the next best is"), std::string::npos);
}

RawVolume cutTo8Bit(RawVolume raw) {
    std::vector<uint8_t> values;
    for (size_t n = 0; n < raw.values.size(); ++n)
        values.push_back(uint8_t(std::clamp(raw.values[n], 0.0f, 255.0f)));
    raw.values = {};
    raw.values.append(std::move(values));
    return raw;
}

// -1000 .. 1000 HU: lung, fat, soft tissue, cancellous bone, and a cortex of which much is denser than the
// scale goes. Half-way from tissue to what is cut off would be 194, and lose the cancellous bone.
TEST(ProposeIso, eightBitSpineThatIsCutOffGivesBone) {
    const IsoProposal proposed = proposeIso(cutTo8Bit(
        mixtureOf({{133, 4, 0.47}, {18, 4, 0.25}, {117, 4, 0.2}, {165, 18, 0.04}, {215, 40, 0.04}})));
    EXPECT_NEAR(proposed.value, 159, 8);
    EXPECT_EQ(proposed.doubt, IsoDoubt::kLarge);
}

// What lies at the end of the scale is no heap of something else where little is on the way to it.
TEST(ProposeIso, eightBitPlateauAtTheEndOfTheScaleIsAMaterial) {
    const IsoProposal proposed =
        proposeIso(cutTo8Bit(mixtureOf({{0, 0.1, 0.5}, {128, 60, 0.06}, {255, 0.1, 0.44}})));
    EXPECT_NEAR(proposed.value, 127.5, 5);
}

TEST(ProposeIso, saysHowSureItIs) {
    RawVolume head = mixtureOf(kHead);
    EXPECT_EQ(proposeIso(head).doubt, IsoDoubt::kLittle);
    EXPECT_NEAR(proposeIso(head).bone_share, 0.14, 0.02);
    const IsoProposal tooth = proposeIso(mixtureOf({{77, 3, 0.7}, {162, 4, 0.2}, {232, 5, 0.08}}));
    EXPECT_EQ(tooth.doubt, IsoDoubt::kSome);
    ASSERT_TRUE(tooth.runner_up);
    EXPECT_NEAR(*tooth.runner_up, 197, 3) << "the enamel";
}

TEST(ProposeIso, saysThatThereIsHardlyAnyBone) {
    const std::string text =
        textOf(proposeIso(mixtureOf({{-1000, 15, 0.5}, {40, 20, 0.4999}, {600, 100, 0.0001}})));
    EXPECT_NE(text.find("there may be no bone"), std::string::npos) << text;
}

TEST(ProposeIso, dryToothInHounsfieldIsCutAtHalfMaximum) {
    EXPECT_NEAR(proposeIso(mixtureOf({{-1000, 10, 0.9}, {1600, 30, 0.07}, {2900, 30, 0.03}})).value, 300, 30);
}

TEST(ProposeIso, analyticBodyIsCutInTheMiddle) {
    AnalyticBody slab;
    slab.kind = BodyKind::kSlab;
    slab.thickness = 6e-3;
    for (const double full : {255.0, 65535.0})
        EXPECT_NEAR(proposeIso(sampleBody(slab, centredGrid({40, 40, 64}, 0.25e-3), full)).value, full / 2,
                    0.01 * full);
}

TEST(ProposeIso, oddValuesDoNotMoveIt) {
    const std::vector<Material> materials = {{390, 15, 0.75}, {825, 20, 0.25}};
    const std::vector<float> odd = {std::numeric_limits<float>::quiet_NaN(),
                                    std::numeric_limits<float>::infinity(), 1e30f};
    EXPECT_NEAR(proposeIso(mixtureOf(materials, 0, odd)).value, proposeIso(mixtureOf(materials)).value, 5);
}

TEST(ProposeIso, constantVolumeIsRefused) {
    for (const float value : {7.0f, std::numeric_limits<float>::quiet_NaN()}) {
        RawVolume raw;
        raw.geometry.dims = {4, 4, 4};
        raw.values.append(std::vector<float>(64, value));
        expectUserError([&] { proposeIso(raw).value; }, {"alike"});
    }
}

}  // namespace
}  // namespace bonemill
