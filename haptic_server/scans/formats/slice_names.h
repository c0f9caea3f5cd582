// The names of a folder's pictures: their order, and whether their numbers are those of one whole stack.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

// Orders "a2" before "a10": numbers in names count as numbers.
bool isBeforeNaturally(const std::string& a, const std::string& b);

struct SliceNumbers {
    std::string problem;  // for people: why the names are not those of one whole stack; else empty
    std::string remark;   // for people: what is unusual about them; else empty
};

// Of names without endings, in their natural order. Names without any number say nothing; else all differ by
// their numbers alone, and one of these runs through all of them in even steps.
SliceNumbers sliceNumbersOf(const std::vector<std::string>& names);

}  // namespace bonemill
