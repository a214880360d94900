#include "host/train/checkpoint.hpp"
#include "host/io/model/model_file.hpp"
#include "runtime/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {
using nlohmann::json;

void write_checkpoint(const Checkpoint& c, const Model& shape, const std::string& path) {
    TensorFile file = tensors_of(c.best);
    for (auto& [name, tensor] : file.tensors) name = "best." + name;
    Model present = shape;
    present.set_flat(c.state.parameters);
    TensorFile now = tensors_of(present);
    const auto count = static_cast<std::int64_t>(c.state.parameters.size());
    file.tensors.insert(file.tensors.begin(), now.tensors.begin(), now.tensors.end());
    file.tensors.emplace_back("first_moment", float_tensor({count}, c.state.first_moment));
    file.tensors.emplace_back("second_moment", float_tensor({count}, c.state.second_moment));
    file.tensors.emplace_back("step", integer_tensor({}, {c.state.step}));
    json records = json::array();
    for (const auto& r : c.records) records.push_back({r.loss, r.validation});
    file.metadata["clvr.checkpoint"] = json{
        {"configuration", c.configuration},
        {"best_validation", c.best_validation},
        {"records", records},
        {"loss_sum", c.loss_sum}}.dump();
    write_tensors(file, path);
}

Checkpoint read_checkpoint(const std::string& path, const std::string& configuration) {
    TensorFile file = read_tensors(path);
    Checkpoint c;
    try {
        const json rest = json::parse(file.metadata.at("clvr.checkpoint"));
        file.metadata.erase("clvr.checkpoint");
        c.configuration = rest.at("configuration").get<std::string>();
        c.best_validation = rest.at("best_validation").get<double>();
        c.loss_sum = rest.at("loss_sum").get<double>();
        for (const auto& r : rest.at("records")) c.records.push_back({r.at(0).get<double>(), r.at(1).get<double>()});
    } catch (const std::exception& e) {
        throw Error(ErrorKind::input, fmt::format("is no checkpoint of clvr ({})", e.what()), path);
    }
    if (c.configuration != configuration)
        throw Error(ErrorKind::input,
                    fmt::format("is of another training: {}; this one is {}. Resume with the same options, or begin anew without --resume",
                                c.configuration, configuration),
                    path);
    const Model present = model_of(file, path);
    TensorFile best;
    best.metadata = file.metadata;
    for (const auto& [name, tensor] : file.tensors)
        if (name.rfind("best.", 0) == 0) best.tensors.emplace_back(name.substr(5), tensor);
    c.best = model_of(best, path);
    c.state.parameters = present.flat();
    try {
        c.state.first_moment = file.at("first_moment").floats();
        c.state.second_moment = file.at("second_moment").floats();
        const auto step = file.at("step").integers();
        c.state.step = step.size() == 1 ? step.front() : -1;
    } catch (const Error& e) {
        throw Error(ErrorKind::input, e.line(), path);
    }
    if (c.state.first_moment.size() != c.state.parameters.size() || c.state.second_moment.size() != c.state.parameters.size() ||
        c.state.step < 0)
        throw Error(ErrorKind::input, "is damaged: its moments do not fit its model", path);
    return c;
}

} // namespace clvr
