#include "common/config/scene_table.h"

#include "common/config/field_unit.h"
#include "proto/scene.pb.h"

namespace bonemill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

std::string defaultText(const FieldDescriptor& field) {
    if (!field.has_default_value()) return "not set";
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return numberText(field.default_value_double());
        case FieldDescriptor::CPPTYPE_FLOAT:
            return numberText(double(field.default_value_float()));
        case FieldDescriptor::CPPTYPE_UINT32:
            return std::to_string(field.default_value_uint32());
        case FieldDescriptor::CPPTYPE_INT32:
            return std::to_string(field.default_value_int32());
        case FieldDescriptor::CPPTYPE_UINT64:
            return std::to_string(field.default_value_uint64());
        case FieldDescriptor::CPPTYPE_INT64:
            return std::to_string(field.default_value_int64());
        case FieldDescriptor::CPPTYPE_BOOL:
            return field.default_value_bool() ? "true" : "false";
        case FieldDescriptor::CPPTYPE_ENUM:
            return field.default_value_enum()->name();
        case FieldDescriptor::CPPTYPE_STRING:
            return "\"" + field.default_value_string() + "\"";
        case FieldDescriptor::CPPTYPE_MESSAGE:
            break;
    }
    return "not set";
}

std::string valuesText(const EnumDescriptor& type) {
    std::string text;
    for (int i = 0; i < type.value_count(); ++i) text += (i ? ", " : "") + type.value(i)->name();
    return text;
}

std::string rangeText(const FieldDescriptor& field) {
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) return "text";
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) return "true, false";
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) return valuesText(*field.enum_type());
    if (!field.options().HasExtension(scene::range)) return "";
    const scene::Range& range = field.options().GetExtension(scene::range);
    return numberText(range.min()) + " .. " + numberText(range.max());
}

// Points and rotations are one row: their coordinates' names say nothing new.
bool isCoordinates(const Descriptor& type) {
    return &type == scene::Vec3::descriptor() || &type == scene::Quaternion::descriptor();
}

void appendRow(const std::string& path, std::string_view unit, const std::string& value,
               const std::string& range, std::string& table) {
    table += "| `" + path + "` | " + std::string(unit) + " | " + value + " | " + range + " |\n";
}

void appendRows(const Descriptor& type, const std::string& prefix, std::string& table) {
    for (int i = 0; i < type.field_count(); ++i) {
        const FieldDescriptor& field = *type.field(i);
        const std::string path = prefix + field.name() + (field.is_repeated() ? "[]" : "");
        const std::string_view unit = unitOfField(field.name());
        if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
            appendRow(path, unit, defaultText(field), rangeText(field), table);
        } else if (isCoordinates(*field.message_type())) {
            const bool is_point = field.message_type() == scene::Vec3::descriptor();
            appendRow(path, unit, "not set", is_point ? "x, y, z" : "w, x, y, z, of length 1", table);
        } else {
            appendRows(*field.message_type(), path + ".", table);
        }
    }
}

}  // namespace

std::string describeDefaults() {
    std::string table = "| field | unit | default | range |\n|---|---|---|---|\n";
    appendRows(*scene::Scene::descriptor(), "", table);
    return table;
}

}  // namespace bonemill
