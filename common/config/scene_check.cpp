#include "common/config/scene_check.h"

#include <cmath>
#include <vector>

#include "common/base/user_error.h"
#include "common/bounds/message_bounds.h"
#include "common/config/field_unit.h"
#include "common/config/scene_tools.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

class SceneChecker {
  public:
    SceneChecker(const FieldLines& lines, const std::string& name) : lines_(lines), name_(name) {}

    void checkValues(const Message& message, const std::string& prefix, std::string_view outer_unit);
    void checkVolume(const scene::Scene& scene) const;
    void checkAccuracy(const scene::Accuracy& accuracy) const;
    void checkTools(const scene::Scene& scene) const;
    void checkTool(const scene::Tool& tool, const std::string& path) const;
    void checkWaypoints(const scene::SimulatedOperator& simulated_operator) const;

    [[noreturn]] void refuse(const std::string& path, const std::string& why) const {
        throw UserError(placeOf(name_, lines_, path) + "field `" + path + "` " + why);
    }

  private:
    void checkNumber(const FieldDescriptor& field, double value, const std::string& path,
                     std::string_view unit) const;
    void checkText(const std::string& text, const std::string& path) const;
    void checkQuaternion(const scene::Quaternion& q, const std::string& path) const;

    const FieldLines& lines_;
    const std::string& name_;
};

void SceneChecker::checkValues(const Message& message, const std::string& prefix,
                               std::string_view outer_unit) {
    const auto& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
        const bool repeated = field->is_repeated();
        // The coordinates of p_WD_mm are mm, too.
        const std::string_view own_unit = unitOfField(field->name());
        const std::string_view unit = own_unit.empty() ? outer_unit : own_unit;
        for (int i = 0; i < (repeated ? reflection.FieldSize(message, field) : 1); ++i) {
            const std::string path = prefix + field->name() + (repeated ? "[" + std::to_string(i) + "]" : "");
            if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
                const Message& nested = repeated ? reflection.GetRepeatedMessage(message, field, i)
                                                 : reflection.GetMessage(message, field);
                checkValues(nested, path + ".", unit);
                if (const auto* q = dynamic_cast<const scene::Quaternion*>(&nested))
                    checkQuaternion(*q, path);
            } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
                checkText(repeated ? reflection.GetRepeatedString(message, field, i)
                                   : reflection.GetString(message, field),
                          path);
            } else {
                checkNumber(*field, numberIn(message, *field, i), path, unit);
            }
        }
    }
}

void SceneChecker::checkNumber(const FieldDescriptor& field, double value, const std::string& path,
                               std::string_view unit) const {
    if (const std::string why = numberProblem(field, value, unit); !why.empty()) refuse(path, why);
}

// Texts become file names and go over the network as UTF-8.
void SceneChecker::checkText(const std::string& text, const std::string& path) const {
    for (size_t i = 0; i < text.size(); ++i) {
        const auto lead = static_cast<unsigned char>(text[i]);
        if (lead < 0x20 || lead == 0x7f) refuse(path, "holds a control character");
        const int tail = lead < 0x80         ? 0
                         : lead >> 5 == 0x6  ? 1
                         : lead >> 4 == 0xe  ? 2
                         : lead >> 3 == 0x1e ? 3
                                             : -1;
        bool is_utf8 = tail >= 0 && i + size_t(tail) < text.size();
        for (int k = 1; is_utf8 && k <= tail; ++k) is_utf8 = (text[i + size_t(k)] & 0xc0) == 0x80;
        if (!is_utf8) refuse(path, "is not UTF-8 text");
        i += size_t(tail);
    }
}

void SceneChecker::checkQuaternion(const scene::Quaternion& q, const std::string& path) const {
    constexpr double kNormTolerance = 0.01;
    const double norm = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
    if (std::abs(norm - 1.0) <= kNormTolerance) return;
    refuse(path, "has length " + numberText(norm) +
                     ", not 1 (w is 1 where it is not written: write all of w, x, y, z)");
}

void SceneChecker::checkVolume(const scene::Scene& scene) const {
    const scene::Volume& volume = scene.volume();
    if (volume.path().empty()) refuse("volume.path", "is missing: name the file or DICOM folder of the bone");
    const bool has_window = volume.has_window_low() && volume.has_window_high();
    if (has_window && volume.window_low() >= volume.window_high())
        refuse("volume.window_low", "= " + numberText(volume.window_low()) +
                                        " is not below window_high = " + numberText(volume.window_high()));
    if (!volume.has_iso_value()) return;
    const std::string iso = "= " + numberText(volume.iso_value());
    if (volume.has_window_low() && volume.iso_value() <= volume.window_low())
        refuse("volume.iso_value", iso + " is not above window_low = " + numberText(volume.window_low()));
    if (volume.has_window_high() && volume.iso_value() > volume.window_high())
        refuse("volume.iso_value", iso + " is above window_high = " + numberText(volume.window_high()));
}

void SceneChecker::checkAccuracy(const scene::Accuracy& accuracy) const {
    constexpr double kFinestSpacing_um = 1;
    const double spacing_um = accuracy.sample_spacing_um();
    if (spacing_um > 0 && spacing_um < kFinestSpacing_um)
        refuse("accuracy.sample_spacing_um",
               "= " + numberText(spacing_um) + " is finer than " + numberText(kFinestSpacing_um) +
                   " (µm): give that or more, or 0 for one sample per contact point");
}

void SceneChecker::checkTools(const scene::Scene& scene) const {
    const auto pathOf = [](int index) { return "tool[" + std::to_string(index) + "]"; };
    if (scene.tool_size() > kMaxTools)
        refuse(pathOf(kMaxTools), "is one tool too many: a scene has at most " + std::to_string(kMaxTools));
    const std::vector<std::string> names = toolNamesOf(scene);
    for (int i = 0; i < scene.tool_size(); ++i) {
        checkTool(scene.tool(i), pathOf(i));
        for (int k = 0; k < i; ++k)
            if (names[size_t(i)] == names[size_t(k)])
                refuse(pathOf(i) + ".name", "= \"" + names[size_t(i)] + "\" is also what " + pathOf(k) +
                                                " is called: give each tool a name of its own");
    }
}

void SceneChecker::checkTool(const scene::Tool& tool, const std::string& path) const {
    if (tool.shape_size() > 0 && !tool.mesh_path().empty())
        refuse(path + ".mesh_path",
               "stands beside " + path + ".shape: the tool is made of shapes or of a mesh, give one");
    for (int i = 0; i < tool.shape_size(); ++i)
        if (tool.shape(i).kind_case() == scene::Tool::Shape::KIND_NOT_SET)
            refuse(path + ".shape[" + std::to_string(i) + "]",
                   "is empty: give it a sphere, capsule, cylinder or cone");
    if (tool.burr_kind() != scene::Tool::BALL && !tool.has_burr_length_mm())
        refuse(path + ".burr_length_mm",
               "is missing: a burr_kind of " + scene::Tool::BurrKind_Name(tool.burr_kind()) + " needs it");
}

void SceneChecker::checkWaypoints(const scene::SimulatedOperator& simulated_operator) const {
    for (int i = 1; i < simulated_operator.waypoint_size(); ++i) {
        const double before = simulated_operator.waypoint(i - 1).time_s();
        const double now = simulated_operator.waypoint(i).time_s();
        if (now <= before)
            refuse("simulated_operator.waypoint[" + std::to_string(i) + "].time_s",
                   "= " + numberText(now) + " does not come after the waypoint before it (" +
                       numberText(before) + " s): times must increase");
    }
}

}  // namespace

std::string numberProblem(const FieldDescriptor& field, double value, std::string_view unit) {
    if (!std::isfinite(value)) return "= " + numberText(value) + " is not a finite number";
    if (!field.options().HasExtension(scene::range)) return "";
    const scene::Range& range = field.options().GetExtension(scene::range);
    if (value >= range.min() && value <= range.max()) return "";
    const std::string suffix = unit.empty() ? "" : " (" + std::string(unit) + ")";
    return "= " + numberText(value) + " is outside " + numberText(range.min()) + " .. " +
           numberText(range.max()) + suffix;
}

void checkScene(const ParsedScene& parsed, const std::string& name) {
    SceneChecker checker(parsed.lines, name);
    checker.checkValues(parsed.scene, "", {});
    checker.checkVolume(parsed.scene);
    checker.checkAccuracy(parsed.scene.accuracy());
    checker.checkTools(parsed.scene);
    checker.checkWaypoints(parsed.scene.simulated_operator());
    const auto refuse = [&](const std::string& path, const std::string& why) { checker.refuse(path, why); };
    checkMaterials(parsed.scene, refuse);
    checkEffects(parsed.scene, refuse);
    checkTask(parsed.scene, refuse);
}

}  // namespace bonemill
