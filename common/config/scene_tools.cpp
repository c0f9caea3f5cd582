#include "common/config/scene_tools.h"

#include <algorithm>
#include <charconv>

#include "common/base/user_error.h"

namespace bonemill {

std::vector<const scene::Tool*> toolsOf(const scene::Scene& scene) {
    if (scene.tool_size() == 0) return {&scene::Tool::default_instance()};
    std::vector<const scene::Tool*> tools;
    for (const scene::Tool& tool : scene.tool()) tools.push_back(&tool);
    return tools;
}

std::vector<std::string> toolNamesOf(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const scene::Tool* tool : toolsOf(scene))
        names.push_back(tool->name().empty() ? "tool " + std::to_string(names.size() + 1) : tool->name());
    return names;
}

size_t toolIndexOf(const std::vector<std::string>& names, const std::string& text) {
    const auto named = std::find(names.begin(), names.end(), text);
    if (named != names.end()) return size_t(named - names.begin());
    size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_number = error == std::errc() && end == text.data() + text.size();
    if (is_number && number >= 1 && number <= names.size()) return number - 1;
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    throw UserError("no tool of the scene is called '" + text + "'; it has: " + known);
}

}  // namespace bonemill
