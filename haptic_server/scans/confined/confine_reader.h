// Leaves to a reader's process what reading files needs, and nothing else: whatever a file makes of it, it
// reaches nothing but the pipe that it writes into. There is no Eigen in here: ITK's sources include it.
#pragma once

namespace bonemill {

// From now on this process, which has one thread, and its threads to come
// - hold no descriptor but 0 to 2 and `pipe`, and can make none that writes;
// - can make the system calls that are listed in confine_reader.cpp, and no others: these fail with EPERM, or
//   with ENOSYS where a library then takes an older one;
// - have System V and POSIX message queues, semaphores and shared memory of their own, where this kernel
//   grants that to this user; they cannot make the calls to reach them anyway;
// - are root by name only, but for reading.
// There is no way back. Whoever maps memory to share it with others does so before. Throws UserError when
// this kernel cannot do it.
void confineReader(int pipe);

}  // namespace bonemill
