#include "render_client/start_window/start_desk/launcher_facts.h"

#include <sstream>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/text/foreign_text.h"

namespace bonemill {
namespace {

using Fields = std::vector<std::string>;

std::vector<Fields> fieldsOf(const std::string& lines) {
    std::vector<Fields> table;
    std::istringstream stream(lines);
    for (std::string line; std::getline(stream, line);) {
        Fields& fields = table.emplace_back();
        size_t begin = 0;
        for (size_t tab; (tab = line.find('\t', begin)) != std::string::npos; begin = tab + 1)
            fields.push_back(line.substr(begin, tab - begin));
        fields.push_back(line.substr(begin));
    }
    return table;
}

std::vector<std::string> wordsIn(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

SceneCard cardOf(const Fields& fields) {
    SceneCard card{.is_own = fields[0] == "case",
                   .name = fields[1],
                   .file = fields[2],
                   .picture = fields[3],
                   .made_first = wordsIn(fields[4]),
                   .lacks = fields[5],
                   .title = fields[1],
                   .task = {},
                   .problem = {}};
    try {
        const scene::Scene scene = loadScene(card.file).scene;
        card.title = printableLine(titleOf(scene));
        card.task = printableLine(scene.task(), 1000);
        card.expected_minutes = scene.expected_minutes();
    } catch (const UserError& error) {
        card.problem = error.what();
    }
    return card;
}

// "bonemill start --device gamepad:/dev/input/event3" -> what stands behind --device; empty: nothing does.
std::string deviceWordOf(const std::string& command) {
    constexpr char kOption[] = " --device ";
    const size_t at = command.find(kOption);
    return at == std::string::npos ? "" : command.substr(at + sizeof kOption - 1);
}

FoundHand handOf(const Fields& fields) {
    FoundHand hand{
        .kind = fields[1], .is_ready = fields[2] == "ready", .text = fields[3], .word = {}, .command = {}};
    if (fields.size() < 5) return hand;
    if (hand.is_ready)
        hand.word = deviceWordOf(fields[4]);
    else
        hand.command = fields[4];
    return hand;
}

}  // namespace

ListFacts listFactsOf(const std::string& lines) {
    ListFacts facts;
    for (const Fields& fields : fieldsOf(lines)) {
        const std::string& kind = fields[0];
        const size_t count = fields.size();
        if ((kind == "scene" || kind == "case") && count == 6) facts.scenes.push_back(cardOf(fields));
        if (kind == "session" && count == 5)
            facts.running.push_back({fields[1], fields[2], fields[3], fields[4]});
        if (kind == "recording" && count == 4) facts.recordings.push_back({fields[1], fields[2]});
        if (kind == "interface" && count == 2) facts.interfaces.push_back(fields[1]);
    }
    return facts;
}

std::vector<FoundSession> foundSessionsOf(const std::string& lines) {
    std::vector<FoundSession> sessions;
    for (const Fields& fields : fieldsOf(lines))
        if (fields.size() == 6)
            sessions.push_back({fields[0], printableLine(fields[1]), fields[2], printableLine(fields[3]),
                                fields[4], fields[5]});
    return sessions;
}

DoctorFacts doctorFactsOf(const std::string& lines) {
    DoctorFacts facts;
    for (const Fields& fields : fieldsOf(lines)) {
        if (fields[0] == "hand" && fields.size() >= 4) {
            facts.hands.push_back(handOf(fields));
        } else if (fields[0] != "hand" && fields.size() >= 3) {
            facts.findings.push_back({.part = fields[0],
                                      .is_ok = fields[1] == "ok",
                                      .is_needed = fields[1] == "MISSING",
                                      .text = fields[2],
                                      .commands = {fields.begin() + 3, fields.end()}});
        }
    }
    return facts;
}

}  // namespace bonemill
