// Finds a vendor's library and devices on this PC, and says what is wrong in words that tell one reason from
// another. It is for start-up only.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bonemill::bridge {

// Loads a vendor's library at run time. It stays loaded until the process ends: drivers that are unloaded
// while their threads run crash, and some fail when they are loaded again.
struct LibrarySearch {
    std::string file;                                 // "libdrd.so.3", as the dynamic linker finds it
    std::string product;                              // whose it is, for people: "the Force Dimension SDK"
    std::string chosen;                               // --library: this file and no other; empty: search
    bool is_global = false;                           // its symbols serve the libraries that it loads itself
    std::vector<std::filesystem::path> folders = {};  // that are searched before the dynamic linker's own
};

class SharedLibrary {
  public:
    // Throws UserError: the library is nowhere (and where that was), or it is there and cannot be loaded (and
    // the dynamic linker's own words).
    explicit SharedLibrary(const LibrarySearch& search);

    const std::string& path() const { return path_; }

    // Looks a function up; one that is not there becomes a null pointer, and its name is remembered.
    template <class Function>
    void require(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(find(name, missing_));
    }
    template <class Function>
    void allow(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(find(name, missing_optional_));
    }
    // Tells which of those that are allowed to be missing are. Throws UserError if a required one is.
    void checkFunctions(const std::function<void(const std::string&)>& tell) const;

  private:
    void* find(const char* name, std::vector<std::string>& missing);

    std::string path_;
    void* handle_ = nullptr;
    std::vector<std::string> missing_;
    std::vector<std::string> missing_optional_;
};

// Looks for devices on USB, so that "no device" becomes "not plugged in", "no permission" or "another user
// has it". It reads /sys, and opens nothing.
struct UsbId {
    const char* vendor;   // "1451", as /sys writes it
    const char* product;  // "" for all of the vendor's
};

struct UsbDevice {
    std::string id;                                // "1451:0402"
    std::vector<std::filesystem::path> nodes;      // /dev/bus/usb/001/004, /dev/ttyACM0, /dev/hidraw1
    std::vector<std::filesystem::path> forbidden;  // those of them that this user may not read and write
};

// `root` has sys and dev; tests have one of their own.
std::vector<UsbDevice> findUsb(std::span<const UsbId> ids, const std::filesystem::path& root = "/");

// Says in a sentence why a library that works sees no device.
std::string whyNoDevice(const std::vector<UsbDevice>& found, const std::string& what);

}  // namespace bonemill::bridge
