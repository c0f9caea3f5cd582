// Guests see what the server shows, and the server hears them as the guest list knows them.
#include "common/base/user_error.h"
#include "haptic_server/teaching/lessons/remark_list.h"
#include "tests/integration/gateway/gateway_guest.h"

namespace bonemill::gateway {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

TEST(Gateway, ShowsAGuestTheWholeModelAndWhatChanges) {
    TestServer server(60);
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken));
    TestGuest guest(gateway, kToken, true);
    ASSERT_TRUE(guest.isWelcome());
    EXPECT_EQ(guest.welcome->name(), "Anna");
    EXPECT_EQ(guest.welcome->role(), topics::Viewer::OPERATOR);
    EXPECT_NE(guest.welcome->sender(), 0u);
    ASSERT_TRUE(guest.pollUntil([&] { return guest.isComplete() && guest.digest().count() == 60; }));
    EXPECT_EQ(guest.digest(), server.publisher.digest());
    EXPECT_TRUE(guest.has_server);
    EXPECT_EQ(guest.samples[Sample::SCENE_INFO], 1);

    const int before = guest.samples[Sample::NODE_MESH];
    server.show({syntheticNode(3, 2), syntheticNode(4, 2), emptyNode(5, 2)});
    const NodeDigest digest = server.publisher.digest();
    ASSERT_TRUE(guest.pollUntil([&] { return guest.digest() == digest; }));
    EXPECT_EQ(guest.samples[Sample::NODE_MESH], before + 3) << "only what has changed";

    server.publisher.publishToolState(syntheticTick(7));
    ASSERT_TRUE(guest.pollUntil([&] {
        server.publisher.publishToolState(syntheticTick(7));
        return guest.tool.tick() == 7;
    }));
}

TEST(Gateway, PicturesOfScenesComeOnceAndToLateGuests) {
    TestServer server(1);
    topics::Lesson lesson;
    lesson.add_scenes()->set_id("cavity");
    ASSERT_TRUE(server.publisher.publishLesson(lesson));
    ASSERT_TRUE(server.publisher.publishScenePicture(0, "cavity", "a picture"));
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", kToken));
    TestGuest guest(gateway, kToken, true);
    ASSERT_TRUE(guest.pollUntil([&] { return guest.samples[Sample::SCENE_PICTURE] == 1; }));
    EXPECT_EQ(guest.samples[Sample::LESSON], 1) << "it comes first";
    lesson.set_trainee("Ann");
    ASSERT_TRUE(server.publisher.publishLesson(lesson));
    ASSERT_TRUE(guest.pollUntil([&] { return guest.samples[Sample::LESSON] == 2; }));
    EXPECT_EQ(guest.samples[Sample::SCENE_PICTURE], 1);
}

TEST(Gateway, ANewRunOfTheServerReplacesTheModel) {
    TestServer server(20);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", kToken));
    TestGuest guest(gateway, kToken, true);
    ASSERT_TRUE(guest.pollUntil([&] { return guest.isComplete(); }));
    server.publisher.beginRun();
    server.show({syntheticNode(1, 1), syntheticNode(100, 1)});
    const NodeDigest digest = server.publisher.digest();
    ASSERT_TRUE(guest.pollUntil([&] { return guest.digest() == digest; }));
}

TEST(Gateway, PassesOnNotesAndStrokesAlsoToWhoComesLater) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken, 0, 2));
    TestGuest anna(gateway, kToken, true);
    ASSERT_TRUE(anna.isWelcome());
    FromGuest order;
    order.mutable_command()->set_sequence(1);
    order.mutable_command()->mutable_add_remark()->set_note("mind the nerve");
    std::vector<topics::Command> heard;
    ASSERT_TRUE(anna.sendUntil(order, [&] {
        heard = server.publisher.takeCommands();
        return !heard.empty();
    }));
    RemarkList book(VolumeGeometry{});
    ASSERT_EQ(book.add(heard[0], 12.5).outcome, topics::DONE);
    server.publisher.publishRemark(5, *book.takeChanges().at(0).remark);
    topics::Remark broken;
    broken.set_number(2);
    server.publisher.publishRemark(6, broken);
    ASSERT_TRUE(anna.pollUntil([&] { return anna.remarks.contains(5); }));
    topics::Remark shown;
    ASSERT_TRUE(shown.ParseFromString(anna.remarks[5]));
    EXPECT_EQ(shown.note(), "mind the nerve");
    EXPECT_EQ(shown.author(), "Anna 1");
    EXPECT_EQ(shown.role(), topics::Viewer::OPERATOR);
    EXPECT_EQ(shown.epoch(), server.publisher.epoch());

    TestGuest late(gateway, kToken, true);
    ASSERT_TRUE(late.pollUntil([&] { return late.remarks.contains(5); }));
    EXPECT_EQ(late.remarks, anna.remarks) << "nothing of what makes no sense";
    server.publisher.removeRemark(5);
    EXPECT_TRUE(late.pollUntil([&] { return late.remarks.empty(); }));
    EXPECT_TRUE(anna.pollUntil([&] { return anna.remarks.empty(); }));
}

TEST(Gateway, ALinkIsGoodForOnePersonWhoMayComeAgainWithTheTicket) {
    TestServer server(20);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", kToken));
    auto first = std::make_unique<TestGuest>(gateway, kToken, true);
    ASSERT_TRUE(first->pollUntil([&] { return first->isComplete(); }));
    const std::string ticket = first->welcome->ticket();
    EXPECT_EQ(ticket.size(), 32u);

    TestGuest thief(gateway, kToken, true);
    ASSERT_TRUE(thief.isRefused());
    EXPECT_NE(thief.refusal->reason().find("already used"), std::string::npos);
    EXPECT_TRUE(thief.refusal->is_final());
    EXPECT_TRUE(thief.nodes.empty());

    TestGuest again(gateway);
    again.epoch = first->epoch;
    again.nodes = first->nodes;
    again.nodes.erase(3);          // it lacks this one,
    again.nodes[4].revision = 99;  // has another state of this one,
    again.nodes[1000] = {1, 1};    // and one that is gone
    again.hello(ticket);
    ASSERT_TRUE(again.pollUntil([&] { return again.isComplete(); }));
    EXPECT_EQ(again.samples[Sample::NODE_MESH], 3);
    EXPECT_TRUE(first->pollUntil([&] { return first->refusal && first->socket.hasEnded(); }))
        << "one window per seat";
    const std::string kept = gateway.filesContent();
    EXPECT_EQ(kept.find(ticket), std::string::npos) << "nothing but hashes is kept";
    EXPECT_EQ(kept.find(kToken), std::string::npos);
}

TEST(Gateway, WhoIsWithdrawnIsSentAwayAndWhoIsNotInvitedStaysOutside) {
    TestServer server(3);
    RunningGateway gateway(invitationOf("Anna", "VIEWER", kToken) +
                           invitationOf("Late", "VIEWER", "late", 1000));
    TestGuest guest(gateway, kToken, true), stranger(gateway, "a wrong token", true),
        late(gateway, "late", true);
    ASSERT_TRUE(guest.isWelcome());
    late.poll();
    ASSERT_TRUE(stranger.isRefused());
    EXPECT_TRUE(stranger.nodes.empty() && !stranger.status);
    ASSERT_TRUE(late.isRefused());
    EXPECT_NE(late.refusal->reason().find("expired"), std::string::npos);
    gateway.invite("");
    EXPECT_TRUE(guest.pollUntil([&] { return guest.refusal && guest.socket.hasEnded(); }));
}

TEST(Gateway, WhoseRoleWasChangedComesInAgainWithTheNewOne) {
    TestServer server(3);
    RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken));
    TestGuest before(gateway, kToken, true);
    ASSERT_TRUE(before.isWelcome());
    gateway.invite(invitationOf("Anna", "VIEWER", kToken));
    EXPECT_TRUE(before.pollUntil([&] { return before.refusal && before.socket.hasEnded(); }));
    EXPECT_FALSE(before.refusal->is_final()) << "the ticket opens the seat";
    TestGuest after(gateway, before.welcome->ticket(), true);
    ASSERT_TRUE(after.isWelcome());
    EXPECT_EQ(after.welcome->role(), topics::Viewer::VIEWER);
    FromGuest command;
    command.mutable_command()->set_sequence(1);
    command.mutable_command()->set_reset_volume(true);
    EXPECT_TRUE(after.sendUntil(command, [&] { return !after.answer.empty(); }));
    EXPECT_NE(after.answer.find("a viewer only looks"), std::string::npos) << after.answer;
}

TEST(Gateway, SpeaksForItsGuestsAsTheListKnowsThem) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken) +
                                 invitationOf("Observer", "VIEWER", "observer"));
    TestGuest anna(gateway, kToken, true), observer(gateway, "observer", true);
    ASSERT_TRUE(anna.isWelcome() && observer.isWelcome());
    FromGuest command;
    command.mutable_command()->set_sequence(1);
    command.mutable_command()->set_reset_volume(true);
    command.mutable_command()->set_role(topics::Viewer::INSTRUCTOR);  // which she is not
    command.mutable_command()->set_name("Somebody");
    std::vector<topics::Command> heard;
    ASSERT_TRUE(anna.sendUntil(command, [&] {
        heard = server.publisher.takeCommands();
        return !heard.empty();
    }));
    EXPECT_EQ(heard[0].sender(), anna.welcome->sender());
    EXPECT_EQ(heard[0].role(), topics::Viewer::OPERATOR);
    EXPECT_EQ(heard[0].name(), "Anna");
    server.publisher.acknowledge(heard[0], Answer::done());
    EXPECT_TRUE(anna.pollUntil([&] { return anna.answer == "done"; }));

    observer.send(command);
    EXPECT_TRUE(observer.pollUntil([&] { return observer.answer.starts_with("refused"); }));
    EXPECT_TRUE(server.publisher.takeCommands().empty());

    FromGuest announce;
    announce.mutable_announce()->set_name("Nobody");
    announce.mutable_announce()->set_role(topics::Viewer::INSTRUCTOR);
    announce.mutable_announce()->add_pointer_m(0);
    announce.mutable_announce()->add_pointer_m(0);
    announce.mutable_announce()->add_pointer_m(0);
    const uint64_t sender = observer.welcome->sender();
    ASSERT_TRUE(observer.sendUntil(announce, [&] {
        anna.poll(std::chrono::milliseconds(0));
        return anna.viewers.contains(sender);
    }));
    topics::Viewer shown;
    ASSERT_TRUE(shown.ParseFromString(anna.viewers[sender]));
    EXPECT_EQ(shown.name(), "Observer");
    EXPECT_EQ(shown.role(), topics::Viewer::VIEWER);
    EXPECT_EQ(shown.link(), "browser");
    EXPECT_TRUE(shown.pointer_m().empty());
}

TEST(Gateway, AHandThatLeavesLetsTheToolGo) {
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken) +
                                 invitationOf("Observer", "VIEWER", "observer"));
    const dds::Participant participant(testDomain());
    dds::Reader<dds::HandPointerSample> reader(participant);
    std::map<uint64_t, topics::HandPointer> hands;
    const auto hear = [&] {
        reader.take(100, [&](const dds::HandPointerSample& sample, const dds::SampleInfo& info) {
            const auto payload = dds::payloadOf(sample);
            if (!info.has_data || sample.session != testSession()) return;
            ASSERT_TRUE(hands[sample.sender].ParseFromArray(payload.data(), int(payload.size())));
        });
    };
    auto anna = std::make_unique<TestGuest>(gateway, kToken, true);
    TestGuest observer(gateway, "observer", true);
    ASSERT_TRUE(anna->isWelcome() && observer.isWelcome());
    FromGuest frame;
    topics::HandPointer& hand = *frame.mutable_hand();
    hand.set_sender(observer.welcome->sender());  // which she is not
    hand.set_sequence(1);
    hand.set_is_holding(true);
    for (const double value : {0.1, 0.2, 0.3}) hand.add_p_wt_m(value);
    for (const double value : {1.0, 0.0, 0.0, 0.0}) hand.add_q_wt(value);
    const uint64_t sender = anna->welcome->sender();
    observer.send(frame);
    ASSERT_TRUE(anna->sendUntil(frame, [&] {
        observer.poll(std::chrono::milliseconds(0));
        hear();
        return hands.contains(sender);
    }));
    EXPECT_TRUE(hands[sender].is_holding());
    EXPECT_EQ(hands[sender].sender(), sender);
    EXPECT_EQ(hands[sender].role(), topics::Viewer::OPERATOR);
    anna.reset();  // its connection is cut
    ASSERT_TRUE(observer.pollUntil([&] {
        hear();
        return !hands[sender].is_holding();
    }));
    EXPECT_EQ(hands.size(), 1u) << "an observer holds nothing";
}

void put(const GatewayCertificate& what, const GatewayCertificate& where) {
    const auto over = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(what.certificate, where.certificate, over);
    std::filesystem::copy_file(what.key, where.key, over);
}

bool shows(const RunningGateway& gateway, const GatewayCertificate& certificate) {
    try {
        const TestGuest guest({"127.0.0.1", gateway.port(), certificate.fingerprint});
        return true;
    } catch (const UserError&) {
        return false;
    }
}

TEST(Gateway, ShowsARenewedCertificateAndKeepsItsGuests) {
    TestServer server(1);
    const test::TemporaryFolder folder;
    const GatewayCertificate old = selfMadeCertificate(folder.path() / "old"),
                             renewed = selfMadeCertificate(folder.path() / "renewed"),
                             used{folder / "certificate.pem", folder / "key.pem", "", false};
    put(old, used);
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", kToken), 1000, used);
    TestGuest anna({"127.0.0.1", gateway.port(), old.fingerprint}, kToken, true);
    ASSERT_TRUE(anna.isWelcome());

    put({renewed.certificate, old.key, "", false}, used);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
    anna.pollUntil([&] { return std::chrono::steady_clock::now() > end; });
    EXPECT_TRUE(shows(gateway, old)) << "a certificate without its key";

    put(renewed, used);
    EXPECT_TRUE(anna.pollUntil([&] { return shows(gateway, renewed); }, std::chrono::seconds(10)));
    server.publisher.publishToolState(syntheticTick(7));
    EXPECT_TRUE(anna.pollUntil([&] {
        server.publisher.publishToolState(syntheticTick(7));
        return anna.tool.tick() == 7;
    }));
}

TEST(Gateway, ThatHearsNothingJoinsAnewAndKeepsItsGuests) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "guests", invitationOf("Anna", "OPERATOR", kToken));
    GatewayOptions options;
    options.domain = testDomain();
    options.session = testSession();
    options.guests = folder / "guests";
    options.rejoin_after = std::chrono::milliseconds(100);
    Gateway gateway(options);
    Guest* const anna = gateway.come({"192.0.2.1"}, Gateway::Clock::now());
    FromGuest hello, command;
    hello.mutable_hello()->set_token(kToken);
    hello.mutable_hello()->set_version(kProtocolVersion);
    gateway.receive(*anna, hello.SerializeAsString(), Gateway::Clock::now());
    ASSERT_TRUE(anna->isAdmitted());
    const auto stepUntil = [&](const std::function<bool()>& condition) {
        return test::waitFor([&] {
            gateway.step(Gateway::Clock::now());
            return condition();
        });
    };
    ASSERT_TRUE(stepUntil([&] { return gateway.rejoinings() >= 2; })) << "no server is there";

    TestServer server(20);
    ASSERT_TRUE(stepUntil([&] {
        server.tellStatus();
        return gateway.mirror().isComplete();
    }));
    const uint64_t rejoinings = gateway.rejoinings();
    command.mutable_command()->set_sequence(1);
    command.mutable_command()->set_reset_volume(true);
    EXPECT_TRUE(stepUntil([&] {
        server.tellStatus();
        gateway.receive(*anna, command.SerializeAsString(), Gateway::Clock::now());
        return !server.publisher.takeCommands().empty();
    })) << "she is heard, too";
    EXPECT_EQ(gateway.rejoinings(), rejoinings) << "a server is heard";
    EXPECT_TRUE(anna->isAdmitted());
}

}  // namespace
}  // namespace bonemill::gateway
