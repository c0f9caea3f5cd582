#include "common/bounds/message_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// A message of this type in which every number, list and text is as it must be.
void fill(Message& message, int depth = 0) {
    const auto& r = *message.GetReflection();
    const Descriptor& type = *message.GetDescriptor();
    const int unit[] = {1, 0, 0, 0};
    for (int n = 0; n < type.field_count(); ++n) {
        const FieldDescriptor* field = type.field(n);
        const auto shape = field->options().GetExtension(bound::shape);
        const bool is_quaternion = shape == bound::QUATERNION || shape == bound::QUATERNION_OR_NONE;
        const int count = is_quaternion                                              ? 4
                          : shape == bound::VECTOR || shape == bound::VECTOR_OR_NONE ? 3
                                                                                     : 1;
        const double low = field->options().HasExtension(scene::range)
                               ? std::max(1.0, field->options().GetExtension(scene::range).min())
                               : 1.0;
        const double high = field->options().HasExtension(scene::range)
                                ? field->options().GetExtension(scene::range).max()
                                : 1.0;
        const double number = std::min(low, high);
        for (int k = 0; k < (field->is_repeated() ? count : 1); ++k) {
            const double value = is_quaternion ? unit[k] : number;
            switch (field->cpp_type()) {
                case FieldDescriptor::CPPTYPE_DOUBLE:
                    field->is_repeated() ? r.AddDouble(&message, field, value)
                                         : r.SetDouble(&message, field, value);
                    break;
                case FieldDescriptor::CPPTYPE_FLOAT:
                    field->is_repeated() ? r.AddFloat(&message, field, float(value))
                                         : r.SetFloat(&message, field, float(value));
                    break;
                case FieldDescriptor::CPPTYPE_UINT32:
                    field->is_repeated() ? r.AddUInt32(&message, field, uint32_t(value))
                                         : r.SetUInt32(&message, field, uint32_t(value));
                    break;
                case FieldDescriptor::CPPTYPE_UINT64:
                    r.SetUInt64(&message, field, uint64_t(value));
                    break;
                case FieldDescriptor::CPPTYPE_STRING:
                    field->is_repeated() ? r.AddString(&message, field, "x")
                                         : r.SetString(&message, field, "x");
                    break;
                case FieldDescriptor::CPPTYPE_MESSAGE:
                    if (depth < 6)
                        fill(field->is_repeated() ? *r.AddMessage(&message, field)
                                                  : *r.MutableMessage(&message, field),
                             depth + 1);
                    break;
                default:
                    break;
            }
        }
    }
}

// Every message in it, however deep, with its path; once per type.
void forEachMessage(Message& message, const std::string& path, std::set<const Descriptor*>& seen,
                    const std::function<void(Message&, const std::string&)>& see) {
    if (!seen.insert(message.GetDescriptor()).second) return;
    see(message, path);
    const auto& r = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    r.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields)
        if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE)
            forEachMessage(field->is_repeated() ? *r.MutableRepeatedMessage(&message, field, 0)
                                                : *r.MutableMessage(&message, field),
                           path + "." + field->name(), seen, see);
}

bool isFloating(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
           field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
}

void setNumber(Message& message, const FieldDescriptor& field, double value) {
    const auto& r = *message.GetReflection();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE)
        field.is_repeated() ? r.SetRepeatedDouble(&message, &field, 0, value)
                            : r.SetDouble(&message, &field, value);
    else
        field.is_repeated() ? r.SetRepeatedFloat(&message, &field, 0, float(value))
                            : r.SetFloat(&message, &field, float(value));
}

// A message of the type with one field spoilt is refused; unspoilt it is not.
class Bounds : public testing::TestWithParam<const Message*> {
  protected:
    Bounds() : message_(GetParam()->New()) { fill(*message_); }

    // Spoils a field of each message within, if `spoil` says that it did, and expects that all of it is
    // refused.
    void expectRefused(const std::function<bool(Message&, const FieldDescriptor&)>& spoil) {
        std::set<const Descriptor*> seen;
        forEachMessage(
            *message_, message_->GetDescriptor()->name(), seen, [&](Message& part, const std::string& path) {
                const std::unique_ptr<Message> kept(part.New());
                kept->CopyFrom(part);
                for (int n = 0; n < part.GetDescriptor()->field_count(); ++n) {
                    const FieldDescriptor& field = *part.GetDescriptor()->field(n);
                    const bool is_spoilt = spoil(part, field);
                    EXPECT_TRUE(!is_spoilt || !isWithinBounds(*message_)) << path << "." << field.name();
                    part.CopyFrom(*kept);
                }
            });
    }

    std::unique_ptr<Message> message_;
};

TEST_P(Bounds, AMessageWithinThemIsTaken) {
    EXPECT_TRUE(isWithinBounds(*message_)) << message_->ShortDebugString();
    const std::string bytes = message_->SerializeAsString();
    const std::unique_ptr<Message> parsed(message_->New());
    EXPECT_TRUE(parseWithinBounds({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, *parsed));
}

TEST_P(Bounds, NoNumberPassesUnchecked) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e30})
        expectRefused([bad](Message& part, const FieldDescriptor& field) {
            if (isFloating(field)) setNumber(part, field, bad);
            return isFloating(field);
        });
}

TEST_P(Bounds, NoListPassesUnchecked) {
    expectRefused([](Message& part, const FieldDescriptor& field) {
        if (!field.is_repeated() || field.file()->package() == "bonemill.scene") return false;
        const auto& r = *part.GetReflection();
        const uint32_t most = field.options().GetExtension(bound::items);
        const bool has_shape = field.options().HasExtension(bound::shape);
        while (uint32_t(r.FieldSize(part, &field)) <= (has_shape ? 4 : most)) {
            switch (field.cpp_type()) {
                case FieldDescriptor::CPPTYPE_DOUBLE:
                    r.AddDouble(&part, &field, 0);
                    break;
                case FieldDescriptor::CPPTYPE_FLOAT:
                    r.AddFloat(&part, &field, 0);
                    break;
                case FieldDescriptor::CPPTYPE_UINT32:
                    r.AddUInt32(&part, &field, 1);
                    break;
                case FieldDescriptor::CPPTYPE_STRING:
                    r.AddString(&part, &field, "x");
                    break;
                default:
                    r.AddMessage(&part, &field)->CopyFrom(r.GetRepeatedMessage(part, &field, 0));
            }
        }
        return true;
    });
}

TEST_P(Bounds, NoTextPassesUnchecked) {
    std::set<const Descriptor*> seen;
    forEachMessage(*message_, "", seen, [](Message& part, const std::string&) {
        const auto& r = *part.GetReflection();
        for (int n = 0; n < part.GetDescriptor()->field_count(); ++n) {
            const FieldDescriptor* field = part.GetDescriptor()->field(n);
            if (field->type() != FieldDescriptor::TYPE_STRING) continue;
            const bool is_id = field->options().GetExtension(bound::shape) == bound::ID;
            const std::string text = is_id ? "a\x1b" : "a\x1b" + std::string(1300, 'x');
            field->is_repeated() ? r.SetRepeatedString(&part, field, 0, text)
                                 : r.SetString(&part, field, text);
        }
    });
    const std::string bytes = message_->SerializeAsString();
    ASSERT_LE(bytes.size(), message_->GetDescriptor()->options().GetExtension(bound::payload));
    const std::unique_ptr<Message> parsed(message_->New());
    ASSERT_TRUE(parseWithinBounds({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, *parsed));
    seen.clear();
    forEachMessage(
        *parsed, parsed->GetDescriptor()->name(), seen, [](Message& part, const std::string& path) {
            const auto& r = *part.GetReflection();
            for (int n = 0; n < part.GetDescriptor()->field_count(); ++n) {
                const FieldDescriptor* field = part.GetDescriptor()->field(n);
                if (field->type() != FieldDescriptor::TYPE_STRING) continue;
                const std::string text =
                    field->is_repeated() ? r.GetRepeatedString(part, field, 0) : r.GetString(part, field);
                EXPECT_EQ(text.find('\x1b'), std::string::npos) << path << "." << field->name();
                EXPECT_LE(text.size(), field->options().GetExtension(bound::bytes))
                    << path << "." << field->name();
            }
        });
}

TEST_P(Bounds, APayloadHasABound) {
    EXPECT_GT(message_->GetDescriptor()->options().GetExtension(bound::payload), 0u);
    const std::vector<uint8_t> bytes(message_->GetDescriptor()->options().GetExtension(bound::payload) + 1);
    EXPECT_FALSE(parseWithinBounds(bytes, *message_));
}

INSTANTIATE_TEST_SUITE_P(
    Payloads, Bounds,
    testing::Values(&topics::SceneInfo::default_instance(), &topics::StructureMesh::default_instance(),
                    &topics::ToolState::default_instance(), &topics::Status::default_instance(),
                    &topics::Lesson::default_instance(), &topics::ScenePicture::default_instance(),
                    &topics::Remark::default_instance(), &topics::Viewer::default_instance(),
                    &topics::DensityBrick::default_instance()),
    [](const auto& info) { return info.param->GetDescriptor()->name(); });

TEST(ShownText, IsPrintableWholeAndShort) {
    EXPECT_EQ(shownText("a\x1b[2J\n", 64), "a[2J");
    EXPECT_EQ(shownText("gr\xc3\xbcn", 3), "gr") << "no half a letter";
    EXPECT_EQ(shownText("x\xc3", 64), "x") << "cut off";
}

}  // namespace
}  // namespace bonemill
