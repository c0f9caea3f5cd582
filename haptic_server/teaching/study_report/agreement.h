// How well raters agree, from a table of their ratings. It is for one thread. Throws UserError.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill::study {

// `file` is a CSV with a header: one column of numbers per rater, one row per rated thing. Says ICC(2,1) of
// all, and Cohen's kappa, plain and with quadratic weights, of each pair.
std::string agreementText(const std::filesystem::path& file);

}  // namespace bonemill::study
