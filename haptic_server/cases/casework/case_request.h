// What a teacher says of the training case that is to be made of a scan, also as words of a command line, and
// the making of it. All but the scan has a default.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/segments.h"

namespace CLI {
class App;
}

namespace bonemill {

// One structure of the label map.
struct CaseLabel {
    std::vector<uint32_t> labels;  // of its voxels; none: those of the segment that is called as it is
    std::string name;
    std::optional<Eigen::Vector3d> color = {};  // red, green, blue, 0 .. 1
    enum class Role : uint8_t { kPlain, kProtected, kTarget } role = Role::kPlain;
};

struct CaseRequest {
    std::string scan;                // file or folder
    std::string series;              // UID; empty: the one that list-series recommends
    std::string acquisition;         // of the series (DicomWish); empty: by rule
    std::vector<double> spacing_mm;  // of voxels whose file or folder does not say it
    std::string out;                 // folder that is made
    std::string title;
    std::string task;    // what the trainee is told to do
    std::string credit;  // of the scan: who is to be named, and its licence
    std::optional<double> iso;
    std::vector<double> at_mm;  // W: middle of the region; empty: all of the bone is milled
    double size_mm = 40;        // edge of the region
    std::optional<double> voxel_mm;
    std::vector<double>
        from_mm;  // W: from there the hand comes; empty: from outside, away from the bone's middle
    std::vector<uint32_t> drop_pieces;
    std::string labels;                    // file
    std::vector<std::string> label_words;  // [NUMBER=]NAME[:protected|:target]
    std::string tools;                     // scene text with tools; empty: the default tool
    std::string figures;                   // folder for the figures (case_figures.h); empty: none
};

// Reads [NUMBER=]NAME[:protected|:target]. Throws UserError.
std::vector<CaseLabel> labelsOf(const std::vector<std::string>& words);

// Gives the structures without a number the labels and the colours of the file's segments. Throws UserError.
void findSegments(const Segments& segments, const std::string& file, std::vector<CaseLabel>& labels);

// Adds the scan and the options of make-case.
void addCaseOptions(CLI::App& app, CaseRequest& request);

// The words from which those options read this request.
std::vector<std::string> wordsOf(const CaseRequest& request);
// They stand behind `command`, as one line for a shell.
std::string commandLineOf(const std::string& command, const CaseRequest& request);

// Makes the case: a folder with the scan, its labels, the scene and where it all comes from. Nothing in it
// comes from the scan's file but values and geometry: no name, no date, no UID, no path. (A face can still be
// made of a CT of a head.) The folder must not exist, or be empty; it is there as a whole or not at all. What
// was found and chosen goes to `out`. Throws UserError.
void makeCase(const CaseRequest& request, const std::string& version, std::ostream& out);

}  // namespace bonemill
