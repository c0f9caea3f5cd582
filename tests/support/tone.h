// Tells what is in a sound: its strength at a frequency (Hz), its loudest tone, its level.
#pragma once

#include <cmath>
#include <complex>
#include <span>

namespace bonemill::test {

// Takes a Hann window over all samples at this frequency (Hz).
inline double amplitudeAt(std::span<const float> samples, double frequency, double sample_rate) {
    std::complex<double> sum = 0;
    const double n = double(samples.size());
    for (size_t i = 0; i < samples.size(); ++i) {
        const double window = 1 - std::cos(2 * M_PI * double(i) / n);
        sum += window * double(samples[i]) * std::polar(1.0, -2 * M_PI * frequency * double(i) / sample_rate);
    }
    return 2 * std::abs(sum) / n;
}

// Returns the frequency (Hz) from low to high, in steps of 4, of the largest amplitude.
inline double loudestTone(std::span<const float> samples, double low, double high, double sample_rate) {
    double best = low, most = 0;
    for (double f = low; f <= high; f += 4) {
        const double amplitude = amplitudeAt(samples, f, sample_rate);
        if (amplitude > most) {
            most = amplitude;
            best = f;
        }
    }
    return best;
}

inline double rms(std::span<const float> samples) {
    double sum = 0;
    for (const float s : samples) sum += double(s) * s;
    return std::sqrt(sum / double(samples.size()));
}

}  // namespace bonemill::test
