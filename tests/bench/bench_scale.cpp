#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "common/process/gnuplot.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/bench_tick.h"

namespace bonemill::bench {
namespace {

constexpr double kSpacing = 0.096e-3;  // m
constexpr int kEdges[] = {128, 256, 512, 1024};
constexpr double kRadii_mm[] = {0.5, 1, 1.5, 2, 2.5, 3, 4};

nlohmann::json medianTicks(TickCase tick_case, int runs) {
    std::vector<nlohmann::json> all;
    for (int n = 0; n < runs; ++n) all.push_back(toJson(measureTicks(tick_case)));
    return medianOf(all);
}

void addRow(Table& table, const std::string& name, const nlohmann::json& figures) {
    std::vector<std::string> cells{name};
    for (const char* part : {"tick_us", "force_us", "milling_us"})
        for (const char* key : {"p50", "p99"}) cells.push_back(number(figures[part][key].get<double>()));
    cells.push_back(number(figures["candidates_mean"].get<double>()));
    table.add(cells);
}

void plot(const nlohmann::json& json, const std::string& picture) {
    const std::string data = picture + ".dat";
    const auto nameOf = [](const std::string& path) {
        return std::filesystem::path(path).filename().string();
    };
    std::ofstream file(data);
    for (const auto& row : json["edge"])
        file << row["voxels_per_edge"] << ' ' << row["tick_us"]["p50"] << ' ' << row["tick_us"]["p99"]
             << '\n';
    file << "\n\n";
    for (const auto& row : json["radius"])
        file << row["burr_radius_mm"] << ' ' << row["force_us"]["p50"] << ' ' << row["milling_us"]["p50"]
             << ' ' << row["tick_us"]["p99"] << '\n';
    file.close();
    const std::string script = picture + ".gnuplot";
    std::ofstream(script)
        << "set terminal pngcairo size 1200,500 font 'sans,11'; set output '" << nameOf(picture)
        << "'; set multiplot layout 1,2; set logscale xy; set grid; set key top left; set ylabel 'us'; set "
           "yrange [1:*];"
           "set xlabel 'voxels per edge, at equal voxels and burr'; set xtics (128,256,512,1024);"
           "plot '"
        << nameOf(data) << "' i 0 u 1:2 w lp t 'tick p50', '' i 0 u 1:3 w lp t 'tick p99';"
        << "set xlabel 'burr radius, mm'; set xtics (0.5,1,1.5,2,3,4);"
           "plot '"
        << nameOf(data) << "' i 1 u 1:2 w lp t 'force p50', '' i 1 u 1:3 w lp t 'milling p50', "
        << "'' i 1 u 1:4 w lp t 'tick p99', 10*x**2 w l dt 2 t 'quadratic', 2*x**3 w l dt 3 t 'cubic'\n";
    runGnuplot(script);
    std::remove(script.c_str());
    std::remove(data.c_str());
}

void run(int runs, int largest_edge, const std::string& picture, const std::string& json_path) {
    nlohmann::json json{{"edge", nlohmann::json::array()}, {"radius", nlohmann::json::array()}};
    Table table({"us", "tick p50", "p99", "force p50", "p99", "milling p50", "p99", "candidates"});
    for (const int edge : kEdges) {
        if (edge > largest_edge) continue;
        nlohmann::json row =
            medianTicks({.edge = edge, .spacing = kSpacing, .burr_radius = 1e-3, .ticks = 2000}, runs);
        addRow(table, std::to_string(edge) + " voxels per edge, R = 1 mm", row);
        row["voxels_per_edge"] = edge;
        json["edge"].push_back(row);
    }
    for (const double radius : kRadii_mm) {
        nlohmann::json row = medianTicks(
            {.edge = 256, .spacing = kSpacing, .burr_radius = radius * kMillimetre, .ticks = 2500}, runs);
        addRow(table, "256 voxels per edge, R = " + number(radius) + " mm", row);
        row["burr_radius_mm"] = radius;
        json["radius"].push_back(row);
    }
    table.print();
    writeJson(json_path, json);
    if (!picture.empty()) plot(json, picture);
}

}  // namespace

void addScaleCommand(CLI::App& app) {
    struct Options {
        std::string picture, json;
        int runs = 3, largest_edge = *std::rbegin(kEdges);
    };
    auto o = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("scale", "tick time against the volume's edge and the burr's radius");
    command->add_option("--runs", o->runs, "medians of so many")->check(CLI::Range(1, 99));
    command->add_option("--largest-edge", o->largest_edge, "of the volume, voxels; 1024 needs 0.9 GB")
        ->check(CLI::Range(kEdges[0], *std::rbegin(kEdges)));
    command->add_option("--plot", o->picture, "write a PNG")->each([](const std::string& file) {
        requireWritable(file);
    });
    addJsonOption(*command, o->json);
    command->callback([o] { run(o->runs, o->largest_edge, o->picture, o->json); });
}

}  // namespace bonemill::bench
