#include "haptic_server/assessment/product/deviation.h"

#include <cmath>

#include "common/base/units.h"
#include "haptic_server/assessment/product/signed_field.h"
#include "haptic_server/assessment/product/weighted_sample.h"

namespace bonemill {
namespace {

constexpr int kDeviationVersion = 1;

void addOneSide(const WeightedSample& sample, const std::string& id, const std::string& label,
                Figures& figures) {
    const auto add = [&](const char* what, const char* text, double value) {
        figures.push_back(
            {id + "." + what, kDeviationVersion, label + ", " + text, value * kPerMillimetre, "mm"});
    };
    add("mean", "mean", sample.isEmpty() ? 0 : sample.mean());
    add("sd", "SD", sample.isEmpty() ? 0 : sample.deviation());
    add("p95", "95 %", sample.isEmpty() ? 0 : sample.percentile(0.95));
    add("max", "most", sample.isEmpty() ? 0 : sample.percentile(1));
}

}  // namespace

Deviation deviationOf(const ChangeGrid& changes, const std::vector<CutPiece>& pieces) {
    const SignedField ideal(changes.box(), changes.spacing(),
                            [&](const Eigen::Vector3i& v) { return changes.staysIdeally(v); });
    Deviation deviation;
    for (const CutPiece& piece : pieces) {
        if (!piece.is_judged) continue;
        const double distance = ideal.at(piece.center_V);
        if (!std::isfinite(distance)) continue;
        deviation.distance.push_back(distance);
        deviation.pieces.push_back(piece);
    }
    return deviation;
}

void addDeviationFigures(const Deviation& deviation, Figures& figures) {
    if (deviation.pieces.empty()) return;
    WeightedSample over, under;
    for (size_t n = 0; n < deviation.pieces.size(); ++n) {
        const double distance = deviation.distance[n], area = deviation.pieces[n].area;
        if (distance > 0) over.add(distance, area);
        if (distance < 0) under.add(-distance, area);
    }
    addOneSide(over, "overcut", "Cut too far", figures);
    addOneSide(under, "undercut", "Not cut far enough", figures);
}

}  // namespace bonemill
