// A case's request as words of a command line: read, and written again.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "haptic_server/cases/casework/case_request.h"

namespace bonemill {

// Adds the scan and the options of make-case.
void addCaseOptions(CLI::App& app, CaseRequest& request);

// The words from which those options read this request.
std::vector<std::string> wordsOf(const CaseRequest& request);
// They stand behind `command`, as one line for a shell.
std::string commandLineOf(const std::string& command, const CaseRequest& request);

}  // namespace bonemill
