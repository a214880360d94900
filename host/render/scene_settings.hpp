// The plain settings of a scene, each declared once: scene files, the command line and validation read this table.
#pragma once
#include "host/render/scene.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace clvr {

/// The numbers that a setting may have; all are finite.
struct SettingRange {
    enum class Ends { inside, outside, alone } ends = Ends::inside; ///< `low` and `high` count, do not count, or are the only ones
    double low = 0, high = 0;
    const char* expected = nullptr; ///< how a refusal says it; null: "low to high"
    bool holds(double value) const;
    std::string text() const;
};

/// A number or switch of a scene. Its default is that of the member.
struct SceneSetting {
    const char* key;   ///< in a scene file, "camera.fov" for `fov` in the object `camera`
    const char* name;  ///< in refusals; with `help` also the option of the command line
    const char* group; ///< of the option
    const char*
        help; ///< of the option, without the default, which is added unless the text ends with one in brackets; null: no such option
    std::variant<double& (*)(Scene&), int& (*)(Scene&), std::uint64_t& (*)(Scene&), bool& (*)(Scene&)> member;
    SettingRange range; ///< of doubles and ints

    std::string section() const; ///< "camera", or empty
    std::string member_name() const;
};

/// Calls f(value) with the setting's variable in the scene.
template <class F>
void visit_setting(const SceneSetting& setting, Scene& scene, F&& f) {
    std::visit([&](auto member) { f(member(scene)); }, setting.member);
}
template <class F>
void visit_setting(const SceneSetting& setting, const Scene& scene, F&& f) {
    std::visit([&](auto member) { f(std::as_const(member(const_cast<Scene&>(scene)))); },
               setting.member); // a member function only finds it
}

/// All of them. Options are listed in this order, and so are the members of a section in a scene file.
const std::vector<SceneSetting>& scene_settings();
/// By its key, which must be there.
const SceneSetting& scene_setting(const std::string& key);

template <class E>
using Names = std::vector<std::pair<const char*, E>>;
const Names<Mode>& mode_names();
const Names<Shading>& shading_names();

} // namespace clvr
