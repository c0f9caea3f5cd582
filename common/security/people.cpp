#include "common/security/people.h"

#include <spdlog/spdlog.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr char kPeopleFile[] = "people.pem";

}  // namespace

People::People(const std::filesystem::path& folder) : folder_(folder) {
    read();
}

std::optional<Identity> People::find(const GuidPrefix& prefix) {
    readIfNewer();
    const auto found = people_.find(prefix);
    return found == people_.end() ? std::nullopt : std::optional(found->second);
}

// What cannot be read changes nothing.
void People::readIfNewer() {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(folder_ / kPeopleFile, error);
    if (error || time == read_time_) return;
    try {
        read();
    } catch (const UserError& problem) {
        spdlog::warn("{}; those who were known stay", problem.what());
        read_time_ = time;
    }
}

void People::read() {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(folder_ / kPeopleFile, error);
    if (error)
        throw UserError("--secure " + folder_.string() + ": " + kPeopleFile +
                        " is missing: this is no server's folder (make-session --server)");
    const Certificate authority = Certificate::read(folder_ / "identity_ca.pem");
    std::map<GuidPrefix, Identity> people;
    for (const Certificate& certificate : Certificate::readAll(folder_ / kPeopleFile))
        if (certificate.isIssuedBy(authority))
            people.emplace(certificate.identity().prefix, certificate.identity());
    people_ = std::move(people);
    read_time_ = time;
}

}  // namespace bonemill
