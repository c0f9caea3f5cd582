#include "haptic_server/cases/casework/case_figures.h"

#include <fstream>
#include <string_view>

#include "common/base/user_error.h"
#include "haptic_server/cases/casework/histogram_figure.h"
#include "haptic_server/cases/casework/pieces_figure.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

void writeFigureFile(const fs::path& file, std::string_view bytes) {
    std::ofstream out(file, std::ios::binary);
    if (!out.write(bytes.data(), std::streamsize(bytes.size())).flush())
        throw UserError(file.string() + ": cannot be written; is the disk full?");
}

}  // namespace

void writeFigures(const fs::path& folder, const RawVolume& scan, const CasePlan& plan) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw UserError(folder.string() + ": cannot be made (" + error.message() + ")");
    writeFigureFile(folder / "histogram.gp", histogramScript(scan, plan));
    const PiecesFigure figure = piecesFigure(scan, plan);
    writeFigureFile(folder / "pieces.gp", figure.script);
    for (const PiecesFigure::Picture& picture : figure.pictures)
        writeFigureFile(folder / picture.file,
                        {reinterpret_cast<const char*>(picture.rgb.data()), picture.rgb.size()});
}

}  // namespace bonemill
