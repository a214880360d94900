#include "tools/bench/row.hpp"

#include "tools/bench/stage.hpp"

#include <algorithm>

namespace clvr::bench {

const char* status_name(Status s) {
    return s == Status::ok ? "ok" : s == Status::unsupported ? "unsupported" : s == Status::wrong_result ? "wrong result" : "error";
}

nlohmann::json to_json(const Row& r) {
    return {{"stage", r.stage},
            {"unit", r.unit},
            {"size", r.size},
            {"status", status_name(r.status)},
            {"reason", r.reason},
            {"note", r.note},
            {"seconds", r.seconds},
            {"spread", r.spread},
            {"rate", r.rate},
            {"flops_per_second", r.flops},
            {"bytes_per_second", r.bytes},
            {"flops_per_byte", r.intensity},
            {"share_of_native", r.native_share},
            {"share_of_ceiling", r.share},
            {"pace_seconds", r.pace_s},
            {"batches", r.batches},
            {"repeated", r.repeated},
            {"hash", r.hash}};
}

Row row_from_json(const nlohmann::json& j) {
    Row r;
    for (const auto& [name, to] :
         {std::pair("stage", &r.stage), {"unit", &r.unit}, {"size", &r.size}, {"reason", &r.reason}, {"note", &r.note}, {"hash", &r.hash}})
        *to = j.at(name).get<std::string>();
    for (const auto& [name, to] : {std::pair("seconds", &r.seconds),
                                   {"spread", &r.spread},
                                   {"rate", &r.rate},
                                   {"flops_per_second", &r.flops},
                                   {"bytes_per_second", &r.bytes},
                                   {"flops_per_byte", &r.intensity},
                                   {"share_of_native", &r.native_share},
                                   {"share_of_ceiling", &r.share},
                                   {"pace_seconds", &r.pace_s}})
        *to = j.at(name).get<double>();
    r.batches = j.at("batches");
    r.repeated = j.at("repeated");
    const std::string status = j.at("status");
    r.status = Status::error;
    for (const Status s : {Status::ok, Status::unsupported, Status::wrong_result})
        if (status == status_name(s)) r.status = s;
    return r;
}

const Row* DeviceRows::ok_row(const std::string& stage) const {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.stage == stage && r.status == Status::ok; });
    return found == rows.end() ? nullptr : &*found;
}

void fill_shares(DeviceRows& device) {
    const Row *fma = device.ok_row("FMA rate"), *copy = device.ok_row("copy"), *triad = device.ok_row("triad");
    const double flops = fma ? fma->flops : 0, bytes = std::max(copy ? copy->bytes : 0, triad ? triad->bytes : 0);
    for (Row& row : device.rows) {
        const auto stage = std::find_if(stages().begin(), stages().end(), [&](const Stage& s) { return s.name == row.stage; });
        if (stage == stages().end() || row.status != Status::ok) continue;
        if (stage->ceiling == Ceiling::arithmetic && flops > 0) row.share = row.flops / flops;
        if (stage->ceiling == Ceiling::bandwidth && bytes > 0) row.share = row.bytes / bytes;
    }
}

} // namespace clvr::bench
