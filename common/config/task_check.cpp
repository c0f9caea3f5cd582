#include <algorithm>
#include <string_view>

#include "common/config/field_unit.h"
#include "common/config/scene_check.h"
#include "common/config/scene_geometry.h"
#include "common/geometry/node_mesh.h"

namespace bonemill {
namespace {

constexpr const char* kTask = "assessment";
constexpr int kMaxZoneShapes = 64;

std::string pathIn(const std::string& list, int index) {
    return std::string(kTask) + "." + list + "[" + std::to_string(index) + "]";
}

std::string quoted(const std::string& text) {
    return "= \"" + text + "\"";
}

bool isMaterial(const scene::Scene& scene, const std::string& name, bool is_protected) {
    return std::ranges::any_of(scene.material(), [&](const auto& material) {
        return material.name() == name && (material.is_protected() || !is_protected);
    });
}

class TaskChecker {
  public:
    TaskChecker(const scene::Scene& scene, const RefuseField& refuse)
        : scene_(scene), task_(scene.assessment()), refuse_(refuse) {}

    void checkZones() const {
        requireFew("zone", task_.zone_size(), kMaxZones, "zones");
        for (int n = 0; n < task_.zone_size(); ++n) checkZone(n);
        // Both get a colour of their own in the viewer, by one number.
        constexpr int kMaxColours = kMaxVertexMaterials;
        if (task_.zone_size() + scene_.material_size() > kMaxColours)
            refuse_(pathIn("zone", 0), "and what follows are too many beside " +
                                           std::to_string(scene_.material_size()) + " materials: all are " +
                                           std::to_string(kMaxColours) + " at most");
    }

    void checkReference() const {
        if (!task_.has_reference()) {
            if (task_.zone_size() > 0 && std::ranges::none_of(task_.zone(), [](const auto& zone) {
                    return zone.role() == scene::Task::TARGET;
                }))
                refuse_(pathIn("zone", 0),
                        "has no target beside it: give one zone the role TARGET, or the task a reference");
            return;
        }
        const scene::Task::Reference& reference = task_.reference();
        const std::string path = std::string(kTask) + ".reference";
        if (reference.volume_path().empty() == (reference.shape_size() == 0))
            refuse_(path, "needs a volume_path or shapes, one of both");
        checkShapes(reference.shape(), path);
    }

    void checkGates() const {
        requireFew("gate", task_.gate_size(), kMaxTaskRules, "gates");
        for (int n = 0; n < task_.gate_size(); ++n) {
            const scene::Task::Gate& gate = task_.gate(n);
            checkFigure(gate.figure(), pathIn("gate", n));
            if (gate.limit_case() == scene::Task::Gate::LIMIT_NOT_SET)
                refuse_(pathIn("gate", n), "has no limit: give it at_most or at_least");
        }
    }

    void checkSubScores() const {
        requireFew("sub_score", task_.sub_score_size(), kMaxTaskRules, "sub-scores");
        for (int n = 0; n < task_.sub_score_size(); ++n) {
            const scene::Task::SubScore& score = task_.sub_score(n);
            const std::string path = pathIn("sub_score", n);
            checkFigure(score.figure(), path);
            if (!score.has_worst() || !score.has_best())
                refuse_(path, "needs both worst and best: the figures at which its score is 0 and 1");
            if (score.worst() == score.best())
                refuse_(path + ".best",
                        "= " + numberText(score.best()) + " is also the worst: there is no scale between");
        }
    }

    void checkWays() const {
        if (task_.has_approach() && vectorOf(task_.approach()).isZero(0))
            refuse_(std::string(kTask) + ".approach", "has no length: give the way into the bone");
        if (task_.has_plan() &&
            (vectorOf(task_.plan().entry_mm()) - vectorOf(task_.plan().tip_mm())).isZero(0))
            refuse_(std::string(kTask) + ".plan", "has its tip where it enters: give both");
    }

    void checkExam() const {
        if (task_.exam() && task_.has_feedback() && task_.feedback() != scene::Task::NEVER)
            refuse_(std::string(kTask) + ".feedback",
                    "= " + scene::Task::Feedback_Name(task_.feedback()) +
                        " does not go with exam, which gives none: leave one out");
    }

  private:
    void requireFew(const std::string& list, int count, int most, const char* what) const {
        if (count > most)
            refuse_(pathIn(list, most),
                    std::string("is one too many: a task has at most ") + std::to_string(most) + " " + what);
    }

    void checkZone(int n) const {
        const scene::Task::Zone& zone = task_.zone(n);
        const std::string path = pathIn("zone", n);
        if (zone.name().empty()) refuse_(path + ".name", "is missing: say what the zone is called");
        for (int k = 0; k < n; ++k)
            if (task_.zone(k).name() == zone.name())
                refuse_(path + ".name", quoted(zone.name()) + " is also what " + pathIn("zone", k) +
                                            " is called: give each zone a name of its own");
        if (zone.role() == scene::Task::PROTECTED && isMaterial(scene_, zone.name(), true))
            refuse_(path + ".name", quoted(zone.name()) +
                                        " is also a protected material: it is a structure already, leave the "
                                        "zone out or call it otherwise");
        if (zone.material_size() == 0 && zone.shape_size() == 0)
            refuse_(path, "does not say where it is: give it material or shape");
        for (int m = 0; m < zone.material_size(); ++m)
            if (!isMaterial(scene_, zone.material(m), false))
                refuse_(path + ".material[" + std::to_string(m) + "]",
                        quoted(zone.material(m)) + " is no material of this scene");
        checkShapes(zone.shape(), path);
    }

    template <class Shapes>
    void checkShapes(const Shapes& shapes, const std::string& path) const {
        if (shapes.size() > kMaxZoneShapes)
            refuse_(path + ".shape[" + std::to_string(kMaxZoneShapes) + "]",
                    "is one too many: it is " + std::to_string(kMaxZoneShapes) + " shapes at most");
        for (int n = 0; n < shapes.size(); ++n) {
            const std::string at = path + ".shape[" + std::to_string(n) + "]";
            if (shapes[n].kind_case() == scene::Task::Shape::KIND_NOT_SET)
                refuse_(at, "is empty: give it a box, sphere, capsule, cylinder or cone");
            if (shapes[n].has_box() && !(vectorOf(shapes[n].box().size_mm()).array() > 0).all())
                refuse_(at + ".box.size_mm", "is not above 0 on each axis (mm): give x, y and z");
        }
    }

    // What the scene itself must have for a figure to be measured can be told here; what else there is to
    // measure cannot.
    void checkFigure(const std::string& id, const std::string& path) const {
        const std::string at = path + ".figure";
        if (id.empty()) refuse_(at, "is missing: name a figure, for example \"target.removed\"");
        const size_t colon = id.find(':');
        const std::string kind = id.substr(0, colon);
        const bool is_word = std::ranges::all_of(kind, [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
        });
        if (!is_word || kind.empty())
            refuse_(at, quoted(id) +
                            " is no figure: small letters, digits, '_' and '.' make its id, then ':' and the "
                            "name of what it is of");
        const std::string name = colon == std::string::npos ? "" : id.substr(colon + 1);
        if (kind.starts_with("zone.") && !isZone(name, false))
            refuse_(at, quoted(id) + " ends in no zone of this task: name one behind ':'");
        if (kind.starts_with("structure.") && !isMaterial(scene_, name, true) && !isZone(name, true))
            refuse_(at, quoted(id) +
                            " ends in no structure of this scene: name a protected material or zone behind "
                            "':'");
        if (kind.starts_with("cavity.") && !task_.has_approach())
            refuse_(at, quoted(id) + " needs assessment.approach: say which way goes into the bone");
        const bool is_of_line = kind.starts_with("plan.") || kind.starts_with("breach.");
        if (is_of_line && !task_.has_plan())
            refuse_(at, quoted(id) + " needs assessment.plan: say where the line lies");
    }

    bool isZone(const std::string& name, bool is_protected) const {
        return std::ranges::any_of(task_.zone(), [&](const auto& zone) {
            return zone.name() == name && (!is_protected || zone.role() == scene::Task::PROTECTED);
        });
    }

    const scene::Scene& scene_;
    const scene::Task& task_;
    const RefuseField& refuse_;
};

}  // namespace

void checkTask(const scene::Scene& scene, const RefuseField& refuse) {
    if (!scene.has_assessment()) return;
    const TaskChecker checker(scene, refuse);
    checker.checkZones();
    checker.checkReference();
    checker.checkGates();
    checker.checkSubScores();
    checker.checkWays();
    checker.checkExam();
}

}  // namespace bonemill
