// This is a viewer without a picture. It prints one JSON line every 100 ms that says what it shows.
//   probe_viewer --session N [--domain D] [--profile ...] [--interface ...] [--peer ...] [--slices |
//   --moving-slices]
// With slices it wants the densities of three planes, through the middle or moving 4 mm per second.
#include <cinttypes>
#include <cstdio>

#include "common/cli/command_line.h"
#include "common/dds/network_cli.h"
#include "common/process/run_program.h"
#include "render_client/link/subscribe/scene_subscriber.h"

namespace {

using namespace bonemill;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class Probe {
  public:
    Probe(const SubscriberOptions& options, bool has_slices, bool are_moving)
        : subscriber_(options), has_slices_(has_slices || are_moving), are_moving_(are_moving) {}

    void run() {
        for (Clock::time_point due = Clock::now();;) {
            subscriber_.waitForData(10ms);
            changes_ += subscriber_.poll().nodes.size();
            subscriber_.followDensities(densities_);
            if (Clock::now() < due) continue;
            due = Clock::now() + 100ms;
            if (has_slices_ && densities_.grid()) wantPlanes();
            print();
        }
    }

  private:
    void wantPlanes() {
        const DensityGrid& grid = *densities_.grid();
        const Eigen::Vector3i n = bricksPerAxis(grid);
        if (are_moving_) moved_m_ += 0.4e-3;
        std::vector<uint32_t> bricks;
        for (int brick = 0; brick < n.prod(); ++brick) {
            const Eigen::Vector3i first = firstVoxelOf(grid, uint32_t(brick));
            for (int axis = 0; axis < 3; ++axis) {
                const int place = grid.voxels[axis] / 2 + int(moved_m_ / grid.spacing_m[axis]);
                const int plane = place % grid.voxels[axis];
                if (plane < first[axis] || plane >= first[axis] + grid.brick_edge) continue;
                bricks.push_back(uint32_t(brick));
                break;
            }
        }
        densities_.want(std::move(bricks));
    }
    size_t lacking() const {
        return size_t(std::ranges::count_if(densities_.wanted(),
                                            [this](uint32_t brick) { return !densities_.find(brick); }));
    }

    void print() const {
        if (has_slices_)
            std::printf("{\"wanted\":%zu,\"lacking\":%zu,\"taken\":%" PRIu64 ",\"bytes\":%zu}\n",
                        densities_.wanted().size(), lacking(), subscriber_.densityFeed().takenBricks(),
                        densities_.bytes());
        std::printf("{\"complete\":%s,\"server\":%s,\"nodes\":%u,\"digest\":\"%016" PRIx64
                    "\",\"changes\":%zu}\n",
                    subscriber_.isComplete() ? "true" : "false", subscriber_.hasServer() ? "true" : "false",
                    subscriber_.digest().count(), subscriber_.digest().value(), changes_);
        std::fflush(stdout);
    }

    SceneSubscriber subscriber_;
    DensityStore densities_;
    bool has_slices_, are_moving_;
    double moved_m_ = 0;
    size_t changes_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    return runProgram([&] {
        CLI::App app("A viewer without a picture", "probe_viewer");
        SubscriberOptions subscriber;
        dds::NetworkOptions network;
        app.add_option("--session", subscriber.session)->required();
        app.add_option("--domain", subscriber.domain);
        bool has_slices = false, are_moving = false;
        app.add_flag("--slices", has_slices);
        app.add_flag("--moving-slices", are_moving);
        dds::addNetworkOptions(app, network);
        if (!parseCommandLine(app, argc, argv, "probe_viewer")) return 0;
        dds::setNetwork(network, dds::NetworkPart::kViewer, subscriber.session);
        Probe(subscriber, has_slices, are_moving).run();
        return 0;
    });
}
