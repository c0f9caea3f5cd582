// What tells the pictures of one series apart that show the same place: several acquisitions, phases,
// weightings or reconstructions. There is no Eigen in here.
#pragma once

#include <string>

namespace bonemill {

// As the headers say, without padding; empty: nothing.
struct DicomTraits {
    std::string acquisition_number;  // (0020,0012), of frames (0020,9156)
    std::string temporal_position;   // (0020,0100), of frames (0020,9128)
    std::string b_value;             // (0018,9087)
    std::string kernel;              // (0018,1210)
    std::string image_type;          // (0008,0008), of frames (0008,9007): ORIGINAL\PRIMARY\AXIAL
    std::string acquisition_time;    // (0008,0032)
    std::string content_time;        // (0008,0033)
};

}  // namespace bonemill
