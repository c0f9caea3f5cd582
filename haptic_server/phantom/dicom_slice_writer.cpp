#include "haptic_server/phantom/dicom_slice_writer.h"

#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>

#include "common/user_error.h"

namespace bonemill {

void writeCtSlice(const std::filesystem::path& path, const CtSlice& slice) {
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
