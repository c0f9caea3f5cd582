#include "common/bounds/message_bounds.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/text/foreign_text.h"
#include "proto/bounds.pb.h"
#include "proto/scene.pb.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr double kMaxNumber = 1e6;  // as proto/bounds.proto says
// A quaternion that went through double arithmetic stays far closer to unit length than this.
constexpr double kUnitTolerance = 1e-3;

int countOf(const Message& message, const FieldDescriptor& field) {
    return field.is_repeated() ? message.GetReflection()->FieldSize(message, &field) : 1;
}

bool isFloating(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
           field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
}

// Not for NaN.
bool isInRange(const FieldDescriptor& field, double value) {
    if (!field.options().HasExtension(scene::range))
        return !isFloating(field) || std::abs(value) <= kMaxNumber;
    const scene::Range& range = field.options().GetExtension(scene::range);
    return value >= range.min() && value <= range.max();
}

const std::string& textIn(const Message& message, const FieldDescriptor& field, int index,
                          std::string& room) {
    const auto& r = *message.GetReflection();
    return field.is_repeated() ? r.GetRepeatedStringReference(message, &field, index, &room)
                               : r.GetStringReference(message, &field, &room);
}

const Message& messageIn(const Message& message, const FieldDescriptor& field, int index) {
    const auto& r = *message.GetReflection();
    return field.is_repeated() ? r.GetRepeatedMessage(message, &field, index) : r.GetMessage(message, &field);
}

// A text without a shape is cut, see cutTexts().
bool isTextUsable(const FieldDescriptor& field, const std::string& text) {
    const bool is_id = field.options().GetExtension(bound::shape) == bound::ID;
    const bool is_bounded =
        field.type() == FieldDescriptor::TYPE_BYTES && field.options().HasExtension(bound::bytes);
    if (is_id && text.empty()) return false;
    return (!is_id && !is_bounded) || text.size() <= field.options().GetExtension(bound::bytes);
}

bool isElementUsable(const Message& message, const FieldDescriptor& field, int index) {
    std::string room;
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_MESSAGE:
            return isWithinBounds(messageIn(message, field, index));
        case FieldDescriptor::CPPTYPE_STRING:
            return isTextUsable(field, textIn(message, field, index, room));
        case FieldDescriptor::CPPTYPE_ENUM:
            return field.options().GetExtension(bound::shape) != bound::DECLARED ||
                   field.enum_type()->FindValueByNumber(
                       message.GetReflection()->GetEnumValue(message, &field));
        case FieldDescriptor::CPPTYPE_BOOL:
            return true;
        default:
            return isInRange(field, numberIn(message, field, index));
    }
}

bool isUnit(const Message& message, const FieldDescriptor& field) {
    double square = 0;
    for (int n = 0; n < 4; ++n) square += std::pow(numberIn(message, field, n), 2);
    return std::abs(std::sqrt(square) - 1) < kUnitTolerance;
}

bool hasShape(const Message& message, const FieldDescriptor& field, int count) {
    switch (field.options().GetExtension(bound::shape)) {
        case bound::VECTOR_OR_NONE:
            return count == 0 || count == 3;
        case bound::VECTOR:
            return count == 3;
        case bound::QUATERNION_OR_NONE:
            return count == 0 || (count == 4 && isUnit(message, field));
        case bound::QUATERNION:
            return count == 4 && isUnit(message, field);
        default:
            return true;
    }
}

// Lists of a scene file are as long as the payload lets them be; viewers forget those that they do not use.
bool isListBounded(const FieldDescriptor& field) {
    return field.is_repeated() && field.file()->package() != "bonemill.scene";
}

bool isFieldUsable(const Message& message, const FieldDescriptor& field) {
    const auto& r = *message.GetReflection();
    if (field.has_presence() && !r.HasField(message, &field)) return true;
    const int count = countOf(message, field);
    if (isListBounded(field) && count > int(field.options().GetExtension(bound::items))) return false;
    for (int n = 0; n < count; ++n)
        if (!isElementUsable(message, field, n)) return false;
    return hasShape(message, field, count);
}

void cutTexts(Message& message) {
    const auto& r = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    r.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
        const size_t max_bytes = field->options().GetExtension(bound::bytes);
        std::string room;
        for (int n = 0; n < countOf(message, *field); ++n) {
            if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
                cutTexts(field->is_repeated() ? *r.MutableRepeatedMessage(&message, field, n)
                                              : *r.MutableMessage(&message, field));
            } else if (field->type() == FieldDescriptor::TYPE_STRING) {
                std::string text = shownText(textIn(message, *field, n, room), max_bytes);
                field->is_repeated() ? r.SetRepeatedString(&message, field, n, std::move(text))
                                     : r.SetString(&message, field, std::move(text));
            }
        }
    }
}

}  // namespace

double numberIn(const Message& message, const FieldDescriptor& field, int index) {
    const auto& r = *message.GetReflection();
    const bool repeated = field.is_repeated();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return repeated ? r.GetRepeatedDouble(message, &field, index) : r.GetDouble(message, &field);
        case FieldDescriptor::CPPTYPE_FLOAT:
            return double(repeated ? r.GetRepeatedFloat(message, &field, index)
                                   : r.GetFloat(message, &field));
        case FieldDescriptor::CPPTYPE_UINT32:
            return repeated ? r.GetRepeatedUInt32(message, &field, index) : r.GetUInt32(message, &field);
        case FieldDescriptor::CPPTYPE_INT32:
            return repeated ? r.GetRepeatedInt32(message, &field, index) : r.GetInt32(message, &field);
        case FieldDescriptor::CPPTYPE_UINT64:
            return double(repeated ? r.GetRepeatedUInt64(message, &field, index)
                                   : r.GetUInt64(message, &field));
        case FieldDescriptor::CPPTYPE_INT64:
            return double(repeated ? r.GetRepeatedInt64(message, &field, index)
                                   : r.GetInt64(message, &field));
        default:
            return 0;
    }
}

bool isWithinBounds(const Message& message) {
    const auto& type = *message.GetDescriptor();
    for (int n = 0; n < type.field_count(); ++n)
        if (!isFieldUsable(message, *type.field(n))) return false;
    return true;
}

bool parseWithinBounds(std::span<const uint8_t> payload, Message& message) {
    // Bad bytes are counted by the caller; a hostile peer must not fill the log.
    const google::protobuf::LogSilencer silencer;
    if (payload.size() > message.GetDescriptor()->options().GetExtension(bound::payload) ||
        !message.ParseFromArray(payload.data(), static_cast<int>(payload.size())) || !isWithinBounds(message))
        return false;
    cutTexts(message);
    return true;
}

std::string shownText(const std::string& text, size_t max_bytes) {
    std::string shown;
    for (size_t i = 0; i < text.size() && shown.size() < max_bytes;) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
        if (i + length > text.size() || shown.size() + length > max_bytes) break;
        if (unprintableBytes(text, i) == 0) shown.append(text, i, length);
        i += length;
    }
    return shown;
}

}  // namespace bonemill
