#include "haptic_server/volume/import/itk_image_file.h"

#include <fcntl.h>
#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <unistd.h>

#include <sstream>

#include "common/config/user_error.h"

namespace bonemill {
namespace {

// The libraries' warnings would stand between the user and the one message that counts.
void silenceLibraries() {
    itk::Object::SetGlobalWarningDisplay(false);
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::Trace::DebugOff();
}

// MetaIO, the NIfTI library and the JPEG decoders print to stderr themselves. Start-up has one thread, so stderr can be
// pointed elsewhere for the duration of a call.
class QuietStderr {
  public:
    QuietStderr() : before_(dup(STDERR_FILENO)) {
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (before_ >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
        if (nowhere >= 0) close(nowhere);
    }
    ~QuietStderr() {
        if (before_ < 0) return;
        dup2(before_, STDERR_FILENO);
        close(before_);
    }
    QuietStderr(const QuietStderr&) = delete;
    QuietStderr& operator=(const QuietStderr&) = delete;

  private:
    int before_;
};

itk::ImageIOBase::Pointer makeReader(ItkFormat format) {
    switch (format) {
        case ItkFormat::kNrrd: return itk::NrrdImageIO::New().GetPointer();
        case ItkFormat::kNifti: return itk::NiftiImageIO::New().GetPointer();
        case ItkFormat::kMetaImage: return itk::MetaImageIO::New().GetPointer();
        case ItkFormat::kDicom: break;
    }
    return itk::GDCMImageIO::New().GetPointer();
}

// The library's message on one line, without "ITK ERROR: NrrdImageIO(0x55...): ".
std::string plainMessage(const itk::ExceptionObject& error) {
    std::istringstream words(error.GetDescription());
    std::string text, word;
    while (words >> word) text += (text.empty() ? "" : " ") + word;
    const auto end_of_class = text.find("): ");
    if (text.find("ERROR") < end_of_class && end_of_class != std::string::npos) text.erase(0, end_of_class + 3);
    constexpr size_t kLongest = 300;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

ItkImageHeader headerOf(const itk::ImageIOBase& io) {
    ItkImageHeader header;
    for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) header.dims.push_back(io.GetDimensions(a));
    header.components = io.GetNumberOfComponents();
    header.bytes_per_voxel = io.GetComponentSize();
    for (unsigned a = 0; a < 3; ++a) {
        header.axis[a][a] = 1;
        if (a >= io.GetNumberOfDimensions()) continue;
        header.spacing[a] = io.GetSpacing(a);
        header.origin[a] = io.GetOrigin(a);
        const std::vector<double> axis = io.GetDirection(a);
        for (unsigned row = 0; row < 3; ++row) header.axis[a][row] = row < axis.size() ? axis[row] : 0;
    }
    return header;
}

template <class T>
void append(const std::vector<char>& buffer, std::vector<float>& values) {
    const T* samples = reinterpret_cast<const T*>(buffer.data());
    values.insert(values.end(), samples, samples + buffer.size() / sizeof(T));
}

// False for a sample type that is no plain number.
bool appendAs(itk::IOComponentEnum type, const std::vector<char>& buffer, std::vector<float>& values) {
    using Type = itk::IOComponentEnum;
    switch (type) {
        case Type::UCHAR: append<unsigned char>(buffer, values); break;
        case Type::CHAR: append<signed char>(buffer, values); break;
        case Type::USHORT: append<unsigned short>(buffer, values); break;
        case Type::SHORT: append<short>(buffer, values); break;
        case Type::UINT: append<unsigned int>(buffer, values); break;
        case Type::INT: append<int>(buffer, values); break;
        case Type::ULONG: append<unsigned long>(buffer, values); break;
        case Type::LONG: append<long>(buffer, values); break;
        case Type::ULONGLONG: append<unsigned long long>(buffer, values); break;
        case Type::LONGLONG: append<long long>(buffer, values); break;
        case Type::FLOAT: append<float>(buffer, values); break;
        case Type::DOUBLE: append<double>(buffer, values); break;
        default: return false;
    }
    return true;
}

}  // namespace

struct ItkImageFile::Reader {
    itk::ImageIOBase::Pointer io;
};

ItkImageFile::ItkImageFile(ItkFormat format, const std::filesystem::path& path)
    : file_(path.string()), reader_(std::make_unique<Reader>()) {
    silenceLibraries();
    const QuietStderr quiet;
    try {
        reader_->io = makeReader(format);
        reader_->io->SetFileName(file_);
        reader_->io->ReadImageInformation();
        header_ = headerOf(*reader_->io);
    } catch (const itk::ExceptionObject& error) {
        throw UserError(file_ + ": its header cannot be read: " + plainMessage(error));
    }
}

ItkImageFile::~ItkImageFile() = default;

std::string ItkImageFile::dicomTag(const char* tag) const {
    std::string value;
    itk::ExposeMetaData<std::string>(reader_->io->GetMetaDataDictionary(), tag, value);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
    return value;
}

void ItkImageFile::appendValues(std::vector<float>& values) {
    const QuietStderr quiet;
    itk::ImageIOBase& io = *reader_->io;
    try {
        itk::ImageIORegion region(io.GetNumberOfDimensions());
        for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) region.SetSize(a, io.GetDimensions(a));
        io.SetIORegion(region);
        std::vector<char> buffer(size_t(io.GetImageSizeInBytes()));
        io.Read(buffer.data());
        if (!appendAs(io.GetComponentType(), buffer, values))
            throw UserError(file_ + ": its sample type is not a plain number");
    } catch (const itk::ExceptionObject& error) {
        throw UserError(file_ + ": its voxels cannot be read: " + plainMessage(error));
    }
}

}  // namespace bonemill
