// Sets up a scene in a small picture, for the tests of ways of looking, and tells what geometry says of it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/milled_scene.h"

namespace bonemill::test {

inline constexpr int kWidth = 360;
inline constexpr int kHeight = 270;
inline constexpr double kSphereRadius = 0.005;
inline const Eigen::Vector3d kSphereCenter(0.008, 0.008, 0.008);

inline const std::vector<NodeMesh>& sphereNodes() {
    static const std::vector<NodeMesh> nodes = meshBody(
        65, 2.5e-4, [](const Eigen::Vector3d& p) { return (p - kSphereCenter).norm() - kSphereRadius; });
    return nodes;
}

struct Pixel {
    double x = 0, y = 0;  // from the upper left
};

// Returns where a point (W) appears.
inline Pixel project(const Camera& camera, const Eigen::Vector3d& p_W, int width, int height) {
    const Eigen::Vector3d p_C = camera.R_WC.transpose() * (p_W - camera.eye_W);
    const double pixels = height / (2 * camera.halfTangent() * -p_C.z());
    return {width / 2.0 + (p_C.x() + camera.shift * p_C.z()) * pixels, height / 2.0 - p_C.y() * pixels};
}

class ViewMode : public testing::Test {
  protected:
    ViewMode() : context_(kWidth, kHeight) { freshScene(); }
    void freshScene() {
        scene_.reset();
        scene_ = std::make_unique<RenderScene>(context_.gl());
        scene_->settings().show_hud = false;
    }
    Picture draw() {
        scene_->draw(kWidth, kHeight, 1);
        return context_.read();
    }
    void showSphere(const std::vector<NodeMesh>& nodes = sphereNodes()) {
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(kSphereRadius);
        scene_->setSceneInfo(makeSceneInfo("sphere", kSphereCenter - half, kSphereCenter + half));
        for (const NodeMesh& node : nodes) scene_->setNode(node);
    }
    void lookFromTheLeft() {
        scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = M_PI / 2, .elevation = 0.0});
    }

    OsmesaContext context_;
    std::unique_ptr<RenderScene> scene_;
};

inline size_t countDifferent(const Picture& a, const Picture& b) {
    size_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const auto p = a.at(x, y), q = b.at(x, y);
            count += std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) > 6;
        }
    return count;
}

}  // namespace bonemill::test
