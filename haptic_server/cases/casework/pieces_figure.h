// The pieces of bone seen from the top, the front and the left, each in its colour with the number that
// --drop-piece takes. The views lie as in a drawing, so that a place can be read off in W.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptic_server/cases/casework/case_plan.h"

namespace bonemill {

struct PiecesFigure {
    struct Picture {
        std::string file;
        std::vector<uint8_t> rgb;  // rows from the bottom up
    };
    std::string script;  // for gnuplot; writes pieces.png where it runs, beside the pictures
    std::vector<Picture> pictures;
};

// Noise is not drawn, and what is dropped is pale. Start-up only.
PiecesFigure piecesFigure(const RawVolume& scan, const CasePlan& plan);

}  // namespace bonemill
