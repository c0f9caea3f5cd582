#include "haptic_server/recording/journal/build_facts.h"

#include <gnu/libc-version.h>
#include <openssl/rand.h>

#include <algorithm>
#include <cstdlib>

#include "common/base/user_error.h"
#include "common/digest/digest.h"
#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {
namespace {

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error))
        if (entry.is_regular_file(error)) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

uint64_t bytesIn(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
        const uintmax_t size = std::filesystem::file_size(path, error);
        return error ? 0 : uint64_t(size);
    }
    uint64_t bytes = 0;
    for (const auto& file : filesIn(path)) bytes += bytesIn(file);
    return bytes;
}

}  // namespace

journal::Build buildFacts(const std::string& version) {
    journal::Build build;
    build.set_version(version);
    build.set_compiler(__VERSION__);
    std::string library = std::string("glibc ") + gnu_get_libc_version();
#if defined(__x86_64__)
    library += __builtin_cpu_supports("fma") ? ", FMA" : ", no FMA";
    library += __builtin_cpu_supports("avx2") ? ", AVX2" : ", no AVX2";
#endif
    if (const char* tunables = std::getenv("GLIBC_TUNABLES")) library += std::string(", ") + tunables;
    build.set_library(library);
    for (const CpuLevel level : kCpuLevels)
        if (isSupported(level) && &kernelsOf(level) == &kernels()) build.set_kernels(cpuLevelName(level));
    return build;
}

std::string sha256Of(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) return sha256OfFile(path);
    Sha256 hash;
    for (const auto& file : filesIn(path)) {
        const std::string line = file.lexically_relative(path).string() + '\n' +
                                 std::to_string(bytesIn(file)) + '\n' + sha256OfFile(file) + '\n';
        hash.add(line);
    }
    return hexOf(hash.take());
}

std::vector<journal::File> hashedFiles(const std::vector<NamedFile>& files) {
    std::vector<journal::File> hashed;
    for (const NamedFile& file : files) {
        journal::File& entry = hashed.emplace_back();
        entry.set_what(file.name);
        entry.set_path(std::filesystem::absolute(file.path).lexically_normal());
        entry.set_bytes(bytesIn(file.path));
        entry.set_sha256(sha256Of(file.path));
    }
    return hashed;
}

std::string newJournalId() {
    std::string bytes(16, '\0');
    if (RAND_bytes(reinterpret_cast<unsigned char*>(bytes.data()), int(bytes.size())) != 1)
        throw UserError("the system gives no random numbers");
    return hexOf(bytes);
}

}  // namespace bonemill
