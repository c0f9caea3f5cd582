// Finds elements in the functional groups of an enhanced multi-frame DICOM file: per frame, else shared by
// all.
#pragma once

#include <gdcmDataSet.h>
#include <gdcmSequenceOfItems.h>

#include <cstring>
#include <optional>
#include <string>

#include "haptic_server/scans/dicom/dicom_slice.h"

namespace bonemill {

using DicomItems = gdcm::SmartPointer<gdcm::SequenceOfItems>;

// Null when there is no such sequence.
DicomItems itemsOf(const gdcm::DataSet& data, const gdcm::Tag& tag);

// Empty when there is no such element, or it is a sequence.
std::string bytesOf(const gdcm::DataSet& data, const gdcm::Tag& tag);

// Of an element that holds one number of this type (VR US, UL, FD).
template <class Number>
std::optional<Number> numberOf(const std::string& bytes) {
    Number number;
    if (bytes.size() != sizeof number) return std::nullopt;
    std::memcpy(&number, bytes.data(), sizeof number);
    return number;
}

// `data` must outlive it.
class FunctionalGroups {
  public:
    explicit FunctionalGroups(const gdcm::DataSet& data);

    size_t frameCount() const;                                     // 0: the file has no groups per frame
    DicomItems items(size_t frame, const gdcm::Tag& group) const;  // null: there are none
    // Of an element in the only item of a group; empty when there is none.
    std::string bytes(size_t frame, const gdcm::Tag& group, const gdcm::Tag& element) const;
    std::string text(size_t frame, const gdcm::Tag& group, const gdcm::Tag& element) const;  // no padding
    template <class Number>
    std::optional<Number> number(size_t frame, const gdcm::Tag& group, const gdcm::Tag& element) const {
        return numberOf<Number>(bytes(frame, group, element));
    }
    // Texts are empty where the groups do not say it.
    DicomPlaceTexts placeTexts(size_t frame) const;

  private:
    DicomItems per_frame_, shared_;
};

}  // namespace bonemill
