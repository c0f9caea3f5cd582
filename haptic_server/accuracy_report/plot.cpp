#include "haptic_server/accuracy_report/plot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "common/config/user_error.h"

namespace bonemill {
namespace {

constexpr double kSmallestError = 1e-3;  // %, for the logarithm
constexpr int kCommandNotFound = 127;

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

double errorPercent(const SettingFigures& f) {
    return std::max(kSmallestError, 100 * f.errors.force_vector);
}

bool isPreset(const SettingFigures& f) {
    return presetOfName(f.name).has_value();
}

// One line per chosen setting: p99.9, error, label, name.
template <class Choose>
std::string block(const char* name, const ReportData& data, Choose&& choose) {
    std::ostringstream text;
    text << '$' << name << " << END_OF_DATA\n";
    for (size_t n = 0; n < data.settings.size(); ++n) {
        const SettingFigures& f = data.settings[n];
        if (!choose(f, n)) continue;
        const std::string label = isPreset(f) ? f.name : std::to_string(n + 1);
        text << f.times.p99_9 << ' ' << errorPercent(f) << ' ' << quoted(label) << '\n';
    }
    text << "END_OF_DATA\n";
    return text.str();
}

std::string frontBlock(const ReportData& data) {
    std::vector<std::pair<double, double>> points;
    for (size_t n = 0; n < data.settings.size(); ++n)
        if (data.front[n]) points.emplace_back(data.settings[n].times.p99_9, errorPercent(data.settings[n]));
    std::sort(points.begin(), points.end());
    std::ostringstream text;
    text << "$front << END_OF_DATA\n";
    for (const auto& [time, error] : points) text << time << ' ' << error << '\n';
    text << "END_OF_DATA\n";
    return text.str();
}

// What the numbers stand for, beside the plot.
std::string legend(const ReportData& data) {
    std::ostringstream text;
    double y = 0.92;
    for (size_t n = 0; n < data.settings.size(); ++n) {
        const SettingFigures& f = data.settings[n];
        text << "set label " << 100 + n << ' '
             << quoted((isPreset(f) ? "" : std::to_string(n + 1) + "  ") + f.name +
                       (f.is_in_force ? "  (in force)" : ""))
             << " at screen 0.665, screen " << y << " left noenhanced font \",10\"\n";
        y -= 0.84 / double(std::max<size_t>(24, data.settings.size()));
    }
    return text.str();
}

}  // namespace

std::string paretoScript(const ReportData& data, const std::filesystem::path& png) {
    std::ostringstream script;
    script << block("candidates", data, [](const SettingFigures& f, size_t) { return !isThesis(f); })
           << block("thesis", data, [](const SettingFigures& f, size_t) { return isThesis(f); })
           << block("in_force", data, [](const SettingFigures& f, size_t) { return f.is_in_force; })
           << frontBlock(data) << legend(data);
    script
        << "set terminal pngcairo size 1500,850 font \"DejaVu Sans,11\"\n"
        << "set output " << quoted(png.string()) << '\n'
        << "set title " << quoted(data.scene + ": force error against tick time")
        << " noenhanced font \",14\"\n"
        << "set rmargin at screen 0.65\n"
           "set logscale xy\n"
           "set offsets graph 0.1, graph 0.12, graph 0.08, graph 0.08\n"
           "set xtics (1,2,3,5,7,10,15,20,30,50,70,100,150,200,300,500,700,1000,1500,2000,3000,5000,10000)\n"
           "set ytics (0.001,0.002,0.005,0.01,0.02,0.05,0.1,0.2,0.5,1,2,5,10,20,50,100,200,500,1000)\n"
           "set grid lc rgb \"#dddddd\"\n"
           "set key bottom left\n"
           "set xlabel \"tick, p99.9, µs (this machine)\"\n"
           "set ylabel \"force error against truth, % (RMS)\"\n";
    if (data.budget_us)
        script << "set arrow from " << *data.budget_us << ", graph 0 to " << *data.budget_us
               << ", graph 1 nohead dt 2 lc rgb \"#c04040\"\n"
               << "set label \"budget\" at " << *data.budget_us
               << ", graph 0.97 right offset -0.5,0 tc rgb \"#c04040\"\n";
    script << "plot $front using 1:2 with lines lw 2 lc rgb \"#50a060\" title \"Pareto front\", \\\n"
              " $candidates using 1:2 with points pt 7 ps 1.3 lc rgb \"#2050a0\" title \"gradient law\", \\\n"
              " $candidates using 1:2:3 with labels offset 0.6,0.6 left noenhanced font \",10\" notitle, \\\n"
              " $thesis using 1:2 with points pt 9 ps 1.5 lc rgb \"#d06050\" title \"thesis\\\\_2012: "
              "another law, "
              "difference only\", \\\n"
              " $thesis using 1:2:3 with labels offset 0.6,0.6 left noenhanced font \",10\" notitle, \\\n"
              " $in_force using 1:2 with points pt 6 ps 3 lw 2 lc rgb \"#202020\" title \"in force in the "
              "scene\"\n";
    return script.str();
}

void runGnuplot(const std::filesystem::path& script) {
    std::string program = "gnuplot", argument = script.string();
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int spawn_error = posix_spawnp(&child, "gnuplot", nullptr, nullptr, arguments, environ);
    const std::string advice =
        "; the picture is missing, the figures are written (Debian: apt install gnuplot-nox)";
    if (spawn_error)
        throw UserError(std::string("gnuplot cannot be run (") + std::strerror(spawn_error) + ')' + advice);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kCommandNotFound)
        throw UserError("gnuplot cannot be run" + advice);
    throw UserError("gnuplot failed on " + script.string() +
                    "; the picture is missing, the figures are written");
}

}  // namespace bonemill
