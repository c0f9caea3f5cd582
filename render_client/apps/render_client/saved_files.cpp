#include "render_client/apps/render_client/saved_files.h"

#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>

#include "common/attempts_csv/attempts_csv.h"
#include "common/base/user_error.h"
#include "common/files/whole_file.h"
#include "render_client/hand/controls/picture_name.h"
#include "render_client/language/language.h"
#include "render_client/look/offscreen/osmesa_context.h"

namespace bonemill {

std::filesystem::path nextName(const char* format) {
    for (int number = 1;; ++number) {
        char name[64];
        std::snprintf(name, sizeof name, format, number);
        if (!std::filesystem::exists(name)) return name;
    }
}

HudNotice savePicture(const GlApi& gl, int width, int height, const std::string& class_folder,
                      const std::string& scene) {
    try {
        std::filesystem::path folder = std::filesystem::current_path();
        if (!class_folder.empty()) folder = std::filesystem::path(class_folder) / "pictures";
        std::filesystem::create_directories(folder);
        const std::filesystem::path name = pictureName(folder, scene, std::time(nullptr));
        writePng(readPicture(gl, width, height), name);
        return {tr("Picture saved: {1}", {name.string()}), HudTone::kGood};
    } catch (const std::exception& error) {
        return {error.what(), HudTone::kWarning};
    }
}

std::optional<HudNotice> changeLanguage(const std::string& code) {
    try {
        if (!code.empty()) chooseLanguage(code);
        return std::nullopt;
    } catch (const UserError& error) {
        return HudNotice{error.what(), HudTone::kWarning};
    }
}

HudNotice saveAttempts(const topics::Lesson& lesson) {
    try {
        WholeFile file(nextName("bonemill_attempts_%04d.csv"));
        std::ofstream stream(file.part(), std::ios::binary);
        stream << attemptsCsv(lesson);
        stream.close();
        if (!stream) throw UserError("cannot write " + file.path().string() + "; is the disk full?");
        file.finish();
        return {tr("Attempts saved: {1}", {std::filesystem::absolute(file.path()).string()}), HudTone::kGood};
    } catch (const std::exception& error) {
        return {error.what(), HudTone::kWarning};
    }
}

}  // namespace bonemill
