// A run writes its files at its end with this, each on its own: one that fails must not cost the others, nor
// the file of that name which was there before. One normal thread.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "common/files/whole_file.h"

namespace bonemill {

class FinalFiles {
  public:
    // Calls write_file(where) unless the path is empty, and notes what it throws; what it writes there gets
    // the path.
    template <class WriteFile>
    void write(const std::string& path, WriteFile&& write_file) {
        if (path.empty()) return;
        try {
            WholeFile file(path);
            write_file(file.part());
            file.finish();
        } catch (const std::exception& error) {
            note(error.what());
        }
    }
    // Something is missing in the files that was found elsewhere.
    void note(std::string problem) { problems_.push_back(std::move(problem)); }

    // One message for each file that is not there or not whole; none when all is well.
    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

}  // namespace bonemill
