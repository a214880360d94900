// What the server says to its clients, as JSON text.
#pragma once
#include "host/view/jobs.hpp"
#include "host/view/volume_facts.hpp"

#include <optional>
#include <string>

namespace clvr::view {

/// The scene as it stands: `scene` is JSON text (SceneForm::to_page).
struct SceneNews {
    std::uint64_t generation = 0;
    std::string scene;
    PlacedCamera camera{};
};

/// What no client changes: presets, settings, limits, version.
class Greeting {
public:
    explicit Greeting(const std::string& version);
    /// `volume`: volume_json().
    std::string hello(Role role, const std::string& device, const SceneNews& scene, const nlohmann::ordered_json& volume,
                      const std::vector<Job>& jobs) const;

private:
    std::string fixed_; ///< the members that are always the same
};

/// `id`: of the request that this answers.
std::string scene_reply(const SceneNews& scene, std::optional<std::uint64_t> id = {});
std::string volume_reply(const nlohmann::ordered_json& volume);
std::string refused_scene_reply(std::uint64_t generation, const std::string& message);
std::string refused_reply(std::uint64_t id, const std::string& message);
/// level: "warning" or "error".
std::string notice_reply(const char* level, const std::string& message);
std::string role_reply(Role role);
std::string clients_reply(std::size_t count);
std::string picked_reply(std::uint64_t id, const std::optional<Double3>& position);
/// `transfer`: JSON text of clvr's own form.
std::string transfer_reply(std::uint64_t id, const std::string& transfer);
std::string job_reply(const Job& job, std::optional<std::uint64_t> id = {});
std::string bye_reply(const std::string& message);

} // namespace clvr::view
