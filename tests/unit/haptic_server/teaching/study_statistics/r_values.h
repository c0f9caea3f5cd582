// The numbers that tests/support/study_r_values.R wrote with R, by their names.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/places.h"

namespace bonemill::test {

inline const std::vector<double>& rValues(const std::string& name) {
    static const auto all = [] {
        std::map<std::string, std::vector<double>> values;
        std::ifstream file(sourceDir() + "/tests/unit/haptic_server/teaching/study_statistics/r_values.txt");
        for (std::string line; std::getline(file, line);) {
            std::istringstream words(line);
            std::string key;
            words >> key;
            for (double value; words >> value;) values[key].push_back(value);
        }
        return values;
    }();
    if (!all.contains(name)) throw std::runtime_error("r_values.txt has no " + name);
    return all.at(name);
}

}  // namespace bonemill::test
