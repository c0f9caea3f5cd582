// This is a tool that is smaller all around than it will be: its distances are raised by an offset. It is
// RT-safe, for the tick thread only.
#pragma once

#include <algorithm>

#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

class GrowingField final : public ToolField {
  public:
    GrowingField() : ToolField({}, 0) {}

    // The whole tool, which must outlive its use here; the offset stays.
    void setWhole(const ToolField& whole) noexcept {
        ToolField::operator=(whole);
        whole_ = &whole;
        makeThinner();
    }
    // The tool is so much smaller than the whole, in m; at least 0.
    void setOffset(double offset) noexcept {
        offset_ = std::max(0.0, offset);
        makeThinner();
    }
    double offset() const noexcept { return offset_; }
    const ToolField& whole() const noexcept { return *whole_; }

    void distances(const PointBatch<float>& points_T, float* out) const noexcept override {
        raised(points_T, out);
    }
    void distances(const PointBatch<double>& points_T, double* out) const noexcept override {
        raised(points_T, out);
    }
    void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept override {
        raisedSample(points_T, out);
    }
    void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept override {
        raisedSample(points_T, out);
    }
    void nearest(const PieceBatch& pieces_T, float* centers, float* bounds) const noexcept override {
        whole_->nearest(pieces_T, centers, bounds);
        for (int i = 0; i < pieces_T.center.count; ++i)
            centers[i] += float(offset_), bounds[i] += float(offset_);
    }
    ToolSample sample(const Eigen::Vector3d& p_T) const noexcept override {
        ToolSample at = whole_->sample(p_T);
        at.distance += offset_;
        return at;
    }
    double distanceError() const noexcept override { return whole_->distanceError(); }
    double distanceBound(const Eigen::Vector3d& p_T) const noexcept override {
        return whole_->distanceBound(p_T) + offset_;
    }
    double testCost() const noexcept override { return whole_->testCost(); }

  private:
    // A part that is not there yet still counts as a tenth of its radius: others divide by it.
    static constexpr double kThinnestShare = 0.1;

    void makeThinner() noexcept {
        if (!whole_) return;
        const double whole = whole_->thinnestRadius();
        setThinnestRadius(std::max(kThinnestShare * whole, whole - offset_));
    }
    template <class Scalar>
    void raised(const PointBatch<Scalar>& points_T, Scalar* out) const noexcept {
        whole_->distances(points_T, out);
        for (int i = 0; i < points_T.count; ++i) out[i] += Scalar(offset_);
    }
    template <class Scalar>
    void raisedSample(const PointBatch<Scalar>& points_T, SampleBatch<Scalar>& out) const noexcept {
        whole_->sample(points_T, out);
        for (int i = 0; i < points_T.count; ++i) out.distance[i] += Scalar(offset_);
    }

    const ToolField* whole_ = nullptr;
    double offset_ = 0;  // m
};

}  // namespace bonemill
