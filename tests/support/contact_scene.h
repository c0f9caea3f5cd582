// Makes analytic bone and an analytic tool, and says what their contact must be by sums over a fine sampling
// of the exact surface.
#pragma once

#include <random>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/equilibrium/gradient_model.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

struct SurfaceElement {
    Eigen::Vector3d position;  // V
    Eigen::Vector3d normal;    // V, out of the bone
    double area;               // m²
};

// Makes a square of a plane around `center`, `half` to each side, in pieces of `step`.
inline std::vector<SurfaceElement> planeElements(const Eigen::Vector3d& center, const Eigen::Matrix3d& R,
                                                 double half, double step) {
    std::vector<SurfaceElement> elements;
    const int n = int(std::ceil(half / step));
    for (int i = -n; i < n; ++i)
        for (int j = -n; j < n; ++j)
            elements.push_back(
                {center + R * (step * Eigen::Vector3d(i + 0.5, j + 0.5, 0)), R.col(2), step * step});
    return elements;
}

// Makes the wall of a round hole along R's z axis; the bone is outside.
inline std::vector<SurfaceElement> holeElements(const Eigen::Vector3d& center, const Eigen::Matrix3d& R,
                                                double radius, double half, double step) {
    std::vector<SurfaceElement> elements;
    const int around = int(std::ceil(2 * M_PI * radius / step)), along = int(std::ceil(half / step));
    const double angle = 2 * M_PI / around, length = half / along;
    for (int i = 0; i < around; ++i)
        for (int j = -along; j < along; ++j) {
            const double phi = (i + 0.5) * angle;
            const Eigen::Vector3d out(std::cos(phi), std::sin(phi), 0);
            elements.push_back({center + R * (radius * out + length * (j + 0.5) * Eigen::Vector3d::UnitZ()),
                                -(R * out), radius * angle * length});
        }
    return elements;
}

// This is the gradient law without guard and caps, by quadrature.
inline Wrench quadrature(const std::vector<SurfaceElement>& surface, const ToolField& tool, double kappa,
                         const Pose& X_VT) {
    Wrench sum;
    const Pose X_TV = X_VT.inverse();
    for (const SurfaceElement& e : surface) {
        const ToolSample sample = tool.sample(X_TV * e.position);
        if (sample.distance >= 0) continue;
        const Eigen::Vector3d force = kappa * e.area * sample.distance * (X_VT.rotation * sample.gradient);
        sum.force += force;
        sum.torque += (e.position - X_VT.position).cross(force);
    }
    return sum;
}

inline Eigen::Quaterniond randomRotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    Eigen::Quaterniond turn;
    // One after the other: compilers differ in the order of a call's arguments.
    for (const int n : {2, 1, 0, 3}) turn.coeffs()[n] = normal(random);
    return turn.normalized();
}

// Holds the distances of the shapes' union, with eight nodes on the thinnest radius.
inline SdfGrid gridOf(const std::vector<ToolShape>& shapes) {
    const ShapeField field(shapes);
    const double spacing = field.thinnestRadius() / 8;
    const Eigen::Vector3d origin = field.box().min().array() - 3 * spacing;
    const Eigen::Vector3i nodes = ((field.box().sizes() / spacing).array().ceil() + 7).cast<int>();
    std::vector<float> values;
    for (int k = 0; k < nodes.z(); ++k)
        for (int j = 0; j < nodes.y(); ++j)
            for (int i = 0; i < nodes.x(); ++i)
                values.push_back(float(field.distanceBound(origin + spacing * Eigen::Vector3d(i, j, k))));
    return {nodes, spacing, origin, std::move(values)};
}

// It has everything that a GradientModel needs, around a body given by its distance.
struct ContactScene {
    ContactScene(const VolumeGeometry& geometry, const DistanceFunction& body,
                 const std::vector<ToolShape>& shapes, ShellConfig shell = {})
        : bone(bodyVolume(geometry, body), Eigen::Vector3i::Constant(16), shell),
          tool(gridOf(shapes), shapes, 1e-3) {}

    SpoWorld world() const { return {bone.volume, bone.lattice, bone.shell}; }

    ShellView view(const AccuracySettings& settings = {}) const {
        return {bone.volume,
                bone.lattice,
                bone.shell,
                levelOf(bone.shell, settings),
                settings.sample_spacing,
                settings.most_samples};
    }

    GradientContactResult contactAt(const GradientContactConfig& config, const AccuracySettings& settings,
                                    const Pose& X_VT) const {
        GradientContact contact(config);
        const ToolField& field = tool.field(settings);
        contact.gather(view(settings), field, X_VT, 0.2e-3);
        return settings.precision == Precision::kDouble ? contact.evaluate<double>(field, X_VT)
                                                        : contact.evaluate<float>(field, X_VT);
    }

    BoneModel bone;
    ToolModel tool;
};

}  // namespace bonemill::test
