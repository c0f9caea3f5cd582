#include "render_client/apps/render_client/clip_maker.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>

#include "common/base/units.h"
#include "common/process/start_apart.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

std::string viewText(const OrbitCamera& camera) {
    const Eigen::Vector3d target_mm = camera.target_W / kMillimetre;
    std::array<char, 200> text;
    std::snprintf(text.data(), text.size(), "%.3f,%.3f,%.3f,%.3f,%.3f,%.3f",
                  std::remainder(camera.azimuth, 2 * std::numbers::pi) / kDegree, camera.elevation / kDegree,
                  camera.distance / kMillimetre, target_mm.x(), target_mm.y(), target_mm.z());
    return text.data();
}

}  // namespace

HudNotice ClipMaker::make(const ClientOptions& options, double moment_s, const OrbitCamera& camera,
                          const std::filesystem::path& file) {
    if (!file_.empty())
        return {tr("A clip is being written already: {1}", {file_.string()}), HudTone::kWarning};
    const std::filesystem::path whole = std::filesystem::absolute(file);
    if (!startApart({options.launcher, "replay", options.recording, "--clip", whole.string(), "--at",
                     std::to_string(moment_s), "--view", viewText(camera), "--domain",
                     std::to_string(options.subscriber.domain)}))
        return {tr("{1} cannot be started", {options.launcher}), HudTone::kWarning};
    file_ = whole;
    begun_ = looked_ = Clock::now();
    return {tr("A clip of ten seconds is being written, slowly, beside the replay: {1}", {whole.string()}),
            HudTone::kPlain};
}

std::optional<HudNotice> ClipMaker::news() {
    const Clock::time_point now = Clock::now();
    if (file_.empty() || now - looked_ < kLookEvery) return std::nullopt;
    looked_ = now;
    if (std::error_code none; std::filesystem::exists(file_, none))
        return HudNotice{tr("Clip saved: {1}", {std::exchange(file_, {}).string()}), HudTone::kGood};
    if (now - begun_ < kLongest) return std::nullopt;
    return HudNotice{
        tr("No clip has come: bonemill's logs say why ({1})", {std::exchange(file_, {}).string()}),
        HudTone::kWarning};
}

}  // namespace bonemill
