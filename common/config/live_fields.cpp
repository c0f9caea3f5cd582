#include "common/config/live_fields.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <cmath>

#include "common/bounds/message_bounds.h"
#include "common/config/field_unit.h"
#include "common/config/scene_check.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

class Silence final : public google::protobuf::io::ErrorCollector {
    void AddError(int, int, const std::string&) override {}
};

std::vector<LiveField> findLiveFields() {
    std::vector<LiveField> found;
    const auto* const tuning = scene::Tuning::descriptor();
    for (int p = 0; p < tuning->field_count(); ++p) {
        const auto* const part = tuning->field(p)->message_type();
        for (int n = 0; n < part->field_count(); ++n)
            if (part->field(n)->options().GetExtension(scene::live))
                found.push_back({tuning->field(p), part->field(n)});
    }
    return found;
}

const Message& partOf(const scene::Tuning& tuning, const LiveField& field) {
    return tuning.GetReflection()->GetMessage(tuning, field.part);
}

// What is set that is not live.
std::string unlivePath(const scene::Tuning& tuning) {
    std::vector<const FieldDescriptor*> parts, fields;
    tuning.GetReflection()->ListFields(tuning, &parts);
    for (const FieldDescriptor* part : parts) {
        const Message& message = tuning.GetReflection()->GetMessage(tuning, part);
        message.GetReflection()->ListFields(message, &fields);
        for (const FieldDescriptor* field : fields)
            if (!field->options().GetExtension(scene::live)) return LiveField{part, field}.path();
    }
    return "";
}

// The device's own limits are made for what the scene file lets the hand feel.
bool isOnlyLowered(const LiveField& field) {
    return field.path() == "coupling.max_force_n" || field.path() == "coupling.max_torque_nmm";
}

}  // namespace

std::string LiveField::path() const {
    return part->name() + "." + field->name();
}

std::string LiveField::unit() const {
    return std::string(unitOfField(field->name()));
}

const scene::Range& LiveField::range() const {
    return field->options().GetExtension(scene::range);
}

const std::vector<LiveField>& liveFields() {
    static const std::vector<LiveField> kFields = findLiveFields();
    return kFields;
}

std::optional<double> valueOf(const scene::Tuning& tuning, const LiveField& field) {
    const Message& part = partOf(tuning, field);
    if (!part.GetReflection()->HasField(part, field.field)) return std::nullopt;
    return numberIn(part, *field.field, 0);
}

void setValue(scene::Tuning& tuning, const LiveField& field, double value) {
    Message& part = *tuning.GetReflection()->MutableMessage(&tuning, field.part);
    part.GetReflection()->SetDouble(&part, field.field, value);
}

scene::Range boundsOf(const LiveField& field, const scene::Tuning& of_scene) {
    scene::Range bounds = field.range();
    if (const auto own = valueOf(of_scene, field); own && isOnlyLowered(field)) bounds.set_max(*own);
    return bounds;
}

scene::Tuning tunableOf(const scene::Scene& scene) {
    scene::Tuning all, out;
    *all.mutable_contact() = scene.contact();
    *all.mutable_coupling() = scene.coupling();
    for (const LiveField& field : liveFields())
        setValue(out, field, numberIn(partOf(all, field), *field.field, 0));
    return out;
}

scene::Scene tunedScene(scene::Scene scene, const scene::Tuning& tuning) {
    scene.mutable_contact()->MergeFrom(tuning.contact());
    scene.mutable_coupling()->MergeFrom(tuning.coupling());
    return scene;
}

std::string tuningProblem(const scene::Tuning& tuning, const scene::Tuning& of_scene) {
    if (const std::string path = unlivePath(tuning); !path.empty())
        return "field `" + path +
               "` cannot be tuned while the session runs: change it in the scene file and choose the scene "
               "anew";
    for (const LiveField& field : liveFields()) {
        const std::optional<double> value = valueOf(tuning, field);
        if (!value) continue;
        if (const std::string why = numberProblem(*field.field, *value, field.unit()); !why.empty())
            return "field `" + field.path() + "` " + why;
        if (const double most = boundsOf(field, of_scene).max(); *value > most)
            return "field `" + field.path() + "` = " + numberText(*value) +
                   " is above what the scene file says (" + numberText(most) +
                   "): what the hand may feel is only lowered while the session runs";
    }
    return "";
}

std::string tuningText(const scene::Tuning& tuning) {
    std::string text;
    const FieldDescriptor* open = nullptr;  // the part whose brace is
    for (const LiveField& field : liveFields()) {
        const std::optional<double> value = valueOf(tuning, field);
        if (!value) continue;
        if (open && open != field.part) text += "}\n";
        if (open != field.part) text += field.part->name() + " { ";
        open = field.part;
        text += field.field->name() + ": " + numberText(*value) + " ";
    }
    return open ? text + "}" : text;
}

std::optional<scene::Tuning> tuningOfText(const std::string& text) {
    scene::Tuning tuning;
    Silence silence;
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&silence);
    if (!parser.ParseFromString(text, &tuning)) return std::nullopt;
    return tuning;
}

}  // namespace bonemill
