// The golden values: what every conforming device gives, in bits. The self-test, the tests and the conformance runs all read them here. A
// change means that pictures change: made on purpose only (tests/README.md, "Goldens"). To make them anew, run `clvr selftest` and
// copy what it found.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace clvr::selftest {

/// pixel_hash of each golden scene (golden_scene), the denoised one's of golden_denoised, the rendered and denoised one's of
/// golden_picture.
inline const std::map<std::string, std::string> golden_hashes{
    {"automatic", "9134b63b13f2a2de5b141411ae7cacfeacec5ce7863a67b88d513b5efecd6e15"},
    {"dvr", "c9826472ad12078dd257a7efc6e6dccf4e914f1b8bee7b4f48273ec36dfa573b"},
    {"gradient", "29f4915e6f68007451d1693799e96547b821e1fc8ee178b74863bfc7f49062e7"},
    {"mip", "9bcdade87d2f47653dd0f64cb968c24500a67109609089504ad09896e01cf257"},
    {"phase", "7154431002c1afea4d385351a75823ddbe5ca3eb1d15a918573df6fcdad1c5a8"},
};
inline const std::string golden_denoised_hash = "2f842ced212505c430e78eb0b9e46d27e9a9d89534f993d17779341a72dc449b";
inline const std::string golden_picture_hash = "325e089a6a4a05d70d098d0d2bf79493d0dc13adfc5ea3b393fad92d2adb7d4d";

/// SHA-256 of the bits that the functions of kernels/lib/math.clh give for function_arguments, in the order of math_values.cl.
inline const std::array<std::pair<const char*, const char*>, 5> golden_functions{{
    {"log", "892b8bb4c963141f9fafb6ee106e7baa0698e2a03e1d8b0b777856aed0827405"},
    {"exp", "8f99d4a83cbeadf884cc6fbd8e81209911e27bf48aee2b9a68eeb7e8fbf7ac4b"},
    {"sincos", "113bfcc8d9e3b48e0ed4ca2af5e8397c02041fade9232e71bd59d9edcb3edfb7"},
    {"atan2", "4068bb3f0a6ed28a310238eb3688fccd569dde8dd9815fbae8835648edba3545"},
    {"acos", "22dd58cc7708a13fe0438cb2f1fc50cce0564f3144a1cffbfbec5171cde920a5"},
}};

/// Stops of the rays of the majorant check.
constexpr int golden_stops = 23321;

/// SHA-256 of the mean loss of each step of a tiny training (doubles), then of the weights after it (floats).
inline const std::string golden_training_hash = "633c1759ceb673dc9b4f448ea4fce6f59080e5be424234ddf4c441ac6d7af7ac";

/// Philox4x32 with 10 rounds: Random123's examples/kat_vectors.
struct KnownRandom {
    std::array<std::uint32_t, 4> counter;
    std::array<std::uint32_t, 2> key;
    std::array<std::uint32_t, 4> block;
};
inline constexpr KnownRandom published_random[] = {
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}, {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
};

} // namespace clvr::selftest
