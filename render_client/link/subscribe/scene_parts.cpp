#include "render_client/link/subscribe/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Returns nothing for what is no number.
std::optional<double> numberOf(const Message& message, const FieldDescriptor& field, int index) {
    const auto& r = *message.GetReflection();
    const bool repeated = field.is_repeated();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return repeated ? r.GetRepeatedDouble(message, &field, index) : r.GetDouble(message, &field);
        case FieldDescriptor::CPPTYPE_UINT32:
            return repeated ? r.GetRepeatedUInt32(message, &field, index) : r.GetUInt32(message, &field);
        case FieldDescriptor::CPPTYPE_INT32:
            return repeated ? r.GetRepeatedInt32(message, &field, index) : r.GetInt32(message, &field);
        default:
            return std::nullopt;
    }
}

bool isInRange(const FieldDescriptor& field, double value) {
    if (!std::isfinite(value)) return false;
    if (!field.options().HasExtension(scene::range)) return true;
    const scene::Range& range = field.options().GetExtension(scene::range);
    return value >= range.min() && value <= range.max();
}

bool isElementUsable(const Message& message, const FieldDescriptor& field, int index) {
    const auto& r = *message.GetReflection();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE)
        return isWithinRanges(field.is_repeated() ? r.GetRepeatedMessage(message, &field, index)
                                                  : r.GetMessage(message, &field));
    const auto number = numberOf(message, field, index);
    return !number || isInRange(field, *number);
}

}  // namespace

bool isWithinRanges(const Message& message) {
    const auto& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    return std::ranges::all_of(fields, [&](const FieldDescriptor* field) {
        const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
        for (int i = 0; i < count; ++i)
            if (!isElementUsable(message, *field, i)) return false;
        return true;
    });
}

void keepShownParts(scene::Material& material) {
    scene::Material kept;
    kept.set_name(material.name());
    if (material.has_color()) kept.mutable_color()->Swap(material.mutable_color());
    kept.set_is_protected(material.is_protected());
    material.Swap(&kept);
    material.DiscardUnknownFields();
}

}  // namespace bonemill
