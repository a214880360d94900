// What a page says to the server.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace clvr::view {

enum class Role { control, watch };

/// The first message of every client.
struct Hello {
    std::string token;
    Role role = Role::watch; ///< wanted
};
/// The scene to be seen, as JSON text: parse_client_scene().
struct SceneChange {
    std::uint64_t generation = 0;
    std::string scene;
};
/// A picture was drawn.
struct Ack {
    std::uint32_t number = 0;
};
/// The page is hidden, or seen again.
struct Pause {
    bool paused = false;
};
struct TakeControl {};
/// Which place in the world the picture shows there. Shares of its width and height.
struct Pick {
    std::uint64_t id = 0;
    double x = 0, y = 0;
};
/// The text of a transfer-function file.
struct TransferText {
    std::uint64_t id = 0;
    std::string text;
};
/// The text of a scene file.
struct SceneText {
    std::uint64_t id = 0;
    std::string text;
};
struct TimeStep {
    int step = 0;
};
enum class Product { still, turntable, scene, transfer };
struct Save {
    std::uint64_t id = 0;
    Product what = Product::still;
    std::string format = "png";                ///< of a still: png, jpg or exr
    std::optional<int> width, height, samples; ///< else the scene's
    int views = 72;                            ///< of a turntable
};
struct Cancel {
    std::string job;
};

using ClientMessage = std::variant<Hello, SceneChange, Ack, Pause, TakeControl, Pick, TransferText, SceneText, TimeStep, Save, Cancel>;

/// The greatest counter that a page's numbers hold exactly.
inline constexpr std::uint64_t greatest_count = (std::uint64_t{1} << 53) - 1;

/// Throws Error{input} for anything but one JSON object of these, whole and of the right types, without further members. The scene of a
/// SceneChange and the texts of files are not looked into.
ClientMessage parse_message(const std::string& text);

/// The names of roles and products in messages.
const char* name_of(Role role);
const char* name_of(Product product);

} // namespace clvr::view
