#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>

#include "common/base/user_error.h"
#include "tests/bench/big_scans.h"

namespace bonemill::bench {
namespace {

gdcm::TransferSyntax::TSType syntaxOf(Packing packing) {
    switch (packing) {
        case Packing::kJpegLossless:
            return gdcm::TransferSyntax::JPEGLosslessProcess14_1;
        case Packing::kJpeg2000:
            return gdcm::TransferSyntax::JPEG2000Lossless;
        case Packing::kRle:
            break;
    }
    return gdcm::TransferSyntax::RLELossless;
}

}  // namespace

void packSeries(const std::filesystem::path& from, const std::filesystem::path& folder, Packing packing) {
    std::filesystem::create_directories(folder);
    for (const auto& entry : std::filesystem::directory_iterator(from)) {
        gdcm::ImageReader reader;
        reader.SetFileName(entry.path().c_str());
        gdcm::ImageChangeTransferSyntax change;
        change.SetTransferSyntax(syntaxOf(packing));
        if (!reader.Read()) throw UserError("cannot read " + entry.path().string());
        change.SetInput(reader.GetImage());
        if (!change.Change()) throw UserError("cannot pack " + entry.path().string());
        gdcm::ImageWriter writer;
        const std::string file = folder / entry.path().filename();
        writer.SetFileName(file.c_str());
        writer.SetFile(reader.GetFile());
        writer.SetImage(change.GetOutput());
        if (!writer.Write()) throw UserError("cannot write " + file);
    }
}

}  // namespace bonemill::bench
