// Chooses the files of a folder that make one volume, and their order: from headers, never from file names;
// and says which of them show bone best.
//
// There is no DICOM library in here: tests feed it headers. Positions and spacings are in mm and LPS, as
// in the files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_stack.h"

namespace bonemill {

// Which stack is wanted; what is empty leaves it to the rule.
struct DicomWish {
    std::string series_uid;
    std::string acquisition;     // DicomStack::name, or what stands before its "/"
    std::filesystem::path file;  // the stack that holds it goes before others of the series
};

struct DicomChoice {
    DicomStack stack;
    std::string how_chosen;  // for people: where stacks of the series overlap; else empty
    std::string left_out;    // for people: other stacks in the folder
    std::string damaged;     // for people: files of other series that cannot be read; else empty
};

// Slices of one series with the same patient, Frame of Reference, modality, orientation, size and pixel
// spacing as the first of them belong together, and of those that overlap the ones of one acquisition or
// phase (dicom_parts.h). Series come in the order of their UIDs. Stacks of a series that share a name are
// counted: "1/1", "1/2". There is one slice at least. A stack whose series misses a damaged file, or may do
// so, or of whose slices only some state a scale, has that as its problem.
std::vector<DicomStack> stacksOf(const std::vector<DicomSlice>& slices, const IsSamePicture& is_same_picture,
                                 const std::vector<DamagedFile>& damaged = {});

// What tells a stack from all others of the folder: series, and its name where it has one.
std::string titleOf(const DicomStack& stack);

bool isScout(const DicomStack& stack);  // it is no scan: a localizer, or of too few slices

// Of the stacks that are wished for, the one that recommendForBone() would recommend; where none can be used,
// the one with the most slices. Throws UserError, naming `folder` and the files and positions at fault.
DicomChoice chooseStack(const std::vector<DicomSlice>& slices, const DicomWish& wish,
                        const std::string& folder, const IsSamePicture& is_same_picture,
                        const std::vector<DamagedFile>& damaged = {});

// Is it the name of a sharp reconstruction kernel, as makers give for bone? dicom_series.cpp has the table.
bool isBoneKernel(const std::string& kernel);

struct BoneRecommendation {
    const DicomStack* stack = nullptr;  // nothing: none can be used
    std::string why;                    // for people
};

// Scouts and what cannot be used are left out, and so is what a series holds beside a larger stack that
// cannot be used. CT goes before all else, bone kernels before others unless their slices are more than twice
// as far apart as the thinnest, then the thinnest slices, then the most, then the lowest number of
// acquisition, then originals.
BoneRecommendation recommendForBone(const std::vector<DicomStack>& stacks);

}  // namespace bonemill
