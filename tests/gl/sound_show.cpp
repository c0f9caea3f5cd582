// Plays a scripted load of the spindle, heard and seen:
//   sound_show DIR    writes milling_sound.wav and, by gnuplot, milling_sound.png into DIR
// The load is a run-up, idle, light contact, heavy contact, a stall, free again, and a wall milled through.
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "common/process/gnuplot.h"
#include "common/process/run_program.h"
#include "render_client/sound/milling_synth.h"
#include "render_client/sound/sound_output.h"

namespace bonemill {
namespace {

constexpr size_t kWindow = 4096, kHop = 1600;
constexpr double kShownHz = 6000;

// The script says by hand what a spindle does: (s, rpm, N, W, mm of wall), linear in between.
constexpr struct {
    double time, rpm, force, power, wall_mm;
} kScript[] = {{0, 0, 0, 0, 9},       {1.2, 30000, 0, 0, 9},  {3, 30000, 0, 0, 9}, {3.1, 28500, 1, 2, 9},
               {5.5, 28500, 1, 2, 9}, {5.7, 22000, 6, 9, 9},  {8, 22000, 6, 9, 9}, {8.2, 9000, 12, 10, 9},
               {8.8, 0, 14, 0, 9},    {9.8, 0, 14, 0, 9},     {10, 0, 0, 0, 9},    {11, 30000, 0, 0, 9},
               {12, 30000, 0, 0, 3},  {12.2, 28500, 1, 2, 3}, {16, 28500, 1, 2, 0}};
constexpr double kLength = 16;  // s

SoundLoad loadAt(double time) {
    size_t n = 0;
    while (n + 2 < std::size(kScript) && kScript[n + 1].time < time) ++n;
    const auto &a = kScript[n], &b = kScript[n + 1];
    const double part = (time - a.time) / (b.time - a.time);
    const auto between = [&](double low, double high) { return low + part * (high - low); };
    return {between(a.rpm, b.rpm) * 2 * M_PI / 60, between(a.force, b.force), between(a.power, b.power),
            between(a.wall_mm, b.wall_mm) / 1000};
}

std::vector<float> play() {
    MillingSynth synth{scene::MillingSound()};
    constexpr size_t kBlock = MillingSynth::kSampleRate / 60;
    std::vector<float> samples(size_t(kLength) * MillingSynth::kSampleRate);
    for (size_t at = 0; at < samples.size(); at += kBlock) {
        synth.setLoad(loadAt(double(at) / MillingSynth::kSampleRate));
        synth.render(std::span(samples).subspan(at, kBlock));
    }
    return samples;
}

// Writes rows "time frequency decibel", with a blank line after each time.
void writeSpectrogram(const std::vector<float>& samples, const std::filesystem::path& path) {
    std::ofstream file(path);
    const double bin = double(MillingSynth::kSampleRate) / kWindow;
    for (size_t at = 0; at + kWindow < samples.size(); at += kHop) {
        for (int k = 1; k * bin < kShownHz; k += 2) {
            std::complex<double> sum = 0, turn = 1;
            const std::complex<double> step = std::polar(1.0, -2 * M_PI * k / double(kWindow));
            for (size_t i = 0; i < kWindow; ++i, turn *= step)
                sum += (1 - std::cos(2 * M_PI * double(i) / kWindow)) * double(samples[at + i]) * turn;
            const double level = 20 * std::log10(2 * std::abs(sum) / kWindow + 1e-5);
            file << double(at) / MillingSynth::kSampleRate << ' ' << k * bin << ' ' << level << '\n';
        }
        file << '\n';
    }
}

void plot(const std::filesystem::path& folder) {
    std::ofstream script(folder / "milling_sound.gp");
    script << "set terminal pngcairo size 1100,520 font 'DejaVu Sans,11'\nset output "
              "'milling_sound.png'\nset xlabel 'time (s)'\nset ylabel 'frequency (Hz)'\nset cblabel 'dB of "
              "full scale'\n"
              "set xrange [0:15.9]\nset yrange [0:6000]\nset cbrange [-90:-15]\n"
              "set palette defined (0 '#10141c', 0.35 '#1f4e79', 0.65 '#d9822b', 1 '#fff3c4')\n"
              "set label 1 'run-up' at 0.2,5700 tc rgb 'white' front\nset label 2 'idle' at 1.8,5700 tc rgb "
              "'white' front\n"
              "set label 3 'light contact' at 3.4,5700 tc rgb 'white' front\n"
              "set label 4 'heavy contact' at 5.9,5700 tc rgb 'white' front\n"
              "set label 5 'stall' at 8.9,5700 tc rgb 'white' front\nset label 6 'free again' at 10.3,5700 "
              "tc rgb 'white' front\nset label 7 'wall of 3 to 0 mm' at 12.6,5700 tc rgb 'white' front\n"
              "plot 'milling_sound.dat' using 1:2:3 with image notitle\n";
    script.close();
    runGnuplot(folder / "milling_sound.gp");
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    using namespace bonemill;
    if (argc != 2) {
        std::cerr << "usage: sound_show DIR" << std::endl;
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    return runProgram([&] {
        std::filesystem::create_directories(folder);
        const std::vector<float> samples = play();
        WavFile wav(folder / "milling_sound.wav", MillingSynth::kSampleRate);
        wav.write(samples);
        wav.finish();
        writeSpectrogram(samples, folder / "milling_sound.dat");
        plot(folder);
        return 0;
    });
}
