#include "haptic_server/scans/pixels/itk_image_file.h"

#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <span>
#include <sstream>
#include <type_traits>

#include "common/base/user_error.h"
#include "haptic_server/core/volume/forget_memory.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"

namespace bonemill {
namespace {

template <class Io>
itk::ImageIOBase::Pointer makeIo() {
    return Io::New().GetPointer();
}

// The library's list of what it can make is made when it is first asked, by one thread at a time here.
itk::ImageIOBase::Pointer makeReader(ItkFormat format) {
    static std::mutex only_one;
    const std::lock_guard lock(only_one);
    static const std::map<ItkFormat, itk::ImageIOBase::Pointer (*)()> kMakers{
        {ItkFormat::kNrrd, makeIo<itk::NrrdImageIO>}, {ItkFormat::kMetaImage, makeIo<itk::MetaImageIO>}};
    return kMakers.at(format)();
}

// Puts the library's message on one line, without "ITK ERROR: NrrdImageIO(0x55...): ".
std::string plainMessage(const itk::ExceptionObject& error) {
    std::istringstream words(error.GetDescription());
    std::string text, word;
    while (words >> word) text += (text.empty() ? "" : " ") + word;
    const auto end_of_class = text.find("): ");
    if (text.find("ERROR") < end_of_class && end_of_class != std::string::npos)
        text.erase(0, end_of_class + 3);
    constexpr size_t kLongest = 300;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

// A sparse file holds less than its length says.
uint64_t bytesOnDisk(const std::string& file) {
    constexpr uint64_t kBlockBytes = 512;  // whatever the file system's are
    struct stat facts {};
    if (stat(file.c_str(), &facts) != 0) return 0;
    return std::min(uint64_t(facts.st_size), uint64_t(facts.st_blocks) * kBlockBytes);
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
inline constexpr bool kIsHeldAsItIs =
    std::is_same_v<T, uint8_t> || std::is_same_v<T, int16_t> || std::is_same_v<T, uint16_t>;

// Works block by block, so that the samples and their copy are never there together.
template <class T>
void appendConverted(std::span<T> samples, RawValues& values) {
    constexpr size_t kBlock = size_t(1) << 20;
    std::vector<float> block;
    for (size_t begin = 0; begin < samples.size(); begin += kBlock) {
        const auto part = samples.subspan(begin, std::min(kBlock, samples.size() - begin));
        block.assign(part.begin(), part.end());
        values.append(std::span<const float>(block));
        forget(part);
    }
}

template <class T>
void readSamples(itk::ImageIOBase& io, RawValues& values) {
    std::vector<T> samples(size_t(io.GetImageSizeInBytes()) / sizeof(T));
    io.Read(samples.data());
    if constexpr (kIsHeldAsItIs<T>)
        values.append(std::move(samples));
    else
        appendConverted(std::span(samples), values);
}

// It is false for a sample type that is no plain number.
bool readAs(itk::IOComponentEnum type, itk::ImageIOBase& io, RawValues& values) {
    using Type = itk::IOComponentEnum;
    using Read = void (*)(itk::ImageIOBase&, RawValues&);
    static const std::map<Type, Read> kReads{{Type::UCHAR, readSamples<unsigned char>},
                                             {Type::CHAR, readSamples<signed char>},
                                             {Type::USHORT, readSamples<unsigned short>},
                                             {Type::SHORT, readSamples<short>},
                                             {Type::UINT, readSamples<unsigned int>},
                                             {Type::INT, readSamples<int>},
                                             {Type::ULONG, readSamples<unsigned long>},
                                             {Type::LONG, readSamples<long>},
                                             {Type::ULONGLONG, readSamples<unsigned long long>},
                                             {Type::LONGLONG, readSamples<long long>},
                                             {Type::FLOAT, readSamples<float>},
                                             {Type::DOUBLE, readSamples<double>}};
    const auto read = kReads.find(type);
    if (read == kReads.end()) return false;
    read->second(io, values);
    return true;
}

}  // namespace

uint64_t mostMemoryToRead(const std::filesystem::path& file, uint64_t voxel_bytes) {
    constexpr uint64_t kTables = 256 << 20;
    return kTables + 8 * bytesOnDisk(file.string()) + 4 * voxel_bytes;
}

struct ItkImageFile::Reader {
    itk::ImageIOBase::Pointer io;
};

ItkImageFile::ItkImageFile(ItkFormat format, const std::filesystem::path& path)
    : file_(path.string()), reader_(std::make_unique<Reader>()) {
    noteFileBeingRead(path);
    const MemoryCap cap(mostMemoryToRead(file_, 0));
    try {
        reader_->io = makeReader(format);
        reader_->io->SetFileName(file_);
        reader_->io->ReadImageInformation();
        header_ = headerOf(*reader_->io);
    } catch (const itk::ExceptionObject& error) {
        throw UserError(file_ + ": its header cannot be read: " + plainMessage(error));
    } catch (const std::bad_alloc&) {
        refuseMemory(mostMemoryToRead(file_, 0), file_);
    } catch (const std::exception& error) {  // of the libraries below ITK
        throw UserError(file_ + ": its header cannot be read: " + error.what());
    }
    if (header_.bytes_per_voxel == 0) throw UserError(file_ + ": its sample type is not a plain number");
}

ItkImageFile::~ItkImageFile() = default;

void ItkImageFile::appendValues(RawValues& values) {
    itk::ImageIOBase& io = *reader_->io;
    const uint64_t bytes = uint64_t(io.GetImageSizeInBytes());
    const uint64_t most = mostMemoryToRead(file_, bytes) + bytes / header_.bytes_per_voxel * sizeof(float);
    const MemoryCap cap(most);
    try {
        itk::ImageIORegion region(io.GetNumberOfDimensions());
        for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) region.SetSize(a, io.GetDimensions(a));
        io.SetIORegion(region);
        if (!readAs(io.GetComponentType(), io, values))
            throw UserError(file_ + ": its sample type is not a plain number");
    } catch (const itk::ExceptionObject& error) {
        throw UserError(file_ + ": its voxels cannot be read: " + plainMessage(error));
    } catch (const UserError&) {
        throw;
    } catch (const std::bad_alloc&) {
        refuseMemory(most, file_);
    } catch (const std::exception& error) {
        throw UserError(file_ + ": its voxels cannot be read: " + error.what());
    }
}

}  // namespace bonemill
