// Makes a training case of a scan: a folder with the scan, its labels, the scene and where it all comes from.
//
// Nothing in the folder comes from the scan's file but values and geometry: no name, no date, no UID, no
// path. (A face can still be made of a CT of a head.)
#pragma once

#include <iosfwd>
#include <string>

#include "haptic_server/cases/casework/case_request.h"

namespace bonemill {

// The folder must not exist, or be empty; it is there as a whole or not at all. What was found and chosen
// goes to `out`. Throws UserError.
void makeCase(const CaseRequest& request, const std::string& version, std::ostream& out);

}  // namespace bonemill
