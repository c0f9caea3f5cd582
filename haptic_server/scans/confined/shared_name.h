// The name of the file that a reader's process is at, in memory that it shares with the process that guards
// it (guarded_import.h). There is no Eigen in here: ITK's sources include it.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill {

// Is for the guarding process; one at a time. Without memory for it, messages name the volume's path.
class SharedName {
  public:
    SharedName();
    ~SharedName();
    SharedName(const SharedName&) = delete;
    SharedName& operator=(const SharedName&) = delete;

    int file() const { return file_; }  // is for the reader; -1: none

  private:
    int file_;
};

// Returns what the reader noted (noteFileBeingRead), or `path`. The reader may have been taken over, so this
// is made one line of text, whatever it wrote.
std::string nameOfFileBeingRead(const std::filesystem::path& path);

// For a child that was not forked: noteFileBeingRead() writes there.
void shareNameOfFileBeingRead(int name);

// For the handler of a signal that ends the reader: what this thread noted is the file at fault, whatever
// others have noted since. It is safe in a handler.
void nameFileOfEndingThread() noexcept;

// Control characters would end a message's line, or command the terminal that shows it.
std::string oneLine(std::string text);

// Tells the guarding process which file a reader is at: the message names it when the reader dies. It has no
// effect outside importGuarded.
void noteFileBeingRead(const std::filesystem::path& file) noexcept;

}  // namespace bonemill
