// Shows the viewer's effects at work on the tooth phantom, without server and clock:
//   effect_show pictures DIR    writes effect_dust.png, effect_bleeding.png, effect_irrigation.png and
//                               effect_spin.png
//   effect_show measure         prints what each effect costs per picture, as one JSON object
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <vector>

#include "common/process/run_program.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/milling_session.h"

namespace bonemill {
namespace {

using test::BurrRun;
using test::MillingSession;

constexpr double kBurrRadius = 1.0e-3;
const Eigen::Vector3d kShaft(0.42, -0.52, 0.75);

VolumeGeometry toothGeometry() {
    VolumeGeometry geometry;
    geometry.dims = {104, 104, 100};
    geometry.spacing.setConstant(1.6e-4);
    return geometry;
}

// V is the phantom's frame, moved so that the crown lies in the grid.
const Eigen::Vector3d kOrigin_W(-8.3e-3, -8.3e-3, 6e-3);

// Estimates the distance from the phantom's tissues around; the estimate is right near the surface.
double toothDistance(const Eigen::Vector3d& p_V) {
    constexpr double kStep = 1.6e-4;
    int inside = 0, all = 0;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x, ++all)
                inside +=
                    toothTissue(kOrigin_W + p_V + kStep * Eigen::Vector3d(x, y, z)) != ToothTissue::kAir;
    return (0.5 - double(inside) / all) * 3 * kStep;
}

// It is made once, because the phantom is slow.
const VoxelVolume& tooth() {
    static const VoxelVolume kTooth = MillingSession::makeVolume(toothGeometry(), toothDistance);
    return kTooth;
}

struct Stage {
    Stage(int width, int height, const scene::Effects& wish)
        : context(width, height), scene(context.gl()), session(tooth(), kBurrRadius) {
        const Eigen::Vector3d low(2.6e-3, 2.6e-3, 0), high(14e-3, 14e-3, 14e-3);
        info = test::makeSceneInfo("tooth", low, high);
        *info.mutable_tool() = test::makeToolMesh(kBurrRadius, 4.5e-4, 0.022);
        info.set_burr_radius_m(kBurrRadius);
        *info.mutable_viewer_effects() = wish;
        auto* camera = info.mutable_camera();
        camera->set_has_target(true);
        test::setVector({8.0e-3, 6.6e-3, 10.6e-3}, camera->mutable_target_m());
        camera->set_distance_m(0.019);
        camera->set_azimuth_rad(-0.5);
        camera->set_elevation_rad(0.62);
        scene.setSceneInfo(info);
        scene.settings().show_hud = false;
        scene.settings().show_force = false;
        session.show(scene);
    }
    // Mills a groove over the front of the crown.
    void mill(const BurrRun& run) {
        const Pose start = test::toolAt({6.2e-3, 3.3e-3, 10.6e-3}, kShaft);
        Pose from = start, to = start;
        to.position += Eigen::Vector3d(3.6e-3, -0.2e-3, 0.2e-3);
        session.stroke(scene, from, to, 1.2, run);
        std::swap(from, to);
        to.position += Eigen::Vector3d(0.2e-3, 0.5e-3, 0.9e-3);
        session.stroke(scene, from, to, 1.2, run);
        from = to;
        to.position += Eigen::Vector3d(2.2e-3, 0.2e-3, 0.1e-3);
        session.stroke(scene, from, to, 0.8, run);
        last = to;
    }
    void leave() {
        Pose away = last;
        away.position += Eigen::Vector3d(1.5e-3, -4.2e-3, 3.6e-3);
        session.stroke(scene, last, away, 0.4, {.is_pedal_down = false});
        last = away;
    }
    Picture draw() {
        scene.draw(context_width, context_height, 1);
        return context.read();
    }

    OsmesaContext context;
    RenderScene scene;
    MillingSession session;
    topics::SceneInfo info;
    Pose last;
    int context_width = 960, context_height = 640;
};

void save(Stage& stage, const std::filesystem::path& path) {
    writePng(stage.draw(), path);
    std::cout << path.string() << std::endl;
}

void drawDust(const std::filesystem::path& folder) {
    scene::Effects wish;
    wish.mutable_bone_dust();
    Stage stage(960, 640, wish);
    stage.mill({});
    save(stage, folder / "effect_dust.png");
}

void drawBleeding(const std::filesystem::path& folder) {
    scene::Effects wish;
    wish.mutable_bleeding();
    Stage stage(960, 640, wish);
    stage.mill({});
    stage.leave();
    stage.session.wait(stage.scene, stage.last, 6, {.is_pedal_down = false});
    save(stage, folder / "effect_bleeding.png");
}

void drawIrrigation(const std::filesystem::path& folder) {
    scene::Effects wish;
    wish.mutable_irrigation();
    Stage stage(960, 640, wish);
    stage.mill({.spin_speed = 1000});
    save(stage, folder / "effect_irrigation.png");
}

// Draws a burr at rest, a slow one, and one too fast for the picture, side by side.
void drawSpin(const std::filesystem::path& folder) {
    constexpr int kPart = 320, kHeight = 400;
    Picture picture(3 * kPart, kHeight);
    int part = 0;
    for (const double speed : {0.0, 11.0, 3000.0}) {
        scene::Effects wish;
        wish.mutable_burr_spin();
        Stage stage(kPart, kHeight, wish);
        stage.context_width = kPart;
        stage.context_height = kHeight;
        stage.last = test::toolAt({8.0e-3, 3.2e-3, 13.0e-3}, kShaft);
        stage.session.wait(stage.scene, stage.last, 0.2, {.spin_speed = speed, .is_pedal_down = false});
        stage.scene.setViewWish(
            {.target_W = stage.last.position, .distance = 0.0075, .azimuth = -0.5, .elevation = 0.3});
        stage.draw();
        stage.session.wait(stage.scene, stage.last, 1.0 / 60, {.spin_speed = speed, .is_pedal_down = false});
        const Picture drawn = stage.draw();
        for (int y = 0; y < kHeight; ++y)
            std::memcpy(picture.row(y) + 3 * kPart * part, &drawn.row(y)[0], 3 * kPart);
        ++part;
    }
    const auto path = folder / "effect_spin.png";
    writePng(picture, path);
    std::cout << path.string() << std::endl;
}

// Returns the milliseconds of processor time of one picture, advancing and drawing, while the burr mills, as
// the mean over the strokes.
double meanMs(const scene::Effects& wish, Quality quality) {
    Stage stage(640, 480, wish);
    stage.context_width = 640;
    stage.context_height = 480;
    stage.scene.settings().quality = quality;
    std::vector<double> times;
    const int every = quality == Quality::kFull ? 16 : 1;  // a full picture takes long
    int state = 0;
    stage.session.after_state = [&] {
        if (++state % every != 0) return stage.scene.advance(MillingSession::kPeriod);
        const std::clock_t start = std::clock();  // of all threads
        stage.scene.advance(MillingSession::kPeriod);
        stage.scene.draw(stage.context_width, stage.context_height, 1);
        stage.context.gl().Finish();
        times.push_back(1e3 * double(std::clock() - start) / CLOCKS_PER_SEC);
    };
    stage.mill({});
    return std::accumulate(times.begin(), times.end(), 0.0) / double(times.size());
}

void measure() {
    struct Case {
        const char* name;
        scene::Effects wish;
    };
    std::vector<Case> cases(6);
    cases[0].name = "none";
    cases[1].name = "bone_dust";
    cases[1].wish.mutable_bone_dust();
    cases[2].name = "bleeding";
    cases[2].wish.mutable_bleeding();
    cases[3].name = "irrigation";
    cases[3].wish.mutable_irrigation();
    cases[4].name = "burr_spin";
    cases[4].wish.mutable_burr_spin();
    cases[5].name = "all";
    for (size_t i = 1; i < 5; ++i) cases[5].wish.MergeFrom(cases[i].wish);
    std::printf("{\"unit\":\"ms of processor time per picture, mean\",\"size\":\"640x480\"");
    for (const Case& c : cases)
        std::printf(",\n\"%s\":{\"quick\":%.2f,\"full\":%.1f}", c.name, meanMs(c.wish, Quality::kQuick),
                    meanMs(c.wish, Quality::kFull));
    std::printf("}\n");
}

int show(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "pictures" && argc == 3) {
        std::filesystem::create_directories(argv[2]);
        drawDust(argv[2]);
        drawBleeding(argv[2]);
        drawIrrigation(argv[2]);
        drawSpin(argv[2]);
        return 0;
    }
    if (what == "measure" && argc == 2) {
        measure();
        return 0;
    }
    std::cerr << "usage: effect_show pictures DIR | measure" << std::endl;
    return 2;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::show(argc, argv); });
}
