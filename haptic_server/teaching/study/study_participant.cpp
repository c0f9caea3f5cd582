#include "haptic_server/teaching/study/study_participant.h"

#include <sys/random.h>

#include <cerrno>
#include <set>
#include <system_error>

#include "common/base/user_error.h"

namespace bonemill::study {
namespace {

constexpr size_t kMaxSessions = 10'000;

void requireUuid(const JsonObject& json, const std::string& key) {
    if (!isUuid(json.text(key))) json.refuse(key, "must be a session's UUID, as study next prints it");
}

constexpr double kMaxFigure = 1e15;

std::map<std::string, double> figuresIn(const JsonObject& json) {
    std::map<std::string, double> figures;
    for (const char* const key : kRunFigures)
        if (json.has(key)) figures[key] = json.number(key, -kMaxFigure, kMaxFigure);
    return figures;
}

}  // namespace

std::string toJson(const Participant& participant) {
    Json sessions = Json::array();
    for (const Session& session : participant.sessions)
        sessions.push_back({{"session", session.uuid},
                            {"period", session.period},
                            {"condition", session.condition},
                            {"task", session.task},
                            {"attempt", session.attempt}});
    Json json = {{"pseudonym", participant.pseudonym},
                 {"group", participant.group},
                 {"place", participant.place},
                 {"consent", participant.has_consent},
                 {"withdrawn", participant.has_withdrawn},
                 {"withdrawal_reason", participant.withdrawal_reason},
                 {"sessions", sessions}};
    return json.dump(1) + "\n";
}

Participant parseParticipant(const Json& parsed, const std::string& file) {
    const JsonObject json(parsed, file);
    json.allowOnly({"pseudonym", "group", "place", "consent", "withdrawn", "withdrawal_reason", "sessions"});
    Participant participant;
    participant.pseudonym = json.identifier("pseudonym");
    participant.group = json.identifier("group");
    participant.place = json.whole("place", 0, 1'000'000);
    participant.has_consent = json.flagOr("consent", false);
    participant.has_withdrawn = json.flagOr("withdrawn", false);
    participant.withdrawal_reason = json.textOr("withdrawal_reason", "");
    for (const JsonObject& entry : json.objects("sessions", 1, kMaxSessions)) {
        entry.allowOnly({"session", "period", "condition", "task", "attempt"});
        requireUuid(entry, "session");
        participant.sessions.push_back({entry.text("session"), entry.whole("period", 0, kMaxSessions),
                                        entry.text("condition"), entry.text("task"),
                                        entry.whole("attempt", 0, kMaxSessions)});
    }
    return participant;
}

bool isUuid(std::string_view text) {
    if (text.size() != 36) return false;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool is_hyphen = i == 8 || i == 13 || i == 18 || i == 23;
        const char c = text[i];
        if (is_hyphen ? c != '-' : !((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'))) return false;
    }
    return true;
}

std::string newUuid() {
    unsigned char bytes[16];
    if (getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
        throw std::system_error(errno, std::generic_category(), "getrandom");
    bytes[6] = (bytes[6] & 0x0f) | 0x40;
    bytes[8] = (bytes[8] & 0x3f) | 0x80;
    std::string text;
    for (size_t i = 0; i < sizeof bytes; ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
        text += "0123456789abcdef"[bytes[i] >> 4];
        text += "0123456789abcdef"[bytes[i] & 15];
    }
    return text;
}

std::string toJson(const Answers& answers) {
    Json values = Json::object();
    for (const auto& [item, answer] : answers.values) {
        if (const double* value = std::get_if<double>(&answer))
            values[item] = *value;
        else
            values[item] = std::get<std::string>(answer);
    }
    const Json json = {
        {"study", answers.study},      {"pseudonym", answers.pseudonym},     {"session", answers.session},
        {"form", answers.form},        {"form_sha256", answers.form_digest}, {"answers", values},
        {"left_out", answers.left_out}};
    return json.dump(1) + "\n";
}

std::string formOfAnswers(const Json& parsed, const std::string& file) {
    return JsonObject(parsed, file).identifier("form");
}

Answers parseAnswers(const Json& parsed, const std::string& file, const Form& form) {
    const JsonObject json(parsed, file);
    json.allowOnly({"study", "pseudonym", "session", "form", "form_sha256", "answers", "left_out"});
    Answers answers;
    answers.study = json.identifier("study");
    answers.pseudonym = json.identifier("pseudonym");
    requireUuid(json, "session");
    answers.session = json.text("session");
    answers.form = json.identifier("form");
    answers.form_digest = json.text("form_sha256");
    if (answers.form_digest != form.digest)
        json.refuse("form_sha256", "is of another text of the form \"" + form.id +
                                       "\" than this study has; put the form back as it was asked");
    const JsonObject given = json.object("answers");
    for (const auto& [id, value] : given.json().items()) {
        const Item* const item = form.find(id);
        if (!item)
            throw UserError(given.place() + ": answers a question that the form \"" + form.id + "\" has not");
        if (!value.is_number() && !value.is_string()) given.refuse(item->id, "must be a number or a text");
        const Answer answer =
            value.is_number() ? Answer(value.get<double>()) : Answer(value.get<std::string>());
        const std::string wrong = wrongWith(*item, answer);
        if (!wrong.empty()) given.refuse(item->id, wrong);
        answers.values.emplace(item->id, answer);
    }
    answers.left_out = json.identifiers("left_out", 10'000);
    std::set<std::string> seen;
    for (const std::string& id : answers.left_out)
        if (!form.find(id) || answers.values.contains(id) || !seen.insert(id).second)
            json.refuse("left_out", "has \"" + id + "\", which is no unanswered question of the form");
    return answers;
}

std::map<std::string, double> figuresOfReport(const std::filesystem::path& report) {
    const Json json = readJson(report);
    const std::map<std::string, double> figures = figuresIn(JsonObject(json, report.string()));
    if (figures.empty())
        throw UserError(report.string() + ": is no report that haptic_server wrote with --report");
    return figures;
}

std::string toJson(const RunRecord& run) {
    const Json json = {{"session", run.session},           {"scene", run.scene},
                       {"scene_sha256", run.scene_sha256}, {"programs", run.programs},
                       {"figures", run.figures},           {"recording", run.recording}};
    return json.dump(1) + "\n";
}

RunRecord parseRun(const Json& parsed, const std::string& file) {
    const JsonObject json(parsed, file);
    json.allowOnly({"session", "scene", "scene_sha256", "programs", "figures", "recording"});
    return {json.text("session"),
            json.text("scene"),
            json.text("scene_sha256"),
            json.text("programs"),
            figuresIn(json.object("figures")),
            json.text("recording")};
}

}  // namespace bonemill::study
