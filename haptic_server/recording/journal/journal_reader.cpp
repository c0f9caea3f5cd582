#include "haptic_server/recording/journal/journal_reader.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {
namespace {

// As hostile files could unpack to far more than they are.
constexpr uint64_t kMaxKept = uint64_t(4) << 30;

// Takes one message after the other into the content.
class Keeper {
  public:
    Keeper(const std::string& name, bool keeps_inputs, JournalContent& content)
        : name_(name), keeps_inputs_(keeps_inputs), content_(content) {}

    void take(JournalTopic topic, const mcap::Message& message) {
        if (!has_manifest_ && topic != JournalTopic::kManifest) fail("does not begin with what it is of");
        if (!takeMessage(topic, message)) fail("has a message that makes no sense");
    }
    bool hasManifest() const { return has_manifest_; }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError("journal " + name_ + " " + what + "; it is damaged, or no journal of bonemill");
    }

    // Empty parts take no bytes in the file, and some in memory.
    template <class Message>
    bool keep(const mcap::Message& bytes, Message& message) {
        if (!parse(bytes, message)) return false;
        kept_ += message.SpaceUsedLong();
        if (kept_ > kMaxKept) fail("holds more than can be kept in memory");
        return true;
    }
    template <class Message>
    bool add(const mcap::Message& bytes, std::vector<Message>& all) {
        return keep(bytes, all.emplace_back());
    }

    bool takeMessage(JournalTopic topic, const mcap::Message& message) {
        switch (topic) {
            case JournalTopic::kManifest:
                return takeManifest(message);
            case JournalTopic::kInputs:
                return takeInputs(message);
            case JournalTopic::kStateHash:
                return add(message, content_.hashes);
            case JournalTopic::kOrder:
                return add(message, content_.orders);
            case JournalTopic::kPutBack:
                return takePutBack(message);
            case JournalTopic::kEvent:
                return takeEvent(message);
            case JournalTopic::kTuned:
                return takeTuned(message);
            default:
                return true;
        }
    }

    bool takeManifest(const mcap::Message& message) {
        if (has_manifest_ || !keep(message, content_.manifest)) return false;
        if (content_.manifest.format() > kJournalFormat)
            throw UserError("journal " + name_ + " is of a newer bonemill (format " +
                            std::to_string(content_.manifest.format()) + "); update this one");
        const double rate = content_.manifest.rate_hz();
        return has_manifest_ = content_.manifest.format() > 0 && rate > 0 && rate < 1e6;
    }

    bool takeInputs(const mcap::Message& message) {
        journal::Inputs inputs;
        if (!(keeps_inputs_ ? keep(message, inputs) : parse(message, inputs)) || inputs.count() == 0 ||
            inputs.count() > kMaxTicksPerInputs)
            return false;
        if (inputs.first_tick() == content_.ticks) content_.ticks += inputs.count();
        if (keeps_inputs_) content_.inputs.push_back(std::move(inputs));
        return true;
    }

    bool takePutBack(const mcap::Message& message) {
        journal::PutBack put_back;
        if (!keep(message, put_back)) return false;
        content_.put_backs[put_back.bone_order()] = put_back.checkpoint();
        return true;
    }

    bool takeTuned(const mcap::Message& message) {
        journal::Tuned tuned;
        if (!keep(message, tuned)) return false;
        content_.tunings[tuned.number()] = tuned.values();
        return true;
    }

    bool takeEvent(const mcap::Message& message) {
        if (!add(message, content_.events)) return false;
        const journal::Event& event = content_.events.back();
        if (event.has_incomplete() && content_.incomplete.empty()) {
            content_.incomplete = event.incomplete().why();
            content_.incomplete_from = event.tick();
        }
        content_.has_ended |= event.has_end();
        return true;
    }

    const std::string& name_;
    bool keeps_inputs_;
    JournalContent& content_;
    bool has_manifest_ = false;
    uint64_t kept_ = 0;
};

// Nothing of another make may pass for a journal. Other programs that write one anew give other numbers to
// its channels.
std::optional<JournalTopic> topicOf(const mcap::Channel& channel) {
    const auto topic = std::ranges::find(kJournalTopics, channel.topic, &JournalTopicName::name);
    if (topic == std::end(kJournalTopics) || channel.encoding != "protobuf") return std::nullopt;
    return topic->topic;
}

}  // namespace

mcap::Reading readJournal(const std::filesystem::path& path, const JournalVisit& visit) {
    requireFile(path);
    std::ifstream input(path, std::ios::binary);
    if (!input) throw UserError(path.string() + ": cannot be opened");
    bool is_journal = false;
    mcap::Reading reading =
        mcap::read(input, [&](const mcap::Channel& channel, const mcap::Message& message) {
            const std::optional<JournalTopic> topic = topicOf(channel);
            if (!topic) return;
            is_journal |= topic == JournalTopic::kManifest;
            visit(*topic, message);
        });
    // Other programs leave the profile out.
    is_journal =
        reading.profile == kJournalProfile || (is_journal && reading.is_foreign && reading.profile.empty());
    if (!is_journal)
        throw UserError(path.string() + ": is no journal of a session" +
                        (reading.index.size() == 0 ? " (" + reading.problem + ")" : ""));
    return reading;
}

JournalContent readJournalContent(const std::filesystem::path& path, KeepInputs keep,
                                  const JournalVisit& visit_also) {
    JournalContent content;
    const std::string name = path.string();
    Keeper keeper(name, keep == KeepInputs::kYes, content);
    const mcap::Reading reading = readJournal(path, [&](JournalTopic topic, const mcap::Message& message) {
        keeper.take(topic, message);
        if (visit_also) visit_also(topic, message);
    });
    if (!keeper.hasManifest())
        throw UserError("journal " + name + " holds nothing: its session was stopped as it began");
    content.problem = reading.problem;
    content.lost_bytes = reading.lost_bytes;
    return content;
}

}  // namespace bonemill
