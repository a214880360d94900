// The golden vectors (tests/golden) and their tolerances.
#pragma once
#include "host/io/model/safetensors.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace clvr::testing {

class Golden {
public:
    explicit Golden(const std::string& name) : file_(read_tensors(std::string(CLVR_TEST_DATA) + "/golden/" + name + ".safetensors")) {
        std::ifstream in(std::string(CLVR_TEST_DATA) + "/golden/manifest.json");
        entries_ = nlohmann::json::parse(in).at("files").at(name).at("tensors");
    }

    /// Values as double, whatever the type; row-major.
    std::vector<double> operator[](const std::string& tensor) const {
        const Tensor& t = file_.at(tensor);
        if (t.type == "F64") return t.doubles();
        if (t.type == "U8") return {t.bytes.begin(), t.bytes.end()};
        if (t.type == "I32") {
            std::vector<std::int32_t> v(t.bytes.size() / 4);
            std::memcpy(v.data(), t.bytes.data(), t.bytes.size());
            return {v.begin(), v.end()};
        }
        const std::vector<float> v = t.floats();
        return {v.begin(), v.end()};
    }
    std::vector<float> floats(const std::string& tensor) const { return file_.at(tensor).floats(); }
    std::vector<std::int64_t> shape(const std::string& tensor) const { return file_.at(tensor).shape; }
    const TensorFile& file() const { return file_; }

    /// `got` within the tensor's own tolerances of `want` (the tensor itself, unless given).
    void expect_near(const std::string& tensor, const std::vector<double>& got, std::vector<double> want = {}) const {
        if (want.empty()) want = (*this)[tensor];
        ASSERT_EQ(got.size(), want.size()) << tensor;
        double largest = 0, error = 0, squares = 0, error_squares = 0;
        for (std::size_t i = 0; i < want.size(); ++i) {
            largest = std::max(largest, std::abs(want[i]));
            error = std::max(error, std::abs(got[i] - want[i]));
            squares += want[i] * want[i];
            error_squares += (got[i] - want[i]) * (got[i] - want[i]);
        }
        ASSERT_TRUE(std::isfinite(error_squares)) << tensor;
        if (largest == 0) {
            EXPECT_EQ(error, 0) << tensor;
            return;
        }
        const auto& entry = entries_.at(tensor);
        const auto limit = [&](const char* name) { return entry.contains(name) ? entry.at(name).get<double>() : 1e-5; };
        EXPECT_LE(error / largest, limit("tol")) << tensor;
        if (entry.contains("tol_rl2")) {
            EXPECT_LE(std::sqrt(error_squares / squares), limit("tol_rl2")) << tensor;
        }
    }

private:
    TensorFile file_;
    nlohmann::json entries_;
};

} // namespace clvr::testing
