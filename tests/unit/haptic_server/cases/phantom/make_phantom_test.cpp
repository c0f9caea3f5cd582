// Runs the program as a user does.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/temporal_bone_phantom.h"
#include "haptic_server/cases/phantom/third_molar_phantom.h"
#include "haptic_server/cases/phantom/vertebra_phantom.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/places.h"
#include "tests/support/sampled_body.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

struct Outcome {
    int code = -1;
    std::string output;  // stdout and stderr
};

Outcome runMakePhantom(const std::string& arguments) {
    Outcome outcome;
    FILE* pipe = popen((test::binDir() + "/make_phantom " + arguments + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    char buffer[256];
    while (std::fgets(buffer, sizeof buffer, pipe)) outcome.output += buffer;
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
    return outcome;
}

TEST(MakePhantom, bodyFileHoldsTheStatedSurface) {
    const test::TemporaryFolder folder;
    const std::string file = folder / "hole.nrrd";
    const Outcome outcome = runMakePhantom("body --kind hole --out " + file +
                                           " --voxel-mm 0.2 --bits 8 --dims 40 41 42 --rotate-deg 10 20 30"
                                           " --offset-mm 0.5 -0.25 0.125 --radius-mm 1.5 --thickness-mm 3");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const RawVolume raw = importVolume(file);
    AnalyticBody body;
    body.kind = BodyKind::kHole;
    body.radius = 1.5e-3;
    body.thickness = 3e-3;
    body.X_WB.rotation = Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(20 * kDegree, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(10 * kDegree, Eigen::Vector3d::UnitX());
    body.X_WB.position = {0.5e-3, -0.25e-3, 0.125e-3};
    EXPECT_EQ(raw.values, sampleBody(body, raw.geometry, 255).values);
    EXPECT_EQ(raw.geometry.dims, Eigen::Vector3i(40, 41, 42));
    EXPECT_LT(
        (raw.geometry.X_WV * (raw.geometry.spacing.cwiseProduct(Eigen::Vector3d(19.5, 20, 20.5)))).norm(),
        1e-12);
}

// at() is the value at a position in W, mm, that lies on a voxel or on a line of the grid.
class Grid {
  public:
    explicit Grid(const std::string& file) : raw_(importVolume(file)) {}
    double at(double x_mm, double y_mm, double z_mm) const {
        const VolumeGeometry& g = raw_.geometry;
        const Eigen::Vector3d index =
            (g.X_WV.inverse() * (Eigen::Vector3d(x_mm, y_mm, z_mm) * kMillimetre)).cwiseQuotient(g.spacing);
        const Eigen::Vector3i low = index.array().floor().cast<int>().max(0).min(g.dims.array() - 2);
        const Eigen::Vector3d f = index - low.cast<double>();
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            Eigen::Vector3i v = low;
            for (int axis = 0; axis < 3; ++axis) {
                const bool is_high = corner >> axis & 1;
                weight *= is_high ? f[axis] : 1 - f[axis];
                v[axis] += is_high;
            }
            sum += weight *
                   raw_.values[size_t(v.x()) +
                               size_t(g.dims.x()) * (size_t(v.y()) + size_t(g.dims.y()) * size_t(v.z()))];
        }
        return sum;
    }
    const RawVolume& raw() const { return raw_; }

  private:
    RawVolume raw_;
};

TEST(MakePhantom, blockHasItsFacesAndLayersWhereTheyAreSaid) {
    const test::TemporaryFolder folder;
    const Outcome outcome =
        runMakePhantom("block --out " + (folder / "b.nrrd") + " --labels " + (folder / "l.nrrd") +
                       " --size-mm 5.03 4 3.1 --layers 0.7:1800 1.1:900 400 --voxel-mm 0.1");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("surface at 400 HU"), std::string::npos) << outcome.output;
    const Grid hu(folder / "b.nrrd"), label(folder / "l.nrrd");
    EXPECT_EQ(hu.at(0, 0, 0.5), -1000);
    for (const double x : {-1.0, 0.037, 1.234}) {
        EXPECT_NEAR(hu.at(x, 0.02, 0), 400, 1) << "top face, half-way";
        EXPECT_NEAR(hu.at(x, 0.02, -0.7), 1350, 1);
        EXPECT_NEAR(hu.at(x, 0.02, -1.8), 650, 1);
    }
    EXPECT_NEAR(hu.at(2.515, 0.3, -0.35), 400, 1) << "side face";
    EXPECT_EQ(hu.at(0, 0, -0.35), 1800);
    EXPECT_EQ(hu.at(0, 0, -1.25), 900);
    EXPECT_EQ(hu.at(0, 0, -2.5), 400);
    EXPECT_NEAR(hu.at(0, 0, -3.1), -300, 1);
    for (const auto& [z, layer] : {std::pair(0.3, 0), {-0.3, 1}, {-1.2, 2}, {-2.5, 3}, {-3.4, 0}})
        EXPECT_EQ(label.at(0, 0, z), layer) << z;
    EXPECT_EQ(label.raw().geometry.dims, hu.raw().geometry.dims);
    EXPECT_EQ(label.raw().geometry.X_WV.position, hu.raw().geometry.X_WV.position);
}

TEST(MakePhantom, shellFollowsAllFaces) {
    const test::TemporaryFolder folder;
    const Outcome outcome =
        runMakePhantom("block --out " + (folder / "b.nrrd") + " --labels " + (folder / "l.nrrd") +
                       " --size-mm 6 6 6 --layers 1:1800 500 --shell --voxel-mm 0.2");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Grid hu(folder / "b.nrrd"), label(folder / "l.nrrd");
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(2.5, 0, -3), {0, -2.5, -3}, {0, 0, -5.5}, {0, 0, -0.5}}) {
        EXPECT_EQ(hu.at(p.x(), p.y(), p.z()), 1800);
        EXPECT_EQ(label.at(p.x(), p.y(), p.z()), 1);
    }
    EXPECT_EQ(hu.at(0, 0, -3), 500);
    EXPECT_EQ(label.at(0, 0, -3), 2);
}

TEST(MakePhantom, vertebraAndLabelsLieOnOneGrid) {
    const test::TemporaryFolder folder;
    const Outcome outcome = runMakePhantom("vertebra --voxel-mm 2 --out " + (folder / "v.nrrd") +
                                           " --labels " + (folder / "l.nrrd"));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Vertebra vertebra;
    const VertebraScan scan = vertebra.scan(vertebra.grid(2e-3));
    const RawVolume ct = importVolume(folder / "v.nrrd"), labels = importVolume(folder / "l.nrrd");
    EXPECT_EQ(ct.values, scan.ct.values);
    EXPECT_EQ(ct.geometry.dims, labels.geometry.dims);
    EXPECT_EQ(ct.geometry.X_WV.position, labels.geometry.X_WV.position);
    for (size_t n = 0; n < scan.labels.size(); ++n) ASSERT_EQ(labels.values[n], float(scan.labels[n]));
}

TEST(MakePhantom, temporalBoneIsOfTheKindThatIsSaid) {
    const test::TemporaryFolder folder;
    const Outcome outcome = runMakePhantom(
        "temporal_bone --voxel-mm 2 --side right --seed 7 --pneumatisation poor --jugular high "
        "--dura low --out " +
        (folder / "t.nrrd") + " --labels " + (folder / "l.nrrd"));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    TemporalBoneKind kind;
    kind.is_right = kind.has_high_jugular = kind.has_low_dura = true;
    kind.pneumatisation = TemporalBoneKind::Pneumatisation::kPoor;
    kind.seed = 7;
    const TemporalBone bone(kind);
    const TemporalScan scan = bone.scan(bone.grid(2e-3));
    const RawVolume ct = importVolume(folder / "t.nrrd"), labels = importVolume(folder / "l.nrrd");
    EXPECT_EQ(ct.values, scan.ct.values);
    EXPECT_EQ(ct.geometry.X_WV.position, scan.ct.geometry.X_WV.position);
    EXPECT_EQ(ct.geometry.dims, labels.geometry.dims);
    for (size_t n = 0; n < scan.labels.size(); ++n) ASSERT_EQ(labels.values[n], float(scan.labels[n]));
}

TEST(MakePhantom, thirdMolarIsOfTheKindThatIsSaid) {
    const test::TemporaryFolder folder;
    const Outcome outcome = runMakePhantom(
        "third_molar --voxel-mm 2 --side right --seed 7 --impaction deep --nerve touching --out " +
        (folder / "t.nrrd") + " --labels " + (folder / "l.nrrd"));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    ThirdMolarKind kind;
    kind.is_right = true;
    kind.impaction = ThirdMolarKind::Impaction::kDeep;
    kind.nerve = ThirdMolarKind::Nerve::kTouching;
    kind.seed = 7;
    const ThirdMolar molar(kind);
    const MolarScan scan = molar.scan(molar.grid(2e-3));
    const RawVolume ct = importVolume(folder / "t.nrrd"), labels = importVolume(folder / "l.nrrd");
    EXPECT_EQ(ct.values, scan.ct.values);
    for (size_t n = 0; n < scan.labels.size(); ++n) ASSERT_EQ(labels.values[n], float(scan.labels[n]));
}

TEST(MakePhantom, skullLabelsRefuseAnotherScan) {
    const test::TemporaryFolder folder;
    const std::string body = folder / "ball.nrrd";
    ASSERT_EQ(runMakePhantom("body --kind sphere --dims 8 8 8 --out " + body).code, 0);
    const Outcome outcome = runMakePhantom("skull_labels --volume " + body + " --out " + (folder / "l.nrrd"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.output.find(body + ": is not the CT head"), std::string::npos) << outcome.output;
}

TEST(MakePhantom, badArgumentsGiveOneMessageAndCode2) {
    const test::TemporaryFolder folder;
    const std::string out = " --out " + (folder / "a.nrrd");
    const std::pair<std::string, std::string> cases[] = {
        {"", "subcommand"},
        {"body --kind sphere", "--out"},
        {"body --kind cube" + out, "cube"},
        {"body --kind sphere --radius-mm -1" + out, "--radius-mm"},
        {"body --kind sphere --radius-mm nan" + out, "--radius-mm"},
        {"body --kind slab --bits 12" + out, "--bits"},
        {"body --kind slab --dims 1 2 3" + out, "--dims"},
        {"body --kind slab --dims 64 64" + out, "--dims"},
        {"body --kind slab --voxel-mm 0" + out, "--voxel-mm"},
        {"body --kind wedge --angle-deg 180" + out, "--angle-deg"},
        {"body --kind slab --thicknes-mm 3" + out, "--thicknes-mm"},
        {"body --kind slab --out /nonexistent/a.nrrd", "/nonexistent/a.nrrd"},
        {"block", "--out"},
        {"block --layers 1500 800" + out, "how thick"},
        {"block --layers 1:99999" + out, "no layer"},
        {"block --layers nan:5 4" + out, "no layer"},
        {"block --layers x" + out, "no layer"},
        {"block --size-mm 900 900 900" + out, "2^30"},
        {"block --size-mm 1 1" + out, "--size-mm"},
        {"tooth", "--out"},
        {"vertebra", "--out"},
        {"vertebra --voxel-mm 0.01" + out, "--voxel-mm"},
        {"vertebra --voxel-mm 2 --out /nonexistent/a.nrrd", "/nonexistent/a.nrrd"},
        {"temporal_bone", "--out"},
        {"temporal_bone --voxel-mm 0.05" + out, "--voxel-mm"},
        {"temporal_bone --side middle" + out, "--side"},
        {"temporal_bone --pneumatisation 1" + out, "--pneumatisation"},
        {"temporal_bone --seed -1" + out, "--seed"},
        {"temporal_bone --dura high" + out, "--dura"},
        {"third_molar" + out + " --impaction high", "--impaction"},
        {"third_molar" + out + " --nerve cut", "--nerve"},
        {"skull_labels" + out, "--volume"},
        {"skull_labels --volume /nonexistent/a.inv3" + out, "/nonexistent/a.inv3"},
        {"tooth --noise-hu -5 --out " + folder.path().string(), "--noise-hu"},
        {"tooth --seed -5 --out " + folder.path().string(), "--seed"},
    };
    for (const auto& [arguments, word] : cases) {
        const Outcome outcome = runMakePhantom(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments;
        EXPECT_EQ(outcome.output.rfind("error: ", 0), 0u) << outcome.output;
        EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
        EXPECT_NE(outcome.output.find(word), std::string::npos) << outcome.output;
    }
}

TEST(MakePhantom, helpIsNoError) {
    EXPECT_EQ(runMakePhantom("body --help").code, 0);
}

}  // namespace
}  // namespace bonemill
