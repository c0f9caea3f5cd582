// These are the visual effects that a scene lists, and what they do between two pictures. There is no OpenGL
// here; the painters are in render_client/look/paint.
//
// An effect that is not listed is not constructed. Time goes on in steps of kStep whatever the calls, so
// the same tool states at the same times give the same picture. The frame is V, the units are m and s. It
// is for one thread.
#pragma once

#include <memory>
#include <optional>

#include "render_client/look/visual_effects/burr_effects.h"
#include "render_client/look/visual_effects/liquids.h"
#include "render_client/look/visual_effects/pulse.h"
#include "render_client/look/visual_effects/traces.h"

namespace bonemill {

class VisualEffects {
  public:
    using Materials = google::protobuf::RepeatedPtrField<scene::Material>;
    static constexpr double kStep = 1.0 / 120;       // s
    static constexpr double kLongestAdvance = 0.25;  // s of one call; what is beyond is left out

    // `materials` are the scene's; by name those that bleed or pulsate are found.
    VisualEffects(const scene::Effects& wish, double burr_radius, const Materials& materials = {});
    static bool anyIn(const scene::Effects& wish);
    static bool needsFilm(const scene::Effects& wish);  // does any of them leave something on the bone?

    // Takes a new tool state: what was removed since the one before leaves the burr now.
    void take(const EffectInput& input);
    // A node's mesh came or changed; an empty one removes it.
    void setNode(const NodeMesh& mesh);
    // The bone is another one.
    void clear();
    // The bone was put back: blood, water and dust on it are forgotten.
    void forget();
    void advance(double dt);

    const SurfaceFilm* film() const { return film_ ? &*film_ : nullptr; }
    SurfaceFilm* film() { return film_ ? &*film_ : nullptr; }
    const BoneDust* dust() const { return dust_ ? &*dust_ : nullptr; }
    const Bleeding* bleeding() const { return bleeding_ ? &*bleeding_ : nullptr; }
    const Irrigation* irrigation() const { return irrigation_ ? &*irrigation_ : nullptr; }
    bool hasBrowning() const { return browning_.has_value(); }
    bool hasBruising() const { return bruising_.has_value(); }
    const Pulse* pulse() const { return pulse_ ? &*pulse_ : nullptr; }
    BurrSpin* spin() { return spin_ ? &*spin_ : nullptr; }

  private:
    struct Trail {
        Eigen::Vector3f centre;
        double time;
    };
    bool needsSurface() const { return dust_ || bleeding_ || irrigation_; }
    void takeToFilm();
    void step();
    void stepFilm(double dt);
    void openCuts();
    void wash(double dt);

    std::optional<BoneDust> dust_;
    std::optional<Bleeding> bleeding_;
    std::optional<Irrigation> irrigation_;
    std::optional<Browning> browning_;
    std::optional<Bruising> bruising_;
    std::optional<BurrSpin> spin_;
    std::optional<Pulse> pulse_;
    std::optional<SurfaceFilm> film_;
    BoneSurface surface_;
    EffectInput input_;
    std::vector<Trail> trail_;  // of the burr while it cut
    double time_ = 0, left_ = 0, film_time_ = 0, shown_time_ = 0, slowest_picture_ = 0;
};

}  // namespace bonemill
