// Runs a helper program of the test with its stdin and stdout on pipes, and kills it when the object goes; it
// ends when this process does. Make it in the main thread.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

class ChildProcess {
  public:
    // Starts the program `name` beside the test; it gets the test's domain and session as arguments, and one
    // more.
    explicit ChildProcess(const std::string& name, std::string argument = "");
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    // Returns the next line that it prints; it is empty when the program ends or stays silent for 30 s.
    std::string readLine();
    bool tell(const std::string& line);
    std::string ask(const std::string& line);
    void finish();  // closes its stdin, and waits for its end
    void kill();    // SIGKILL

  private:
    int pid_ = -1;
    int to_child_ = -1;
    int from_child_ = -1;
};

}  // namespace bonemill
