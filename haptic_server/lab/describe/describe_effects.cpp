#include "haptic_server/lab/describe/describe_effects.h"

#include <google/protobuf/text_format.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "common/config/viewer_effects.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string valueText(const Message& message, const FieldDescriptor& field, int index) {
    google::protobuf::TextFormat::Printer printer;
    printer.SetSingleLineMode(true);
    std::string text;
    printer.PrintFieldValueToString(message, &field, index, &text);
    return " " + text;
}

std::string valuesText(const Message& message, const FieldDescriptor& field) {
    const auto& reflection = *message.GetReflection();
    if (!field.is_repeated())
        return reflection.HasField(message, &field) || field.has_default_value()
                   ? valueText(message, field, -1)
                   : "";
    std::string text;
    for (int n = 0; n < reflection.FieldSize(message, &field); ++n) text += valueText(message, field, n);
    return text;
}

// It reads "name value, name value", as given or by default.
std::string parametersOf(const Message& message) {
    std::string text;
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
        const FieldDescriptor& field = *message.GetDescriptor()->field(i);
        const std::string values = valuesText(message, field);
        if (!values.empty()) text += (text.empty() ? "" : ", ") + field.name() + values;
    }
    return text;
}

std::string microseconds(double us) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f us", us);
    return text;
}

std::string added(double us, double noise_us) {
    return std::abs(us) > noise_us ? microseconds(us) : "below the noise of " + microseconds(noise_us);
}

const EffectCost* costOf(const std::string& name, const EffectCosts* costs) {
    if (!costs) return nullptr;
    for (const EffectCost& cost : costs->effects)
        if (cost.name == name) return &cost;
    return nullptr;
}

std::string costText(const std::string& name, const EffectCosts* costs) {
    const EffectCost* cost = costOf(name, costs);
    if (!cost) return "";
    return "; adds p50 " + added(cost->p50_us, costs->noise_p50_us) + ", p99 " +
           added(cost->p99_us, costs->noise_p99_us);
}

std::string line(const std::string& name, const std::string& parameters, const std::string& more) {
    return "  " + name + (parameters.empty() ? "" : ": " + parameters) + more + "\n";
}

std::string materialsText(const scene::Scene& scene, const EffectCosts* costs) {
    if (scene.material().empty()) return "";
    std::string text =
        line("materials", std::to_string(scene.material_size()), costText("material_stiffness", costs));
    for (const scene::Material& material : scene.material())
        text += "  " + line("material", parametersOf(material), "");
    return text;
}

}  // namespace

std::string describeEffects(const scene::Scene& scene, const EffectCosts* costs) {
    std::string text;
    const Message& effects = scene.effects();
    std::vector<const FieldDescriptor*> listed;
    effects.GetReflection()->ListFields(effects, &listed);
    for (const FieldDescriptor* field : listed) {
        const std::string parameters = parametersOf(effects.GetReflection()->GetMessage(effects, field));
        text += isViewerEffect(*field) ? line(field->name(), parameters, "; in the viewer")
                                       : line(field->name(), parameters, costText(field->name(), costs));
    }
    text += materialsText(scene, costs);
    if (text.empty()) return "effects: none\n";
    if (costs && !costs->effects.empty())
        text += "  all of them: p50 " + microseconds(costs->all.p50) + ", p99 " +
                microseconds(costs->all.p99) + "; without any: p50 " + microseconds(costs->none.p50) +
                ", p99 " + microseconds(costs->none.p99) + " (whole ticks, " + std::to_string(costs->ticks) +
                " in contact or with a button)\n";
    return "effects:\n" + text;
}

}  // namespace bonemill
