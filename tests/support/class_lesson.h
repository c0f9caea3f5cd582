// A lesson with three scenes, one of which cannot be chosen, and two attempts.
#pragma once

#include "proto/topics.pb.h"

namespace bonemill::test {

inline topics::Lesson makeLesson() {
    topics::Lesson lesson;
    lesson.set_epoch(7);
    const auto add = [&](const char* id, const char* title, const char* task) {
        topics::SceneChoice& scene = *lesson.add_scenes();
        scene.set_id(id);
        scene.set_title(title);
        scene.set_task(task);
        scene.add_tools("round burr 3 mm");
        scene.add_tools("round burr 1.5 mm");
        scene.set_expected_s(290);
        return &scene;
    };
    add("cavity", "Cavity in a molar", "Open the crown down to the caries, and leave the pulp closed.");
    add("pedicle", "Pedicle of a vertebra", "Drill a channel of 4 mm through the left pedicle.");
    add("mastoid", "Mastoid", "Expose the facial nerve.")
        ->set_problem("its labels are missing: deploy/make-phantoms");
    lesson.set_scene_id("cavity");
    for (const char* trainee : {"Anna", "=Ben"}) {
        topics::Attempt& attempt = *lesson.add_attempts();
        attempt.set_number(uint32_t(lesson.attempts_size()));
        attempt.set_trainee(trainee);
        attempt.set_scene_id("cavity");
        attempt.set_start_stamp_ns(1'795'460'400'000'000'000);
        attempt.set_time_s(151);
        attempt.set_removed_mm3(12.34);
        attempt.set_max_force_n(5.1);
        attempt.mutable_training()->set_max_temperature_c(48.5);
        attempt.mutable_training()->set_necrotic_mm3(0.2);
    }
    lesson.mutable_attempts(1)->add_structures_touched("pulp");
    return lesson;
}

}  // namespace bonemill::test
