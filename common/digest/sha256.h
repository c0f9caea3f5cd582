// SHA-256, which says what exactly was used or written. Each object is for one normal thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace bonemill {

class Sha256 {
  public:
    static constexpr size_t kBytes = 32;

    Sha256();
    ~Sha256();
    void add(std::string_view bytes);
    // Of all that was added; it begins anew after it.
    std::string take();

  private:
    struct Context;
    std::unique_ptr<Context> context_;
};

// Two digits per byte.
std::string hexOf(std::string_view bytes);
// As 64 hexadecimal digits.
std::string sha256OfText(std::string_view text);
// Of a file's bytes. Throws UserError if it is no file, or cannot be read; a pipe or a device would never
// end.
std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace bonemill
