#include "haptic_server/cases/phantom_dicom/dicom_slice_writer.h"

#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>

#include "common/base/user_error.h"

namespace bonemill {

namespace {

// GDCM aborts the program where the disk is full.
void requireSpace(const std::filesystem::path& path, const CtSlice& slice) {
    constexpr uintmax_t kHeaderBytes = 64 << 10;
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(path.parent_path(), error);
    if (!error && space.available < slice.hu.size() * sizeof(slice.hu[0]) + kHeaderBytes)
        throw UserError("cannot write " + path.string() + ": the disk is full");
}

}  // namespace

void writeCtSlice(const std::filesystem::path& path, const CtSlice& slice) {
    requireSpace(path, slice);
    gdcm::Trace::WarningOff();  // GDCM warns of elements that it then adds itself
    const auto io = itk::GDCMImageIO::New();
    io->SetFileName(path.string());
    io->SetNumberOfDimensions(3);
    io->KeepOriginalUIDOn();
    io->UseCompressionOff();
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetComponentType(itk::IOComponentEnum::SHORT);
    io->SetNumberOfComponents(1);
    itk::ImageIORegion region(3);
    const unsigned size[3] = {unsigned(slice.columns), unsigned(slice.rows), 1};
    for (unsigned a = 0; a < 3; ++a) {
        io->SetDimensions(a, size[a]);
        io->SetSpacing(a, slice.spacing_mm[a]);
        io->SetOrigin(a, slice.position_mm[a]);
        io->SetDirection(a, std::vector<double>(slice.axis[a].begin(), slice.axis[a].end()));
        region.SetSize(a, size[a]);
    }
    io->SetIORegion(region);
    auto& dictionary = io->GetMetaDataDictionary();
    for (const auto& [tag, value] : slice.tags) itk::EncapsulateMetaData<std::string>(dictionary, tag, value);
    try {
        io->Write(slice.hu.data());
    } catch (const itk::ExceptionObject& error) {
        throw UserError("cannot write " + path.string() + ": " + error.GetDescription());
    }
}

}  // namespace bonemill
