// What becomes of a program whose standard output, or whose reader, is not there. runProgram()
// (run_program.h) calls the first two for all programs; a program that serves others calls the third at its
// end. They are for the main thread, and not RT-safe.
#pragma once

namespace bonemill {

// To be called first. From now on writing to a pipe or socket without a reader is an error of that call, and
// ends no program: SIGPIPE is ignored, here and in what is started from here. A standard stream that was
// closed (>&-) fails whoever uses it, instead of the next file that is opened taking its place.
void outliveReaders() noexcept;

// Throws UserError unless all that was printed to standard output has got there: a command that cannot print
// what it found has failed.
void requirePrinted();

// What a session, a gateway or a device does is done, whoever has read of it: what was not printed is told on
// standard error, and requirePrinted() asks for the rest only.
void forgiveUnprinted() noexcept;

}  // namespace bonemill
