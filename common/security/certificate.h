// A certificate as deploy/security/make-session issues it: whose it is, for which role, and for how long. It
// is not for the tick.
#pragma once

#include <array>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct x509_st;  // OpenSSL's X509

namespace bonemill {

// A participant's GUID begins with this if DDS Security has checked who it is: it is made of the
// certificate's subject, and no client can take another one's.
using GuidPrefix = std::array<uint8_t, 6>;

struct Identity {
    std::string name;
    std::string role;  // server, device, operator, instructor, observer, examiner or gateway
    GuidPrefix prefix{};
    std::optional<uint32_t> session;  // that it was made for; nothing: make-session has not made it
};

class Certificate {
  public:
    // Reads all that the file holds, in their order. Throws UserError when it cannot be read, or holds none.
    static std::vector<Certificate> readAll(const std::filesystem::path& file);
    static Certificate read(const std::filesystem::path& file) { return readAll(file).front(); }

    const Identity& identity() const noexcept { return identity_; }
    // For people and for permissions: "CN=Anna,OU=operator,O=bonemill-session-1".
    std::string subject() const;
    bool isIssuedBy(const Certificate& authority) const;
    // Unix times, s.
    std::time_t validFrom() const;
    std::time_t validUntil() const;
    // Throws UserError if it, one of a session, was not yet, or is no longer, valid at that unix time.
    void requireValidAt(std::time_t now) const;
    // Returns whether the file holds the private key that belongs to this. Throws UserError if it holds no
    // key.
    bool hasKey(const std::filesystem::path& file) const;

    const x509_st* get() const noexcept { return x509_.get(); }

  private:
    explicit Certificate(x509_st* owned);

    std::shared_ptr<x509_st> x509_;
    Identity identity_;
};

// Returns "2026-09-01 12:00 UTC".
std::string dayText(std::time_t time);

inline constexpr char kMakeNewSession[] = "make a new session (deploy/security/make-session)";

// Throws UserError unless `now` lies between both; `what` begins the message, as "the certificate of Anna",
// and behind the end `remedy` says what to do.
void requireBetween(std::time_t now, std::time_t first, std::time_t last, const std::string& what,
                    const std::string& remedy = kMakeNewSession);

}  // namespace bonemill
