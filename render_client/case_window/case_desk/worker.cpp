#include "render_client/case_window/case_desk/worker.h"

#include <chrono>
#include <utility>

namespace bonemill {

void Worker::start(std::function<Done()> work) {
    future_ = std::async(std::launch::async, std::move(work));
}

void Worker::poll() {
    if (!future_.valid() || future_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const Done done = std::exchange(future_, {}).get();
    if (done) done();
}

}  // namespace bonemill
