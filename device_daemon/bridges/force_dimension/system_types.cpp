#include "device_daemon/bridges/force_dimension/system_types.h"

#include <algorithm>
#include <iterator>

namespace bonemill::bridge {
namespace {

constexpr SystemType kTypes[] = {
    {63, "delta.3", 20, 0, 5000, 0.150},         {33, "omega.3", 12, 0, 5000, 0.075},
    {34, "omega.6", 12, 0, 5000, 0.075},         {36, "omega.6 left", 12, 0, 5000, 0.075},
    {35, "omega.7", 12, 0, 5000, 0.075},         {37, "omega.7 left", 12, 0, 5000, 0.075},
    {206, "sigma.3", 12, 0, 4000, 0.075},        {104, "sigma.7", 12, 0.2, 4000, 0.075},
    {105, "sigma.7 left", 12, 0.2, 4000, 0.075}, {203, "lambda.3", 12, 0, 8000, 0.112},
    {131, "lambda.6", 12, 0, 8000, 0.112},       {132, "lambda.6 left", 12, 0, 8000, 0.112},
    {108, "lambda.7", 12, 0.2, 8000, 0.112},     {109, "lambda.7 left", 12, 0.2, 8000, 0.112},
    {60, "Falcon", 8, 0, 3000, 0.040},
};

}  // namespace

SystemType systemTypeOf(int type) noexcept {
    const auto found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                    [type](const SystemType& known) { return known.type == type; });
    if (found != std::end(kTypes)) return *found;
    return {type, "Force Dimension arm of unknown type", 8, 0, 3000, 0.040};
}

}  // namespace bonemill::bridge
