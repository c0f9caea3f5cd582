// Reads an MCAP file as the specification allows it (https://mcap.dev/spec), for those that other programs
// than ours have written or written anew: with chunks or without, packed by zstd or not at all, with CRCs or
// without (0), with or without an index. What such a file promises is checked: CRCs that are there, and its
// end. Attachments, metadata and records that are not known are passed over. It is for normal threads.
#pragma once

#include "common/mcap/mcap_reader.h"
#include "common/mcap/mcap_stream.h"

namespace bonemill::mcap {

// The header was taken, and is in `reading`; a first record was taken, too, if `has_record`. Fills in the
// rest of it.
void readForeign(RecordStream& records, bool has_record, const Visit& visit, Reading& reading);

}  // namespace bonemill::mcap
