// Prints what the C library makes of some arguments, bit by bit.
#include <cmath>
#include <cstdio>

int main() {
    for (int n = 1; n < 20000; ++n) {
        const volatile double argument = n * 5e-5;  // volatile: not evaluated by the compiler
        const double x = argument;
        std::printf("%a %a %a %a\n", std::exp(x), std::log(x), std::sin(x), std::atan2(x, 0.4));
    }
}
