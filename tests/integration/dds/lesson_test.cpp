// What can be taught, with the pictures of its scenes, which come by themselves and once.
#include <gtest/gtest.h>

#include "haptic_server/server/publish/publisher.h"
#include "tests/integration/dds/client_probe.h"

namespace bonemill {
namespace {

constexpr char kPng[] = "\x89PNG and so on";

topics::Lesson lessonOf(const std::string& trainee) {
    topics::Lesson lesson;
    for (const char* id : {"cavity", "corridor"}) lesson.add_scenes()->set_id(id);
    lesson.set_trainee(trainee);
    return lesson;
}

TEST(Lessons, PicturesComeOnceAndStayWhateverChanges) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    ASSERT_TRUE(publisher.publishStatus({}));
    ASSERT_TRUE(publisher.publishLesson(lessonOf("Ann")));
    ClientProbe client;
    const auto shows = [](ClientProbe& probe, const std::string& trainee, const std::string& picture) {
        return probe.pollUntil([&] {
            const auto& lesson = probe.subscriber.lesson();
            return lesson && lesson->trainee() == trainee && lesson->scenes(1).picture() == picture;
        });
    };
    EXPECT_TRUE(shows(client, "Ann", ""));
    ASSERT_TRUE(publisher.publishScenePicture(1, "corridor", kPng));
    EXPECT_TRUE(shows(client, "Ann", kPng));
    EXPECT_EQ(client.subscriber.lesson()->scenes(0).picture(), "");
    ASSERT_TRUE(publisher.publishLesson(lessonOf("Bob")));
    EXPECT_TRUE(shows(client, "Bob", kPng));
    ClientProbe late;
    EXPECT_TRUE(shows(late, "Bob", kPng));

    publisher.beginRun();
    ASSERT_TRUE(publisher.publishStatus({}));
    ASSERT_TRUE(publisher.publishLesson(lessonOf("Cid")));
    EXPECT_TRUE(shows(client, "Cid", "")) << "it is another run's";
    ASSERT_TRUE(publisher.publishScenePicture(1, "corridor", kPng));
    EXPECT_TRUE(shows(client, "Cid", kPng));
    EXPECT_EQ(client.subscriber.malformedSamples(), 0u);
}

}  // namespace
}  // namespace bonemill
