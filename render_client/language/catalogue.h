// A catalogue has the sentences of one language by those of the code, as a file of gettext (.po) has them. It
// is a plain value, for any thread; not RT-safe.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace bonemill {

struct CatalogueHash {
    using is_transparent = void;
    size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
};

// By the English sentence; where that has a context, by catalogueKey().
using Catalogue = std::unordered_map<std::string, std::string, CatalogueHash, std::equal_to<>>;

std::string catalogueKey(std::string_view context, std::string_view text);

// Reads the text of a .po file. Entries that are fuzzy or have no translation are left out, and so is what
// makes no sense: those sentences stay English.
Catalogue catalogueOfPo(const std::string& text);

}  // namespace bonemill
