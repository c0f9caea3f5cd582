// The words of the program `study`. Each returns the exit code; what goes wrong is a UserError.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/teaching/study_report/plan_text.h"

namespace bonemill::study {

struct Options {
    std::string folder, group, pseudonym, session, form, reason, out, report, scene, recording;
    std::vector<std::string> files;
    bool has_consent = false, replaces = false;
    std::vector<size_t> groups;
    Plan plan;
    double printed_p = 0;  // 0: none was given
};

int init(const Options& options);
int check(const Options& options);
int enrol(const Options& options);
int next(const Options& options);
int fill(const Options& options);
int page(const Options& options);
int import(const Options& options);
int attach(const Options& options);
int withdraw(const Options& options);
int remove(const Options& options);
int report(const Options& options);
int plan(const Options& options);
int agree(const Options& options);

}  // namespace bonemill::study
