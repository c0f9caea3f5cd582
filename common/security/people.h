// Who belongs to a session: the server knows by this who commands it. It is for one thread, not the tick.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "common/security/certificate.h"

namespace bonemill {

class People {
  public:
    // Reads people.pem of the server's folder: the certificates of all that make-session has made. One that
    // the folder's identity authority has not issued does not count. Throws UserError.
    explicit People(const std::filesystem::path& folder);

    // Returns whose participant has such a GUID. The file is read again when it has changed since.
    std::optional<Identity> find(const GuidPrefix& prefix);

  private:
    void read();
    void readIfNewer();

    std::filesystem::path folder_;
    std::filesystem::file_time_type read_time_{};
    std::map<GuidPrefix, Identity> people_;
};

}  // namespace bonemill
