// Node meshes go this way from the mesher thread to the publisher thread: of each leaf the newest, those that
// changed together in one group. It is for any normal thread, never the tick.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// These are leaves that changed together; shown apart, a crack would be seen between them.
struct NodeGroup {
    std::vector<NodeMesh> meshes;
    std::vector<uint32_t>
        neighbours;             // other leaves of the same change: what waits of them belongs to it too
    int64_t oldest_cut_ns = 0;  // start of the oldest tick whose cut is in it, CLOCK_MONOTONIC; 0: none
    int64_t since_ns = 0;       // it has waited in the outbox since then; 0: it was not there yet
};

class MeshOutbox {
  public:
    // Joins what waits with it when they share a leaf; a newer mesh of a leaf replaces the older one. A group
    // that was taken and comes back has waited all the time.
    void put(NodeGroup&& group, int64_t now_ns);

    // Sleeps until a group has been put since the last call, or for `longest`: then it is false. A group that
    // was taken and comes back wakes nobody.
    bool awaitPut(std::chrono::nanoseconds longest);

    // Takes whole groups, those nearest to the point (V, m) first, until their coded size is some `bytes`: at
    // least one, if any waits and bytes > 0. A group that waits comes nearer by kAgeing, so that none waits
    // for ever.
    std::vector<NodeGroup> takeNearest(const Eigen::Vector3f& point, int64_t bytes, int64_t now_ns);
    static constexpr float kAgeing = 0.1f;  // m/s

    bool isEmpty() const;

    // Every leaf has been put once. (Later calls change nothing.)
    void markWhole(int64_t now_ns);
    // It is true when all that was put until then has been taken: who has all nodes has the whole bone.
    bool hasGivenWhole() const;

  private:
    struct Waiting {
        std::map<uint32_t, NodeMesh> meshes;  // by leaf
        std::set<uint32_t> leaves;            // of these meshes and their neighbours
        int64_t oldest_cut_ns = 0;
        int64_t since_ns = 0;
    };
    void join(Waiting& into, Waiting&& other);

    mutable std::mutex mutex_;
    std::condition_variable has_come_;
    bool is_news_ = false;  // since awaitPut()
    std::map<uint64_t, Waiting> groups_;
    std::map<uint32_t, uint64_t> group_of_;  // by leaf
    uint64_t next_group_ = 0;
    int64_t whole_ns_ = 0;  // 0: not yet
};

}  // namespace bonemill
