#include "device_daemon/bridges/bridge/vendor_device.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "common/base/user_error.h"

namespace bonemill::bridge {
namespace {

// A folder may have the library under its name or, as unpacked archives do, only with all of its version:
// then the newest name counts.
std::filesystem::path fileIn(const std::filesystem::path& folder, const std::string& file) {
    std::error_code error;
    if (exists(folder / file, error)) return folder / file;
    std::filesystem::path found;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().filename().string().starts_with(file + ".")) found = std::max(found, entry.path());
    return found;
}

std::filesystem::path searched(const LibrarySearch& search) {
    if (!search.chosen.empty()) return search.chosen;
    for (const std::filesystem::path& folder : search.folders)
        if (std::filesystem::path found = fileIn(folder, search.file); !found.empty()) return found;
    return search.file;
}

// Returns "a, b, c".
std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

std::string placesOf(const LibrarySearch& search) {
    std::vector<std::string> places;
    for (const std::filesystem::path& folder : search.folders) places.push_back(folder.string());
    places.push_back("the dynamic linker's own folders (LD_LIBRARY_PATH, ldconfig)");
    return joined(places);
}

bool isMissing(const LibrarySearch& search, const std::filesystem::path& path, const std::string& reason) {
    std::error_code error;
    if (path.has_parent_path()) return !exists(path, error);
    return reason.starts_with(search.file + ":");  // the linker names the file that it does not find
}

[[noreturn]] void refuse(const LibrarySearch& search, const std::filesystem::path& path,
                         const std::string& reason) {
    if (!isMissing(search, path, reason))
        throw UserError("dependency: " + path.string() + " is there and cannot be loaded: " + reason +
                        ". Install what it needs (ldd " + path.string() + " lists it).");
    if (!search.chosen.empty())
        throw UserError("library: " + search.chosen + " does not exist (--library names " + search.file +
                        " of " + search.product + ")");
    throw UserError("library: " + search.file + " was not found in " + placesOf(search) + ". Install " +
                    search.product + ", or name the file with --library.");
}

namespace fs = std::filesystem;

std::string wordIn(const fs::path& file) {
    std::string word;
    std::ifstream(file) >> word;
    return word;
}

int numberIn(const fs::path& file) {
    int number = 0;
    std::ifstream(file) >> number;
    return number;
}

fs::path usbNode(const fs::path& device, const fs::path& root) {
    char name[32];
    std::snprintf(name, sizeof(name), "%03d/%03d", numberIn(device / "busnum"), numberIn(device / "devnum"));
    return root / "dev/bus/usb" / name;
}

// The kernel lists what else serves a device, such as .../tty/ttyACM0 or .../hidraw/hidraw1, a few folders
// below.
void addNodesBelow(const fs::path& folder, const fs::path& root, int depth, std::vector<fs::path>& nodes) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        if (entry.is_symlink(error) || !entry.is_directory(error)) continue;
        const std::string parent = folder.filename().string();
        if (parent == "tty" || parent == "hidraw")
            nodes.push_back(root / "dev" / entry.path().filename());
        else if (depth > 0)
            addNodesBelow(entry.path(), root, depth - 1, nodes);
    }
}

UsbDevice describe(const fs::path& device, const fs::path& root, const std::string& id) {
    constexpr int kDepth = 4;
    UsbDevice found{id, {usbNode(device, root)}, {}};
    addNodesBelow(device, root, kDepth, found.nodes);
    for (const fs::path& node : found.nodes)
        if (access(node.c_str(), R_OK | W_OK) != 0) found.forbidden.push_back(node);
    return found;
}

}  // namespace

SharedLibrary::SharedLibrary(const LibrarySearch& search) {
    const std::filesystem::path path = searched(search);
    path_ = path.string();
    handle_ = dlopen(path_.c_str(), RTLD_LAZY | (search.is_global ? RTLD_GLOBAL : RTLD_LOCAL));
    if (handle_) return;
    const char* reason = dlerror();
    refuse(search, path, reason ? reason : "no reason given");
}

void* SharedLibrary::find(const char* name, std::vector<std::string>& missing) {
    void* const symbol = dlsym(handle_, name);
    if (!symbol) missing.push_back(name);
    return symbol;
}

void SharedLibrary::checkFunctions(const std::function<void(const std::string&)>& tell) const {
    if (!missing_optional_.empty())
        tell("the library lacks, and the bridge goes without: " + joined(missing_optional_));
    if (missing_.empty()) return;
    throw UserError("library: " + path_ + " lacks " + joined(missing_) +
                    ". It is another library, or a version that this bridge does not know.");
}

std::vector<UsbDevice> findUsb(std::span<const UsbId> ids, const fs::path& root) {
    std::vector<UsbDevice> found;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(root / "sys/bus/usb/devices", error)) {
        const std::string vendor = wordIn(entry.path() / "idVendor");
        const std::string product = wordIn(entry.path() / "idProduct");
        const bool is_wanted = std::any_of(ids.begin(), ids.end(), [&](const UsbId& id) {
            return vendor == id.vendor && (*id.product == 0 || product == id.product);
        });
        if (!is_wanted) continue;
        std::string numbers = vendor;
        numbers.append(":").append(product);
        found.push_back(describe(fs::canonical(entry.path(), error), root, numbers));
    }
    return found;
}

std::string whyNoDevice(const std::vector<UsbDevice>& found, const std::string& what) {
    if (found.empty())
        return "device: no " + what + " is on USB of this PC. Plug it in and switch it on (lsusb lists it).";
    for (const UsbDevice& device : found) {
        if (device.forbidden.empty()) continue;
        std::vector<std::string> nodes;
        for (const fs::path& node : device.forbidden) nodes.push_back(node.string());
        return "permission: " + what + " " + device.id + " is on USB, and this user may not use " +
               joined(nodes) +
               ". Copy deploy/udev/60-bonemill.rules to /etc/udev/rules.d and plug it in again.";
    }
    return "device: " + what + " " + found.front().id +
           " is on USB and may be used, but its library does not see it. Does another program have it?";
}

}  // namespace bonemill::bridge
