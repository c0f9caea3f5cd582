// Shows the scan's densities to viewers that wish for them: the topics of bricks and of wishes.
//
// The publisher thread owns it; no write waits for a reader. It writes only what a viewer wishes.
#pragma once

#include "common/dds/endpoint.h"
#include "haptic_server/surface/density_stream/density_stream.h"
#include "proto/topics.pb.h"

namespace bonemill {

// They are the values of the scan at densities 0 and 65535, and at the bone's surface.
struct DensityScale {
    double value_at_0;
    double value_at_65535;
    double iso_value;
};

topics::DensityGrid densityGridOf(const DensitySource& source, const DensityScale& scale);

class DensityPublisher {
  public:
    // The epoch is that of the session's Publisher. The participant and the bone must outlive this object.
    DensityPublisher(const dds::Participant& participant, uint32_t session, uint64_t epoch,
                     const DensitySource& source, const DensityScale& scale);

    // Hears what is wished, and writes bricks of about `most_bytes` at most; returns what to charge for
    // them. It takes some 2 ms at most.
    size_t round(int64_t now_ns, int64_t most_bytes);

    uint64_t writtenBricks() const { return written_bricks_; }

  private:
    void takeWishes(int64_t now_ns);

    uint32_t session_;
    DensityStream stream_;
    uint64_t written_bricks_ = 0;
    dds::Writer<dds::DensityBrickSample> writer_;
    dds::Reader<dds::DensityWishSample> reader_;
};

}  // namespace bonemill
