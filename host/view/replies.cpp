#include "host/view/replies.hpp"
#include "host/appearance/transfer_function.hpp"
#include "host/render/scene_settings.hpp"
#include "host/view/limits.hpp"
#include "host/view/net_text.hpp"

#include <limits>
#include <nlohmann/json.hpp>

namespace clvr::view {

namespace {

using nlohmann::ordered_json;

std::string text(const ordered_json& message) { return message.dump(-1, ' ', false, ordered_json::error_handler_t::replace); }

ordered_json presets_json() {
    ordered_json presets = ordered_json::array();
    for (const Preset& preset : transfer_presets())
        presets.push_back({{"name", preset.name},
                           {"description", preset.description},
                           {"transfer", ordered_json::parse(to_json(transfer_preset(preset.name)))}});
    return presets;
}

const char* name_of(SettingRange::Ends ends) {
    return ends == SettingRange::Ends::inside ? "inside" : ends == SettingRange::Ends::outside ? "outside" : "alone";
}

/// JSON has no infinity: an end that is none is null.
ordered_json end_json(double end) { return std::abs(end) < std::numeric_limits<double>::max() ? ordered_json(end) : ordered_json(nullptr); }

ordered_json settings_json() {
    ordered_json settings = ordered_json::array();
    for (const SceneSetting& setting : scene_settings()) {
        ordered_json to{{"key", setting.key},
                        {"name", setting.name},
                        {"help", setting.help ? setting.help : ""},
                        {"low", end_json(setting.range.low)},
                        {"high", end_json(setting.range.high)},
                        {"ends", name_of(setting.range.ends)}};
        visit_setting(setting, Scene(), [&](const auto& usual) { to["default"] = usual; });
        settings.push_back(std::move(to));
    }
    return settings;
}

const char* name_of(JobState state) {
    switch (state) {
    case JobState::waiting:
        return "waiting";
    case JobState::running:
        return "running";
    case JobState::done:
        return "done";
    case JobState::failed:
        return "failed";
    case JobState::cancelled:
        return "cancelled";
    }
    return "";
}

ordered_json json_of(const Job& job) {
    return {{"type", "job"},
            {"job", job.id},
            {"what", name_of(job.what)},
            {"name", job.name},
            {"state", name_of(job.state)},
            {"progress", job.progress},
            {"samples", job.samples},
            {"url", job.state == JobState::done ? "saved/" + job.id + "/" + encoded(job.name) : ""},
            {"message", job.message}};
}

void put_scene(ordered_json& to, const SceneNews& news) {
    const PlacedCamera& camera = news.camera;
    to["generation"] = news.generation;
    to["scene"] = ordered_json::parse(news.scene);
    to["view"] = {{"eye", camera.eye}, {"target", camera.target}, {"up", camera.up}, {"fov", camera.fov}, {"height", camera.height}};
}

} // namespace

Greeting::Greeting(const std::string& version)
    : fixed_(text(
          {{"type", "hello"},
           {"protocol", 1},
           {"version", version},
           {"presets", presets_json()},
           {"settings", settings_json()},
           {"limits", {{"message", largest_message}, {"side", largest_side}, {"samples", largest_samples}, {"views", largest_views}}}})) {}

std::string Greeting::hello(Role role, const std::string& device, const SceneNews& scene, const ordered_json& volume,
                            const std::vector<Job>& jobs) const {
    ordered_json to = ordered_json::parse(fixed_);
    to["role"] = name_of(role);
    to["device"] = device;
    put_scene(to, scene);
    to.update(volume);
    to["jobs"] = ordered_json::array();
    for (const Job& job : jobs) to["jobs"].push_back(json_of(job));
    return text(to);
}

std::string scene_reply(const SceneNews& scene, std::optional<std::uint64_t> id) {
    ordered_json to{{"type", "scene"}};
    if (id) to["id"] = *id;
    put_scene(to, scene);
    return text(to);
}

std::string volume_reply(const ordered_json& volume) {
    ordered_json to{{"type", "volume"}};
    to.update(volume);
    return text(to);
}

std::string refused_scene_reply(std::uint64_t generation, const std::string& message) {
    return text({{"type", "refused"}, {"generation", generation}, {"message", message}});
}
std::string refused_reply(std::uint64_t id, const std::string& message) {
    return text({{"type", "refused"}, {"id", id}, {"message", message}});
}
std::string notice_reply(const char* level, const std::string& message) {
    return text({{"type", "notice"}, {"level", level}, {"message", message}});
}
std::string role_reply(Role role) { return text({{"type", "role"}, {"role", name_of(role)}}); }
std::string clients_reply(std::size_t count) { return text({{"type", "clients"}, {"count", count}}); }
std::string picked_reply(std::uint64_t id, const std::optional<Double3>& position) {
    return text({{"type", "picked"}, {"id", id}, {"position", position ? ordered_json(*position) : ordered_json(nullptr)}});
}
std::string transfer_reply(std::uint64_t id, const std::string& transfer) {
    return text({{"type", "transfer"}, {"id", id}, {"transfer", ordered_json::parse(transfer)}});
}
std::string job_reply(const Job& job, std::optional<std::uint64_t> id) {
    ordered_json to = json_of(job);
    if (id) to["id"] = *id;
    return text(to);
}
std::string bye_reply(const std::string& message) { return text({{"type", "bye"}, {"message", message}}); }

} // namespace clvr::view
