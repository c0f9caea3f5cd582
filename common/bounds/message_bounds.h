// Checks what comes off the wire against the bounds that proto/bounds.proto explains: every number, list and
// text in a message, however deep, also one that nobody has thought of. It is thread-safe and never throws on
// any bytes (other than std::bad_alloc).
#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <span>
#include <string>

namespace bonemill {

// Returns true when it is a message of this type, within its bounds; texts are cut to what stands on a
// screen.
bool parseWithinBounds(std::span<const uint8_t> payload, google::protobuf::Message& message);

bool isWithinBounds(const google::protobuf::Message& message);

// Returns what stands on a screen: nothing unprintable (foreign_text.h), no broken UTF-8 (cut off with all
// that follows), and no more than `max_bytes`.
std::string shownText(const std::string& text, size_t max_bytes);

// Returns the value of a number's field, or of its element `index` if it is repeated; 0 for what is no
// number.
double numberIn(const google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field,
                int index);

}  // namespace bonemill
