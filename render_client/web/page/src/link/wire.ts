// All payloads of the topics (proto/topics.proto).
export * from '#proto/densities_pb';
export * from '#proto/topics_commands_pb';
export * from '#proto/topics_lesson_pb';
export * from '#proto/topics_people_pb';
export * from '#proto/topics_scene_pb';
export * from '#proto/topics_state_pb';
