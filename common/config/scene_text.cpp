#include "common/config/scene_text.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, substituted}));
        }
    }
    return row.back();
}

std::string knownFieldsHint(const Descriptor& type, const std::string& unknown_name) {
    std::string nearest, all;
    size_t nearest_distance = std::max<size_t>(2, unknown_name.size() / 3) + 1;
    for (int i = 0; i < type.field_count(); ++i) {
        const std::string& name = type.field(i)->name();
        all += (i ? ", " : "") + name;
        const size_t distance = editDistance(unknown_name, name);
        // A forgotten unit suffix is far in edits and still plainly meant.
        const bool forgot_unit = unknown_name.size() >= 4 && name.starts_with(unknown_name + "_");
        if (distance < nearest_distance || (forgot_unit && nearest.empty())) {
            nearest = name;
            nearest_distance = std::min(distance, nearest_distance);
        }
    }
    return nearest.empty() ? "; known here: " + all : "; did you mean `" + nearest + "`?";
}

}  // namespace

std::string unknownFieldText(const Descriptor& type, const std::string& name) {
    return "unknown field `" + name + "` in " + type.name() + knownFieldsHint(type, name);
}

namespace {

void collectChoices(const Descriptor& type, const std::string& field_name, std::set<std::string>& seen,
                    std::string& choices) {
    if (!seen.insert(type.full_name()).second) return;
    for (int i = 0; i < type.field_count(); ++i) {
        const FieldDescriptor& field = *type.field(i);
        if (field.message_type()) collectChoices(*field.message_type(), field_name, seen, choices);
        if (field.name() != field_name || !field.enum_type() ||
            !seen.insert(field.enum_type()->full_name()).second)
            continue;
        for (int value = 0; value < field.enum_type()->value_count(); ++value)
            choices += (choices.empty() ? "" : ", ") + field.enum_type()->value(value)->name();
    }
}

// Names the choices of every field of this name: the parser does not say in which message it stands.
std::string choicesOf(const std::string& field_name) {
    std::set<std::string> seen;
    std::string choices;
    collectChoices(*scene::Scene::descriptor(), field_name, seen, choices);
    return choices;
}

class FirstError : public google::protobuf::io::ErrorCollector {
  public:
    void AddError(int line, int /*column*/, const std::string& message) override {
        if (!text_) text_ = std::to_string(line + 1) + ": " + explained(message);
    }
    void AddWarning(int, int, const std::string&) override {}
    const std::optional<std::string>& text() const { return text_; }

  private:
    static std::string explained(const std::string& message) {
        static const std::regex kNoValue(
            "Unknown enumeration value of \"([^\"]+)\" for field \"([^\"]+)\"\\.?");
        std::smatch value;
        if (std::regex_match(message, value, kNoValue))
            return "`" + value[2].str() + "` knows no " + value[1].str() + "; choose " + choicesOf(value[2]);
        static const std::regex kNoField("Message type \"([^\"]+)\" has no field named \"([^\"]+)\"\\.?");
        std::smatch match;
        if (!std::regex_match(message, match, kNoField)) return message;
        const Descriptor* type =
            google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(match[1]);
        if (!type) return message;
        return unknownFieldText(*type, match[2]);
    }
    std::optional<std::string> text_;
};

void collectLines(const Message& message, TextFormat::ParseInfoTree& tree, const std::string& prefix,
                  FieldLines& lines) {
    const auto& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
        const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
        for (int i = 0; i < count; ++i) {
            const int index = field->is_repeated() ? i : -1;
            const std::string path =
                prefix + field->name() + (field->is_repeated() ? "[" + std::to_string(i) + "]" : "");
            // Only the first element of a "[a, b]" list has a location.
            const int line = tree.GetLocation(field, index).line;
            if (line >= 0) lines[path] = line + 1;
            if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
            const Message& nested = field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                                         : reflection.GetMessage(message, field);
            if (auto* subtree = tree.GetTreeForNested(field, index))
                collectLines(nested, *subtree, path + ".", lines);
        }
    }
}

}  // namespace

ParsedScene parseSceneText(const std::string& text, const std::string& name) {
    FirstError errors;
    TextFormat::ParseInfoTree tree;
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&errors);
    parser.WriteLocationsTo(&tree);
    ParsedScene parsed;
    if (!parser.ParseFromString(text, &parsed.scene) || errors.text())
        throw UserError(name + ":" + errors.text().value_or("not a scene in Protobuf text format"));
    collectLines(parsed.scene, tree, "", parsed.lines);
    return parsed;
}

std::string placeOf(const std::string& name, const FieldLines& lines, std::string field_path) {
    while (!field_path.empty()) {
        if (const auto found = lines.find(field_path); found != lines.end())
            return name + ":" + std::to_string(found->second) + ": ";
        const size_t dot = field_path.rfind('.');
        field_path.resize(dot == std::string::npos ? 0 : dot);
    }
    return name + ": ";
}

}  // namespace bonemill
