// The last step of the desk: the case is made.
#include <sstream>
#include <utility>

#include "haptic_server/cases/casework/case_request.h"
#include "render_client/case_window/case_desk/case_desk.h"
#include "render_client/language/language.h"

namespace bonemill {

std::string CaseDesk::commandLine() const {
    CaseRequest shown = request();
    shown.figures.clear();  // they are deploy/make-case's own
    return commandLineOf(command_, shown);
}

void CaseDesk::make() {
    if (is_making_) return say(DeskLine::Kind::kWarning, tr("the case is being made already"));
    if (takesMake()) wants_case_ = true;
}

void CaseDesk::dropWishToMake(const char* why) {
    if (std::exchange(wants_case_, false))
        say(DeskLine::Kind::kWarning, tr("the case was not made: {1}", {why}));
}

void CaseDesk::makeIt() {
    if (const std::string why_not = whyNotYet(); !why_not.empty())
        return say(DeskLine::Kind::kWarning, tr("the case was not made: {1}", {why_not}));
    lines_.clear();
    is_making_ = true;
    begin(tr("making the case"),
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
                  say(DeskLine::Kind::kPlain, tr("the same by hand: {1}", {command}));
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
