// What a study keeps of a person: a pseudonym, a group, that there is consent, and sessions with their
// answers and runs. No name, no time of day. Who is who stands outside of the study's folder. For one thread;
// pure, but for the reports that are read.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/teaching/study/form.h"
#include "haptic_server/teaching/study/protocol.h"

namespace bonemill::study {

// Period 0 is the visit itself, to which the forms before and after everything belong; then one per planned
// session.
struct Session {
    std::string uuid;
    size_t period = 0;
    std::string condition, task;
    size_t attempt = 0;
};

struct Participant {
    std::string pseudonym, group;
    size_t place = 0;  // in the group, from 0: the order follows from it
    bool has_consent = false;
    bool has_withdrawn = false;
    std::string withdrawal_reason;
    std::vector<Session> sessions;

    const Session* find(const std::string& uuid) const {
        for (const Session& session : sessions)
            if (session.uuid == uuid) return &session;
        return nullptr;
    }
};

std::string toJson(const Participant& participant);
// Throws UserError.
Participant parseParticipant(const Json& json, const std::string& file);

bool isUuid(std::string_view text);
// A random one (RFC 9562, version 4) from the kernel.
std::string newUuid();

// The answers of one person in one session to one form. It is the file that a page saves, too.
struct Answers {
    std::string study, pseudonym, session, form, form_digest;
    Values values;
    std::vector<std::string> left_out;  // asked, and no answer wished

    bool isAnswered(const std::string& item) const {
        return values.contains(item) || std::find(left_out.begin(), left_out.end(), item) != left_out.end();
    }
    bool isFinished(const Form& to) const {
        const std::vector<const Item*> items = to.items();
        return std::all_of(items.begin(), items.end(),
                           [&](const Item* item) { return isAnswered(item->id); });
    }
};

std::string toJson(const Answers& answers);
// Every answer is checked against the form. Throws UserError.
Answers parseAnswers(const Json& json, const std::string& file, const Form& form);
// Which form these answers say that they are to.
std::string formOfAnswers(const Json& json, const std::string& file);

// What the study keeps of a run on the simulator: enough to say what was used, and no more.
struct RunRecord {
    std::string session, scene, scene_sha256, programs;
    std::map<std::string, double> figures;  // those of the server's report that kRunFigures names
    std::string recording;                  // the journal's or trace's file name, as told
};

// Taken from a report of haptic_server, when it has them.
inline constexpr const char* kRunFigures[] = {
    "duration_s",    "nominal_rate_hz", "mean_rate_hz", "slowest_second_hz",
    "dropped_ticks", "force_max_n",     "removed_mm3",  "ticks"};

// Reads the report that haptic_server wrote with --report. Throws UserError.
std::map<std::string, double> figuresOfReport(const std::filesystem::path& report);

std::string toJson(const RunRecord& run);
RunRecord parseRun(const Json& json, const std::string& file);

}  // namespace bonemill::study
