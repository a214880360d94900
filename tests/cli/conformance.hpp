// One hash for all implementations: the picture of the self-test (render, features, denoised) and its training, in a process of its own
// with another driver or other settings.
#pragma once
#include "host/selftest/golden_values.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clvr {

class Conformance : public Program {
protected:
    /// What `clvr selftest --json` says under the environment.
    nlohmann::json tested(const Environment& environment, const std::vector<std::string>& arguments) const {
        std::vector<std::string> words{"selftest", "--json"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        const Outcome outcome = run(words, environment);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
    /// The devices compute the picture and the training, whose hashes the report must show. Gives the report of the first device back.
    nlohmann::json expect_golden(const Environment& environment, std::vector<std::string> arguments = {}) const {
        arguments.insert(arguments.end(), {"--check", "trust,picture,training"});
        const nlohmann::json report = tested(environment, arguments);
        if (!report.is_object()) {
            ADD_FAILURE() << "no report";
            return {};
        }
        for (const auto& device : report.at("devices")) {
            EXPECT_EQ(device.at("checks").at(0).at("ok"), true) << device.dump(2);
            EXPECT_EQ(device.at("checks").at(1).at("found"), selftest::golden_picture_hash) << device.dump(2);
            EXPECT_EQ(device.at("checks").at(2).at("found"), selftest::golden_training_hash) << device.dump(2);
        }
        return report.at("devices").at(0);
    }
    static bool installed(const std::string& file) { return std::filesystem::exists(file); }
};

/// One lane: what interpreters and slow compilers manage.
inline const std::string narrow = "packet=1,conv_width=1";

} // namespace clvr
