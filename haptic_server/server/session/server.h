// The live server: one process, and in it one scene after the other, each with tick, mesher, publisher and
// recorder threads around its bone (scene_run.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/dds/network.h"
#include "common/rt/realtime.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/teaching/lessons/scene_folder.h"

namespace bonemill {

struct ServerOptions {
    std::string scene;     // the first one; empty: the first of the folders that can be loaded
    int scene_number = 1;  // in the names of its files
    std::vector<std::string> scene_folders;  // of scenes to choose from; none: the folder of `scene`
    SceneMaker maker;                        // of what scenes to choose from lack
    uint32_t session = 1;
    uint32_t domain = 0;
    dds::NetworkOptions network;
    double seconds = 0;              // after the first tick; 0: until a signal or a shut_down command
    double stream_mbit_per_s = 200;  // of node meshes; nearest to the burr first
    std::string accuracy;   // accuracy.json of accuracy-report; empty: beside the scene, if there is one
    std::string recording;  // folder of the journal that each scene of the session writes
    bool is_recorded = true;
    bool records_results = false;  // also what the ticks came to, which a replay finds again
    bool resumes = false;          // goes on from the newest journal of the session without an end
    std::string from;              // FILE.mcap@SECONDS: goes on from that moment of a recording; or empty
    std::string resumed_journal;   // that is: set by runServer()
    std::string version;           // that --version prints
    std::string trace;             // files to write; empty: none
    std::string report;
    SavePaths save;
    std::string class_table;  // CSV, one line per attempt; empty: class.csv in export_dir, if there is one
    std::string export_dir;   // where clients' export commands write; empty: they are refused
    std::string beacon;       // ADDRESS:PORT to tell the session's clock to (beacon.h); empty: none
    bool allows_broadcast = false;  // to all PCs of a network
    int rt_core = coreFromLast(0);  // of the tick thread; kAnyCore (-1) leaves the choice to the kernel
    bool is_strict_realtime = false;
    bool instructor_only = false;      // others may look, not command
    bool until_device_leaves = false;  // end when the daemon shuts down in order
};

// Runs until told to stop; returns the process' exit code. Throws UserError at start-up, also when real-time
// permissions are missing and is_strict_realtime is set. Files are written also after SIGINT, SIGTERM or
// SIGHUP. Those of the second scene and later ones have a number before their ending (result_files.h).
int runServer(const ServerOptions& options);

// Returns the table of the scenes that can be chosen (scene_folder.h). Throws UserError.
std::string listScenesOf(const ServerOptions& options);

}  // namespace bonemill
