// Takes from a reader's process all that reading files does not need, so that a file that takes the reader
// over has little to do with it.
#pragma once

namespace bonemill {

// From now on this process and its threads open files only to read them, and neither start programs nor look
// into other processes, send them signals, change their limits or type into their terminal; sockets, file
// systems and the kernel's settings are out of reach (such calls fail with EPERM), and root is root by name
// only, but for reading. There is no way back. It is called by a process with one thread. Throws UserError
// when this kernel cannot do it.
void confineReader();

}  // namespace bonemill
