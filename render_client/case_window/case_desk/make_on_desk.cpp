// The last step of the desk: the case is made.
#include <sstream>

#include "haptic_server/cases/casework/case_request.h"
#include "render_client/case_window/case_desk/case_desk.h"

namespace bonemill {

std::string CaseDesk::commandLine() const {
    CaseRequest shown = request();
    shown.figures.clear();  // they are deploy/make-case's own
    return commandLineOf(command_, shown);
}

void CaseDesk::make() {
    if (whyNotYet().empty()) wants_case_ = true;
}

void CaseDesk::makeIt() {
    lines_.clear();
    begin("making the case",
          [this, request = request(), version = version_, command = commandLine()]() -> Worker::Done {
              std::ostringstream report;
              std::string problem;
              try {
                  makeCase(request, version, report);
              } catch (const std::exception& error) {
                  problem = error.what();
              }
              return [this, text = report.str(), problem, request, command] {
                  takeReport(text);
                  if (!problem.empty()) return say(DeskLine::Kind::kError, problem);
                  say(DeskLine::Kind::kPlain, "the same by hand: " + command);
                  request_.out = freeFolder(request.out);
              };
          });
}

void CaseDesk::takeReport(const std::string& report) {
    std::istringstream text(report);
    for (std::string line; std::getline(text, line);) {
        const bool is_warning = line.starts_with("warning: ");
        say(is_warning ? DeskLine::Kind::kWarning : DeskLine::Kind::kPlain, line);
        constexpr char kWrote[] = "wrote ";
        if (line.starts_with(kWrote)) made_scene_ = line.substr(sizeof kWrote - 1);
    }
}

}  // namespace bonemill
