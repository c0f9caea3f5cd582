// Checks the pages of a class.
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace bonemill::test {

// Every element is closed in its order, as XML asks, but for those of HTML that have no end.
inline std::string wellFormed(const std::string& html) {
    const std::regex tag("<(/?)([a-zA-Z0-9]+)((?:[^'\">]|'[^']*'|\"[^\"]*\")*)>");
    std::vector<std::string> open;
    for (std::sregex_iterator at(html.begin(), html.end(), tag), end; at != end; ++at) {
        const std::string name = (*at)[2], rest = (*at)[3];
        if (name == "meta" || name == "img" || rest.ends_with("/")) continue;
        if ((*at)[1].length() == 0) {
            open.push_back(name);
        } else {
            if (open.empty() || open.back() != name) return "</" + name + "> closes nothing";
            open.pop_back();
        }
    }
    return open.empty() ? "" : "<" + open.back() + "> stays open";
}

inline std::string withoutStyle(std::string html) {
    const size_t from = html.find("<style>"), to = html.find("</style>");
    return html.erase(from, to + 8 - from);
}

}  // namespace bonemill::test
